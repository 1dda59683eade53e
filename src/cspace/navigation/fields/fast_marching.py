"""Fast marching: solves the eikonal equation |∇T| · speed = 1 from the goal; the path descends T.

Sethian 1996, "A fast marching level set method for monotonically advancing fronts". T is the arrival time
of a front that starts at the goal. It is computed by first-order upwind differences in the order of
arrival, so its only minimum is the goal. The error decreases with the side of the cells times the logarithm
of their number. Paths over a grid keep the error of their eight directions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputTypeError
from cspace.navigation.fields.potential_a_star import clearance_field, number_of
from cspace.navigation.grid.search import checked_ends
from cspace.navigation.text import counted
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.navigation.route import Route

__all__ = ["arrival_times", "plan", "reason", "trace"]

WORDS: Final = ("arrive",)


def plan(world: Any, start: Any, goal: Any, *, slow_within: float = 0.0) -> Route:
    """The descent along the arrival times of a front from the goal, at any angle.

    start, goal: (2,) [m] in free cells. slow_within [m]: nearer to walls than this the speed decreases in
    proportion to the clearance, so that the path keeps away from them (Garrido et al. 2006); elsewhere, and
    with 0, it is 1.

    The front moves from cell to cell across sides. The path is in free cells and passes corners no closer
    than the centre of an adjacent cell. route.evidence["time"] [m] is T of the start's cell.
    """
    near = number_of("slow_within", slow_within, 0.0)
    ends = checked_ends(world, start, goal)
    options = {"slow_within": slow_within}
    made: Route = clearance_field(world).march_route(
        world, world, "fast_marching", options, *ends, near / world.resolution
    )
    return made


def arrival_times(grid: Any, goal: ArrayLike, *, slow_within: float = 0.0) -> Array:
    """Arrival times of a front from the cell of goal (2,) [m] at the centres of cells: (rows, columns) [m,
    over a speed of 1]; infinite where it does not arrive. slow_within: as for the planner. InputTypeError
    for worlds other than grids."""
    if not isinstance(grid, _core.GridBase):
        raise InputTypeError(f"grid is a {type(grid).__name__}; give an OccupancyGrid (or world.to_grid())")
    near = number_of("slow_within", slow_within, 0.0)
    _, end = checked_ends(grid, goal, goal)
    found: Array = clearance_field(grid).march_times(grid, end, near / grid.resolution)
    return found


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    if not route:
        cells = counted(route.stats.nodes, "cell")
        return f"no way leads to the goal: its front has come to {cells} and no farther"
    return f"went down the times of a front that takes {route.evidence['time']:.6g} m to the start"


def trace(route: Route) -> Trace:
    """The cells in the order of the front's arrival: start and end (k, 2) [m] are their centre; value [m]
    is the time."""
    world = route.world
    near = route.options["slow_within"] / world.resolution
    return Trace(WORDS, *clearance_field(world).march_trace(world, route.start, route.goal, near))
