"""Exact cell decomposition: trapezoids between vertical lines through the corners of obstacles.

A vertical line through every corner, up and down to the next wall, cuts free space into trapezoids, at most
three for each corner and one more. A sweep from left to right finds them in n log n steps (de Berg et al.
2008, chapter 6; Latombe 1991, section 5.1). Cells that share part of a side are neighbours. The route goes
from cell to cell through the middles of the doors between them, along a shortest such path. The funnel
algorithm (Lee & Preparata 1984) then shortens it inside those cells. The result is the shortest path in
this sequence of cells, not in all of free space.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.maps import PolygonWorld
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.tables import count_things


class ExactCells(PlanePlanner):
    """A path through the trapezoids of a PolygonWorld.

    The trace contains the event "enter": the point of the door through which a cell is entered; its value
    is the path length [m] to it.
    """

    name = "exact_cells"
    summary = "path through trapezoidal cells, shortened by the funnel algorithm"
    events = ("enter",)

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        return _core._polygon_route(traced, world, world._core, self, start, goal, 2)

    def explain_route(self, route: Route) -> str:
        cells = count_things(len(exact_cells(route.world)[0]), "cell")
        if route:
            return (
                f"a chain of cells leads from start to goal; the shortest path inside it, of {cells} in all"
            )
        return f"no chain of the {cells} leads from start to goal, and they fill free space"


def exact_cells(world: PolygonWorld) -> tuple[Array, npt.NDArray[np.int32]]:
    """The trapezoids (k, 4, 2) [m], counterclockwise from the lower left, and the pairs (d, 2) with a door.

    Corners with equal x have cells of zero width between them, which connect the cells on both sides.
    """
    corners, doors = _core._exact_cells_all(world._core)
    return corners.reshape(-1, 4, 2), doors
