"""Arms of up to three joints whose axes meet, are parallel or fold flat only up to rounding."""

import numpy as np
import pytest

import cspace as cs
from ik.geometries import angle_gap

X, Y, Z = np.eye(3)


@pytest.mark.parametrize("tilt", [0, 1e-17, 6e-17, 1e-12, 1e-9, 1e-8, 1e-7, 1e-4])
@pytest.mark.parametrize("size", [1e-3, 1, 1e3])
def test_a_pan_and_roll_arm_reaches_its_poses_whatever_rounding_left_of_the_right_angle(tilt, size):
    robot = cs.Robot.from_screws([Z, -Y + tilt * Z], np.zeros((2, 3)), cs.pose([0, -size, 0]))
    for q in np.random.default_rng(3).uniform(-3, 3, (20, 2)):
        s = robot.ik(robot.fk(q))
        assert s.complete
        assert angle_gap(s.q, q).min() < 1e-6


@pytest.mark.parametrize("off", [0, 1e-15, 1e-14, 1e-12, 1e-9])
def test_a_tip_on_the_axis_up_to_rounding(off):
    robot = cs.Robot.from_screws([Y], [[1, 1, 1]], cs.pose([1 + off, 0.5, 1]))
    for q in np.random.default_rng(4).uniform(-3, 3, (20, 1)):
        assert angle_gap(robot.ik(robot.fk(q)).q, q).min() < 1e-9


@pytest.mark.parametrize("fold", [1e-8, 3e-8, 1e-7, 3e-7, 1e-6, 1e-4])
@pytest.mark.parametrize("name", ["planar_3r", "three_link"])
def test_a_planar_arm_that_is_almost_folded_has_both_elbows(name, fold):
    """Folded back, the wrist is close to the axis of the first joint; the elbows are half a turn apart."""
    robot = cs.load_robot(name)
    for first, last in np.random.default_rng(5).uniform(-3, 3, (10, 2)):
        q = np.array([first, np.pi - fold, last])
        s = robot.ik(robot.fk(q))
        assert not s.complete or s.self_motions or len(s.q) == 2
        assert angle_gap(s.q, q).min() < 1e-5


@pytest.mark.parametrize("joint_types", ["RRR", "PPP", "RR", "PP"])
def test_joints_on_one_line_leave_more_than_a_curve_unless_they_are_two(joint_types):
    n = len(joint_types)
    robot = cs.Robot.from_screws([Z] * n, np.zeros((n, 3)), np.eye(4), joint_types=joint_types)
    s = robot.ik(robot.fk([0.7, -0.2, 0.1][:n]))
    assert s.self_motions
    assert s.complete == (n == 2)
