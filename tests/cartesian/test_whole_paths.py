"""Redundant arms and free turns along whole paths: exact, within limits, farther than least motion."""

import numpy as np
import pytest

import cspace as cs
from cspace.cartesian import follow_cartesian, follow_free_turn, follow_redundant, move_cartesian
from cspace.errors import InputError
from cspace.trajectory import arc_path, line_path

TOLERANCE = 1e-5
REDUNDANT = ("panda", "iiwa14", "xarm7", "sawyer")
SIX = ("ur5e", "puma560", "crx10ia")


def lines(robot, seed, count):
    """Lines of some decimetres and their first configurations."""
    rng = np.random.default_rng(seed)
    for q in robot.random_configuration(count, rng=rng, reach=0.7):
        T = robot.fk(q)
        goal = T.copy()
        goal[:3, 3] += rng.uniform(-0.25, 0.25, 3)
        goal[:3, :3] = cs.spatial.exp_so3(rng.uniform(-0.4, 0.4, 3)) @ T[:3, :3]
        yield q, line_path(T, goal)


def check_branch(robot, branch, path, axis=None):
    s = np.linspace(0, path.length, 300)
    q = branch.path(s)
    assert (q >= robot.limits.lower - 1e-12).all()
    assert (q <= robot.limits.upper + 1e-12).all()
    T, wanted = robot.fk(q), path(s)
    assert np.linalg.norm(T[:, :3, 3] - wanted[:, :3, 3], axis=1).max() <= 1.5 * TOLERANCE
    R, given = T[:, :3, :3], wanted[:, :3, :3]
    if axis is not None:
        R, given = R @ axis, given @ axis
    off = R - given
    assert np.sqrt((off.reshape(len(s), -1) ** 2).sum(axis=1)).max() <= 3 * TOLERANCE
    assert branch.path.continuity >= 2 or len(branch.path) < 2


@pytest.mark.slow
@pytest.mark.parametrize("name", REDUNDANT)
def test_whole_paths_keep_to_path_and_limits_and_reach_as_far_as_least_motion(name):
    robot = cs.load_robot(name)
    planned = least = 0
    for q, path in lines(robot, 1, 10):
        for start in (None, q):
            branch = follow_redundant(robot, path, start, tolerance=TOLERANCE)
            planned += bool(branch)
            least += bool(follow_cartesian(robot, path, start))
            if branch:
                check_branch(robot, branch, path)
                if start is not None:
                    np.testing.assert_allclose(branch.path.start, q, atol=1e-9)
            else:
                assert branch.cause in ("unreachable", "jump", "singularity", "limit")
                assert branch.reason.startswith("at s = ")
    assert planned >= least > 0


@pytest.mark.slow
@pytest.mark.parametrize("name", [*SIX, "panda"])
def test_a_free_turn_keeps_the_axis_and_reaches_where_the_whole_pose_does(name):
    robot = cs.load_robot(name)
    axis = np.array([0.0, 0.6, 0.8])
    for q, path in lines(robot, 2, 6):
        branch = follow_free_turn(robot, path, axis, tolerance=TOLERANCE)
        if branch:
            check_branch(robot, branch, path, axis)
        elif follow_cartesian(robot, path):
            assert branch.cause in ("singularity", "limit")  # beside the chain, not because nothing reaches
        turned = path(0.0) @ cs.pose((0, 0, 0), rotvec=0.3 * axis)
        there = robot.ik(turned, near=q)
        if there:
            begun = follow_free_turn(robot, path, axis, there.q[0], tolerance=TOLERANCE)
            if begun:
                np.testing.assert_allclose(begun.path.start, there.q[0], atol=1e-9)
                check_branch(robot, begun, path, axis)


def test_a_door_opens_with_a_hand_that_turns_about_the_handle():
    """The handle goes along most of a quarter circle, and the hand turns about it."""
    robot = cs.load_robot("panda")
    T = cs.pose((0.55, 0.15, 0.5), rpy=(0, np.pi / 2, 0))
    hinge, angle = np.array([0.55, 0.65, 0.5]), -0.45 * np.pi
    path = arc_path(T, center=hinge, axis=(0, 0, 1), angle=angle)
    free = follow_free_turn(robot, path, "x", tolerance=TOLERANCE)
    assert free
    check_branch(robot, free, path, np.array([1.0, 0, 0]))
    turned = cs.spatial.rotation_distance(robot.fk(free.path.end), path(path.length))
    assert turned > 0.2  # what a stiff grasp would have to do


def test_what_cannot_be_planned_is_named():
    six = cs.load_robot("ur5e")
    path = line_path(cs.pose((0.4, 0, 0.4)), cs.pose((0.4, 0.1, 0.4)))
    with pytest.raises(InputError, match="0 redundant joints"):
        follow_redundant(six, path)
    with pytest.raises(InputError, match="axis 'w' is unknown"):
        follow_free_turn(six, path, "w")
    with pytest.raises(InputError, match="axis is zero"):
        follow_free_turn(six, path, (0, 0, 0))
    with pytest.raises(InputError, match="start has shape"):
        follow_free_turn(six, path, "z", [0.0])
    far = line_path(cs.pose((3, 0, 0.4)), cs.pose((3, 0.1, 0.4)))
    for branch in (follow_free_turn(six, far), follow_redundant(cs.load_robot("panda"), far)):
        assert not branch
        assert branch.cause == "unreachable"


@pytest.mark.slow
@pytest.mark.parametrize("turns", [0.5, 1, 2, 3, 5, 8, 13, 30])
@pytest.mark.parametrize(("axis", "column"), [("z", 2), ("x", 0)])
def test_a_valve_turns_as_often_as_it_takes(axis, column, turns):
    """The hand turns on its handle, so that no joint winds up."""
    robot = cs.load_robot("ur5e")
    start = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    T = robot.fk(start)
    valve = {"center": T[:3, 3] + 0.08 * T[:3, 1], "axis": T[:3, column], "angle": 2 * np.pi * turns}
    motion = robot.move_arc(start=start, **valve, free_axis=axis, velocity=2.0, acceleration=8.0)
    assert motion, motion.reason
    q = motion(np.linspace(0, motion.duration, 2000))
    assert ((q >= robot.limits.lower - 1e-8) & (q <= robot.limits.upper + 1e-8)).all()
    tip = robot.fk(q)
    np.testing.assert_allclose(tip[:, :3, column], np.tile(valve["axis"], (2000, 1)), atol=3e-5)
    np.testing.assert_allclose(np.linalg.norm(tip[:, :3, 3] - valve["center"], axis=1), 0.08, atol=2e-5)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "panda", "iiwa14", "puma560", "gen3"])
def test_motions_of_the_tip_begin_at_their_start_in_every_bit(name):
    robot = cs.load_robot(name)
    rng, arrived = np.random.default_rng(2), 0
    for q in robot.random_configuration(8, rng=rng, reach=0.6):
        T = robot.fk(q)
        path = line_path(T, T @ cs.pose(rng.uniform(-0.1, 0.1, 3), rpy=rng.uniform(-0.2, 0.2, 3)))
        for free_axis in (None, "z"):
            motion = move_cartesian(robot, path, q, velocity=2.0, acceleration=5.0, free_axis=free_axis)
            if motion:
                arrived += 1
                assert (motion(0.0) == q).all()
                assert motion.path.continuity >= 2
    assert arrived >= 8


@pytest.mark.slow
@pytest.mark.parametrize(("name", "seed"), [("crx3ia", 7), ("irb120", 10), ("ur5e", 1), ("sawyer", 3)])
def test_the_tip_is_near_its_path_everywhere_beside_singular_configurations_too(name, seed):
    """Paths that end as near to the border of the reach as a branch goes; looked at between all nodes."""
    robot = cs.load_robot(name)
    rng, arrived = np.random.default_rng(seed), 0
    for q in robot.random_configuration(6, rng=rng, reach=0.7):
        T = robot.fk(q)
        path = line_path(T, T @ cs.pose(2.0 * rng.normal(size=3)))
        motion = move_cartesian(robot, path, q, velocity=2.0, acceleration=5.0, as_far_as_possible=True)
        if not motion:
            continue
        arrived += 1
        breaks = motion.path.breaks
        s = np.unique(
            (breaks[:-1, None] + np.linspace(0, 1, 41) * np.diff(breaks)[:, None]).clip(0, breaks[-1])
        )
        reached, wanted = robot.fk(motion.path(s)), motion.cartesian(s)
        assert np.linalg.norm(reached[:, :3, 3] - wanted[:, :3, 3], axis=1).max() <= 1e-5
        turned = np.linalg.norm(reached[:, :3, :3] - wanted[:, :3, :3], axis=(1, 2)) * np.sqrt(0.5)
        assert turned.max() <= 1e-5
    assert arrived >= 3


@pytest.mark.slow
@pytest.mark.parametrize("name", ["iiwa14", "panda", "xarm7", "gen3"])
def test_singular_starts_of_redundant_arms_are_answered(name):
    """No solution has a slope there: the motion goes on, or ends at a place with a cause, without errors."""
    robot = cs.load_robot(name)
    rng = np.random.default_rng(1)
    for _ in range(6):
        q = np.clip(rng.choice([0.0, 0.0, np.pi / 2, -np.pi / 2], robot.dof), *robot.limits.range)
        T = robot.fk(q)
        motion = move_cartesian(
            robot, line_path(T, T @ cs.pose(rng.uniform(-0.1, 0.1, 3))), q, velocity=2.0, acceleration=5.0
        )
        assert motion or "at s = " in motion.reason


@pytest.mark.parametrize("name", ["planar_2r", "planar_3r", "scara"])
def test_a_free_turn_of_an_arm_with_few_joints(name):
    """Where a turn leaves a freedom it is searched; where it leaves none the single way is followed."""
    robot = cs.load_robot(name)
    q = robot.random_configuration(rng=np.random.default_rng(0), reach=0.6)
    T = np.asarray(robot.fk(q))
    goal = T.copy()
    goal[:2, 3] *= 0.9
    path = line_path(T, goal)
    for start in (q, None):
        motion = move_cartesian(robot, path, start, velocity=2.0, acceleration=5.0, free_axis="z")
        assert motion, motion.reason
        check_branch(robot, motion.branches[motion.chosen], path, np.array([0.0, 0.0, 1.0]))
