"""A free turn of the tip: it arrives wherever the turn that stays does, and is never slower."""

import numpy as np
import pytest

import cspace as cs
from cspace.cartesian import follow_redundant, move_cartesian
from cspace.cartesian.guided import null_bases
from cspace.cartesian.relax_chain import ChainMotion, solve_block_tridiagonal
from cspace.errors import InputError
from cspace.trajectory import arc_path, line_path, pose_path

LIMITS = {"velocity": 2.0, "acceleration": 5.0}
SLOWER = 1.001
"""Durations are known to a thousandth."""

FIVE = [(np.pi / 2, 0, 0.3, 0), (0, 0.4, 0, 0), (0, 0.35, 0, 0), (np.pi / 2, 0, 0, 0), (0, 0, 0.1, 0)]
"""A Denavit–Hartenberg table of an arm whose last joint turns the tip about its z."""


def random_arm(rng):
    """Six revolute joints, none of them redundant; some axes are parallel, perpendicular or meet."""
    while True:
        bends = (0.0, np.pi / 2, -np.pi / 2, rng.uniform(-3.0, 3.0))
        a, d = rng.choice([0.0, 0.2, 0.35], 6), rng.choice([0.0, 0.2], 6)
        robot = cs.Robot.from_dh(
            np.stack([rng.choice(bends, 6), a, d, 0.0 * a], axis=1), convention="standard"
        )
        if not robot.solver.redundant_joints:
            return robot


def random_path(rng, robot, q):
    """A line, an arc or a polyline from a configuration; of an arm with few joints between poses it has."""
    T = robot.fk(q)
    if robot.dof < 6:
        return line_path(T, robot.fk(q + rng.uniform(-0.3, 0.3, robot.dof)))
    size = rng.choice([0.02, 0.1, 0.25])
    goals = [T @ cs.pose(rng.uniform(-size, size, 3), rotvec=rng.uniform(-0.3, 0.3, 3)) for _ in range(2)]
    kind = rng.integers(0, 3)
    if kind == 0:
        return line_path(T, goals[0])
    if kind == 1:
        center = T[:3, 3] + rng.uniform(-0.2, 0.2, 3)
        return arc_path(T, center=center, axis=rng.normal(size=3), angle=rng.uniform(-1.5, 1.5))
    return pose_path(np.array([T, *goals]), deviation=rng.choice([0.0, 0.01]))


def check_law(robot, path, axis, start):
    """A motion with a free turn keeps the axis, arrives where one without does, and is not slower."""
    stays = move_cartesian(robot, path, start, **LIMITS)
    turns = move_cartesian(robot, path, start, free_axis=axis, **LIMITS)
    if stays:
        assert turns, turns.reason
        assert turns.duration <= stays.duration * SLOWER
    if turns:
        s = np.linspace(0.0, path.length, 100)
        tip, wanted = robot.fk(turns.path(s)), path(s)
        a = cs.cartesian.free_turn.tool_axis(axis)
        np.testing.assert_allclose(tip[:, :3, 3], wanted[:, :3, 3], atol=2e-5)
        np.testing.assert_allclose(tip[:, :3, :3] @ a, wanted[:, :3, :3] @ a, atol=2e-5)
        assert start is None or (turns(0.0) == start).all()
        assert (
            (turns.path(s) >= robot.limits.lower - 1e-8) & (turns.path(s) <= robot.limits.upper + 1e-8)
        ).all()
    return bool(stays), bool(turns)


def run_law(robots, seed):
    rng, found = np.random.default_rng(seed), []
    for robot in robots:
        q = robot.random_configuration(rng=rng, reach=rng.choice([0.5, 0.9]))
        axis = rng.choice(["x", "y", "z"]) if rng.random() < 0.6 else rng.normal(size=3)
        start = q if rng.random() < 0.8 else None
        found.append(check_law(robot, random_path(rng, robot, q), axis, start))
    return np.array(found).sum(axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "panda", "iiwa14", "puma560", "irb120", "gen3", "scara"])
def test_a_free_turn_arrives_where_a_fixed_one_does_and_is_never_slower(name):
    stays, turns = run_law([cs.load_robot(name)] * 8, 3)
    assert turns >= stays > 0


def test_the_same_of_random_arms():
    rng = np.random.default_rng(4)
    stays, turns = run_law([random_arm(rng) for _ in range(20)], 5)
    assert turns >= stays > 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_the_same_of_all_arms_of_the_catalogue(seed):
    robots = []
    for name in np.random.default_rng(seed).permutation(cs.robots.names())[:40]:
        robot = cs.load_robot(name)
        if robot.tip is not None and 3 <= robot.dof <= 7 and robot.chain.dof == len(robot.chain.joint_names):
            robots += [robot] if len(robot.solver.redundant_joints) < 2 else []
    stays, turns = run_law(robots, seed)
    assert turns > stays > 0


@pytest.mark.parametrize(
    ("name", "q", "move"),
    [
        ("panda", [0.902, 0.246, -2.701, -1.758, 1.397, 2.841, -2.249], [-0.066, -0.09, -0.051]),
        ("ur5e", [0.546, 5.709, -1.945, -5.121, -3.175, 0.055], [0.083, -0.119, 0.04]),
    ],
)
def test_lines_that_no_chain_of_the_search_follows(name, q, move):
    """A start between the values of the search, and one beside a singular configuration."""
    robot = cs.load_robot(name)
    goal = robot.fk(q).copy()
    goal[:3, 3] += move
    assert check_law(robot, line_path(robot.fk(q), goal), "z", np.array(q)) == (True, True)


def test_no_joint_turns_that_needs_not():
    """The last joint turns the tip about its free axis alone: it rests."""
    robot = cs.Robot.from_dh(FIVE, convention="standard")
    q = np.array([0.2, 0.8, -1.2, -0.6, 0.3])
    goal = robot.fk(q).copy()
    goal[2, 3] += 0.1
    motion = robot.move_linear(goal, start=q, free_axis="z", **LIMITS)
    assert motion.duration == pytest.approx(robot.move_linear(goal, start=q, **LIMITS).duration, rel=1e-3)
    assert np.ptp(motion(np.linspace(0.0, motion.duration, 100))[:, 4]) < 1e-6


def test_a_start_may_be_turned_about_the_axis_and_no_other():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    T = robot.fk(q)
    turned = T @ cs.pose((0, 0, 0), rotvec=(0, 0, 0.7))
    path = line_path(turned, turned @ cs.pose((0.1, 0.05, 0)))
    motion = move_cartesian(robot, path, q, free_axis="z", **LIMITS)
    assert motion
    assert (motion(0.0) == q).all()
    with pytest.raises(InputError, match="rad from the begin"):
        move_cartesian(robot, path, q, free_axis="x", **LIMITS)


def test_as_far_as_possible_a_free_turn_goes_no_less_far():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    options = {"start": q, "as_far_as_possible": True, **LIMITS}
    stays = robot.move_linear(cs.pose((1.4, 0, 0.3)), **options)
    turns = robot.move_linear(cs.pose((1.4, 0, 0.3)), free_axis="z", **options)
    assert stays.stopped_by
    assert turns.stopped_by
    assert turns.s_end >= stays.s_end * (1 - 1e-3)


def test_a_planar_arm_with_a_redundant_joint_follows_a_path():
    """The null space has one dimension although there are fewer than seven joints."""
    robot = cs.Robot.from_dh([(0.0, 0.4, 0.0, 0.0)] * 4, convention="standard")
    q = np.array([0.4, 0.5, -0.6, 0.7])
    T = robot.fk(q)
    path = line_path(T, T @ cs.pose((-0.1, -0.05, 0), rpy=(0, 0, 0.2)))
    branch = follow_redundant(robot, path, q)
    assert branch, branch.reason
    s = np.linspace(0.0, path.length, 100)
    np.testing.assert_allclose(robot.fk(branch.path(s)), path(s), atol=2e-5)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 16, 17, 100])
@pytest.mark.parametrize("k", [0, 1, 2, 3])
def test_block_tridiagonal_systems_as_a_dense_solver_does(n, k):
    rng = np.random.default_rng(n + k)
    beside, half = rng.normal(size=(n - 1, k, k)), rng.normal(size=(n, k, k))
    blocks = half @ np.swapaxes(half, 1, 2) + 6.0 * np.eye(k)
    dense, row = np.zeros((n, k, n, k)), np.arange(n)
    dense[row, :, row, :] = blocks
    dense[row[:-1], :, row[1:], :] = beside
    dense[row[1:], :, row[:-1], :] = np.swapaxes(beside, 1, 2)
    right = rng.normal(size=(n, k))
    wanted = np.linalg.solve(dense.reshape(n * k, n * k), right.ravel()).reshape(n, k)
    np.testing.assert_allclose(solve_block_tridiagonal(blocks, beside, right), wanted, atol=1e-9)


@pytest.mark.parametrize("name", ["panda", "iiwa14", "xarm7"])
def test_a_relaxed_chain_reaches_its_poses_and_no_chain_beside_it_moves_less(name):
    robot = cs.load_robot(name)
    q = robot.random_configuration(rng=np.random.default_rng(1), reach=0.4)
    T = robot.fk(q)
    path = line_path(T, T @ cs.pose((0.05, -0.05, 0.08)))
    branch = follow_redundant(robot, path, q)
    s = np.linspace(0.0, path.length, 17)
    none = cs.Limits(np.full(robot.dof, -np.inf), np.full(robot.dof, np.inf))
    motion = ChainMotion(robot, s, path(s), 1, np.ones(robot.dof), none)
    relaxed = motion.relax(motion.relax(branch.path(s), keeps_start=True), keeps_start=True)
    np.testing.assert_allclose(robot.fk(relaxed), path(s), atol=1e-6)
    np.testing.assert_array_equal(relaxed[0], branch.path(0.0))

    def measure(chain):
        return np.sum(np.diff(chain, axis=0) ** 2)

    assert measure(relaxed) <= measure(branch.path(s)) * (1 + 1e-6)
    bent = np.sin(np.pi * s / path.length)[:, None] * null_bases(robot, relaxed, 1)[:, 0]
    slope = (measure(relaxed + 1e-3 * bent) - measure(relaxed - 1e-3 * bent)) / 2e-3
    assert abs(slope) < 0.02 * np.sqrt(measure(relaxed) * measure(bent))
