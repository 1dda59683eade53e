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
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputTypeError, suggest
from cspace.navigation.grid.search import checked_ends
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.navigation.route import Route

__all__ = ["BrushfireDiagram", "brushfire_diagram", "plan", "reason", "trace"]

PREFER: Final = ("clearance", "length")
WORDS: Final = ("burn", "meet", "keep")


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
    if not isinstance(grid, _core.GridBase):
        raise InputTypeError(f"grid is a {type(grid).__name__}; give an OccupancyGrid (or world.to_grid())")
    core = _core_of(grid)
    return BrushfireDiagram(core.clearance(), core.labels(), core.cells().view(np.bool_), *core.branches())


def plan(world: Any, start: Any, goal: Any, *, prefer: str = "clearance") -> Route:
    """A path over the cells of a grid that maximises the clearance.

    start, goal: (2,) [m] in free cells. prefer: on the diagram, "clearance" maximises the least clearance
    over all paths by sides of cells, and is the shortest of those on the diagram; "length" is the shortest
    path on the diagram.

    From start and goal the path ascends the clearance to the diagram. A diagonal step is allowed where both
    adjacent cells are free. route.evidence["least_clearance"] [m] is that of the centres of the cells on
    the path. UnknownNameError for another preference.
    """
    if prefer not in PREFER:
        raise suggest("choice of prefer=", prefer, PREFER)
    ends = checked_ends(world, start, goal)
    options = {"prefer": prefer}
    route: Route = _core_of(world).route(world, "brushfire", options, *ends, prefer == PREFER[0])
    return route


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    if not route:
        return "no way leads to the goal: start and goal lie in different parts of the diagram"
    least: float = route.evidence["least_clearance"]
    wide = "; no way over cells keeps farther" if route.options["prefer"] == PREFER[0] else ""
    return f"the centres of its cells keep {least:.6g} m from walls{wide}"


def trace(route: Route) -> Trace:
    """The fires: "burn" reaches a cell from the nearest point of a wall, "meet" is a cell where fires meet,
    "keep" a cell that connects the diagram. start, end: (k, 2) [m]; value [m]: the clearance."""
    return Trace(WORDS, *_core_of(route.world).trace())


def _core_of(grid: Any) -> _core.BrushfireCore:
    """The fields that the core has computed for a grid, cached with it."""
    kept = vars(grid)
    if "_brushfire" not in kept:
        kept["_brushfire"] = _core.BrushfireCore(grid)
    core: _core.BrushfireCore = kept["_brushfire"]
    return core
