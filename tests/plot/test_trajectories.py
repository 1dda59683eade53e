"""Pictures of trajectories: what the panels of a robot show, and what is marked as exceeded."""

import numpy as np
import pytest

import cspace as cs
from cspace import plot
from cspace.errors import InputError, InputTypeError
from cspace.plot.trajectories import BEYOND

START = np.array([0, -0.7, 0, -2.0, 0, 1.5, 0.7])


def panels_of(artists):
    return artists[0].figure.axes


def curves(panel, count):
    """The curves of a panel, drawn first."""
    return panel.lines[:count]


def red_times(panel):
    rows = [line.get_xydata() for line in panel.lines if line.get_color() == BEYOND]
    return (
        np.unique(np.concatenate([row[np.isfinite(row[:, 1]), 0] for row in rows])) if rows else np.zeros(0)
    )


@pytest.mark.parametrize("seed", range(3))
def test_torques_and_tip_speed_are_those_of_the_robot(seed):
    robot = cs.load_robot("panda")
    rng = np.random.default_rng(seed)
    goal = START + rng.uniform(-0.5, 0.5, 7)
    for motion in (
        robot.move_to(goal, start=START),
        cs.time_parametrize(cs.spline([START, goal, START]), robot),
        robot.move_linear(robot.fk(START) @ cs.pose((0.05, 0.05, 0)), start=START),
    ):
        panels = panels_of(plot.trajectory(motion, limits=robot, robot=robot))
        assert len(panels) == 6
        t = curves(panels[4], 7)[0].get_xdata()
        q, qd, qdd = (motion(t, order) for order in range(3))
        tau = robot.inverse_dynamics(q, qd, qdd)
        drawn = np.stack([line.get_ydata() for line in curves(panels[4], 7)], axis=1)
        np.testing.assert_allclose(drawn, tau, atol=1e-9)
        speed, turn = (line.get_ydata() for line in curves(panels[5], 2))
        tip = robot.fk(q)[:, :3, 3]
        way = np.linalg.norm(np.diff(tip, axis=0), axis=1).sum()
        assert np.sum(0.5 * (speed[1:] + speed[:-1]) * np.diff(t)) == pytest.approx(way, rel=1e-3)
        assert turn.max() > 0.0


def test_red_is_exactly_where_a_torque_or_a_speed_exceeds_its_limit():
    robot = cs.load_robot("panda")
    motion = robot.move_to(START + 0.4, start=START)
    t = np.linspace(0, motion.duration, 500)
    tau = np.abs(robot.inverse_dynamics(*(motion(t, order) for order in range(3)))).max(axis=0)
    kept = panels_of(plot.trajectory(motion, robot=robot, torque=tau * 1.01, speed=9.0, turn_rate=9.0))
    assert not red_times(kept[4]).size
    assert not red_times(kept[5]).size
    panels = panels_of(plot.trajectory(motion, robot=robot, torque=tau * 0.9, speed=0.2))
    for panel, count, limit in ((panels[4], 7, tau * 0.9), (panels[5], 2, np.array([0.2, np.inf]))):
        x = curves(panel, count)[0].get_xdata()
        values = np.stack([line.get_ydata() for line in curves(panel, count)], axis=1)
        over = (np.abs(values) > limit * (1 + 1e-9)).any(axis=1)
        assert over.any()
        np.testing.assert_array_equal(red_times(panel), np.unique(x[over]))


def test_a_robot_without_masses_has_no_panel_of_torques():
    robot = cs.load_robot("planar_3r", geometry="skeleton")
    motion = robot.move_to([0.5, 0.1, 0], start=np.zeros(3), velocity=1.0, acceleration=2.0, jerk=20.0)
    masses = [link.inertial for link in robot.description.links if link.inertial]
    assert len(panels_of(plot.trajectory(motion, robot=robot))) == (6 if masses else 5)


def test_wrong_robots_and_limits_are_named():
    robot, other = cs.load_robot("panda"), cs.load_robot("ur5e")
    motion = robot.move_to(START + 0.1, start=START)
    with pytest.raises(InputError, match="the trajectory is of 7 joints, ur5e of 6"):
        plot.trajectory(motion, robot=other)
    with pytest.raises(InputTypeError, match="speed= is of a robot; pass robot="):
        plot.trajectory(motion, speed=0.1)
    with pytest.raises(InputTypeError, match="robot is a str"):
        plot.trajectory(motion, robot="panda")
    with pytest.raises(InputError, match="torque has shape"):
        plot.trajectory(motion, robot=robot, torque=[1, 2])
    with pytest.raises(InputError, match="speed is 0"):
        plot.trajectory(motion, robot=robot, speed=0.0)
    with pytest.raises(InputError, match="needs 6 axes, got 4"):
        plot.trajectory(motion, robot=robot, axes=panels_of(plot.trajectory(motion)))
