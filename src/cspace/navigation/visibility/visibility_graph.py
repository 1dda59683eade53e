"""The shortest path over the visibility graph: corners of obstacles that see each other.

Lozano-Pérez & Wesley 1979, "An algorithm for planning collision-free paths among polyhedral obstacles".
Only corners that free space bends around can be turned at, and only edges that touch the obstacles at both
ends without entering them (bitangents) can be part of a shortest path. What a corner sees is found by
walking through the triangles of free space (Bungiu et al. 2014); the graph is kept with the world, and a
search by A* with the straight line to the goal as estimate joins start and goal to what they see.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.navigation.text import counted, divided
from cspace.navigation.worlds import need_polygons
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["VisibilityGraph", "plan", "reason", "trace", "visibility_graph"]

_WORDS = ("expand",)


class VisibilityGraph(NamedTuple):
    """The corners of a world that see each other."""

    corners: Array
    """(n, 2) [m]: those that free space bends around."""
    edges: npt.NDArray[np.int32]
    """(k, 2): pairs of corners that see each other and between which a taut string may run, the lower number
    first."""


def plan(world: PolygonWorld, start: ArrayLike, goal: ArrayLike) -> Route:
    """The shortest path from start to goal (2,) [m] through a PolygonWorld.

    The trace holds the event "expand": the last edge of the shortest path to a corner; its value is that
    way's length [m].
    """
    route: Route | None = _core._visibility(world, world._core, "visibility_graph", None, start, goal)
    if route is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        route = _core._visibility(world, world._core, "visibility_graph", None, *ends)
        assert route is not None
    return route


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    if route:
        nodes = len(visibility_graph(route.world).corners)
        return (
            f"the shortest path, over {max(len(route.path) - 2, 0)} of the graph's {counted(nodes, 'corner')}"
        )
    return divided(route.world.components)


def trace(route: Route) -> Trace:
    """The corners in the order in which they were expanded."""
    return Trace(_WORDS, *_core._visibility_trace(route.world._core, route.start, route.goal))


def visibility_graph(world: PolygonWorld) -> VisibilityGraph:
    """The visibility graph of a PolygonWorld, without any start or goal; InputTypeError for other worlds.

    Bitangents alone (Latombe 1991, section 4.1): no other edges can be part of a shortest path.
    """
    need_polygons(world)
    return VisibilityGraph(*_core._visibility_graph(world._core))
