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
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.maps import PolygonWorld
from cspace.maps.outlines import longer_side
from cspace.navigation.checks import need_polygons
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.search import option
from cspace.tables import count_things, show_fields
from cspace.tolerances import FINEST_LEVEL, QUADTREE_CELLS, QUADTREE_DEPTH, UNIFORM_DEPTH

METRICS: Final = ("euclidean", "manhattan")


@show_fields
class ApproximateCells(NamedTuple):
    """The squares of the decomposition of a world; they fill the square around its bounds."""

    squares: Array
    """(k, 4): xmin, ymin, xmax, ymax [m]."""
    kinds: npt.NDArray[np.int8]
    """(k,): 0 free, 1 mixed, 2 full."""


@show_fields
class CellEvidence(NamedTuple):
    """The squares that support a verdict."""

    free: int
    mixed: int
    full: int
    depth: int
    """The level of the smallest square."""
    side: float
    """Side of the smallest square [m]."""


@dataclass(frozen=True, eq=False)
class ApproximateCellsSearch(PlanePlanner):
    """A path through the free squares of a PolygonWorld.

    The status is "undetermined" where the remaining mixed squares may contain a path: narrow gaps, or a
    start or goal without a visible free square nearby. route.evidence is a CellEvidence.

    The trace contains the decomposition and its search: "split" and "free" squares, with their lower left
    corner as start, their upper right corner as end and their level as value; "expand" for a door, with the
    previous door as start and the path length so far [m] in the metric as value.
    """

    name = "approximate_cells"
    summary = "path through free squares of a quadtree"
    events = ("split", "free", "expand")

    depth: int = option(
        6,
        "the level to which mixed squares are split at once; at level k a square's side is the longer side "
        "of the bounds over 2ᵏ.",
        minimum=0,
        maximum=FINEST_LEVEL,
    )
    min_size: float = option(0.0, "the lower bound of a square's side; 0 sets no bound.", unit="m", minimum=0)
    refine: bool = option(
        True,
        "whether squares that may still contain a path are split further, where depth does not decide the "
        "query.",
    )
    max_depth: int | None = option(
        None,
        "the level at which refinement ends; by default 12, or 9 for squares of one size.",
        minimum=0,
        maximum=FINEST_LEVEL,
    )
    uniform: bool = option(False, "whether free squares are split as well, so that all have one size.")
    metric: str | None = option(
        None,
        "the metric in which the path through the middles of doors is shortest, "
        '"euclidean" or "manhattan"; by default the latter for squares of one size.',
        choices=METRICS,
    )

    def _fill_in(self, world: Any) -> ApproximateCellsSearch:
        usual = UNIFORM_DEPTH if self.uniform else QUADTREE_DEPTH
        last = max(self.depth, usual if self.max_depth is None else self.max_depth)
        if self.min_size > 0:
            last = min(last, max(0, math.frexp(longer_side(world.bounds) / self.min_size)[1] - 1))
        return self._in_force(max_depth=last, metric=self.metric or METRICS[self.uniform])

    def _settings(self) -> tuple[Any, ...]:
        """depth, the deepest level, refine, uniform, manhattan, the largest number of cells."""
        manhattan = self.metric == "manhattan"
        return self.depth, self.max_depth, self.refine, self.uniform, manhattan, QUADTREE_CELLS

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        def count_squares(free: int, mixed: int, full: int, deepest: int) -> CellEvidence:
            return CellEvidence(free, mixed, full, deepest, longer_side(world.bounds) / 2**deepest)

        settings = *self._settings(), count_squares
        return _core._approximate_cells(traced, world, world._core, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        found: CellEvidence = route.evidence
        mixed = count_things(found.mixed, "mixed square")
        squares = f"{found.free} free and {mixed}, the smallest {found.side:.6g} m wide"
        if route:
            return f"a chain of free squares leads from start to goal, among {squares}"
        if route.status == "unreachable":
            return f"not even the mixed squares connect start with goal, among {squares}"
        return f"only mixed squares would connect start with goal, among {squares}"


def approximate_cells(world: PolygonWorld, depth: int = 6, *, uniform: bool = False) -> ApproximateCells:
    """The decomposition of a PolygonWorld into squares.

    depth, uniform: as for the planner "approximate_cells", for a tree without refinement. InputError for a
    depth out of range.
    """
    need_polygons(world)
    planner = ApproximateCellsSearch(depth, refine=False, uniform=uniform)._fill_in(world)
    return ApproximateCells(*_core._approximate_cells_all(world._core, planner._settings()))
