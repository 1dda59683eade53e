"""The judges of the benchmarks are right: arms as numbers, singular configurations, what counts as found."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from data import ROOT


@pytest.fixture(autouse=True)
def _benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))


def configurations(arm, count, seed=3):
    import problems

    return problems.random_configurations(arm, count, np.random.default_rng(seed))


@pytest.mark.parametrize("name", ["ur5e+1e-3", "stanford", "random:RRPRPR", "scara"])
def test_the_plain_kinematics_are_those_of_the_robot(name):
    import arms
    import chains

    arm = arms.load(name)
    robot = cs.Robot(cs.model.from_screws(arm.axes, arm.points, arm.T_zero, joint_types=arm.joint_types))
    q = configurations(arm, 20)
    assert np.abs(chains.fk(arm, q) - robot.fk(q)).max() < 1e-13
    assert np.abs(chains.jacobian(arm, q) - robot.jacobian(q)).max() < 1e-13


@pytest.mark.parametrize("joint", range(7))
def test_an_arm_with_a_joint_held_moves_as_the_whole_arm_does_with_it_there(joint):
    import arms
    import chains

    arm = arms.load("iiwa14")
    q = configurations(arm, 20)
    q[:, joint] = 0.7
    locked = arms.locked(arm, joint, 0.7, "held")
    assert np.abs(chains.fk(locked, np.delete(q, joint, axis=1)) - chains.fk(arm, q)).max() < 1e-13


@pytest.mark.parametrize("name", ["jaco2", "stanford"])
def test_singular_configurations_lose_a_direction_and_a_step_of_their_joint_brings_it_back(name):
    import arms
    import chains
    import completeness

    arm = arms.load(name)
    q, joints = completeness.singular_configurations(arm, 30, np.random.default_rng(5))
    assert len(q) == 30
    assert arm.turns[joints].all()
    assert np.linalg.svd(chains.jacobian(arm, q), compute_uv=False)[:, -1].max() < 1e-12
    low, high = q.copy(), q.copy()
    low[np.arange(30), joints] -= 1e-4
    high[np.arange(30), joints] += 1e-4
    before, after = (np.linalg.det(chains.jacobian(arm, side)) for side in (low, high))
    assert (before * after < 0).all()


def test_a_configuration_that_is_not_listed_is_missed_and_a_turn_of_a_listed_one_is_not():
    import arms
    import completeness

    arm = arms.load("stanford")
    q = configurations(arm, 5)
    listed = np.stack([np.full_like(q, np.nan), q], axis=1)
    turned = q + 2 * np.pi * arm.turns
    assert completeness.gaps(arm, turned, listed).max() < 1e-12
    assert completeness.gaps(arm, q + 0.1, listed).min() > 0.09
    assert np.isinf(completeness.gaps(arm, q, listed[:, :1])).all()
    slid = q + np.where(arm.turns, 0.0, 2 * np.pi)
    assert completeness.gaps(arm, slid, listed).min() > 6


def test_examining_counts_what_a_solver_leaves_out():
    import arms
    import completeness

    class Forgetful:
        """A robot that drops the first solution of every goal and certifies the rest."""

        def __init__(self, robot):
            self.robot = robot

        def ik(self, T, threads):
            answer = self.robot.ik(T, threads=threads)
            self.q, self.complete = answer.q[:, 1:], np.ones(len(T), dtype=bool)
            return self

    arm = arms.load("ur5e")
    robot = cs.Robot(cs.model.from_screws(arm.axes, arm.points, arm.T_zero))
    q = configurations(arm, 60)
    whole, part = (completeness.examine(arm, solver, q) for solver in (robot, Forgetful(robot)))
    assert whole["missed"] == whole["false"] == 0
    assert whole["residual"] < 1e-12
    assert part["missed"] == part["false"] > 0
