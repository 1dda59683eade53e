"""Single precision: how far batches of floats are from those of doubles, on random robots."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from dynamics.test_motion_and_force import ARMS, ROBOTS, TREES, massless_tip
from kinematics.robots import random_q
from model.random_robots import random_pose

FREE = [cs.Robot(robot.description, floating=True) for robot in [*TREES[:4], ARMS[1], ARMS[4]]]
ALL = [*ROBOTS, *FREE]
ids = [f"{robot.name}{' floating' if robot.floating else ''}" for robot in ALL]
COUNT = 300

# As docs/dynamics.md states them, relative to the largest entry of the batch; ACCELERATIONS: of the row, the
# typical one and the worst; EFFORT: of the torques of the accelerations that were found.
TORQUES, MASS, EFFORT = 1e-6, 1e-6, 5e-5
ACCELERATIONS = 1e-5, 5e-4


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def motion(robot, rng, count=COUNT):
    """Random rows that are floats already: arguments as floats and the same numbers as doubles."""
    shape = (count, robot.dof)
    given = [random_q(robot, rng, count), rng.normal(size=shape), rng.normal(size=shape)]
    floats = [x.astype(np.float32) for x in given]
    placed = {}
    if robot.floating:
        placed["T_world_base"] = random_pose(rng)
    return floats, [x.astype(np.float64) for x in floats], placed


def test_torques_of_floats(rng):
    worst = 0.0
    for robot in ALL:
        floats, doubles, placed = motion(robot, rng)
        tau = robot.inverse_dynamics(*floats, dtype=np.float32, **placed)
        assert tau.dtype == np.float32
        exact = robot.inverse_dynamics(*doubles, **placed)
        worst = max(worst, np.abs(tau - exact).max() / np.abs(exact).max())
    assert worst < TORQUES


def test_mass_matrices_of_floats(rng):
    worst = 0.0
    for robot in ALL:
        floats, doubles, placed = motion(robot, rng)
        M = robot.mass_matrix(floats[0], dtype=np.float32, **placed)
        exact = robot.mass_matrix(doubles[0], **placed)
        worst = max(worst, np.abs(M - exact).max() / np.abs(exact).max())
    assert worst < MASS


def test_accelerations_of_floats_need_nearly_the_torques_that_were_given(rng):
    worst, errors = 0.0, []
    for robot in ALL:
        floats, doubles, placed = motion(robot, rng)
        qdd = robot.forward_dynamics(*floats, dtype=np.float32, **placed)
        tau = robot.inverse_dynamics(*doubles[:2], qdd.astype(np.float64), **placed)
        size = max(np.abs(robot.inverse_dynamics(*doubles, **placed)).max(), np.abs(doubles[2]).max())
        worst = max(worst, np.abs(tau - doubles[2]).max() / size)
        exact = robot.forward_dynamics(*doubles, **placed)
        errors.append(np.abs(qdd - exact).max(axis=1) / np.abs(exact).max(axis=1))
    assert worst < EFFORT
    assert np.median(errors) < ACCELERATIONS[0]
    assert np.max(errors) < ACCELERATIONS[1]


@pytest.mark.parametrize("robot", [TREES[0], ARMS[1], FREE[0]], ids=lambda robot: robot.name)
def test_rows_of_floats_do_not_depend_on_their_neighbours(robot, rng):
    floats, doubles, placed = motion(robot, rng, 37)
    for function in (robot.inverse_dynamics, robot.forward_dynamics):
        many = function(*floats, dtype=np.float32, **placed)
        for count in (1, 3, 16, 17):
            part = function(*(x[:count] for x in floats), dtype=np.float32, **placed)
            np.testing.assert_array_equal(part, many[:count])
        # Arguments of other types and shapes are converted, and an array is written into.
        np.testing.assert_array_equal(function(*doubles, dtype="float32", **placed), many)
        out = np.empty_like(many)
        assert function(*floats, out=out, dtype=np.float32, threads=2, **placed) is out
        np.testing.assert_array_equal(out, many)
        one = function(*(x[0].tolist() for x in floats), dtype=np.float32, **placed)
        np.testing.assert_array_equal(one, many[0])
        np.testing.assert_array_equal(function(*floats, out=floats[2], dtype=np.float32, **placed), many)
        floats[2] = doubles[2].astype(np.float32)


def test_wrenches_count_in_floats(rng):
    robot = ARMS[1]
    floats, doubles, _ = motion(robot, rng)
    pushed = {"wrenches": {robot.tip: rng.normal(size=(COUNT, 6)) * 10}}
    tau = robot.inverse_dynamics(*floats, dtype=np.float32, **pushed)
    exact = robot.inverse_dynamics(*doubles, **pushed)
    assert np.abs(tau - exact).max() < TORQUES * np.abs(exact).max()


def test_bad_arguments_of_floats_are_named(rng):
    robot = ARMS[0]
    floats, _, _ = motion(robot, rng, 20)
    zero = np.zeros(6, np.float32)
    for change, error, message in (
        ((0, np.nan), InputError, "q"),
        ((1, np.inf), InputError, "qd"),
        ((2, np.nan), InputError, "qdd"),
        ((0, 2e4), InputError, "10000"),
    ):
        given = [x.copy() for x in floats]
        given[change[0]][7, 2] = change[1]
        with pytest.raises(error, match=message):
            robot.inverse_dynamics(*given, dtype=np.float32)
    with pytest.raises(InputTypeError, match="float32"):
        robot.mass_matrix(zero, dtype=np.float32, out=np.empty((6, 6)))
    with pytest.raises(InputError, match="out has shape"):
        robot.mass_matrix(zero, dtype=np.float32, out=np.empty((5, 6), np.float32))
    with pytest.raises(InputError, match="dtype"):
        robot.mass_matrix(zero, dtype=np.int32)
    with pytest.raises(InputError, match="qdd has shape"):
        robot.inverse_dynamics(zero, zero, zero[:5], dtype=np.float32)
    light = massless_tip()
    with pytest.raises(InputError, match="'second' moves no inertia"):
        light.forward_dynamics(np.full((5, 2), 0.3), [0, 0], [0, 0], dtype=np.float32)
