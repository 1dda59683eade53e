"""Brushfire: the distance transform of a grid, and its Voronoi diagram, along which clearance is greatest.

Fires start at the walls and spread into free space. Where fires from different walls meet they form the
Voronoi diagram. Blum 1967, "A transformation for extracting new descriptors of shape"; Choset et al. 2005,
"Principles of Robot Motion", section 5.3. The distances are Euclidean and exact: from the centre of a cell
to the nearest point of a blocked cell or of the border of the grid. Two fires meet in a cell in two cases.
They come from different boundary loops, or from points of one loop whose distance along the wall is more
than twice their straight distance. Around a single corner, and along stairs, the ratio is smaller. The
meeting cells are connected by thinning free space from the walls inwards, at every level of clearance. A
path along the diagram is therefore as wide as any path over the cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.navigation.cache import keep_with
from cspace.navigation.checks import need_grid
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.search import option
from cspace.tables import show_fields

PREFER: Final = ("clearance", "length")


@show_fields
@dataclass(frozen=True, eq=False)
class BrushfireDiagram:
    """The Voronoi diagram of a grid (rows, columns), and the fields behind it.

    clearance (rows, columns) [m]: from the centre of a cell to the nearest wall, 0 where blocked. labels
    (rows, columns): the nearest straight piece of wall, between corners, −1 where blocked. cells (rows,
    columns): the diagram. Its branches join cells that have a number of neighbours in it other than two:
    ends (k, 4) are row and column of the two, lengths (k,) [m] by steps along sides, widths (k,) [m] the
    least clearance.
    """

    clearance: Array
    labels: npt.NDArray[np.int32]
    cells: npt.NDArray[np.bool_]
    ends: npt.NDArray[np.int32]
    lengths: Array
    widths: Array


def brushfire_diagram(grid: Any) -> BrushfireDiagram:
    """The diagram of an OccupancyGrid (rows, columns): InputTypeError for other worlds."""
    need_grid(grid)
    core = _core_of(grid)
    return BrushfireDiagram(core.clearance(), core.labels(), core.cells().view(np.bool_), *core.branches())


@dataclass(frozen=True, eq=False)
class Brushfire(PlanePlanner):
    """A path over the cells of a grid that maximises the clearance.

    From start and goal the path ascends the clearance to the diagram. A diagonal step is allowed where both
    adjacent cells are free. route.evidence["least_clearance"] [m] is that of the centres of the cells on
    the path.

    The trace contains the fires: "burn" reaches a cell from the nearest point of a wall, "meet" is a cell
    where fires meet, "keep" a cell that connects the diagram; its value is the clearance [m].
    """

    name = "brushfire"
    summary = "widest path over cells, on the diagram of wave fronts from walls"
    world = "grid"
    events = ("burn", "meet", "keep")

    prefer: str = option(
        "clearance",
        'on the diagram, "clearance" maximises the least clearance over all paths by sides of cells, and is '
        'the shortest of those on the diagram; "length" is the shortest path on the diagram.',
        choices=PREFER,
        subject="choice of prefer=",
    )

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        settings = _core_of(world), self.prefer == "clearance", lambda least: {"least_clearance": least}
        return _core._brushfire(traced, world, world, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        if not route:
            return "no path to the goal: start and goal lie in different parts of the diagram"
        least: float = route.evidence["least_clearance"]
        wide = "; no path over cells keeps farther" if self.prefer == "clearance" else ""
        return f"the centres of its cells keep {least:.6g} m from walls{wide}"


def _core_of(grid: Any) -> Any:
    """The BrushfireCore of a grid, cached with it."""
    return keep_with(grid, "_brushfire", None, lambda: _core.BrushfireCore(grid))
