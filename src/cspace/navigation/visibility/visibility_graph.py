"""The shortest path over the visibility graph: corners of obstacles that see each other.

Lozano-Pérez & Wesley 1979, "An algorithm for planning collision-free paths among polyhedral obstacles".
Only corners that free space bends around can be turned at, and only edges that touch the obstacles at both
ends without entering them (bitangents) can be part of a shortest path. What a corner sees is found by
walking through the triangles of free space (Bungiu et al. 2014); the graph is kept with the world, and a
search by A* with the straight line to the goal as estimate joins start and goal to what they see.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.maps import PolygonWorld
from cspace.navigation.checks import need_polygons
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.navigation.text import explain_division
from cspace.tables import count_things, show_fields


@show_fields
class VisibilityGraph(NamedTuple):
    """The corners of a world that see each other."""

    corners: Array
    """(n, 2) [m]: those that free space bends around."""
    edges: npt.NDArray[np.int32]
    """(k, 2): pairs of corners that see each other and between which a taut string may run, the lower number
    first."""


class VisibilityGraphSearch(PlanePlanner):
    """The shortest path through a PolygonWorld.

    The trace holds the event "expand": the last edge of the shortest path to a corner; its value is that
    path's length [m].
    """

    name = "visibility_graph"
    summary = "shortest path over mutually visible corners"
    events = ("expand",)

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        return _core._polygon_route(traced, world, world._core, self, start, goal, 1)

    def explain_route(self, route: Route) -> str:
        if not route:
            return explain_division(route.world)
        corners = count_things(len(visibility_graph(route.world).corners), "corner")
        return f"the shortest path, over {max(len(route.path) - 2, 0)} of the graph's {corners}"


def visibility_graph(world: PolygonWorld) -> VisibilityGraph:
    """The visibility graph of a PolygonWorld, without any start or goal; InputTypeError for other worlds.

    Bitangents alone (Latombe 1991, section 4.1): no other edges can be part of a shortest path.
    """
    need_polygons(world)
    return VisibilityGraph(*_core._visibility_graph(world._core))
