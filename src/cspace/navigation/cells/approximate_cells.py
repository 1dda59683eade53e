"""Approximate cell decomposition: a quadtree whose mixed squares are subdivided, and a path through its
free squares.

The root square contains the bounds. A square without a wall inside is free or full. A square that contains
a wall is mixed, and is split into four, down to a level (Brooks & Lozano-Pérez 1983, "A subdivision
algorithm in configuration space for findpath with rotation"; Latombe 1991, section 5.3). The route goes
through free squares only, from the middle of one door to the next, along a shortest such path. If not even
the mixed squares connect start with goal, no path exists. If only they do, the answer is open, and they are
split further.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, suggest
from cspace.navigation.text import counted
from cspace.navigation.worlds import need_polygons
from cspace.search.trace import Trace
from cspace.tolerances import QUADTREE_CELLS, QUADTREE_DEPTH, UNIFORM_DEPTH

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["ApproximateCells", "CellEvidence", "approximate_cells", "plan", "reason", "trace"]

METRICS: Final = ("euclidean", "manhattan")
WORDS: Final = ("split", "free", "expand")
KINDS: Final = ("free", "mixed", "full")
FINEST: Final = 20
"""The deepest level that the core numbers."""


class ApproximateCells(NamedTuple):
    """The squares of the decomposition of a world; they fill the square around its bounds."""

    squares: Array
    """(k, 4): xmin, ymin, xmax, ymax [m]."""
    kinds: npt.NDArray[np.int8]
    """(k,): 0 free, 1 mixed, 2 full."""


class CellEvidence(NamedTuple):
    """The squares that support a verdict."""

    free: int
    mixed: int
    full: int
    depth: int
    """The level of the smallest square."""
    side: float
    """Side of the smallest square [m]."""


def plan(
    world: PolygonWorld,
    start: Any,
    goal: Any,
    *,
    depth: int = 6,
    min_size: float = 0.0,
    refine: bool = True,
    max_depth: int | None = None,
    uniform: bool = False,
    metric: str | None = None,
) -> Route:
    """A path from start to goal (2,) [m] through the free squares of a PolygonWorld.

    depth: the level to which mixed squares are split at once; at level k a square's side is the longer side
    of the bounds over 2ᵏ. min_size [m]: the lower bound of a square's side; 0 sets no bound. refine:
    whether squares that may still contain a path are split further, where depth does not decide the query.
    max_depth: the level at which refinement ends; by default 12, or 9 for squares of one size. uniform:
    whether free squares are split as well, so that all have one size. metric: the metric in which the path
    through the middles of doors is shortest, "euclidean" or "manhattan"; by default the latter for squares
    of one size.

    The status is "undetermined" where the remaining mixed squares may contain a path: narrow gaps, or a
    start or goal without a visible free square nearby. route.evidence is a CellEvidence. UnknownNameError
    for another metric, InputError for a level that is not an integer from 0 to 20, and for a negative size.
    """
    options: dict[str, Any] = {
        "depth": depth,
        "min_size": min_size,
        "refine": refine,
        "max_depth": max_depth,
        "uniform": uniform,
        "metric": metric,
    }
    settings = _settings(world, **options)
    options |= {"max_depth": int(settings[1]), "metric": METRICS[settings[4]]}
    ends = world.check_free(start, "start"), world.check_free(goal, "goal")

    def evidence(free: int, mixed: int, full: int, deepest: int) -> CellEvidence:
        return CellEvidence(free, mixed, full, deepest, _side(world) / 2**deepest)

    given = world._core, world, "approximate_cells", options
    made: Route = _core._approximate_cells(*given, *ends, settings, evidence)
    return made


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    found: CellEvidence = route.evidence
    squares = (
        f"{found.free} free and {counted(found.mixed, 'mixed square')}, the smallest {found.side:.6g} m wide"
    )
    if route:
        return f"a chain of free squares leads from start to goal, among {squares}"
    if route.status == "unreachable":
        return f"not even the mixed squares connect start with goal, among {squares}"
    return f"only mixed squares would connect start with goal, among {squares}"


def trace(route: Route) -> Trace:
    """The decomposition and its search: "split" and "free" squares, with their lower left corner as start,
    their upper right corner as end and their level as value; "expand" for a door, with the previous door as
    start and the path length so far [m] in the metric as value."""
    settings = _settings(route.world, **route.options)
    return Trace(WORDS, *_core._approximate_cells_trace(route.world._core, route.start, route.goal, settings))


def approximate_cells(world: PolygonWorld, depth: int = 6, *, uniform: bool = False) -> ApproximateCells:
    """The decomposition of a PolygonWorld into squares.

    depth, uniform: as in `plan`, for a tree without refinement. InputError for a depth that is not an
    integer from 0 to 20.
    """
    need_polygons(world)
    settings = _settings(world, depth, 0.0, False, None, uniform, None)
    return ApproximateCells(*_core._approximate_cells_all(world._core, settings))


def _side(world: PolygonWorld) -> float:
    """Side of the square around the bounds [m]."""
    xmin, ymin, xmax, ymax = world.bounds
    return max(xmax - xmin, ymax - ymin)


def _settings(
    world: PolygonWorld,
    depth: int,
    min_size: float,
    refine: bool,
    max_depth: int | None,
    uniform: bool,
    metric: str | None,
) -> npt.NDArray[np.int64]:
    """depth, the deepest level, refine, uniform, manhattan, the largest number of cells: (6,)."""
    metric = metric if metric is not None else METRICS[bool(uniform)]
    if metric not in METRICS:
        raise suggest("metric", metric, METRICS)
    first = _level("depth", depth)
    usual = UNIFORM_DEPTH if uniform else QUADTREE_DEPTH
    last = max(first, usual if max_depth is None else _level("max_depth", max_depth))
    smallest = float(as_floats(min_size, "min_size"))
    if smallest < 0:
        raise InputError(f"min_size is {smallest:g}; it must be zero or more [m]")
    if smallest > 0:
        last = min(last, max(0, math.frexp(_side(world) / smallest)[1] - 1))
    manhattan = metric == "manhattan"
    return np.array([first, last, refine, uniform, manhattan, QUADTREE_CELLS], dtype=np.int64)


def _level(name: str, value: Any) -> int:
    number = float(as_floats(value, name).reshape(())) if np.size(value) == 1 else math.nan
    if not (0 <= number <= FINEST and number == int(number)):
        raise InputError(f"{name} is {value!r}; it must be a whole number from 0 to {FINEST}")
    return int(number)
