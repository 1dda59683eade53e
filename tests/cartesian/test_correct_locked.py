"""Configurations near a guess with one joint where it is."""

import numpy as np
import pytest

import cspace as cs
from cspace.cartesian.refine import correct_locked
from cspace.ik.solver import as_solver


@pytest.mark.parametrize("name", ["panda", "gen3", "iiwa14", "xarm7", "sawyer"])
def test_poses_are_reached_with_the_redundant_joint_where_it_is(name: str) -> None:
    robot = cs.load_robot(name)
    joint = as_solver(robot).redundant_joints[0]
    rng = np.random.default_rng(1)
    q = robot.random_configuration(300, rng=rng)
    T = robot.fk(q)
    near = q + 0.02 * rng.uniform(-1.0, 1.0, q.shape)
    near[:, joint] = q[:, joint]
    found = correct_locked(robot, T, near, joint)
    reached = np.isfinite(found[:, 0])
    assert reached.mean() > 0.95  # others are beside singular configurations
    assert (found[reached, joint] == near[reached, joint]).all()
    assert np.abs(robot.fk(found[reached]) - T[reached]).max() < 1e-8


def test_poses_out_of_reach_give_nan() -> None:
    robot = cs.load_robot("panda")
    q = robot.random_configuration(20, rng=0)
    T = robot.fk(q)
    T[:, 0, 3] += 5.0
    assert np.isnan(correct_locked(robot, T, q, 2)).all()
