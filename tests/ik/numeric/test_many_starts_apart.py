"""Of the ends of many descents those that differ are listed once each, as a comparison of all pairs says."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs

SAME = 1e-6


def gaps(robot: cs.Robot, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The largest joint difference of each row of a to each row of b, angles the short way round."""
    d = a[:, None] - b[None]
    turns = np.array([kind == "revolute" for kind in robot.joint_types])
    return np.abs(np.where(turns, np.angle(np.exp(1j * d)), d)).max(axis=-1)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "ur5e", "scara", "fetch_torso", "stanford", "planar_3r"])
def test_ends_of_many_starts_are_apart(name: str) -> None:
    robot = cs.load_robot(name)
    q = robot.random_configuration(rng=3)
    s = robot.ik_many_starts(robot.fk(q), starts=1500, rng=4)
    assert s
    apart = gaps(robot, s.q, s.q) + np.eye(len(s.q))
    assert apart.min() > SAME
    assert s.hits.min() >= 1


def test_ends_on_both_sides_of_half_a_turn_are_one() -> None:
    robot = cs.load_robot("ur5e")
    for joint in range(6):
        q = np.array([0.3, -1.2, 1.4, -0.8, 0.7, 0.1])
        q[joint] = np.pi
        s = robot.ik_many_starts(robot.fk(q), starts=q + np.random.default_rng(1).normal(0, 1e-3, (200, 6)))
        assert (gaps(robot, s.q, q[None])[:, 0] < 1e-6).sum() <= 1
        assert s.hits.sum() >= 150
        assert len(s.q) <= 16
