"""Right angles that a file rounds, made exact."""

import itertools
import math

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.ik import geometry
from cspace.model import Description, Joint, Link, Loop, from_urdf, to_urdf, with_right_angles
from cspace.model.right_angles import square_axis, square_rotation
from model.rounding import print_right_angles
from oracles.forward import motion

AXES = np.vstack([np.eye(3), -np.eye(3)])
QUARTER_TURNS = [
    np.array(columns).T
    for columns in itertools.product(AXES, repeat=3)
    if np.array_equal(np.cross(columns[0], columns[1]), columns[2])
]
"""The 24 rotations whose axes are coordinate axes."""

WITH_FRAMES = ("cr5", "gen3", "gen3_lite", "gp7", "icub_left_leg", "lite6", "xarm6", "xarm7", "so101", "ur5")
ROUNDINGS = [(3, 2e-3), (4, 1e-5), (5, 1e-5), (6, 1e-5)]


def rotation(axis, angle):
    return motion("R", axis, angle)[:3, :3]


def random_axis(rng):
    axis = rng.normal(size=3)
    return axis / np.linalg.norm(axis)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-5, 1e-3])
def test_rotations_near_quarter_turns_become_these(tolerance):
    rng = np.random.default_rng(0)
    assert len(QUARTER_TURNS) == 24
    for R in QUARTER_TURNS:
        for _ in range(10):
            off = rotation(random_axis(rng), rng.uniform(0, 0.99) * tolerance)
            np.testing.assert_array_equal(square_rotation(R @ off, tolerance), R)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-5, 1e-3])
def test_rotations_about_one_axis_keep_their_angle(tolerance):
    """The axis becomes exact; the other two move by the tolerance at most."""
    rng = np.random.default_rng(1)
    for R, axis in itertools.product(QUARTER_TURNS, AXES):
        angle = rng.uniform(0.02, 1.55)
        exact = R @ rotation(axis, angle)
        off = rotation(random_axis(rng), rng.uniform(0, 0.99) * tolerance)
        squared = square_rotation(exact @ off, tolerance)
        np.testing.assert_array_equal(squared @ axis, R @ axis)
        np.testing.assert_allclose(squared, exact, atol=tolerance, rtol=0)
        np.testing.assert_allclose(squared @ squared.T, np.eye(3), atol=1e-15, rtol=0)
        np.testing.assert_allclose(square_rotation(exact, tolerance), exact, atol=1e-15, rtol=0)


def test_other_rotations_and_axes_stay_bit_for_bit():
    rng = np.random.default_rng(2)
    for _ in range(300):
        R = rotation(random_axis(rng), rng.uniform(0.5, 3))
        if np.abs(R).max() < math.cos(1e-2):
            assert square_rotation(R, 1e-2) is R
            np.testing.assert_array_equal(square_axis(R[0], 1e-2), R[0])


def test_axes_near_coordinate_axes_become_these():
    rng = np.random.default_rng(3)
    for axis in AXES:
        for _ in range(20):
            near = rotation(random_axis(rng), rng.uniform(0, 0.99e-5)) @ axis
            np.testing.assert_array_equal(square_axis(near, 1e-5), axis)


@pytest.mark.parametrize(("digits", "tolerance"), ROUNDINGS)
@pytest.mark.parametrize("name", WITH_FRAMES)
def test_a_file_that_rounds_right_angles_gives_the_arm_without_rounding(name, digits, tolerance):
    """Other angles differ in second order, where they are written between rounded ones."""
    exact = cs.load_robot(name).description
    rounded = print_right_angles(exact, digits)
    squared = with_right_angles(rounded, tolerance)
    for joint, true, near in zip(squared.joints, exact.joints, rounded.joints, strict=True):
        np.testing.assert_allclose(joint.origin, true.origin, atol=tolerance**2 + 1e-14, rtol=0)
        np.testing.assert_array_equal(joint.origin[:3, 3], near.origin[:3, 3])
        np.testing.assert_array_equal(joint.axis, true.axis)
    assert squared.links == rounded.links
    assert squared.poses == rounded.poses


def test_the_numbers_of_a_file_stay_unless_asked_otherwise(tmp_path):
    path = tmp_path / "arm.urdf"
    rounded = print_right_angles(cs.load_robot("lite6").description, 4)
    path.write_text(to_urdf(rounded))
    q = np.random.default_rng(4).uniform(-2, 2, (20, 6))
    exact, as_written = cs.load_robot("lite6").fk(q), cs.Robot(rounded).fk(q)
    np.testing.assert_allclose(cs.load_robot(path).fk(q), as_written, atol=1e-12)
    assert np.abs(as_written - exact).max() > 1e-6
    np.testing.assert_allclose(cs.load_robot(path, right_angles=1e-5).fk(q), exact, atol=1e-12)
    squared = cs.robots.load_description(path, right_angles=1e-5)
    np.testing.assert_allclose(cs.Robot(squared).fk(q), exact, atol=1e-12)
    np.testing.assert_allclose(cs.load_robot(path, right_angles=1e-6).fk(q), as_written, atol=1e-12)


def test_loops_have_exact_right_angles_as_well():
    links = [Link("a"), Link("b")]
    off = rotation([0.6, 0.0, 0.8], 5e-6)
    frame = np.eye(4)
    frame[:3, :3] = off
    loop = Loop("l", "universal", "a", "b", frame, frame, axis=off[0], second_axis=off[1])
    robot = Description("r", links, [Joint("j", "revolute", "a", "b")], loops=[loop])
    squared = with_right_angles(robot).loops[0]
    for pose in (squared.origin, squared.child_origin):
        np.testing.assert_array_equal(pose, np.eye(4))
    np.testing.assert_array_equal([squared.axis, squared.second_axis], np.eye(3)[:2])


@pytest.mark.parametrize("wrong", [0, -1e-5, 0.02, math.nan, math.inf, [1e-5, 1e-5]])
def test_tolerances_that_no_rounding_has_are_refused(wrong):
    with pytest.raises(InputError, match="right_angles"):
        cs.load_robot("lite6", right_angles=wrong)
    with pytest.raises(InputTypeError, match="right_angles"):
        cs.load_robot("lite6", right_angles="yes")


@pytest.mark.parametrize("name", ["lite6", "icub_left_leg"])
def test_an_arm_of_rounded_axes_says_so(name):
    exact = cs.load_robot(name)
    rounded = cs.Robot(print_right_angles(exact.description, 4))
    assert "right_angles" in str(geometry(rounded))
    for robot in (exact, cs.Robot(with_right_angles(rounded.description))):
        assert "right_angles" not in str(geometry(robot))


def singular_configurations(robot, count, rng):
    """Random configurations with one joint where the determinant of the Jacobian changes its sign."""
    found = []
    while len(found) < count:
        q, joint = rng.uniform(-3, 3, 6), rng.integers(1, 5)
        grid = np.linspace(-math.pi, math.pi, 25)

        def volume(value, q=q, joint=joint):
            return np.linalg.det(robot.jacobian([*q[:joint], value, *q[joint + 1 :]]))

        values = np.array([volume(value) for value in grid])
        changes = np.flatnonzero(values[:-1] * values[1:] < 0)
        if not len(changes):
            continue
        k = rng.choice(changes)
        low, high = grid[k], grid[k + 1]
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if volume(middle) * values[k] > 0 else (low, middle)
        q[joint] = low
        found.append(q)
    return found


@pytest.mark.parametrize("name", ["lite6", "icub_left_leg", "cr5", "yam", "xarm6"])
def test_singular_poses_of_arms_with_exact_right_angles_are_certified(name):
    """Nearly all: rounding of the goal decides about few of them. With rounded axes, nine in ten were not."""
    robot, certified = cs.load_robot(name), 0
    for q in singular_configurations(robot, 30, np.random.default_rng(5)):
        T = robot.fk(q)
        s = robot.ik(T)
        certified += bool(s.complete)
        np.testing.assert_allclose(robot.fk(s.q), np.broadcast_to(T, (len(s), 4, 4)), atol=1e-8)
        gap = np.abs((s.q - q + math.pi) % (2 * math.pi) - math.pi).max(axis=1).min()
        assert gap < 1e-6 or s.self_motions
    assert certified >= 28


def test_a_written_file_keeps_exact_right_angles():
    for name in WITH_FRAMES:
        exact = cs.load_robot(name).description
        again = with_right_angles(from_urdf(to_urdf(exact)))
        for joint, true in zip(again.joints, exact.joints, strict=True):
            np.testing.assert_allclose(joint.origin, true.origin, atol=1e-15, rtol=0)
