"""The self-motions of solutions with locked joints: the locked ones stay, and so does the tip."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs


@pytest.mark.parametrize("name", ["iiwa14", "panda", "xarm7", "gen3", "pr2_right"])
@pytest.mark.parametrize("bent", range(1, 6))
@pytest.mark.parametrize("locked", [0, 2, 6])
def test_locked_joints_stay_along_self_motions(name: str, bent: int, locked: int) -> None:
    robot = cs.load_robot(name)
    q = np.array([0.3, 0.4, 0.1, -1.2, 0.4, 0.6, 0.3])
    q[bent] = 0.0
    T = robot.fk(q)
    s = robot.ik(T, locked={locked: q[locked]})
    assert str(s)
    for motion in s.self_motions:
        assert motion.direction[locked] == 0.0
        for along in motion.sample(5):
            np.testing.assert_allclose(robot.fk(along), T, rtol=0, atol=1e-9)
            assert along[locked] == pytest.approx(s.q[motion.row, locked], abs=1e-15)
        nearest = motion.nearest(q)
        np.testing.assert_allclose(robot.fk(nearest), T, rtol=0, atol=1e-9)
        assert nearest[locked] == pytest.approx(s.q[motion.row, locked], abs=1e-15)
        bounds = motion.bounds[locked]
        assert np.isnan(bounds).all() or np.ptp(bounds) < 1e-12


def test_locked_joint_in_singular_goal_is_found_at_all() -> None:
    """At least one of the goals above is singular, so that the law has something to say."""
    robot = cs.load_robot("iiwa14")
    q = np.array([0.3, 0.0, 0.1, -1.2, 0.4, 0.6, 0.3])
    s = robot.ik(robot.fk(q), locked={6: q[6]})
    assert s.status == "singular"
    assert len(s.self_motions) > 0


def test_arms_that_no_form_solves_name_their_self_motions() -> None:
    for tilt in (0.0, 1e-3, 0.3):
        robot = cs.Robot.from_screws(
            [[1, 0, tilt], *[[0, 0, 1]] * 3],
            [[0, 0, 0], [0, 0, 0], [0.25, 0, 0.1], [0.5, 0, 0.1]],
            cs.pose([0.7, 0, 0.1]),
            joint_types="PRRR",
        )
        T = robot.fk([0.2, 0.3, np.pi, -0.4])
        s = robot.ik(T)
        assert str(s)
        for motion in s.self_motions:
            for along in motion.sample(4):
                np.testing.assert_allclose(robot.fk(along), T, rtol=0, atol=1e-9)
