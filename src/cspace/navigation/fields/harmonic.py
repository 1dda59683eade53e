"""Harmonic potential: solves Laplace's equation over free cells, with 0 at the goal and 1 on walls.

Connolly, Burns & Weiss 1990, "Path planning using Laplace's equation". Every other cell is the mean of its
four neighbours, so the goal is the only local minimum, and a descent leads to it from everywhere. 1 − the
potential is the probability that a random walk reaches the goal before a wall. Along a corridor of w cells
it decreases by exp(−π / w) per cell, and the potential soon rounds to 1. The solver therefore computes and
stores the logarithm of the probability, to a relative error that does not depend on its size.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputTypeError
from cspace.navigation.fields.potential_a_star import clearance_field
from cspace.navigation.grid.search import checked_ends
from cspace.navigation.route import Stats, new_route
from cspace.navigation.text import counted
from cspace.search.trace import Trace
from cspace.tolerances import HARMONIC_CYCLES, HARMONIC_RESIDUAL

if TYPE_CHECKING:
    from cspace.navigation.route import Route

__all__ = ["HarmonicEvidence", "harmonic", "plan", "reason", "trace"]

WORDS: Final = ("descend",)
MOST_KEPT: Final = 2
"""The number of fields cached with a grid; each takes about fifty bytes per cell."""


class HarmonicEvidence(NamedTuple):
    """The accuracy of the solution of Laplace's equation."""

    residual: float
    """The largest relative difference between a cell's probability and the mean of its four neighbours."""
    cycles: int
    """Iterations of the solver."""
    rests: int
    """Cells other than the goal without a descending step; if there are none, descents arrive from
    everywhere."""


UNSOLVED: Final = HarmonicEvidence(0.0, 0, 0)
"""Whether walls are known to separate start from goal."""


def plan(world: Any, start: Any, goal: Any) -> Route:
    """Descent along the harmonic potential from start to goal, from cell to cell, past no blocked corner.

    start, goal: (2,) [m] in free cells. The first query for a goal solves the whole field, further queries
    only descend it; where walls separate start from goal, no solution is needed. An interrupt stops the
    solver. route.evidence is a HarmonicEvidence. "undetermined" where the equation was not solved
    accurately enough for the descent to arrive.
    """
    ends = checked_ends(world, start, goal)
    began = time.perf_counter()
    if _core._walls_divide(world, *ends):
        stats = Stats(0, 0, time.perf_counter() - began)
        return new_route(
            world, "harmonic", {}, ends, "unreachable", np.empty((0, 2)), np.inf, stats, UNSOLVED
        )
    field = _field(world, ends[1])
    seconds = time.perf_counter() - began
    evidence = HarmonicEvidence(field.residual, field.cycles, field.rests)
    made: Route = field.route(world, world, "harmonic", {}, *ends, seconds, evidence)
    return made


def harmonic(grid: Any, goal: ArrayLike) -> Array:
    """−log of the probability that a random walk from a cell reaches goal (2,) [m] before a wall: (rows,
    columns).

    0 at the goal, infinite on blocked cells and where no path leads to the goal. The harmonic potential is
    1 − exp(−field), which rounds to 1 where the field is above 37; it increases with the field.
    InputTypeError for worlds other than grids.
    """
    if not isinstance(grid, _core.GridBase):
        raise InputTypeError(f"grid is a {type(grid).__name__}; give an OccupancyGrid (or world.to_grid())")
    _, end = checked_ends(grid, goal, goal)
    found: Array = _field(grid, end).heights(grid)
    return found


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    evidence: HarmonicEvidence = route.evidence
    if evidence == UNSOLVED:
        return "no way leads to the goal: walls divide it from the start, as is known without the potential"
    if route.status == "unreachable":
        cells = counted(route.stats.nodes, "cell")
        return f"no way leads to the goal: the start is not among the {cells} connected with it"
    solved = f"solved to a share of {evidence.residual:.2g} in {counted(evidence.cycles, 'cycle')}"
    if not route:
        return f"the potential rests on {counted(evidence.rests, 'cell')} beside the goal; it was {solved}"
    return f"went down a harmonic potential without rest but the goal, {solved}, for {route.length:.6g} m"


def trace(route: Route) -> Trace:
    """The steps "descend": start, end (k, 2) [m] are centres of cells; value: −log of the probability at
    the end."""
    world = route.world
    if route.evidence == UNSOLVED:
        return Trace(WORDS, np.empty(0, np.int8), np.empty((0, 2)), np.empty((0, 2)), np.empty(0))
    return Trace(WORDS, *_field(world, route.goal).trace(world, route.start))


def _field(grid: Any, goal: Array) -> _core.HarmonicField:
    """The field of a goal, cached with the grid."""
    kept: dict[tuple[float, ...], _core.HarmonicField] = vars(grid).setdefault("_harmonic", {})
    key = tuple(map(float, goal))
    if key not in kept:
        while len(kept) >= MOST_KEPT:
            kept.pop(next(iter(kept)))
        kept[key] = _core.HarmonicField(grid, clearance_field(grid), goal, HARMONIC_RESIDUAL, HARMONIC_CYCLES)
    return kept[key]
