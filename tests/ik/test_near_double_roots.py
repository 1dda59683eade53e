"""At poses where several solutions merge each is listed once, however singular its twin."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ik.arms import load


@pytest.mark.parametrize("name", ["jaco2", "jaco_dh", "gen3_lite", "crx10ia", "xarm6"])
def test_no_two_rows_are_one_within_rounding(name):
    robot = load(name)
    rng = np.random.default_rng(17)
    quarters = rng.integers(-1, 3, (60, robot.dof)) * np.pi / 2
    for q in [np.array([0, np.pi, np.pi, 0, 0, 0.0]), *quarters]:
        goal = robot.fk(q)
        found = robot.ik(goal)
        assert found
        for a, b in itertools.combinations(np.flatnonzero([not f for f in found._is_self_motion]), 2):
            step = (found.q[b] - found.q[a] + np.pi) % (2 * np.pi) - np.pi
            if np.abs(step).max() > 1e-5:
                continue
            halfway = np.abs(robot.fk(found.q[a] + step / 2) - goal).max()
            assert halfway > 5e-15, (q, found.q[a], found.q[b])
