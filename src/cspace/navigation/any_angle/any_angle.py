"""Polyanya: the shortest path in the plane, by a search over intervals of the sides of convex polygons.

Cui, Harabor & Grastien 2017, "Compromise-free pathfinding on a navigation mesh". A shortest path turns only
at corners of obstacles. A search node is an interval of a polygon's side that is visible from such a
corner. The search expands the interval with the smallest lower bound, so the first path to the goal is a
shortest one. Every decision is an exact orientation test of given points. In grids with many corners the
polygons are the runs of free cells in the rows, read from the cells during the search, without
preprocessing.
"""

from __future__ import annotations

from typing import Any

from cspace import _core
from cspace.maps import OccupancyGrid
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.navigation.text import explain_division
from cspace.tables import count_things
from cspace.tolerances import CELLS_PER_CORNER, MESHED_CORNERS, RUN_CELLS


class AnyAngle(PlanePlanner):
    """The shortest path through a PolygonWorld, or over an OccupancyGrid.

    The trace contains the event "see": a segment from one end of an interval to the other; its value is a
    lower bound of the length [m] of a path through the interval.
    """

    name = "any_angle"
    summary = "shortest path through convex polygons (Polyanya)"
    takes_cells = True
    events = ("see",)

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        if world.kind == "grid":
            return _core._grid_any_angle(traced, world, world, self, start, goal)
        return _core._polygon_route(traced, world, world._core, self, start, goal, 0)

    def takes_grid(self, grid: OccupancyGrid) -> bool:
        """Whether runs of cells are faster than polygons for this grid: it has many corners."""
        cells = grid.rows * grid.columns
        return cells <= RUN_CELLS and grid.corners > max(MESHED_CORNERS, cells / CELLS_PER_CORNER)

    def explain_route(self, route: Route) -> str:
        if route:
            corners = max(len(route.path) - 2, 0)
            return f"the shortest path; it turns at {count_things(corners, 'corner')} of obstacles"
        if route.world.kind == "grid":
            return (
                "walls separate start from goal: no path connects the parts of free space in which they lie"
            )
        return explain_division(route.world)
