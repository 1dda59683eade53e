"""The shortest path in the plane: Polyanya on the convex polygons of free space.

Cui, Harabor & Grastien 2017, "Compromise-free pathfinding on a navigation mesh". A path turns at corners of
obstacles alone; the search runs over intervals of polygons' sides that such a corner sees, the most
promising first, so the first path that arrives is a shortest one. Every decision is an exact orientation of
given points. In grids of many corners the polygons are the runs of free cells in the rows, read from the
cells where the search comes to them: nothing is prepared.
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

    The trace holds the event "see": from one end of an interval to the other; its value is the length [m]
    that a path through it has at least.
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
    """Whether runs of cells serve this grid better than polygons: where it has many corners."""
    cells = grid.rows * grid.columns
    return cells <= RUN_CELLS and grid.corners > max(MESHED_CORNERS, cells / CELLS_PER_CORNER)


def reason(route: Route) -> str:
    """The verdict in a sentence."""
    if route:
        corners = max(len(route.path) - 2, 0)
        return f"the shortest path; it turns at {counted(corners, 'corner')} of obstacles"
    if route.world.kind == "grid":
        return "walls divide start from goal: no path connects the parts of free space in which they lie"
    return divided(route.world.components)


def trace(route: Route) -> Trace:
    """The intervals in the order in which they were looked through."""
    world, ends = route.world, (route.start, route.goal)
    if world.kind == "grid":
        return Trace(_WORDS, *_core._grid_any_angle_trace(world, *ends))
    return Trace(_WORDS, *_core._any_angle_trace(world._core, *ends))
