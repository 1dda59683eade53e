"""Masses on their way to the core: what is off the chain, locked; links split, renamed, mounted, loaded."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import Description, Inertial, Joint, Link, from_toml, from_urdf, mounted
from cspace.robot import Robot
from cspace.spatial import pose
from dynamics.bodies import hand_arm, random_body
from kinematics import robots
from model.random_robots import random_pose, random_tree
from oracles.rigid_bodies import assembled_body, described_body, same_body


def random_ends(rng, description):
    """Two links with a joint between them that moves."""
    names = [link.name for link in description.links]
    while True:
        base, tip = (str(name) for name in rng.choice(names, 2, replace=False))
        robot = Robot(description, base, tip)
        if robot.dof:
            return base, tip, robot


@pytest.mark.parametrize("seed", range(20))
def test_what_is_off_the_chain_is_carried_at_its_locked_values(seed):
    rng = np.random.default_rng(seed)
    description = random_tree(rng, n=14, mimics=False, branch=0.5)
    base, tip, free = random_ends(rng, description)
    off = [joint.name for joint in description.moving_joints if joint.name not in free.joint_names]
    locked = {name: rng.uniform(-2, 2) for name in off}
    robot = Robot(description, base, tip, locked=locked)
    for _ in range(3):
        q = robots.random_q(robot, rng)
        values = {**locked, **dict(zip(robot.joint_names, q, strict=True))}
        expected = described_body(description, values, base)
        same_body(assembled_body(robot, q), expected)
        np.testing.assert_allclose(robot.center_of_mass(q), expected[1], atol=1e-12)
        assert robot.mass == pytest.approx(expected[0], rel=1e-14)


@pytest.mark.parametrize("seed", range(10))
def test_the_whole_tree_is_one_body_at_every_configuration(seed):
    rng = np.random.default_rng(seed)
    robot = robots.tree(seed)
    for _ in range(3):
        q = robots.random_q(robot, rng)
        values = dict(zip(robot.joint_names, q, strict=True))
        same_body(assembled_body(robot, q), described_body(robot.description, values))


@pytest.mark.parametrize("seed", range(5))
def test_fingers_move_the_centre_by_their_share_of_the_mass(seed):
    rng = np.random.default_rng(seed)
    description = hand_arm(rng)
    finger = description.link("left").inertial.mass
    q = rng.uniform(-2, 2, 4)
    closed, open_by = (Robot(description, tip="tcp", locked={"open": value}) for value in (0.0, 0.04))
    assert closed.mass == open_by.mass
    R = closed.fk(q, "hand")[:3, :3]
    moved = R @ [0, 0.04 * finger - 0.5 * 0.04 * finger, 0] / closed.mass  # the mimic goes back half as far
    np.testing.assert_allclose(open_by.center_of_mass(q), closed.center_of_mass(q) + moved, atol=1e-14)
    links = [Link(li.name) if li.name in ("left", "right") else li for li in description.links]
    bare = Robot(replace(description, links=tuple(links)), tip="tcp")
    assert bare.mass + 2 * finger == pytest.approx(closed.mass)
    assert np.linalg.norm(bare.center_of_mass(q) - closed.center_of_mass(q)) > 1e-4


@pytest.mark.parametrize("seed", range(10))
def test_a_link_split_by_a_fixed_joint_weighs_the_same(seed):
    rng = np.random.default_rng(seed)
    whole = Robot(hand_arm(rng), tip="tcp")
    link, body, place = "link_2", random_body(rng), random_pose(rng)
    split = replace(
        whole.description,
        links=(*whole.description.links, Link("part", body)),
        joints=(*whole.description.joints, Joint("seam", "fixed", link, "part", place)),
    )
    tensor = place[:3, :3] @ body.inertia @ place[:3, :3].T
    com = place[:3, :3] @ body.com + place[:3, 3]
    loaded = whole.with_payload(body.mass, com, tensor, frame=link)
    mine, theirs = Robot(split, tip="tcp")._assembly, loaded._assembly
    for name in ("mass", "center", "inertia"):
        np.testing.assert_allclose(getattr(mine, name), getattr(theirs, name), rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("seed", range(5))
def test_names_and_order_do_not_matter(seed):
    rng = np.random.default_rng(seed)
    old = random_tree(rng, n=12, mimics=False, branch=0.5)
    links = [replace(link, name=f"new {link.name}") for link in old.links]
    joints = [
        replace(j, name=f"new {j.name}", parent=f"new {j.parent}", child=f"new {j.child}") for j in old.joints
    ]
    shuffled = Description(
        "shuffled",
        tuple(links[i] for i in rng.permutation(len(links))),
        tuple(joints[i] for i in rng.permutation(len(joints))),
    )
    one, two = Robot(old, tip=old.leaves[0]), Robot(shuffled, tip=f"new {old.leaves[0]}")
    assert two.joint_names == tuple(f"new {name}" for name in one.joint_names)
    q = robots.random_q(one, rng)
    same_body(assembled_body(two, q), assembled_body(one, q))
    for name in ("mass", "center", "inertia"):
        np.testing.assert_allclose(getattr(two._assembly, name), getattr(one._assembly, name), atol=1e-13)


@pytest.mark.parametrize("seed", range(5))
def test_a_mount_moves_the_body_and_a_tool_leaves_it(seed):
    rng = np.random.default_rng(seed)
    arm = robots.arm(seed)
    T, q = random_pose(rng), robots.random_q(arm, rng)
    mass, center, inertia = assembled_body(arm, q)
    R = T[:3, :3]
    moved = mass, R @ center + T[:3, 3], R @ inertia @ R.T
    there = arm.with_base(T)
    same_body(assembled_body(there, q), moved)
    same_body(assembled_body(there.with_tool(random_pose(rng)), q), moved)
    same_body(assembled_body(Robot(mounted(arm.description, "link_0", T)), q), moved)


@pytest.mark.parametrize("seed", range(5))
def test_a_payload_is_one_more_body_at_its_frame(seed):
    rng = np.random.default_rng(seed)
    body, T_tool, T_mount = random_body(rng), random_pose(rng), random_pose(rng)
    arm = Robot(hand_arm(rng), tip="tcp", locked={"open": 0.02}).with_base(T_mount).with_tool(T_tool)
    q = robots.random_q(arm, rng)
    for frame in (None, "tool", "tcp", "left", "link_0", "link_1"):
        loaded = arm.with_payload(body.mass, body.com, body.inertia, frame=frame)
        T = arm.fk(q) if frame is None else arm.fk(q, frame)
        mass, center, inertia = assembled_body(arm, q)
        R, p = T[:3, :3], T[:3, :3] @ body.com + T[:3, 3]
        expected_center = (mass * center + body.mass * p) / (mass + body.mass)
        d, e = center - expected_center, p - expected_center
        expected = inertia + R @ body.inertia @ R.T
        expected = expected + mass * (d @ d * np.eye(3) - np.outer(d, d))
        expected = expected + body.mass * (e @ e * np.eye(3) - np.outer(e, e))
        same_body(assembled_body(loaded, q), (mass + body.mass, expected_center, expected))
        assert (loaded.frames, loaded.tip, loaded.joint_names) == (arm.frames, arm.tip, arm.joint_names)
        np.testing.assert_array_equal(loaded.fk_all(q), arm.fk_all(q))


def test_a_payload_composes_and_survives_copies_and_files():
    rng = np.random.default_rng(0)
    arm, T = robots.arm(4), random_pose(rng)
    one = arm.with_payload(1.5, (0, 0, 0.1)).with_tool(T).with_base(T).with_payload(0.5)
    other = arm.with_base(T).with_tool(T).with_payload(0.5).with_payload(1.5, (0, 0, 0.1), frame="link_7")
    q = robots.random_q(arm, rng)
    same_body(assembled_body(one, q), assembled_body(other, q))
    assert one.mass == pytest.approx(arm.mass + 2.0)
    for again in (
        pickle.loads(pickle.dumps(one)),
        Robot(from_urdf(one.to_urdf())),
        Robot(from_toml(one.to_toml())),
    ):
        np.testing.assert_allclose(again.center_of_mass(q), one.center_of_mass(q), atol=1e-12)
        assert again.mass == pytest.approx(one.mass)


def test_a_point_mass_at_a_frame_without_a_mass():
    links = (Link("base"), Link("arm"), Link("tcp"))
    joints = (
        Joint("turn", "continuous", "base", "arm", axis=(0, 0, 1)),
        Joint("end", "fixed", "arm", "tcp", pose((0.5, 0, 0))),
    )
    pendulum = Robot(Description("pendulum", links, joints)).with_payload(2.0)
    np.testing.assert_allclose(pendulum.center_of_mass([np.pi / 2]), [0, 0.5, 0], atol=1e-15)
    assert pendulum.mass == 2.0


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"mass": -1.0}, InputError, "mass is -1 kg; it must not be negative"),
        ({"mass": np.nan}, InputError, "mass is NaN"),
        ({"mass": np.inf}, InputError, "mass is inf"),
        ({"mass": "heavy"}, InputTypeError, "mass must be a number"),
        ({"mass": 1.0, "com": (0, 0)}, InputError, r"com has shape \(2,\), expected \(3,\)"),
        ({"mass": 1.0, "inertia": np.ones(3)}, InputError, r"inertia has shape \(3,\), expected \(3, 3\)"),
        ({"mass": 1.0, "inertia": np.triu(np.ones((3, 3)))}, InputError, "inertia is not symmetric"),
        ({"mass": 1.0, "frame": "link_9"}, UnknownNameError, "no frame 'link_9' in arm 1; did you mean"),
    ],
)
def test_a_bad_payload_is_refused(arguments, error, text):
    with pytest.raises(error, match=text):
        robots.arm(1).with_payload(**arguments)


def test_a_payload_on_a_robot_that_branches_needs_a_frame():
    robot = robots.tree(3)
    with pytest.raises(InputError, match="random branches, so it has no tip for a payload; give frame=: "):
        robot.with_payload(1.0)
    frame = robot.leaves[0]
    loaded = robot.with_payload(1.0, frame=frame)
    q = robots.random_q(robot, np.random.default_rng(0))
    total = robot.mass * robot.center_of_mass(q) + robot.fk(q, frame)[:3, 3]
    np.testing.assert_allclose(loaded.center_of_mass(q), total / loaded.mass, atol=1e-13)


def test_a_floating_robot_carries_its_payload():
    robot = Robot(robots.arm(2).description, tip="link_7", floating=True)
    T, q = random_pose(np.random.default_rng(1)), np.zeros(6)
    total = robot.mass * robot.center_of_mass(q, T_world_base=T) + 3.0 * robot.fk(q, T_world_base=T)[:3, 3]
    loaded = robot.with_payload(3.0)
    np.testing.assert_allclose(loaded.center_of_mass(q, T_world_base=T), total / loaded.mass, atol=1e-13)


def test_resistances_reach_the_assembly_in_the_order_of_joints():
    links = tuple(Link(name, Inertial(1, (0, 0, 0), np.eye(3))) for name in "abcd")
    joints = (
        Joint("one", "revolute", "a", "b", armature=0.1, damping=0.2, friction=0.3),
        Joint("two", "planar", "b", "c", damping=2.0),
        Joint("three", "prismatic", "c", "d", armature=5.0),
    )
    assembly = Robot(Description("r", links, joints[::-1]))._assembly
    np.testing.assert_array_equal(assembly.armature, [0.1, 0, 0, 0, 5.0])
    np.testing.assert_array_equal(assembly.damping, [0.2, 2, 2, 2, 0])
    np.testing.assert_array_equal(assembly.friction, [0.3, 0, 0, 0, 0])
    backward = Robot(Description("r", links, joints), base="d", tip="a")._assembly
    np.testing.assert_array_equal(backward.armature, [5.0, 0, 0, 0, 0.1])
