"""The residual of every row: the motion by which goals were moved away from the poses of the rows."""

from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace.ik.goals.partial import plain_goal
from cspace.spatial import exp_so3
from ik.arms import load

ARMS = ["ur5e", "kr6_r900", "jaco2", "scara", "planar_3r", "so101"]
MOTIONS = [0.0, 1e-12, 1e-9, 1e-4, 0.3, 1.7, 3.1]


def answered(name, n=40):
    """A batch of goals, some of which have fewer solutions than others and some none."""
    robot = load(name)
    T = robot.fk(robot.random_configuration(n, rng=3))
    T[::7, :3, 3] *= 40
    return robot, robot.ik(T)


def turned(T, angle, rng):
    """Poses turned by an angle about random axes, each through its own origin."""
    axis = rng.normal(size=(*T.shape[:-2], 3))
    axis *= angle / np.linalg.norm(axis, axis=-1, keepdims=True)
    out = T.copy()
    out[..., :3, :3] = exp_so3(axis) @ T[..., :3, :3]
    return out


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("by", MOTIONS)
def test_goals_that_moved_are_missed_by_their_motion(name, by):
    rng = np.random.default_rng(1)
    _, batch = answered(name)
    real = np.arange(batch.q.shape[-2]) < batch.count[..., None]
    shift = rng.normal(size=(len(batch), 3))
    shift *= by / np.linalg.norm(shift, axis=-1, keepdims=True)
    moved = batch.goal.copy()
    moved[:, :3, 3] += shift
    for goals in (moved, turned(batch.goal, by, rng)):
        residual = replace(batch, goal=goals).residual
        assert np.array_equal(np.isnan(residual), ~real)
        np.testing.assert_allclose(residual[real], by, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", ARMS)
def test_one_and_many_are_measured_alike_and_by_the_parts_of_the_goal(name):
    robot, batch = answered(name)
    assert batch.residual.shape == batch.q.shape[:-1]
    for i in range(0, len(batch), 5):
        one, rows = batch[i], batch.q[i][: batch.count[i]]
        np.testing.assert_array_equal(one.residual, batch.residual[i][: batch.count[i]])
        if len(rows):
            parts = plain_goal(batch.goal[i]).residual(robot.fk(rows))
            np.testing.assert_allclose(one.residual, parts, rtol=0, atol=1e-14)


def test_points_are_missed_by_their_distance():
    rows = [[0, np.pi / 2, 0.3, 0], [0.4, 0, 0, 0], [0.3, 0, 0, 0]]
    arm = cs.Robot.from_dh(rows, convention="standard")
    p = arm.fk(arm.random_configuration(30, rng=0))[:, :3, 3]
    batch = arm.ik(position=p)
    real = np.isfinite(batch.q[..., 0])
    assert np.array_equal(np.isfinite(batch.residual), real)
    away = replace(batch, goal=p + np.array([0.0, 0.6, 0.8]))
    np.testing.assert_allclose(away.residual[real], 1.0, rtol=1e-9)
