"""Harmonic potential: Laplace's equation over free cells, 0 at the goal and 1 on walls (Connolly, Burns &
Weiss 1990, "Path planning using Laplace's equation").

Every other cell is the mean of the four beside it, so none but the goal is lower than all around it, and a
way down leads to the goal from everywhere. 1 − the potential is the chance that a random walk comes to the
goal before it comes to a wall. Along a corridor that is w cells wide it falls by exp(−π / w) with every
cell, and the potential is soon 1 to the last digit of a double; so what is solved for, and kept, is the
logarithm of the chance, to a relative error that does not depend on how small it is.
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
"""Fields that are kept with a grid; each takes some fifty bytes per cell."""


class HarmonicEvidence(NamedTuple):
    """How well Laplace's equation was solved."""

    residual: float
    """By what share of itself a cell's chance differs from the mean of the four beside it, at most."""
    cycles: int
    """Of the solver."""
    rests: int
    """Cells but the goal from which no step leads down: with none, descents arrive from everywhere."""


UNSOLVED: Final = HarmonicEvidence(0.0, 0, 0)
"""Where walls are known to divide start from goal."""


def plan(world: Any, start: Any, goal: Any) -> Route:
    """Down the harmonic potential from start to goal, from cell to cell, past no blocked corner.

    start, goal: (2,) [m] in free cells. The first question for a goal solves for the whole field, further
    ones go down it; where walls divide start from goal, none is needed. An interrupt ends the solution.
    route.evidence is a HarmonicEvidence. "undetermined" where the equation was not solved well enough for
    the descent to arrive.
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
    """−log of the chance that a random walk from a cell comes to goal (2,) [m] before a wall: (rows,
    columns).

    0 at the goal, infinite on blocked cells and where no way leads to the goal. The harmonic potential is
    1 − exp(−field), which is 1 in doubles where the field is above 37; the field goes up with it.
    InputTypeError for other worlds than grids.
    """
    if not isinstance(grid, _core.GridBase):
        raise InputTypeError(f"grid is a {type(grid).__name__}; give an OccupancyGrid (or world.to_grid())")
    _, end = checked_ends(grid, goal, goal)
    found: Array = _field(grid, end).heights(grid)
    return found


def reason(route: Route) -> str:
    """The verdict in a sentence."""
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
    """The steps "descend": start, end (k, 2) [m] are centres of cells; value: −log of the chance at the
    end."""
    world = route.world
    if route.evidence == UNSOLVED:
        return Trace(WORDS, np.empty(0, np.int8), np.empty((0, 2)), np.empty((0, 2)), np.empty(0))
    return Trace(WORDS, *_field(world, route.goal).trace(world, route.start))


def _field(grid: Any, goal: Array) -> _core.HarmonicField:
    """The field of a goal, kept beside the grid."""
    kept: dict[tuple[float, ...], _core.HarmonicField] = vars(grid).setdefault("_harmonic", {})
    key = tuple(map(float, goal))
    if key not in kept:
        while len(kept) >= MOST_KEPT:
            kept.pop(next(iter(kept)))
        kept[key] = _core.HarmonicField(grid, clearance_field(grid), goal, HARMONIC_RESIDUAL, HARMONIC_CYCLES)
    return kept[key]
