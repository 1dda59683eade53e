"""Brushfire: fires lit at the walls of a grid burn into free space, and where fires from different walls meet
they leave its Voronoi diagram, along which clearance is greatest.

Blum 1967, "A transformation for extracting new descriptors of shape"; Choset et al. 2005, "Principles of
Robot Motion", section 5.3. The distances are Euclidean and exact: from the centre of a cell to the nearest
point of a blocked one, or of the border of the grid. Fires meet in a cell if they stem from different rings
of walls, or from places of one ring that are, along the wall, more than twice as far apart as straight on;
around a single corner, and along stairs, it is less than that. What joins the cells where they meet is found
by thinning free space from the walls inwards, at every level of clearance, so that a way along the diagram is
as wide as any way over the cells.
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
    """The Voronoi diagram of a grid (rows, columns), and what it was made from.

    clearance (rows, columns) [m]: from the centre of a cell to the nearest wall, 0 where blocked. labels
    (rows, columns): the straight piece of wall, between corners, that is nearest, −1 where blocked. cells
    (rows, columns): the diagram. Its branches join cells with other than two neighbours in it: ends (k, 4)
    are row and column of the two, lengths (k,) [m] by steps along sides, widths (k,) [m] the least clearance.
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
    """A way over the cells of a grid that keeps away from walls.

    start, goal: (2,) [m] in free cells. prefer: on the diagram, "clearance" makes the least clearance as
    great as on any way by sides of cells, and the way the shortest of those on the diagram; "length"
    takes the shortest on the diagram.

    From start and goal the way goes up the clearance to the diagram. A diagonal step is taken where both
    cells beside it are free. route.evidence["least_clearance"] [m] is that of the centres of the cells on
    the way. UnknownNameError for another preference.
    """
    if prefer not in PREFER:
        raise suggest("choice of prefer=", prefer, PREFER)
    ends = checked_ends(world, start, goal)
    options = {"prefer": prefer}
    route: Route = _core_of(world).route(world, "brushfire", options, *ends, prefer == PREFER[0])
    return route


def reason(route: Route) -> str:
    """The verdict in a sentence."""
    if not route:
        return "no way leads to the goal: start and goal lie in different parts of the diagram"
    least: float = route.evidence["least_clearance"]
    wide = "; no way over cells keeps farther" if route.options["prefer"] == PREFER[0] else ""
    return f"the centres of its cells keep {least:.6g} m from walls{wide}"


def trace(route: Route) -> Trace:
    """The fires: "burn" reaches a cell from the nearest point of a wall, "meet" is a cell where fires meet,
    "keep" one that joins them in the diagram. start, end: (k, 2) [m]; value [m]: the clearance."""
    return Trace(WORDS, *_core_of(route.world).trace())


def _core_of(grid: Any) -> _core.BrushfireCore:
    """What the core has made of a grid, kept beside it."""
    kept = vars(grid)
    if "_brushfire" not in kept:
        kept["_brushfire"] = _core.BrushfireCore(grid)
    core: _core.BrushfireCore = kept["_brushfire"]
    return core
