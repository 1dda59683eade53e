"""Six revolute joints in general position: every solution, certified, against two oracles."""

import numpy as np
import pytest

from cspace.model import from_screws
from cspace.robot import Robot
from ik.arms import load
from ik.geometries import angle_gap, random_q, unit
from oracles import companion, ik_many_starts

ARMS = ["jaco2", "crx10ia", "xarm6", "piper", "gen3_lite", "m1013"]


def random_arm(rng):
    axes = np.array([unit(v) for v in rng.normal(size=(6, 3))])
    T_zero = np.eye(4)
    T_zero[:3, 3] = rng.uniform(-1, 1, 3)
    return Robot(from_screws(axes, rng.uniform(-1, 1, (6, 3)), T_zero))


def calibrated(name, size, rng):
    """A catalogue arm with its axes and offsets disturbed, as a calibration finds them."""
    c = load(name).chain
    axes = np.array([unit(h + size * rng.normal(size=3)) for h in c.axes])
    return Robot(
        from_screws(axes, c.points + size * rng.normal(size=(6, 3)), c.T_zero, name=f"{name} measured")
    )


def scaled(robot, factor):
    c = robot.chain
    T_zero = c.T_zero.copy()
    T_zero[:3, 3] *= factor
    return Robot(from_screws(c.axes, factor * c.points, T_zero))


def expect_all(robot, q, share=1.0):
    """Every answer reaches its goal, q is among them, and the certificate holds on a share of the goals."""
    goals = robot.fk(q)
    batch = robot.ik(goals)
    size = max(1.0, np.abs(robot.chain.points).max())
    assert np.nanmax(batch.residual) < 1e-11 * size
    assert np.nanmin(angle_gap(batch.q, q[:, None]), axis=1).max() < 1e-6
    assert np.mean(batch.complete) >= share
    assert (batch.count[batch.complete] % 2 == 0).all()
    return goals, batch


@pytest.mark.parametrize("name", ARMS)
def test_every_configuration_is_recovered_and_the_list_certified(name):
    expect_all(load(name), random_q(np.random.default_rng([1, *map(ord, name)]), 2000, 6), 0.999)


@pytest.mark.parametrize("seed", range(6))
def test_random_arms(seed):
    rng = np.random.default_rng([2, seed])
    expect_all(random_arm(rng), random_q(rng, 500, 6), 0.998)


@pytest.mark.parametrize("size", [1e-3, 1e-4])
@pytest.mark.parametrize("name", ["ur5e", "puma560", "irb120", "kr6_r900", "jaco2", "crx10ia"])
def test_calibrated_arms(name, size):
    rng = np.random.default_rng([3, *map(ord, name)])
    expect_all(calibrated(name, size, rng), random_q(rng, 500, 6), 0.998)


@pytest.mark.slow
@pytest.mark.parametrize("name", ARMS)
def test_the_companion_matrix_finds_nothing_else(name):
    """On poses of each arm the eigenvalues of the 24 × 24 matrix give no solution that is not listed."""
    robot, rng = load(name), np.random.default_rng([4, *map(ord, name)])
    c = robot.chain
    agreed = 0
    for T in robot.fk(random_q(rng, 6, 6)):
        found = robot.ik(T)
        expected = companion.all_solutions(c.axes, c.points, c.T_zero, T, rng)
        gaps = [angle_gap(found.q, row).min() for row in expected]
        assert max(gaps, default=0) < 1e-5
        agreed += len(expected) == len(found)
    assert agreed >= 3


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_many_starts_find_nothing_else(seed):
    rng = np.random.default_rng([5, seed])
    robot = random_arm(rng)
    c = robot.chain
    goals = robot.fk(random_q(rng, 4, 6))
    for T, expected in zip(
        goals, ik_many_starts.all_solutions(c.axes, c.points, c.T_zero, goals, rng=seed), strict=True
    ):
        found = robot.ik(T)
        assert len(found) == len(expected)
        assert max(angle_gap(found.q, row).min() for row in expected) < 1e-6


@pytest.mark.parametrize("factor", [1e-3, 1e3])
@pytest.mark.parametrize("name", ["jaco2", "xarm6"])
def test_small_and_large_arms_have_the_same_solutions(name, factor):
    robot, rng = load(name), np.random.default_rng(6)
    other = scaled(robot, factor)
    for q in random_q(rng, 50, 6):
        a, b = robot.ik(robot.fk(q)).q, other.ik(other.fk(q)).q
        assert len(a) == len(b)
        assert max(angle_gap(b, row).min() for row in a) < 1e-7


def test_the_arm_with_sixteen_solutions():
    """Manseur and Doty 1989: six revolute joints can reach a pose in sixteen ways."""
    alpha = np.radians([90, 1, 90, 1, 90, 0])
    table = np.column_stack(
        [alpha, [0.3, 1.0, 0.0, 1.5, 0.0, 0.0], [0.0, 0.0, 0.2, 0.0, 0.0, 0.0], np.zeros(6)]
    )
    robot = Robot.from_dh(table, convention="standard")
    T = np.array(
        [
            [-0.760117, -0.641689, 0.102262, -1.140175],
            [0.133333, 0.0, 0.991071, 0.0],
            [-0.635959, 0.766965, 0.085558, 0.0],
            [0, 0, 0, 1],
        ]
    )
    U, _, Vt = np.linalg.svd(T[:3, :3])
    T[:3, :3] = U @ Vt
    found = robot.ik(T)
    assert len(found) == 16
    assert found.complete


def test_poses_out_of_reach_say_by_how_much():
    robot = load("jaco2")
    T = robot.fk(np.full(6, 0.4))
    for far in (3.0, 1e3, 1e9):
        T[:3, 3] = [far, 0.1, 0.2]
        found = robot.ik(T)
        assert not found
        assert found.status == "unreachable"
        assert found.complete
        assert far - 2 < found.out_of_reach < far + 1


def test_near_gives_the_nearest_of_all():
    rng = np.random.default_rng(7)
    robot = random_arm(rng)
    for q in random_q(rng, 20, 6):
        T, seed = robot.fk(q), random_q(rng, 6)
        every = robot.ik(T).q
        gaps = (every - seed + np.pi) % (2 * np.pi) - np.pi
        assert np.linalg.norm(robot.ik(T, near=seed).q[0] - seed) == pytest.approx(
            np.linalg.norm(gaps, axis=1).min(), abs=1e-9
        )


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("name", ARMS)
def test_solutions_near_singular_ones_are_recovered(name, off):
    robot, rng = load(name), np.random.default_rng([8, *map(ord, name)])
    q = np.array([near_singular(robot, rng, off) for _ in range(60)])
    batch = robot.ik(robot.fk(q))
    weakest = np.linalg.svd(robot.jacobian(q), compute_uv=False)[:, -1]
    allowed = np.maximum(1e-5, 1e-13 / weakest)
    assert (np.nanmin(angle_gap(batch.q, q[:, None]), axis=1) <= allowed).all()
    assert np.nanmax(batch.residual) < 1e-9


def near_singular(robot, rng, off):
    """A configuration `off` [rad] in one joint from where the determinant of the Jacobian changes sign."""
    while True:
        q, joint = random_q(rng, 6), rng.integers(1, 5)
        grid = np.linspace(-np.pi, np.pi, 121)
        line = np.tile(q, (len(grid), 1))
        line[:, joint] = grid
        signs = np.sign(np.linalg.det(robot.jacobian(line)))
        flips = np.flatnonzero(signs[:-1] * signs[1:] < 0)
        if len(flips) == 0:
            continue
        k = rng.choice(flips)
        low, high = grid[k], grid[k + 1]
        for _ in range(60):
            q[joint] = (low + high) / 2
            if np.sign(np.linalg.det(robot.jacobian(q))) == signs[k]:
                low = q[joint]
            else:
                high = q[joint]
        q[joint] += off * rng.choice([-1, 1])
        return q
