"""Joint paths along Cartesian paths: they keep to them, and where a branch ends is said."""

import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.cartesian import follow_cartesian
from cspace.errors import InputError
from cspace.trajectory import arc_path, line_path, pose_path

ARMS = ("ur5e", "puma560", "crx10ia", "irb140", "panda", "iiwa14")
SEEDS = range(3)
TOLERANCE = 1e-5


def path_from(robot, q, rng, kind):
    """A path of some decimetres from a configuration."""
    T = robot.fk(q)
    step = np.concatenate([rng.uniform(-0.15, 0.15, 3), rng.uniform(-0.4, 0.4, 3)])
    goal = np.eye(4)
    goal[:3, :3] = cs.spatial.exp_so3(step[3:]) @ T[:3, :3]
    goal[:3, 3] = T[:3, 3] + step[:3]
    if kind == "line":
        return line_path(T, goal)
    if kind == "arc":
        center = T[:3, 3] + rng.uniform(-0.1, 0.1, 3)
        return arc_path(T, center=center, axis=rng.normal(size=3), angle=rng.uniform(-1.5, 1.5))
    return pose_path([T, goal, robot.fk(q + rng.uniform(-0.2, 0.2, robot.dof))], deviation=0.02)


def distance(robot, joints, path, count=400):
    s = np.linspace(0, path.length, count)
    T, wanted = robot.fk(joints(s)), path(s)
    off = np.linalg.norm(T[:, :3, 3] - wanted[:, :3, 3], axis=1).max()
    return max(off, np.linalg.norm(T[:, :3, :3] - wanted[:, :3, :3], axis=(1, 2)).max() / np.sqrt(2))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", ["line", "arc", "poses"])
@pytest.mark.parametrize("name", ARMS)
def test_joint_paths_keep_to_the_cartesian_path(name, kind, seed):
    robot = cs.load_robot(name)
    rng = np.random.default_rng([seed, len(name)])
    arrived = 0
    for q in robot.random_configuration(4, rng=rng, reach=0.6):
        path = path_from(robot, q, rng, kind)
        found = follow_cartesian(robot, path, tolerance=TOLERANCE)
        assert bool(found) == any(found.branches)
        for branch in found.branches:
            if branch:
                arrived += 1
                assert branch.path.length == path.length
                assert max(branch.deviation) <= TOLERANCE
                assert distance(robot, branch.path, path) <= 1.5 * TOLERANCE
                twist, _ = path.twists(path.length / 3)
                np.testing.assert_allclose(
                    robot.jacobian(branch.path(path.length / 3)) @ branch.path(path.length / 3, 1),
                    twist,
                    atol=1e-2,
                )
            else:
                assert branch.reason.startswith("at s = ")
                assert branch.cause in ("limit", "singularity", "jump", "unreachable")
                assert 0 <= branch.s_end <= path.length
    assert arrived > 0


@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda"])
def test_slopes_and_bends_are_those_of_the_joints(name):
    """The derivatives at nodes, against differences of the joint path that its neighbours make."""
    robot = cs.load_robot(name)
    for q in robot.random_configuration(20, rng=5, reach=0.5):
        T = robot.fk(q)
        path = arc_path(T, center=T[:3, 3] + [0.1, 0.05, 0], axis=(0, 1, 1), angle=0.8)
        if follow_cartesian(robot, path, q):
            break
    coarse = follow_cartesian(robot, path, q).branches[0].path
    fine = follow_cartesian(robot, path, q, tolerance=1e-10).branches[0].path
    assert len(fine) > len(coarse)
    s = coarse.breaks[1:-1]
    for order, allowed in ((0, 1e-4 if robot.dof > 6 else 1e-9), (1, 2e-3), (2, 0.1)):
        np.testing.assert_allclose(coarse(s, order), fine(s, order), atol=allowed)
    if robot.dof == 6:
        np.testing.assert_allclose(coarse(s, 1), fine(s, 1), atol=1e-7)


def test_a_start_chooses_its_branch():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    path = line_path(robot.fk(q), robot.fk(q) @ cs.pose((0.1, 0.05, 0)))
    alone = follow_cartesian(robot, path, q)
    assert len(alone) == 1
    np.testing.assert_allclose(alone.branches[0].path.start, q, atol=1e-9)
    every = follow_cartesian(robot, path)
    assert every.complete
    assert len(every) == 8
    assert any(np.allclose(branch.q_start, q, atol=1e-9) for branch in every.branches)


def test_a_path_out_of_reach_says_where_it_ends():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    T = robot.fk(q)
    far = T.copy()
    far[:3, 3] *= 3
    found = follow_cartesian(robot, line_path(T, far))
    assert not found
    assert "at s = " in found.reason
    ends = [branch.s_end for branch in found.branches]
    reach = np.linalg.norm(far[:3, 3] - T[:3, 3])
    assert 0 < max(ends) < reach
    just_before = line_path(T, far)(max(ends) - 1e-6)
    assert robot.ik(just_before)
    with pytest.raises(InputError, match="tolerance"):
        follow_cartesian(robot, line_path(T, far), tolerance=-1.0)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["ur5e", "puma560", "xarm6", "yam", "planar_3r"])
def test_joints_may_turn_far_on_a_short_way(name, seed):
    """Beside singular configurations: where a fine track arrives, so does the joint path."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng([seed, 7])
    for q in robot.random_configuration(30, rng=rng):
        T = robot.fk(q)
        if robot.dof < 6:
            goal = cs.pose((*rng.normal(0, 0.5, 2), 0)) @ T @ cs.pose(rpy=(0, 0, rng.normal(0, 0.5)))
        else:
            goal = T @ cs.pose(rng.normal(0, 0.3, 3), rpy=rng.normal(0, 0.5, 3))
        path = line_path(T, goal)
        found = follow_cartesian(robot, path, q, limits=False, tolerance=TOLERANCE)
        if found:
            assert distance(robot, found.branches[0].path, path, 2000) <= 1.5 * TOLERANCE
        elif found.branches[0].cause == "jump":
            assert not robot.track(path(np.linspace(0, path.length, 4000)), q, limits=False)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda", "planar_3r", "cobra600"])
def test_limits_hold_between_nodes(name):
    """A joint turns back in the middle of a line; a limit just before that ends the branch, there."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(3)
    refused = 0
    for q in robot.random_configuration(150, rng=rng):
        T, move = robot.fk(q), cs.pose((*rng.normal(0, 0.2, 2), 0))
        path = line_path(T, move @ T)
        free = follow_cartesian(robot, path, q)
        if not free:
            continue
        s = np.linspace(0, path.length, 2001)
        rows = free.branches[0].path(s)
        inner = rows.argmax(axis=0)
        room = rows.max(axis=0) - np.maximum(rows[0], rows[-1])
        for j in np.flatnonzero(room > 1e-3):
            upper = np.array(robot.limits.upper)
            upper[j] = rows[inner[j], j] - room[j] * 10 ** rng.uniform(-3, -1)
            branch = follow_cartesian(robot, path, q, limits=cs.Limits(robot.limits.lower, upper)).branches[0]
            if branch:  # a redundant arm goes another way
                assert (branch.path(s) <= upper + 1e-8).all()
                continue
            refused += 1
            if robot.dof < 7:
                assert (branch.cause, branch.joint) == ("limit", robot.joint_names[j])
                above = s[rows[:, j] > upper[j]]
                np.testing.assert_allclose(branch.s_end, above[0], atol=2 * path.length / 2000)
    assert refused


def test_branches_are_pickled_with_their_reasons():
    robot = cs.load_robot("ur5e")
    start = robot.fk(np.array([0.0, -1.2, 1.5, -1.8, -1.57, 0.0]))
    goal = start.copy()
    goal[2, 3] += 3.0
    found = follow_cartesian(robot, line_path(start, goal))
    assert not found
    for branch in found.branches:
        again = pickle.loads(pickle.dumps(branch))
        assert again.reason == branch.reason != ""
