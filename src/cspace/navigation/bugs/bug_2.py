"""Bug 2 (Lumelsky & Stepanov 1987): along the line from start to goal, and along walls back to it.

A robot with touch alone follows the line from start to goal, the M-line. At a wall it follows the wall to a
point of the M-line that is nearer to the goal and from which the line is free. If it comes back to where it
met the wall, no way exists. The way is no longer than the distance from start to goal and, for each ring of
walls, as many times its perimeter as the line enters it.
"""

from __future__ import annotations

from typing import Any

from cspace.navigation.bugs.walk import BUG_2, hand_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, hand: str = "left") -> Route:
    """The walk of a robot without a map from start to goal (2,) [m] in a PolygonWorld.

    hand: the one it keeps on the wall, "left" or "right".

    route.path is the walk even where no way exists; route.evidence is a BugEvidence; route.stats counts
    the pieces of wall and the straight lines followed.
    """
    return search(world, start, goal, "bug_2", {"hand": hand}, BUG_2, hand_of(hand))


def trace(route: Route) -> Trace:
    """The walk: "go", "hit", "follow" and "leave", one event after the other."""
    return traced(route, BUG_2, hand_of(route.options["hand"]))
