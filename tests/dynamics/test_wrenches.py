"""Wrenches in the recursions against Jacobians, on random trees with a fixed or floating base."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, UnknownNameError
from dynamics.test_motion_and_force import ARMS, ROBOTS, TREES, scale
from kinematics.robots import random_q
from model.random_robots import random_pose

FREE = [cs.Robot(robot.description, floating=True) for robot in [*TREES[:4], ARMS[1]]]
ALL = [*ROBOTS, *FREE]
ids = [f"{robot.name}{' floating' if robot.floating else ''}" for robot in ALL]


@pytest.fixture
def rng():
    return np.random.default_rng(17)


def pulled(robot, q, wrenches, expressed_in, placed):
    """Σ Jᵀ w by Jacobians."""
    total = 0.0
    for frame, w in wrenches.items():
        J = robot.jacobian(q, frame, expressed_in=expressed_in, **placed)
        total = total + np.einsum("...ij,...i->...j", J, w)
    return total


def some_wrenches(robot, rng, count):
    """At a few frames, the base among them, one for all rows or one for each."""
    frames = [robot.base, *rng.choice(robot.frames, size=3)]
    return {f: rng.normal(size=(count, 6) if i % 2 else 6) * 10 for i, f in enumerate(frames)}


@pytest.mark.parametrize("axes", ["base", "tip"])
@pytest.mark.parametrize("robot", ALL, ids=ids)
def test_wrenches_are_those_of_jacobians(robot, axes, rng):
    count = 13
    q = random_q(robot, rng, count)
    qd, force = rng.normal(size=(2, count, robot.dof))
    wrenches = some_wrenches(robot, rng, count)
    for T in (None, random_pose(rng), np.array([random_pose(rng) for _ in range(count)])):
        placed = {} if T is None else {"T_world_base": T}
        pushed = {"wrenches": wrenches, "expressed_in": axes, **placed}
        pull = pulled(robot, q, wrenches, axes, placed)
        free = robot.inverse_dynamics(q, qd, force, **placed)
        tau = robot.inverse_dynamics(q, qd, force, **pushed)
        np.testing.assert_allclose(tau, free - pull, atol=1e-11 * scale(free))
        again = robot.forward_dynamics(q, qd, tau, **pushed)
        np.testing.assert_allclose(again, force, atol=1e-8 * scale(force))


def test_more_wrenches_than_configurations_give_as_many_answers(rng):
    robot = ARMS[1]
    q, (qd, force) = random_q(robot, rng), rng.normal(size=(2, robot.dof))
    w = rng.normal(size=(4, 5, 6))
    tau = robot.inverse_dynamics(q, qd, force, wrenches={robot.tip: w})
    expected = robot.inverse_dynamics(q, qd, force) - w @ robot.jacobian(q)
    np.testing.assert_allclose(tau, expected, atol=1e-12 * scale(expected))
    qdd = robot.forward_dynamics(q, qd, tau, wrenches={robot.tip: w})
    np.testing.assert_allclose(qdd, np.broadcast_to(force, qdd.shape), atol=1e-9 * scale(force))
    with pytest.raises(InputError, match="wrench at"):
        robot.inverse_dynamics(np.zeros((3, robot.dof)), qd, force, wrenches={robot.tip: w})


def test_an_answer_may_be_written_over_a_wrench(rng):
    robot = ARMS[0]
    q, qd, force = random_q(robot, rng, 9), *rng.normal(size=(2, 9, 6))
    w = rng.normal(size=(9, 6))
    expected = robot.inverse_dynamics(q, qd, force, wrenches={robot.tip: w})
    np.testing.assert_array_equal(
        robot.inverse_dynamics(q, qd, force, wrenches={robot.tip: w}, out=w), expected
    )


def test_bad_wrenches_are_named():
    robot, zero = ARMS[0], np.zeros(6)
    with pytest.raises(UnknownNameError, match="tipp"):
        robot.forward_dynamics(zero, zero, zero, wrenches={robot.tip: zero}, expressed_in="tipp")
    with pytest.raises(InputError, match="wrench at"):
        robot.forward_dynamics(zero, zero, zero, wrenches={robot.tip: np.full(6, np.nan)})
