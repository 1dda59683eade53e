"""Harmonic potential: solves Laplace's equation over free cells, with 0 at the goal and 1 on walls.

Connolly, Burns & Weiss 1990, "Path planning using Laplace's equation". Every other cell is the mean of its
four neighbours, so the goal is the only local minimum, and a descent leads to it from everywhere. 1 − the
potential is the probability that a random walk reaches the goal before a wall. Along a corridor of w cells
it decreases by exp(−π / w) per cell, and the potential soon rounds to 1. The solver therefore computes and
stores the logarithm of the probability, to a relative error that does not depend on its size.
"""

from __future__ import annotations

import time
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.navigation.cache import clearance_field, keep_with
from cspace.navigation.checks import check_ends, need_grid
from cspace.navigation.planner import NO_EVENTS, PlanePlanner
from cspace.navigation.route import Route, Stats, new_route
from cspace.tables import count_things, show_fields
from cspace.tolerances import HARMONIC_CYCLES, HARMONIC_FIELDS, HARMONIC_RESIDUAL


@show_fields
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


class Harmonic(PlanePlanner):
    """Descent along the harmonic potential from start to goal, from cell to cell, past no blocked corner.

    The first query for a goal solves the whole field, further queries only descend it; where walls separate
    start from goal, no solution is needed. route.evidence is a
    HarmonicEvidence. "undetermined" where the equation was not solved accurately enough for the descent to
    arrive. The trace contains the steps "descend" between centres of cells; its value is −log of the
    probability at the end.
    """

    name = "harmonic"
    summary = "descent of a harmonic potential over cells, without local minima"
    world = "grid"
    events = ("descend",)

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        ends = check_ends(world, start, goal)
        began = time.perf_counter()
        if _core._walls_divide(world, *ends):
            if traced:
                return NO_EVENTS
            stats = Stats(0, 0, time.perf_counter() - began)
            return new_route(world, self, ends, "unreachable", np.empty((0, 2)), np.inf, stats, UNSOLVED)
        field = _field_of(world, ends[1])
        seconds = time.perf_counter() - began
        settings = field, seconds, lambda: HarmonicEvidence(field.residual, field.cycles, field.rests)
        return _core._harmonic(traced, world, world, self, *ends, *settings)

    def explain_route(self, route: Route) -> str:
        evidence: HarmonicEvidence = route.evidence
        if evidence == UNSOLVED:
            return "no path to the goal: walls separate it from the start, as is known without the potential"
        if route.status == "unreachable":
            cells = count_things(route.stats.nodes, "cell")
            return f"no path to the goal: the start is not among the {cells} connected with it"
        cycles = count_things(evidence.cycles, "cycle")
        solved = f"solved to a share of {evidence.residual:.2g} in {cycles}"
        if not route:
            rests = count_things(evidence.rests, "minimum", "minima")
            return f"the potential has {rests} other than the goal; it was {solved}"
        return (
            f"descended a harmonic potential whose only minimum is the goal, {solved}, for "
            f"{route.length:.6g} m"
        )


def harmonic(grid: Any, goal: ArrayLike) -> Array:
    """−log of the probability that a random walk from a cell reaches goal (2,) [m] before a wall: (rows,
    columns).

    0 at the goal, infinite on blocked cells and where no path leads to the goal. The harmonic potential is
    1 − exp(−field), which rounds to 1 where the field is above 37; it increases with the field.
    InputTypeError for worlds other than grids.
    """
    need_grid(grid)
    return np.asarray(_field_of(grid, grid.check_free(goal, "goal")).heights(grid))


def _field_of(grid: Any, goal: Array) -> _core.HarmonicField:
    """The field of a goal, cached with the grid."""

    def solve() -> _core.HarmonicField:
        return _core.HarmonicField(grid, clearance_field(grid), goal, HARMONIC_RESIDUAL, HARMONIC_CYCLES)

    return keep_with(grid, "_harmonic", tuple(map(float, goal)), solve, HARMONIC_FIELDS)
