"""A path through exact cells: trapezoids between the corners of obstacles.

A vertical line through every corner, up and down to the next wall, cuts free space into trapezoids, at most
three for each corner and one more; a sweep from left to right finds them in n log n steps (de Berg et al.
2008, chapter 6; Latombe 1991, section 5.1). Cells that share a piece of side are neighbours. The route goes
from cell to cell through the middles of the doors between them, a shortest such way, and is then pulled
taut inside those cells by a funnel (Lee & Preparata 1984): the shortest path in this row of cells, not of
all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.navigation.text import counted
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["exact_cells", "plan", "reason", "trace"]

_WORDS = ("enter",)


def plan(world: PolygonWorld, start: ArrayLike, goal: ArrayLike) -> Route:
    """A path from start to goal (2,) [m] through the trapezoids of a PolygonWorld.

    The trace holds the event "enter": the point of the door through which a cell is entered; its value is
    the length [m] of the way there.
    """
    route: Route | None = _core._exact_cells(world, world._core, "exact_cells", None, start, goal)
    if route is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        route = _core._exact_cells(world, world._core, "exact_cells", None, *ends)
        assert route is not None
    return route


def reason(route: Route) -> str:
    """The verdict in a sentence."""
    cells = counted(len(exact_cells(route.world)[0]), "cell")
    if route:
        return f"a chain of cells leads from start to goal; the shortest path inside it, of {cells} in all"
    return f"no chain of the {cells} leads from start to goal, and they fill free space"


def trace(route: Route) -> Trace:
    """The cells in the order in which they were entered."""
    return Trace(_WORDS, *_core._exact_cells_trace(route.world._core, route.start, route.goal))


def exact_cells(world: PolygonWorld) -> tuple[Array, npt.NDArray[np.int32]]:
    """The trapezoids (k, 4, 2) [m], counterclockwise from the lower left, and the pairs (d, 2) with a door.

    Between corners of one x lie cells without width: they are links between those beside them.
    """
    corners, doors = _core._exact_cells_all(world._core)
    return corners.reshape(-1, 4, 2), doors
