"""The shortest path in the plane: Polyanya on the convex polygons of free space.

Cui, Harabor & Grastien 2017, "Compromise-free pathfinding on a navigation mesh". A path turns at corners of
obstacles alone; the search runs over intervals of polygons' sides that such a corner sees, the most
promising first, so the first path that arrives is a shortest one. Every decision is an exact orientation of
given points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from cspace import _core
from cspace.navigation.trace import Trace

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["plan", "reason", "trace"]

_WORDS = ("see",)


def plan(world: PolygonWorld, start: ArrayLike, goal: ArrayLike) -> Route:
    """The shortest path from start to goal (2,) [m] through a PolygonWorld.

    The trace holds the event "see": from one end of an interval to the other; its value is the length [m]
    that a path through it has at least.
    """
    route: Route | None = _core._any_angle(world, world._core, "any_angle", None, start, goal)
    if route is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        route = _core._any_angle(world, world._core, "any_angle", None, *ends)
        assert route is not None
    return route


def reason(route: Route) -> str:
    """The verdict in a sentence."""
    if route:
        corners = len(route.path) - 2
        return f"the shortest path; it turns at {corners} corner{'s' if corners != 1 else ''} of obstacles"
    return f"walls divide start from goal: no path connects the {route.world.components} parts of free space"


def trace(route: Route) -> Trace:
    """The intervals in the order in which they were looked through."""
    return Trace(_WORDS, *_core._any_angle_trace(route.world._core, route.start, route.goal))
