"""Bug 1 (Lumelsky & Stepanov 1987): around what is in the way, then on from its nearest point.

A robot with touch alone goes straight for the goal. At a wall it walks around the whole ring of walls,
returns the shorter way to the ring's point nearest to the goal and leaves there. No ring is met twice, so the
way is no longer than the distance from start to goal and one and a half times the perimeters of the rings
met. If at that point the line to the goal enters the wall, no way exists.
"""

from __future__ import annotations

from typing import Any

from cspace.navigation.bugs.walk import BUG_1, hand_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, hand: str = "left") -> Route:
    """The walk of a robot without a map from start to goal (2,) [m] in a PolygonWorld.

    hand: the one it keeps on the wall, "left" or "right".

    route.path is the walk even where no way exists; route.evidence is a BugEvidence; route.stats counts
    the pieces of wall and the straight lines followed.
    """
    return search(world, start, goal, "bug_1", {"hand": hand}, BUG_1, hand_of(hand))


def trace(route: Route) -> Trace:
    """The walk: "go", "hit", "follow" and "leave", one event after the other."""
    return traced(route, BUG_1, hand_of(route.options["hand"]))
