"""Voronoi Bug: explores the generalised Voronoi diagram with a range sensor (Choset & Burdick 1995).

The robot detects walls up to a distance and has no map. It moves away from the nearest wall until two walls
are equally near. It then follows the points equally near to both, branch by branch, and keeps a graph of
the points where three walls meet. It recognises dead ends and leaves them. Where no wall is within range it
moves straight to the goal; where only one is, it follows that wall at this distance. It moves to the goal
when the goal is visible. If all connected branches are exhausted, the goal is behind a wall that the robot
follows, or enclosed by a boundary loop. In the first case it continues from the wall's point nearest to the
goal; in the second the goal is unreachable.

With noise its only input is a scan: 720 readings all around. Each reading is the distance to the nearest
wall in a beam of half a degree plus a normal deviate, clipped to [0, range]. The robot stops and averages
16 to 400 scans until the standard error of their mean is a hundredth of the least reading. Walls count as
equally near if the difference could be chance. It steps a quarter of the clearance between two walls,
corrects to where both are equally near, and moves to where three are. It leaves branches whose end is
visible together with their walls. A position counts as known within a quarter of the clearance. If all
branches are exhausted it repeats the search closer to walls, four times in all. Since a gap may have been
missed, it never reports that the goal is unreachable.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf
from typing import Any, NamedTuple

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.navigation.text import explain_entry
from cspace.search import draw_seed, option
from cspace.tables import count_things, show_fields
from cspace.tolerances import SCAN_NOISE


@show_fields
class VoronoiBugEvidence(NamedTuple):
    """What a robot found that traced the points equally near to two walls, and what encloses its goal."""

    meets: Array
    """(k, 2) [m]: where three or more walls are nearest, in the order of their discovery."""
    branches: int
    """The number of branches that it entered."""
    dead_ends: int
    """The number of branches that end in a corner of walls."""
    clearance: float
    """The least sensed distance from walls along the branches [m]; inf if there was no branch."""
    scans: int
    """The number of scans of a sensor with noise; 0 without noise."""
    shut: tuple[int, tuple[float, float]] | None
    """For an unreachable goal: the boundary loop that encloses it, an index of `world.walls`, and a point
    (x, y) of the loop where the line to the goal enters the wall; else None."""


@dataclass(frozen=True, eq=False)
class VoronoiBug(PlanePlanner):
    """Voronoi Bug: explores the generalised Voronoi diagram with a range sensor (Choset & Burdick 1995).

    The robot stays just within its range of the walls that it follows. route.path is the path travelled
    even where no path exists; route.evidence is a VoronoiBugEvidence; route.stats counts meet points and
    branches. The status is "undetermined" where rounding hides the connections between branches, and with
    noise where the goal has not been seen.

    The trace contains the motion, step by step: "away" from the nearest wall, "trace" between two, "roll"
    along one, "back" over known positions, "go" straight to the goal; its value is the least distance from
    walls along that branch [m], NaN without a branch.
    """

    name = "voronoi_bug"
    summary = "traces the points equally far from two walls; range sensor"
    sensing = "range"
    events = ("away", "trace", "roll", "back", "go")

    range: float = option(
        inf,
        "of the sensor, more than 0; inf is limited only by walls.",
        unit="m",
        above=0,
        may_be_infinite=True,
    )
    noise: float = option(
        0.0,
        "the standard deviation of a reading, at most a fifth of the range; 0 gives exact readings.",
        unit="m",
    )
    rng: int | np.random.Generator | None = option(
        None, "seed, Generator or None, used only with noise; `route.options` keeps the seed."
    )

    def _fill_in(self, world: Any) -> VoronoiBug:
        xmin, ymin, xmax, ymax = world.bounds
        most = SCAN_NOISE * min(self.range, hypot(xmax - xmin, ymax - ymin))
        if not 0 <= self.noise <= most:
            rule = f"it must lie between 0 and {most:g} m, a fifth of the farthest reading"
            raise InputError(f"noise is {self.noise:g}; {rule}")
        return self._in_force(rng=draw_seed(self.rng) if self.noise else 0)

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        settings = *self.values.values(), VoronoiBugEvidence
        return _core._voronoi_bug(traced, world, world._core, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        found: VoronoiBugEvidence = route.evidence
        branches = count_things(found.branches, "branch", "branches")
        took = f"{branches} and {count_things(len(found.meets), 'meet point')}"
        if route:
            return f"reached the goal after {route.length:.6g} m, {took}"
        if self.noise:
            scans = count_things(found.scans, "scan")
            return (
                f"stopped after {route.length:.6g} m, {took}, {scans}: "
                "the noisy sensor did not find the goal, which is no proof"
            )
        if found.shut is None:
            return f"stopped after {route.length:.6g} m, {took}: rounding hides how branches are connected"
        ring, at = found.shut
        loop = f"boundary loop {ring} separates it from the robot: {explain_entry(at)}"
        return f"{took} are exhausted without sight of the goal, and {loop}"
