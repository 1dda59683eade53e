"""Tangent Bug (Kamon, Rimon & Rivlin 1998): around what is in view by its edges, else along walls.

A robot sees walls up to a distance. It goes for the goal, around what is in the way by the edge in view over
which the rest of the way would be shortest. Where every edge lies further from the goal than it is itself, it
follows the wall until a point comes into view that is nearer to the goal than all of the wall it has
followed. A ring of walls followed all around is judged as Bug 1 judges it.
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
    """The walk of a robot with a range sensor from start to goal (2,) [m] in a PolygonWorld.

    range [m]: how far it sees; 0 leaves touch alone, inf sees as far as walls let it. hand: the one it
    keeps on the wall, "left" or "right"; None turns it to the better edge in view.

    route.path is the walk even where no way exists; route.evidence is a BugEvidence. Raises InputError on
    a negative range or NaN.
    """
    reach = inf if range == inf else float(as_floats(range, "range"))
    if reach < 0:
        raise InputError(f"range is {reach:g}; it must be zero or more [m], or inf")
    options = {"range": reach, "hand": hand}
    return search(world, start, goal, "tangent_bug", options, TANGENT_BUG, _number(hand), reach)


def trace(route: Route) -> Trace:
    """The walk: "go", "hit", "follow" and "leave", one event after the other."""
    options = route.options
    return traced(route, TANGENT_BUG, _number(options["hand"]), options["range"])


def _number(hand: str | None) -> int:
    return EITHER if hand is None else hand_of(hand)
