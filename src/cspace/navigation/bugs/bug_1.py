"""Bug 1: circumnavigates each obstacle and leaves it at the point nearest to the goal (Lumelsky & Stepanov
1987).

A robot with only a contact sensor moves straight to the goal. At a wall it follows the whole boundary loop,
returns the shorter way to the loop's point nearest to the goal and leaves the wall there. No loop is met
twice. The path is therefore no longer than the distance from start to goal plus one and a half times the
perimeters of the loops met. If the line to the goal enters the wall at that point, no path exists.
"""

from __future__ import annotations

from typing import Any

from cspace.navigation.bugs.walk import BUG_1, hand_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, hand: str = "left") -> Route:
    """The path of a robot without a map from start to goal (2,) [m] in a PolygonWorld.

    hand: the side of the robot on which it keeps the wall, "left" or "right".

    route.path is the path travelled even where no path exists; route.evidence is a BugEvidence; route.stats
    counts the pieces of wall and the straight lines followed.
    """
    return search(world, start, goal, "bug_1", {"hand": hand}, BUG_1, hand_of(hand))


def trace(route: Route) -> Trace:
    """The motion: the events "go", "hit", "follow" and "leave" in order."""
    return traced(route, BUG_1, hand_of(route.options["hand"]))
