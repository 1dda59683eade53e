"""Arms whose joints do each other's work, of any number of joints: every goal that a configuration makes is
answered, and rightly."""

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import cspace as cs
from cspace.ik import geometry
from cspace.robot import Robot
from ik.arms import shared_chains

SHAPES = ("random", "aligned", "parallel", "coaxial")
SETTINGS = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))


def shaped_arm(rng, word, shape):
    """Axes without a pattern, along the coordinate axes, mostly parallel, or often on the line of another."""
    n = len(word)
    axes, points = np.empty((2, n, 3))
    for i in range(n):
        h, p = rng.normal(size=3), rng.uniform(-1, 1, 3)
        if shape == "aligned":
            h, p = np.eye(3)[rng.integers(3)], 0.5 * rng.integers(-1, 2, 3)
        elif shape == "parallel" and rng.random() < 0.7:
            h = np.array([0, 0, 1.0])
        elif shape == "coaxial" and i and rng.random() < 0.4:
            other = rng.integers(i)
            h, p = axes[other], points[other]
        axes[i], points[i] = h / np.linalg.norm(h), p
    T_zero = np.eye(4)
    T_zero[:3, 3] = rng.uniform(-1, 1, 3)
    return Robot.from_screws(axes, points, T_zero, joint_types=word)


def generic_rank(robot):
    q = np.random.default_rng(0).uniform(-2, 2, (20, robot.dof))
    return int((np.linalg.svd(robot.jacobian(q), compute_uv=False) > 1e-6).sum(axis=-1).max())


def gaps(robot, q, row):
    turns = np.array([kind == "R" for kind in robot.joint_types])
    return np.where(turns, np.angle(np.exp(1j * (q - row))), q - row)


words = st.text("RP", min_size=1, max_size=6)
seeds = st.integers(0, 2**32 - 1)


@SETTINGS
@given(words, st.sampled_from(SHAPES), seeds)
def test_no_arm_is_refused(word, shape, seed):
    rng = np.random.default_rng(seed)
    robot = shaped_arm(rng, word, shape)
    T = robot.fk(rng.uniform(-2, 2, robot.dof))
    s = robot.ik(T)
    assert s
    assert s.residual.max() <= 1e-9
    assert np.abs(robot.fk(s.q) - T).max() < 1e-8
    assert geometry(robot).family != "none"
    if s.freedom:
        assert len(s.freedom) == robot.dof - generic_rank(robot)


def partial_goals(T):
    p, z = T[:3, 3], T[:3, 2]
    yield {"position": p}
    yield {"position": p, "direction": z}
    yield {"direction": z}
    yield {"rotation": T[:3, :3]}
    yield {"look_at": p + 0.3 * z}
    yield {"ray": (p - 0.2 * z, z)}
    yield {"position": (p[0], None, p[2])}
    yield {"position": p, "angle_to": ("z", np.arctan2(np.hypot(z[0], z[1]), z[2]))}


@pytest.mark.slow
@SETTINGS
@given(words, st.sampled_from(SHAPES), seeds)
@example("PRRRR", "parallel", 35865)  # the joint that is held rests along the self-motion
@example("RRRRR", "parallel", 39916800)  # the last step towards a start leads away from the goal
@example("RRRRR", "aligned", 2)
def test_partial_goals_are_answered(word, shape, seed):
    rng = np.random.default_rng(seed)
    robot = shaped_arm(rng, word, shape)
    for goal in partial_goals(robot.fk(rng.uniform(-2, 2, robot.dof))):
        s = robot.ik(**goal)
        assert s, goal
        assert s.residual.max() <= 1e-9, goal


@settings(SETTINGS, max_examples=25)
@given(st.integers(7, 16), st.sampled_from(SHAPES), seeds)
def test_long_arms_of_low_rank(n, shape, seed):
    rng = np.random.default_rng(seed)
    robot = shaped_arm(rng, "".join(rng.choice(list("RP"), p=[0.3, 0.7], size=n)), shape)
    q = rng.uniform(-2, 2, n)
    T = robot.fk(q)
    for s in (robot.ik(T), robot.ik(T, near=q + 0.01)):
        assert s
        assert s.residual.max() <= 1e-9
        assert len(s.freedom) == n - generic_rank(robot)


def planar_arm(n):
    """n joints with parallel axes, a rod between each two."""
    points = np.stack([0.3 * np.arange(n), np.zeros(n), np.zeros(n)], axis=1)
    T_zero = np.eye(4)
    T_zero[0, 3] = 0.3 * n
    return Robot.from_screws(np.tile([0, 0, 1.0], (n, 1)), points, T_zero, joint_types="R" * n)


@pytest.mark.parametrize("n", [4, 5, 7])
def test_the_nearest_of_a_planar_arm(n):
    """No configuration nearby on the self-motion is nearer: the way to the seed is square to all of it."""
    robot, rng = planar_arm(n), np.random.default_rng(n)
    for _ in range(10):
        q = rng.uniform(-2, 2, n)
        seed = q + rng.uniform(-0.2, 0.2, n)
        s = robot.ik(robot.fk(q), near=seed)
        assert len(s) == 1
        assert s.residual[0] < 1e-10
        gap = gaps(robot, s.q[0], seed)
        assert np.linalg.norm(gap) <= np.linalg.norm(gaps(robot, q, seed)) + 1e-12
        moves = np.linalg.svd(robot.jacobian(s.q[0]))[2][3:]
        assert np.abs(moves @ gap).max() < 1e-8
        assert len(s.freedom) == n - 3


def test_four_joints_of_a_planar_arm_against_a_sweep():
    """Of the samples spread over the feasible intervals all reach the goal, and the intervals are those of a
    dense sweep of the joint that is held.
    """
    robot = planar_arm(4)
    T = robot.fk([0.4, 0.9, -0.7, 0.5])
    found = robot.redundancy(T)
    joint = robot.joint_names.index(found.parameter)
    values = np.linspace(-np.pi, np.pi, 2000, endpoint=False)
    counts = robot.ik(T, locked={joint: values}).count
    assert found.complete
    assert [len(found.feasible(v)) for v in values] == counts.tolist()
    s = robot.ik(T, samples=12)
    assert len({round(v, 9) for v in s.q[:, joint]}) == 12
    assert s.residual.max() < 1e-12


def test_two_turns_on_one_line_share_an_angle():
    axes = [[0, 0, 1], [0, 0, 1], [0, 1, 0], [0, 1, 0]]
    points = [[0, 0, 0], [0, 0, 0.2], [0, 0, 0.4], [0.5, 0, 0.4]]
    T_zero = np.eye(4)
    T_zero[:3, 3] = [1, 0, 0.4]
    robot = Robot.from_screws(axes, points, T_zero, joint_types="RRRR")
    q = np.array([0.3, 0.5, -0.4, 0.9])
    s = robot.ik(robot.fk(q))
    assert len(s.freedom) == 1
    assert np.abs(gaps(robot, s.q[:, :2].sum(axis=1)[:, None], 0.8)[..., 0]).min(initial=1) < 1e-9
    assert np.abs(np.sin(s.q[:, 0] + s.q[:, 1] - 0.8)).max() < 1e-9
    near = robot.ik(robot.fk(q), near=[0.2, 0.8, -0.4, 0.9])
    assert near.q[0] == pytest.approx([0.1, 0.7, -0.4, 0.9], abs=1e-9)  # the excess shared evenly
    locked = robot.ik(robot.fk(q), locked={0: 0.1})
    assert np.abs(gaps(robot, locked.q, [0.1, 0.7, -0.4, 0.9])).max(axis=1).min() < 1e-9


def test_parallel_slides_without_limits_share_a_way():
    axes = [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 1, 0]]
    robot = Robot.from_screws(axes, np.zeros((4, 3)), np.eye(4), joint_types="PPRR")
    s = robot.ik(robot.fk([2.0, -0.5, 0.3, 0.2]))
    assert s.complete
    assert len({round(v, 6) for v in s.q[:, 0]}) == 16
    assert np.abs(s.q[:, 0] + s.q[:, 1] - 1.5).max() < 1e-9
    assert np.abs(s.residual).max() < 1e-9


def test_what_is_out_of_reach_says_so():
    robot = planar_arm(5)
    T = robot.fk(np.full(5, 0.2))
    T[2, 3] = 0.25
    s = robot.ik(T)
    assert not s
    assert s.status == "unreachable"
    assert s.out_of_reach == pytest.approx(0.25, abs=1e-6)
    assert robot.ik(T, least_squares=True).q.shape == (1, 5)


def test_batches():
    robot = planar_arm(4)
    q = np.random.default_rng(2).uniform(-1, 1, (5, 4))
    b = robot.ik(robot.fk(q))
    assert b.count.min() > 0
    assert np.nanmax(b.residual) < 1e-9
    assert len(b[0]) == b.count[0]
    near = robot.ik(robot.fk(q), near=q)
    assert np.abs(gaps(robot, near.q[:, 0], q)).max() < 1e-8


def test_an_arm_whose_tool_turns_about_its_last_axis():
    """The last joint of so101 turns the tool about the axis that is asked for: the goal leaves it free."""
    robot = cs.load_robot("so101")
    for q in robot.random_configuration(5, rng=4):
        T = robot.fk(q)
        s = robot.ik(position=T[:3, 3], direction=T[:3, 2])
        assert s
        assert s.residual.max() < 1e-9


@pytest.mark.parametrize("name", sorted(shared_chains()))
def test_every_chain_of_the_shared_data_is_answered(name):
    row = shared_chains()[name]
    kinds = ["P" if joint["type"] == "prismatic" else "R" for joint in row["joints"]]
    axes, points = ([joint[key] for joint in row["joints"]] for key in ("axis", "point"))
    robot = Robot.from_screws(axes, points, np.array(row["tool_zero"]), joint_types="".join(kinds), name=name)
    q = np.random.default_rng(1).uniform(-1, 1, len(kinds))
    T = robot.fk(q)
    s = robot.ik(T)
    assert s
    assert s.residual.max() <= 1e-9
    position = robot.ik(position=T[:3, 3], direction=T[:3, 2])
    assert position
    assert position.residual.max() <= 1e-9
