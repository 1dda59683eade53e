"""Polyanya: the shortest path in the plane, by a search over intervals of the sides of convex polygons.

Cui, Harabor & Grastien 2017, "Compromise-free pathfinding on a navigation mesh". A shortest path turns only
at corners of obstacles. A search node is an interval of a polygon's side that is visible from such a
corner. The search expands the interval with the smallest lower bound, so the first path to the goal is a
shortest one. Every decision is an exact orientation test of given points. In grids with many corners the
polygons are the runs of free cells in the rows, read from the cells during the search, without
preprocessing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from cspace import _core
from cspace.maps import OccupancyGrid
from cspace.navigation.text import counted, divided
from cspace.search.trace import Trace
from cspace.tolerances import CELLS_PER_CORNER, MESHED_CORNERS, RUN_CELLS

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["plan", "reason", "takes_cells", "trace"]

_WORDS = ("see",)


def plan(world: PolygonWorld | OccupancyGrid, start: ArrayLike, goal: ArrayLike) -> Route:
    """The shortest path from start to goal (2,) [m] through a PolygonWorld, or over an OccupancyGrid.

    The trace contains the event "see": a segment from one end of an interval to the other; its value is a
    lower bound of the length [m] of a path through the interval.
    """
    if isinstance(world, OccupancyGrid):
        return _over_cells(world, start, goal)
    route: Route | None = _core._any_angle(world, world._core, "any_angle", None, start, goal)
    if route is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        route = _core._any_angle(world, world._core, "any_angle", None, *ends)
        assert route is not None
    return route


def _over_cells(grid: OccupancyGrid, start: ArrayLike, goal: ArrayLike) -> Route:
    route: Route | None = _core._grid_any_angle(grid, "any_angle", None, start, goal)
    if route is None:
        ends = grid.check_free(start, "start"), grid.check_free(goal, "goal")
        route = _core._grid_any_angle(grid, "any_angle", None, *ends)
        assert route is not None
    return route


def takes_cells(grid: OccupancyGrid) -> bool:
    """Whether runs of cells are faster than polygons for this grid: it has many corners."""
    cells = grid.rows * grid.columns
    return cells <= RUN_CELLS and grid.corners > max(MESHED_CORNERS, cells / CELLS_PER_CORNER)


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    if route:
        corners = max(len(route.path) - 2, 0)
        return f"the shortest path; it turns at {counted(corners, 'corner')} of obstacles"
    if route.world.kind == "grid":
        return "walls divide start from goal: no path connects the parts of free space in which they lie"
    return divided(route.world.components)


def trace(route: Route) -> Trace:
    """The intervals in the order in which they were expanded."""
    world, ends = route.world, (route.start, route.goal)
    if world.kind == "grid":
        return Trace(_WORDS, *_core._grid_any_angle_trace(world, *ends))
    return Trace(_WORDS, *_core._any_angle_trace(world._core, *ends))
