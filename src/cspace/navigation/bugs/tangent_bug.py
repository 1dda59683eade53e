"""Tangent Bug: moves toward the visible edge with the shortest estimated path (Kamon, Rimon & Rivlin 1998).

A range sensor detects walls up to a distance. The robot moves to the goal, and passes an obstacle at the
visible edge that minimises the estimated remaining path. Where every visible edge is farther from the goal
than the robot itself, it follows the wall. It leaves the wall when a visible point is nearer to the goal
than every point of the wall followed so far. A boundary loop that has been followed completely is judged as
in Bug 1.
"""

from __future__ import annotations

from math import inf
from typing import Any

from cspace.arrays import as_floats
from cspace.errors import InputError
from cspace.navigation.bugs.walk import EITHER, TANGENT_BUG, hand_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, range: float = inf, hand: str | None = None) -> Route:
    """The path of a robot with a range sensor from start to goal (2,) [m] in a PolygonWorld.

    range [m]: of the sensor; 0 is contact only, inf is limited only by walls. hand: the side of the robot
    on which it keeps the wall, "left" or "right"; None turns it to the better visible edge.

    route.path is the path travelled even where no path exists; route.evidence is a BugEvidence. Raises
    InputError for a negative range or NaN.
    """
    reach = inf if range == inf else float(as_floats(range, "range"))
    if reach < 0:
        raise InputError(f"range is {reach:g}; it must be zero or more [m], or inf")
    options = {"range": reach, "hand": hand}
    return search(world, start, goal, "tangent_bug", options, TANGENT_BUG, _number(hand), reach)


def trace(route: Route) -> Trace:
    """The motion: the events "go", "hit", "follow" and "leave" in order."""
    options = route.options
    return traced(route, TANGENT_BUG, _number(options["hand"]), options["range"])


def _number(hand: str | None) -> int:
    return EITHER if hand is None else hand_of(hand)
