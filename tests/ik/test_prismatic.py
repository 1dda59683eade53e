"""Joints that turn or slide, up to six in any order: every solution, certified, against many starts."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cspace.model import from_screws
from cspace.robot import Robot
from ik.geometries import unit
from oracles import ik_many_starts

WORDS = ["".join(w) for n in (4, 5, 6) for w in product("RP", repeat=n) if "P" in w and w.count("P") <= 3]
X, Y, Z = np.eye(3).tolist()
O = [0.0, 0.0, 0.0]


def arm_of(word, axes, points, tip):
    T_zero = np.eye(4)
    T_zero[:3, 3] = tip
    return Robot(from_screws(axes, points, T_zero, joint_types=word))


MACHINES = {
    "SCARA": arm_of("RRRP", [Z, Z, Z, Z], [O, [0.4, 0, 0], [0.7, 0, 0], [0.7, 0, 0]], [0.7, 0, 0.1]),
    "SCARA, slide third": arm_of("RRPR", [Z] * 4, [O, [0.4, 0, 0], O, [0.7, 0, 0]], [0.7, 0, 0.1]),
    "SCARA, slide first": arm_of("PRRR", [Z] * 4, [O, O, [0.4, 0, 0], [0.7, 0, 0]], [0.7, 0, 0.1]),
    "cylindrical": arm_of("RPPRRR", [Z, Z, X, Z, Y, X], [O, O, O] + [[0.5, 0, 0.3]] * 3, [0.6, 0, 0.3]),
    "polar": arm_of("RRPRRR", [Z, Y, X, X, Y, X], [O, [0, 0, 0.4], O] + [[0.5, 0, 0.4]] * 3, [0.6, 0, 0.4]),
    "Stanford": arm_of(
        "RRPRRR",
        [Z, Y, Z, Z, Y, Z],
        [O, [0, 0.15, 0.4], [0, 0.15, 0.4]] + [[0, 0.15, 0.4]] * 3,
        [0, 0.15, 0.6],
    ),
    "gantry with wrist": arm_of("PPPRRR", [X, Y, Z, Z, Y, Z], [O] * 6, [0, 0, -0.2]),
    "gantry on a turntable": arm_of("RPPPRR", [Z, X, Y, Z, Y, X], [O] * 6, [0.1, 0, -0.2]),
    "five-axis machine": arm_of("PPPRR", [X, Y, Z, Z, Y], [O] * 5, [0, 0, -0.2]),
    "wrist at the base": arm_of(
        "RRRPRP", [Z, Y, Z, X, Z, [0, 0.6, 0.8]], [O, O, O, O, [0.3, 0.1, 0], O], [0.5, 0, 0.2]
    ),
    "arm on a cross slide": arm_of(
        "PPRRRR", [X, Y, Z, Y, X, Y], [O, O, O, [0, 0, 0.3], [0, 0, 0.6], [0, 0, 0.6]], [0.1, 0, 0.6]
    ),
}


def random_arm(word, rng):
    axes = [unit(v) for v in rng.normal(size=(len(word), 3))]
    return arm_of(word, axes, rng.uniform(-1, 1, (len(word), 3)), rng.uniform(-1, 1, 3))


def slides_of(robot):
    return np.array([kind == "P" for kind in robot.joint_types])


def random_q(robot, rng, n, size=1.0):
    return np.where(
        slides_of(robot),
        size * rng.uniform(0.1, 1, (n, robot.dof)),
        rng.uniform(-np.pi, np.pi, (n, robot.dof)),
    )


def gap(robot, a, b):
    """Largest difference of two configurations, turns on the circle [rad, m]."""
    d = np.asarray(a) - b
    return np.abs(np.where(slides_of(robot), d, (d + np.pi) % (2 * np.pi) - np.pi)).max(axis=-1)


def expect_all(robot, q):
    """Every answer reaches its goal, q is among them, and the certificate holds."""
    batch = robot.ik(robot.fk(q))
    size = max(1.0, np.abs(robot.chain.points).max())
    assert np.nanmax(batch.residual) < 1e-10 * size
    assert np.nanmin(gap(robot, batch.q, q[:, None]), axis=1).max() < 1e-6 * size
    assert batch.complete.mean() >= 0.995
    return batch


@pytest.mark.parametrize("word", WORDS)
def test_every_order_in_general_position(word):
    rng = np.random.default_rng([1, *map(ord, word)])
    for _ in range(2):
        robot = random_arm(word, rng)
        batch = expect_all(robot, random_q(robot, rng, 200))
        if len(word) == 6:
            most = {1: 16, 2: 8, 3: 2}[word.count("P")]
            assert batch.count.max() <= most
            assert (batch.count % 2 == 0).mean() > 0.99
        else:
            assert (batch.count == 1).all()


@pytest.mark.parametrize("name", MACHINES)
def test_machines(name):
    robot = MACHINES[name]
    expect_all(robot, random_q(robot, np.random.default_rng([2, *map(ord, name)]), 500))


@pytest.mark.parametrize("name", ["SCARA", "cylindrical", "Stanford", "arm on a cross slide"])
@pytest.mark.parametrize("size", [1e-3, 1e3])
def test_small_and_large_machines(name, size):
    c, word = MACHINES[name].chain, MACHINES[name].joint_types
    robot = arm_of(word, c.axes, size * c.points, size * c.T_zero[:3, 3])
    q = random_q(robot, np.random.default_rng(3), 100, size)
    batch = robot.ik(robot.fk(q))
    units = np.where(slides_of(robot), size, 1.0)
    d = (batch.q - q[:, None]) / units
    d = np.where(slides_of(robot), d, (d + np.pi) % (2 * np.pi) - np.pi)
    assert np.nanmin(np.abs(d).max(axis=2), axis=1).max() < 1e-6


@pytest.mark.parametrize("name", MACHINES)
def test_many_starts_find_nothing_else_on_machines(name):
    expect_nothing_else(MACHINES[name], 4)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(
    word=st.text("RP", min_size=4, max_size=6).filter(lambda w: w.count("P") <= 3), seed=st.integers(0, 10**6)
)
def test_many_starts_find_nothing_else_on_random_arms(word, seed):
    expect_nothing_else(random_arm(word, np.random.default_rng(seed)), seed)


def expect_nothing_else(robot, seed):
    rng = np.random.default_rng([4, seed])
    c = robot.chain
    goals = robot.fk(random_q(robot, rng, 2))
    oracle = ik_many_starts.all_solutions(
        c.axes, c.points, c.T_zero, goals, joint_types=robot.joint_types, rng=seed, starts=150
    )
    for T, expected in zip(goals, oracle, strict=True):
        found = robot.ik(T)
        if np.linalg.svd(robot.jacobian(found.q), compute_uv=False)[:, -1].min() > 1e-4:
            assert max(gap(robot, found.q, row).min() for row in expected) < 1e-6
        assert len(found) >= len(expected)


def test_a_tilt_that_a_scara_cannot_take_is_named():
    robot = MACHINES["SCARA"]
    T = robot.fk([0.3, -0.8, 0.2, 0.1])
    T[:3, :3] = T[:3, :3] @ [[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]]
    found = robot.ik(T)
    assert not found
    assert found.status == "unreachable"
    assert "orientation" in found.reason
    best = robot.ik(T, least_squares=True)
    assert best.status == "least_squares"


def test_a_slide_reaches_as_far_as_it_likes():
    robot = MACHINES["polar"]
    for far in (10.0, 1e3):
        T = robot.fk([0.3, -0.8, far, 0.1, 0.4, -0.2])
        assert gap(robot, robot.ik(T).q, [0.3, -0.8, far, 0.1, 0.4, -0.2]).min() < 1e-6


def on_the_border(robot, rng, joints=3):
    """A configuration in which the first joints, which place the wrist, are singular."""
    while True:
        q, j = random_q(robot, rng, 1)[0], rng.integers(joints)
        rows = np.repeat(q[None], 81, axis=0)
        rows[:, j] = np.linspace(-3.0, 3.0, 81)
        sign = np.sign(np.linalg.det(robot.jacobian(rows)))
        if len(turns := np.flatnonzero(sign[:-1] != sign[1:])):
            break
    k = rng.choice(turns)
    low, high = rows[k, j], rows[k + 1, j]
    for _ in range(60):
        q[j] = 0.5 * (low + high)
        low, high = (q[j], high) if np.sign(np.linalg.det(robot.jacobian(q))) == sign[k] else (low, q[j])
    return q


@pytest.mark.parametrize("place", ["PRR", "RPR", "RRP", "PPR", "PRP", "RPP"])
def test_a_slide_and_a_wrist_on_the_border_of_their_reach_and_beyond(place):
    rng, empty = np.random.default_rng([4, *map(ord, place)]), 0
    for _ in range(4):
        points = np.vstack([rng.uniform(-1, 1, (3, 3)), np.repeat(rng.uniform(-1, 1, (1, 3)), 3, axis=0)])
        axes = [unit(v) for v in rng.normal(size=(6, 3))]
        robot = arm_of(place + "RRR", axes, points, rng.uniform(-1, 1, 3))
        for _ in range(3):
            q = on_the_border(robot, rng)
            T = robot.fk(q)
            found = robot.ik(T)
            assert gap(robot, found.q, q).min() < 1e-4
            across = np.linalg.svd(robot.jacobian(q))[0][:3, -1]
            for step in (-0.3, -0.01, 0.01, 0.3):
                beyond = T.copy()
                beyond[:3, 3] += step * unit(across)
                answer = robot.ik(beyond)
                if not answer:
                    empty += 1
                    assert answer.status == "unreachable"
                    assert not robot.ik_many_starts(beyond, 60, rng=0, limits=False)
    assert empty > 0 or place == "RRP"  # it reaches almost everything


def test_axes_parallel_and_square_in_odd_places():
    """No closed form and no regular formulation: neighbours of the arm lead to its solutions."""
    robot = arm_of(
        "RRRRPR",
        [Z, X, X, Y, Z, Y],
        [O, [0, 0, 0.3], [0, 0.4, 0.3], [0.1, 0.4, 0.3], O, [0.1, 0.6, 0.5]],
        [0.2, 0.6, 0.5],
    )
    q = random_q(robot, np.random.default_rng(5), 200)
    batch = robot.ik(robot.fk(q))
    assert np.nanmin(gap(robot, batch.q, q[:, None]), axis=1).max() < 1e-5
    assert np.nanmax(batch.residual) < 1e-9


@pytest.mark.parametrize(
    ("name", "q"),
    [
        ("Stanford", [0.3, 0.4, 0.5, 0.2, 0.0, 0.6]),
        ("gantry with wrist", [0.3, 0.4, 0.5, 0.2, 0.0, 0.6]),
        ("cylindrical", [0.3, 0.4, 0.5, 0.2, 0.0, 0.6]),
        ("arm on a cross slide", [0.3, 0.4, 0.5, 0.2, 0.0, 0.6]),
    ],
)
def test_a_wrist_in_line_is_one_family_and_not_a_handful(name, q):
    robot, q = MACHINES[name], np.array(q)
    T = robot.fk(q)
    found = robot.ik(T)
    lost = np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] < 1e-9
    assert (found.status == "singular") == lost
    assert found.residual.max() < 1e-9
    for self_motion in found.self_motions:
        moved = (
            self_motion.q
            + np.linspace(-np.pi, np.pi, 73)[:, None]
            * self_motion.direction
            / np.abs(self_motion.direction).max()
        )
        if np.abs(robot.fk(moved) - T).max() > 1e-9:
            continue  # a curve that is not straight
        apart = [gap(robot, moved, row).min() for k, row in enumerate(found.q) if k != self_motion.row]
        assert min(apart, default=1) > 0.05
    again = robot.ik(T, near=q)
    assert gap(robot, again.q, q).min() < 1e-6


def test_free_joints_of_a_family_stand_at_zero_or_where_they_were():
    robot = MACHINES["gantry with wrist"]
    T = robot.fk([0.3, 0.4, 0.5, 0.2, 0.0, 0.6])
    found = robot.ik(T)
    assert len(found) == 1
    assert found.q[0] == pytest.approx([0.3, 0.4, 0.5, 0.0, 0.0, 0.8], abs=1e-9)
    kept = robot.ik(T, near=[0, 0, 0, -1.0, 0, 0])
    assert kept.q[0] == pytest.approx([0.3, 0.4, 0.5, -1.0, 0.0, 1.8], abs=1e-9)
