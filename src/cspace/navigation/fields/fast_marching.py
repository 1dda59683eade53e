"""Fast marching: solves the eikonal equation |∇T| · speed = 1 from the goal; the path descends T.

Sethian 1996, "A fast marching level set method for monotonically advancing fronts". T is the arrival time
of a front that starts at the goal. It is computed by first-order upwind differences in the order of
arrival, so its only minimum is the goal. The error decreases with the side of the cells times the logarithm
of their number. Paths over a grid keep the error of their eight directions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.navigation.cache import clearance_field
from cspace.navigation.checks import need_grid
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.search import option
from cspace.tables import count_things


@dataclass(frozen=True, eq=False)
class FastMarching(PlanePlanner):
    """The descent along the arrival times of a front from the goal, at any angle.

    The front moves from cell to cell across sides. The path is in free cells and passes corners no closer
    than the centre of an adjacent cell. route.evidence["time"] [m] is T of the start's cell. The trace
    contains the event "arrive" for the cells in the order of the front's arrival; its value is the time [m].
    """

    name = "fast_marching"
    summary = "descent of the arrival times of a front from the goal, at any angle"
    world = "grid"
    events = ("arrive",)

    slow_within: float = option(
        0.0,
        "nearer to walls than this the speed decreases in proportion to the clearance, so that the path "
        "keeps away from them (Garrido et al. 2006); elsewhere, and with 0, it is 1.",
        unit="m",
        minimum=0,
    )

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        settings = clearance_field(world), self.slow_within / world.resolution, lambda time: {"time": time}
        return _core._fast_marching(traced, world, world, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        if not route:
            cells = count_things(route.stats.nodes, "cell")
            return f"no path to the goal: its front reached only {cells}"
        return (
            f"descended the arrival times of a front that takes {route.evidence['time']:.6g} m to the start"
        )


def arrival_times(grid: Any, goal: ArrayLike, *, slow_within: float = 0.0) -> Array:
    """Arrival times of a front from the cell of goal (2,) [m] at the centres of cells: (rows, columns) [m,
    over a speed of 1]; infinite where it does not arrive. slow_within: as for the planner. InputTypeError
    for worlds other than grids."""
    need_grid(grid)
    near = FastMarching(slow_within).slow_within / grid.resolution
    return np.asarray(clearance_field(grid).march_times(grid, grid.check_free(goal, "goal"), near))
