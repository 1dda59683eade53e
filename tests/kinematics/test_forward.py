"""Forward kinematics: against one matrix per joint, for every frame, alone and in batches."""

import numpy as np
import pytest

from cspace.errors import CspaceError, InputError
from cspace.model import Description, Joint, Link, Mimic, chain, from_screws
from cspace.robot import Robot
from kinematics import robots
from model.random_robots import random_pose, random_tree
from oracles.forward import link_poses, product_of_exponentials


@pytest.mark.parametrize("seed", range(30))
def test_every_frame_is_where_one_matrix_per_joint_puts_it(seed):
    rng = np.random.default_rng(seed)
    description = random_tree(rng, n=14, branch=0.3 if seed % 3 else 0.0)
    robot = Robot(description)
    q = robots.random_q(robot, rng)
    poses = link_poses(description, dict(zip(robot.joint_names, q, strict=True)))
    together = robot.fk_all(q)
    assert set(robot.frames) == set(poses)
    for i, frame in enumerate(robot.frames):
        np.testing.assert_allclose(robot.fk(q, frame), poses[frame], atol=2e-14)
        np.testing.assert_allclose(together[i], poses[frame], atol=2e-14)
    if robot.tip is not None:
        np.testing.assert_array_equal(robot.fk(q), robot.fk(q, robot.tip))


@pytest.mark.parametrize("joint_types", ["", "R", "P", "RPR", "RRRRRR", "RPPRRPR", "R" * 40])
def test_a_chain_is_its_product_of_exponentials(joint_types):
    rng = np.random.default_rng(len(joint_types))
    n = len(joint_types)
    axes, points = rng.normal(size=(n, 3)), rng.normal(size=(n, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    T_zero = random_pose(rng)
    robot = Robot(from_screws(axes, points, T_zero, joint_types=joint_types))
    assert robot.joint_types == joint_types
    for q in robots.random_q(robot, rng, 5):
        expected = product_of_exponentials(axes, points, joint_types, T_zero, q)
        np.testing.assert_allclose(robot.fk(q), expected, atol=1e-13 * max(n, 1))
    screws = robot.chain
    again = product_of_exponentials(screws.axes, screws.points, screws.joint_types, screws.T_zero, q)
    np.testing.assert_allclose(again, robot.fk(q), atol=1e-13 * max(n, 1))


@pytest.mark.parametrize("seed", range(20))
def test_a_chain_between_any_two_links_is_the_relative_pose_in_the_tree(seed):
    rng = np.random.default_rng(seed)
    description = random_tree(rng, n=10)
    base, tip = (
        str(name) for name in rng.choice([link.name for link in description.links], 2, replace=False)
    )
    robot = Robot(description, base, tip)
    assert (robot.base, robot.tip) == (base, tip)
    q = robots.random_q(robot, rng)
    poses = link_poses(description, dict(zip(robot.joint_names, q, strict=True)))
    expected = np.linalg.inv(poses[base]) @ poses[tip]
    np.testing.assert_allclose(robot.fk(q), expected, atol=1e-12)
    assert set(robot.frames) == set(chain(description, base, tip).frames)


@pytest.mark.parametrize("angle", [0.0, 1e-16, 1e-12, 1e-8, 1e-4, np.pi / 2, np.pi - 1e-12, np.pi])
def test_axes_that_are_almost_parallel_keep_their_digits(angle):
    """The common normal of such axes is far away; the reduced chain must not go there."""
    rng = np.random.default_rng(1)
    axes = np.array([[0, np.sin(k * angle), np.cos(k * angle)] for k in range(5)])
    points = rng.normal(size=(5, 3))
    robot = Robot(from_screws(axes, points, random_pose(rng)))
    for q in robots.random_q(robot, rng, 10):
        expected = product_of_exponentials(axes, points, "RRRRR", robot.chain.T_zero, q)
        np.testing.assert_allclose(robot.fk(q), expected, atol=1e-14)


def test_a_batch_is_a_loop_of_single_calls_over_any_leading_axes():
    for robot in (robots.arm(1), robots.arm(2, "RPRPRRR"), robots.planar(1.0, 0.5)):
        rng = np.random.default_rng(3)
        for lead in [(), (1,), (7,), (2, 3), (0,), (3, 0, 2)]:
            q = robots.random_q(robot, rng, *lead)
            T = robot.fk(q)
            assert T.shape == (*lead, 4, 4)
            for index in np.ndindex(*lead):
                np.testing.assert_allclose(T[index], robot.fk(q[index].copy()), atol=1e-14)


def test_the_number_of_threads_never_changes_a_bit():
    robot = robots.arm(5)
    q = robots.random_q(robot, np.random.default_rng(0), 9999)
    for function in (robot.fk, robot.jacobian, robot.fk_all, robot.center_of_mass):
        one = function(q, threads=1)
        for threads in (2, 3, None):
            np.testing.assert_array_equal(one, function(q, threads=threads))


def test_what_is_read_may_be_a_list_a_view_or_another_type():
    robot = robots.arm(4)
    q = robots.random_q(robot, np.random.default_rng(0), 8)
    T = robot.fk(q[2].copy())
    swapped = q[2].astype(">f8")
    backward = np.ascontiguousarray(q[2][::-1])[::-1]
    for same in (q[2], q[2].tolist(), tuple(q[2]), np.asfortranarray(q)[2], swapped, backward):
        np.testing.assert_allclose(robot.fk(same), T, atol=1e-14)
        np.testing.assert_allclose(robot.jacobian(same), robot.jacobian(q[2].copy()), atol=1e-14)
    whole = np.array([0, 1, -1, 2, 0, 1])
    np.testing.assert_allclose(robot.fk(whole), robot.fk(whole.astype(float)), atol=1e-14)
    np.testing.assert_allclose(robot.fk(q.astype(np.float32))[2], T, atol=1e-5)


@pytest.mark.parametrize("sequence", [list, tuple])
@pytest.mark.parametrize("entry", [10**400, "1", None, True, 1j, np.nan, np.inf, [0.0]])
@pytest.mark.parametrize("place", [0, 3, 5])
def test_a_sequence_is_refused_as_an_array_of_it_is(sequence, entry, place):
    robot = robots.arm(4)
    values = [0.1 * k for k in range(6)]
    whole = [1, *values[1:]]
    np.testing.assert_array_equal(robot.fk(sequence(whole)), robot.fk(np.array(whole)))
    np.testing.assert_array_equal(robot.fk(sequence(map(np.float64, values))), robot.fk(np.array(values)))
    values[place] = entry
    for function in (robot.fk, robot.jacobian, robot.fk_all):
        with pytest.raises(CspaceError):
            function(sequence(values))
    for count in (5, 7):
        with pytest.raises(CspaceError, match="shape"):
            robot.fk(sequence([0.0] * count))


def test_a_base_pose_may_be_unaligned():
    robot = robots.arm(4)
    q, T = np.full(6, 0.2), random_pose(np.random.default_rng(1))
    unaligned = np.frombuffer(bytearray(129), np.uint8)[1:].view(float).reshape(4, 4)
    unaligned[...] = T
    for function in (robot.fk, robot.jacobian, robot.fk_all, robot.center_of_mass):
        np.testing.assert_array_equal(function(q, T_world_base=unaligned), function(q, T_world_base=T))


def test_out_is_written_and_returned():
    robot = robots.arm(4)
    q = robots.random_q(robot, np.random.default_rng(0), 8)
    T, J = np.full((8, 4, 4), np.nan), np.full((8, 6, 6), np.nan)
    assert robot.fk(q, out=T) is T
    assert robot.jacobian(q, out=J) is J
    both = robot.fk_jacobian(q)
    np.testing.assert_array_equal(T, both[0])
    np.testing.assert_array_equal(J, both[1])
    T[:], J[:] = np.nan, np.nan
    robot.fk_jacobian(q, out=(T, J))
    np.testing.assert_array_equal(T, both[0])
    np.testing.assert_array_equal(J, both[1])


def test_tool_and_base_count_in_every_function():
    robot = robots.arm(6)
    rng = np.random.default_rng(6)
    T_tool, T_base, q = random_pose(rng), random_pose(rng), robots.random_q(robot, rng)
    changed = robot.with_tool(T_tool).with_base(T_base)
    np.testing.assert_allclose(changed.fk(q), T_base @ robot.fk(q) @ T_tool, atol=1e-14)
    np.testing.assert_allclose(changed.fk(q, "link_3"), T_base @ robot.fk(q, "link_3"), atol=1e-14)
    rotated = np.kron(np.eye(2), T_base[:3, :3])
    expected = rotated @ robot.jacobian(q, point=T_tool[:3, 3])
    np.testing.assert_allclose(changed.jacobian(q), expected, atol=1e-14)
    screws = changed.chain
    by_screws = product_of_exponentials(screws.axes, screws.points, "RRRRRR", screws.T_zero, q)
    np.testing.assert_allclose(by_screws, changed.fk(q), atol=1e-13)
    center = T_base[:3, :3] @ robot.center_of_mass(q) + T_base[:3, 3]
    np.testing.assert_allclose(changed.center_of_mass(q), center, atol=1e-14)
    twice = changed.with_tool(T_tool).with_base(T_base)
    np.testing.assert_allclose(twice.fk(q), T_base @ T_base @ robot.fk(q) @ T_tool @ T_tool, atol=1e-13)
    assert changed.tip == "tool"
    assert robot.tip == "link_7"


def test_t_world_base_places_the_robot_row_by_row_or_at_once():
    rng = np.random.default_rng(8)
    for robot in (robots.arm(6), robots.tree(6)):
        q, bases = robots.random_q(robot, rng, 5), np.array([random_pose(rng) for _ in range(5)])
        frame = robot.frames[-1]
        T = robot.fk(q, frame)
        np.testing.assert_allclose(robot.fk(q, frame, T_world_base=bases), bases @ T, atol=1e-14)
        np.testing.assert_allclose(robot.fk(q, frame, T_world_base=bases[0]), bases[0] @ T, atol=1e-14)
        np.testing.assert_allclose(robot.fk(q[0], frame, T_world_base=bases), bases @ T[0], atol=1e-14)
        everything = robot.fk_all(q, T_world_base=bases)
        np.testing.assert_allclose(everything, bases[:, None] @ robot.fk_all(q), atol=1e-14)


def test_a_joint_that_mimics_follows_even_a_leader_outside_the_chain():
    turn = np.eye(4)
    turn[0, 3] = 1.0
    links = [Link(name) for name in ("base", "left", "right")]
    joints = [
        Joint("lead", "revolute", "base", "left", axis=[0, 0, 1]),
        Joint("follow", "revolute", "base", "right", turn, [0, 0, 1], mimic=Mimic("lead", -2.0, 0.5)),
    ]
    robot = Robot(Description("pair", tuple(links), tuple(joints)), tip="right")
    assert robot.joint_names == ("lead",)
    angle = -2.0 * 0.3 + 0.5
    np.testing.assert_allclose(robot.fk([0.3])[:2, 0], [np.cos(angle), np.sin(angle)], atol=1e-15)
    np.testing.assert_allclose(robot.jacobian(np.array([0.3]))[5], [-2.0], atol=1e-15)


@pytest.mark.parametrize(
    "kinds", [("revolute", "revolute"), ("prismatic", "prismatic"), ("revolute", "prismatic")]
)
@pytest.mark.parametrize("multiplier", [1.0, -1e12])
def test_joints_that_follow_enormous_values_have_poses_without_nan(kinds, multiplier, tmp_path):
    links = '<robot name="a"><link name="b"/><link name="c"/><link name="d"/>'
    joint = '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/><axis xyz="0 1 1"/>{}{}</joint>'
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    mimic = f'<mimic joint="one" multiplier="{multiplier}"/>'
    parts = (
        joint.format("one", kinds[0], "b", "c", limit, ""),
        joint.format("two", kinds[1], "c", "d", limit, mimic),
    )
    (tmp_path / "a.urdf").write_text(links + "".join(parts) + "</robot>")
    robot = Robot.from_urdf(tmp_path / "a.urdf")
    for q in (1e10, 1e99, -1e100):
        rows = np.full((5, 1), q)
        for result in (
            robot.fk([q]),
            robot.jacobian([q]),
            robot.fk(rows),
            robot.fk_all(rows),
            robot.manipulability(rows),
        ):
            assert np.isfinite(result).all()
    for q in (2e100, 1e208, -1e300):
        for call in (robot.fk, robot.jacobian, robot.fk_jacobian, robot.fk_all, robot.manipulability):
            for given in ([q], np.full((5, 1), q)):
                with pytest.raises(InputError, match=r"the largest allowed value is ±1e\+100"):
                    call(given)
