import copy
import pickle

import numpy as np
import pytest

from cspace.errors import CspaceError, DescriptionError, InputError, UnknownNameError
from cspace.model import Chain, Description, Joint, Link, Mimic, chain, default_tip, from_screws, twists
from cspace.model.chain import find_path
from cspace.robot import Robot
from model.random_robots import random_pose, random_tree, random_values
from oracles.forward import link_poses, product_of_exponentials


def chain_values(robot, values):
    """The value of each joint of a chain from the values of the coordinates behind them."""
    c = robot.coordinates
    return c.multiplier * np.array([values[name] for name in c.names])[c.index] + c.offset


@pytest.mark.parametrize("seed", range(12))
def test_a_chain_between_any_two_links_moves_as_the_tree_does(seed):
    rng = np.random.default_rng(seed)
    tree = random_tree(rng)
    values = random_values(rng, tree)
    names = [link.name for link in tree.links]
    poses = link_poses(tree, values)
    for _ in range(12):
        base, tip = (str(name) for name in rng.choice(names, 2))
        path = {joint.name for joint, _ in find_path(tree, base, tip)}
        off = [joint for joint in tree.moving_joints if joint.name not in path]
        c = chain(tree, base, tip, locked={j.name: values[j.name] for j in off if j.mimic is None})
        assert set(c.frames) == set(names)
        q = chain_values(c, values)
        T = product_of_exponentials(c.axes, c.points, c.joint_types, c.T_zero, q)
        np.testing.assert_allclose(T, np.linalg.inv(poses[base]) @ poses[tip], atol=1e-13)
        stays = {joint.name for joint in off if joint.mimic and leader(tree, joint) in path}
        for frame, (k, T_zero) in c.frames.items():
            if stays.isdisjoint(joint.name for joint, _ in find_path(tree, base, frame)):
                T = product_of_exponentials(c.axes[:k], c.points[:k], c.joint_types[:k], T_zero, q[:k])
                np.testing.assert_allclose(T, np.linalg.inv(poses[base]) @ poses[frame], atol=1e-13)


def leader(tree, joint):
    return joint.name if joint.mimic is None else leader(tree, tree.joint(joint.mimic.joint))


@pytest.mark.parametrize("seed", range(6))
def test_joints_off_the_chain_are_locked_with_what_they_carry(seed):
    rng = np.random.default_rng(seed)
    tree = random_tree(rng, mimics=False, branch=0.5)
    tip = str(rng.choice(tree.leaves))
    path = {joint.name for joint, _ in find_path(tree, tree.root, tip)}
    off = [joint.name for joint in tree.moving_joints if joint.name not in path]
    values = {name: rng.uniform(-1, 1) for name in off}
    robot = Robot(tree, tip=tip, locked=values)
    whole = Robot(tree)
    assert robot.mass == pytest.approx(whole.mass)
    q = dict(zip(robot.joint_names, robot.random_configuration(rng=seed, reach=1.0), strict=True))
    both = np.array([values.get(name, q.get(name)) for name in whole.joint_names])
    own = np.array(list(q.values()))
    np.testing.assert_allclose(robot.center_of_mass(own), whole.center_of_mass(both), atol=1e-12)
    for name in robot.frames:
        np.testing.assert_allclose(robot.fk(own, frame=name), whole.fk(both, frame=name), atol=1e-12)
    again = pickle.loads(pickle.dumps(robot.with_tool(random_pose(rng))))
    np.testing.assert_allclose(again.center_of_mass(own), whole.center_of_mass(both), atol=1e-12)


@pytest.mark.parametrize(
    ("locked", "message"),
    [
        ({"j1": 0.0}, "moves the tip"),
        ({"j9": 0.0}, "no joint 'j9'"),
        ({"f2": 0.0}, "mimics 'f1'; lock that one"),
        ({"side": 0.0}, "is fixed"),
        ({"f1": np.nan}, "locked joint 'f1' is NaN"),
    ],
)
def test_only_moving_joints_off_the_chain_are_locked(locked, message):
    joints = (
        Joint("j1", "revolute", "base", "hand"),
        Joint("f1", "prismatic", "hand", "left"),
        Joint("f2", "prismatic", "hand", "right", mimic=Mimic("f1", -1.0, 0.0)),
        Joint("side", "fixed", "base", "sensor"),
    )
    with pytest.raises(CspaceError, match=message):
        Robot(robot_of(*joints), tip="hand", locked=locked)
    with pytest.raises(InputError, match="every joint of 'r' moves"):
        Robot(robot_of(*joints), locked={"f1": 0.0})
    fixed = Robot(robot_of(*joints), tip="hand", locked={"f1": 0.1})
    np.testing.assert_allclose(fixed.fk([0.0], frame="right")[:3, 3], [-0.1, 0, 0], atol=1e-15)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda c: pickle.loads(pickle.dumps(c))])
@pytest.mark.parametrize("changed", [lambda c: c, Chain.reversed, lambda c: c.lock({1: 0.4})])
def test_every_copy_of_a_chain_is_read_only_and_equal(again, changed):
    rng = np.random.default_rng(1)
    points = rng.normal(size=(4, 3))
    whole = chain(from_screws(np.eye(3)[[2, 1, 1, 0]], points, random_pose(rng), joint_types="RRPR"))
    original = changed(whole)
    copied = again(original)
    assert list(copied.frames) == list(original.frames)
    arrays = [(c.axes, c.points, c.T_zero, *(T for _, T in c.frames.values())) for c in (copied, original)]
    for ours, theirs in zip(*arrays, strict=True):
        np.testing.assert_array_equal(ours, theirs)
        assert not ours.flags.writeable
        assert not theirs.flags.writeable
    with pytest.raises(TypeError):
        copied.frames["new"] = (0, np.eye(4))


def test_a_chain_knows_its_limits_and_its_mimics():
    joints = (
        Joint("a", "revolute", "l0", "l1", lower=-1.0, upper=2.0, velocity=3.0),
        Joint("b", "prismatic", "l1", "l2", mimic=Mimic("a", 0.5, 0.1)),
        Joint("c", "prismatic", "l2", "l3", mimic=Mimic("b", -2.0, 0.2)),
        Joint("d", "continuous", "l3", "l4"),
    )
    c = chain(Description("r", tuple(Link(f"l{i}") for i in range(5)), joints))
    assert c.joint_names == ("a", "b", "c", "d")
    assert c.joint_types == "RPPR"
    assert c.dof == 2
    assert c.coordinates.names == ("a", "d")
    np.testing.assert_array_equal(c.coordinates.index, [0, 0, 0, 1])
    np.testing.assert_allclose(c.coordinates.multiplier, [1, 0.5, -1.0, 1])
    np.testing.assert_allclose(c.coordinates.offset, [0, 0.1, 0.0, 0])
    np.testing.assert_array_equal(c.limits.lower, [-1, -np.inf])
    np.testing.assert_array_equal(c.limits.velocity, [3, np.inf])


def test_a_planar_joint_is_two_slides_and_a_turn():
    rng = np.random.default_rng(1)
    robot = Description(
        "p", (Link("a"), Link("b")), (Joint("j", "planar", "a", "b", random_pose(rng), (0, 0, 1)),)
    )
    c = chain(robot)
    assert c.joint_names == ("j/x", "j/y", "j/turn")
    assert c.joint_types == "PPR"
    x, y, turn = 0.3, -0.7, 1.1
    plane = np.eye(4)
    plane[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    plane[:2, 3] = x, y
    T = product_of_exponentials(c.axes, c.points, c.joint_types, c.T_zero, [x, y, turn])
    np.testing.assert_allclose(T, robot.joints[0].origin @ plane, atol=1e-15)


def robot_of(*joints):
    ends = dict.fromkeys(name for joint in joints for name in (joint.parent, joint.child))
    return Description("r", tuple(Link(name) for name in ends), joints)


def test_the_tip_is_found_where_there_is_no_choice():
    arm = robot_of(Joint("j", "revolute", "base", "hand"), Joint("s", "fixed", "base", "sensor"))
    assert default_tip(arm) == "hand"
    flange = robot_of(
        *arm.joints, Joint("f", "fixed", "hand", "tool0"), Joint("g", "fixed", "hand", "camera")
    )
    assert default_tip(flange) == "tool0"
    gripped = robot_of(*flange.joints, Joint("h", "fixed", "tool0", "tool"))
    assert default_tip(gripped) == "tool"
    assert default_tip(robot_of(Joint("f", "fixed", "a", "b"))) == "b"


def test_where_the_tip_is_a_choice_the_leaves_are_named():
    two_arms = robot_of(Joint("l", "revolute", "torso", "left"), Joint("r", "revolute", "torso", "right"))
    with pytest.raises(InputError, match=r"after link 'torso'.*tip=….*'left', 'right'"):
        chain(two_arms)
    assert chain(two_arms, tip="left").joint_names == ("l",)
    two_frames = robot_of(
        Joint("j", "revolute", "a", "b"), Joint("x", "fixed", "b", "grip"), Joint("y", "fixed", "b", "camera")
    )
    with pytest.raises(InputError, match="'grip', 'camera'"):
        chain(two_frames)


def test_unknown_links_and_floating_joints_are_refused():
    robot = robot_of(Joint("f", "floating", "world", "body"), Joint("j", "revolute", "body", "wrist_3_link"))
    with pytest.raises(UnknownNameError, match="did you mean 'wrist_3_link'"):
        chain(robot, tip="wrist3_link")
    with pytest.raises(UnknownNameError, match="no link 'bodi'"):
        chain(robot, base="bodi")
    with pytest.raises(DescriptionError, match="base='body'"):
        chain(robot, base="world")
    assert chain(robot, base="body").joint_names == ("j",)


@pytest.mark.parametrize("seed", range(6))
def test_screws_go_in_and_come_out(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 9))
    axes, points, T_zero = rng.normal(size=(n, 3)), rng.normal(size=(n, 3)), random_pose(rng)
    types = "".join(rng.choice(["R", "P"], n))
    c = chain(from_screws(axes, points, T_zero, joint_types=types))
    np.testing.assert_allclose(c.axes, axes / np.linalg.norm(axes, axis=1)[:, None], atol=1e-15)
    np.testing.assert_allclose(c.points, points, atol=1e-14)
    np.testing.assert_allclose(c.T_zero, T_zero, atol=1e-14)
    assert c.joint_types == types


def test_twists_carry_each_point_of_the_axis_nowhere():
    rng = np.random.default_rng(3)
    c = chain(from_screws(rng.normal(size=(3, 3)), rng.normal(size=(3, 3)), np.eye(4), joint_types="RPR"))
    screws = twists(c.axes, c.points, c.joint_types)
    velocity = screws[:, :3] + np.cross(screws[:, 3:], c.points)
    np.testing.assert_allclose(velocity[[0, 2]], 0.0, atol=1e-15)
    np.testing.assert_array_equal(screws[1], [*c.axes[1], 0, 0, 0])


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ({"axes": [[0, 0, 0]]}, "axis must not be zero"),
        ({"axes": [[0, 0]]}, "expected"),
        ({"points": [[0, 0, 0], [0, 0, 1]]}, "expected"),
        ({"points": [[0, 0, np.nan]]}, "finite"),
        ({"T_zero": np.ones((4, 4))}, "last row"),
        ({"joint_types": "X"}, "joint_types"),
        ({"joint_types": "RR"}, "joint_types"),
        ({"lower": [1], "upper": [-1]}, "reversed"),
        ({"lower": [1, 2]}, "expected"),
        ({"joint_names": ["a", "b"]}, "2 names"),
    ],
)
def test_bad_screws_are_refused(more, says):
    arguments = {"axes": [[0, 0, 1]], "points": [[0, 0, 0]], "T_zero": np.eye(4)} | more
    with pytest.raises(InputError, match=says):
        from_screws(**arguments)
