"""Bug 2: follows the M-line from start to goal, and walls back to it (Lumelsky & Stepanov 1987).

A robot with only a contact sensor follows the line from start to goal, the M-line. At a wall it follows the
wall to a point of the M-line that is nearer to the goal and from which the line is free. If it returns to
the point where it met the wall, no path exists. The path is no longer than the distance from start to goal
plus, for each boundary loop, its perimeter times the number of times the line enters it.
"""

from __future__ import annotations

from typing import Any

from cspace.navigation.bugs.walk import BUG_2, hand_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, hand: str = "left") -> Route:
    """The path of a robot without a map from start to goal (2,) [m] in a PolygonWorld.

    hand: the side of the robot on which it keeps the wall, "left" or "right".

    route.path is the path travelled even where no path exists; route.evidence is a BugEvidence; route.stats
    counts the pieces of wall and the straight lines followed.
    """
    return search(world, start, goal, "bug_2", {"hand": hand}, BUG_2, hand_of(hand))


def trace(route: Route) -> Trace:
    """The motion: the events "go", "hit", "follow" and "leave" in order."""
    return traced(route, BUG_2, hand_of(route.options["hand"]))
