"""Tools held along or square to the first axis: goals that users ask for most, and at which solutions of
general arms share the angles that lead to them."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.spatial import exp_so3
from ik.arms import load
from ik.likenesses import gap, random_configurations, weakest

UPRIGHT = {
    "down": np.diag([1.0, -1.0, -1.0]),
    "up": np.eye(3),
    "level": np.array([[0, 0, 1.0], [0, 1, 0], [-1, 0, 0]]),
}
NAMES = ["crx10ia", "gen3_lite", "irb140", "jaco2", "m1013", "piper", "xarm6"]


def goals(robot, locked, rng, n):
    """Poses at points within reach, the tool held so and turned about the first axis."""
    T = robot.fk(random_configurations(robot, rng, n))
    T[:, :3, :3] = exp_so3(rng.uniform(-3, 3, (n, 1)) * [0, 0, 1]) @ UPRIGHT[locked]
    return T


def reached_by_tilting(robot, goal, rng, tilts=2):
    """What the solutions of goals tilted a little become when the tilt is taken back."""
    out = []
    for _ in range(tilts):
        tilted = goal.copy()
        tilted[:3, :3] = exp_so3(rng.normal(scale=1.5e-3, size=3)) @ goal[:3, :3]
        tilted[:3, 3] += rng.normal(scale=5e-4, size=3)
        for start in robot.ik(tilted).q:
            found = robot.ik_numeric(goal, start, limits=False)
            if found.success and weakest(robot, found.q) > 1e-3:
                out.append(found.q)
    return out


@pytest.mark.parametrize("locked", UPRIGHT)
@pytest.mark.parametrize("name", NAMES)
def test_certified_lists_hold_what_goals_beside_lead_to(name, locked):
    robot, rng = load(name), np.random.default_rng(31)
    certified = reached = checked = 0
    for goal in goals(robot, locked, rng, 30):
        found = robot.ik(goal)
        reached += len(found) > 0
        certified += len(found) > 0 and found.complete
        if not found.complete:
            continue
        for q in reached_by_tilting(robot, goal, rng):
            checked += 1
            assert min(gap(robot, q, row) for row in found.q) < 1e-5, (goal, q)
    assert checked > 50
    assert certified >= 0.6 * reached


@pytest.mark.parametrize(
    ("name", "xyz", "rpy", "count"),
    [
        ("irb140", (0.4, 0.2, 0.4), (np.pi, 0, 0), 8),
        ("xarm6", (0.4, 0.1, 0.3), (np.pi, 0, 0.3), 8),
        ("jaco2", (0.3, 0.2, 0.4), (np.pi, 0, 0), 4),
    ],
)
def test_a_tool_straight_down(name, xyz, rpy, count):
    found = load(name).ik(cs.pose(xyz, rpy=rpy))
    assert len(found) == count
    assert found.complete
