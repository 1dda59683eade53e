"""Voronoi Bug (Choset & Burdick 1995): between the walls, by the distance to those in sight.

A robot sees walls up to a distance and has no map. It moves away from the nearest wall until two are as near,
and follows the points as near to both, branch by branch, keeping a graph of the points where three meet; dead
ends it sees and leaves. Where no wall is within its range it goes straight for the goal, where only one is it
follows that wall at this distance. It goes to the goal when that is in view. If all branches that hang
together are exhausted, the goal lies beyond a wall that it follows, from whose point nearest to the goal it
goes on, or beyond a ring of walls, and cannot be reached.

With noise it gets nothing but a scan: 720 readings all around, each the distance to the nearest wall in a
beam of half a degree plus a normal deviate, clipped to [0, range]. It stands still and averages scans until
their mean is sure to a hundredth of the least reading, 16 to 400 of them. Walls are as near as others if
that could be chance. It steps a quarter of the clearance between two of them, then back to where both are as
near, and goes to where three are. Branches that end in full view of their walls it leaves. A place counts as
known within a quarter of the clearance. If all branches are exhausted it looks again, closer to walls, four
times in all. Since a gap may have been missed, it never says that the goal is unreachable.
"""

from __future__ import annotations

from math import hypot, inf
from typing import Any, Final, NamedTuple

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.navigation.route import Route
from cspace.navigation.sampling.problem import seed_of
from cspace.navigation.text import counted
from cspace.search.trace import Trace
from cspace.tolerances import SCAN_NOISE

__all__ = ["VoronoiBugEvidence", "plan", "reason", "trace"]

WORDS: Final = ("away", "trace", "roll", "back", "go")


class VoronoiBugEvidence(NamedTuple):
    """What a robot met that traces the points as near to two walls, and what shuts off its goal."""

    meets: Array
    """(k, 2) [m]: where three walls or more are nearest, in the order in which they were found."""
    branches: int
    """How many branches it went into."""
    dead_ends: int
    """How many of them end in a corner of walls."""
    clearance: float
    """The least distance from walls along the branches [m], as sensed; inf where it took none."""
    scans: int
    """How many scans a sensor with noise made; 0 without."""
    shut: tuple[int, tuple[float, float]] | None
    """Unreachable: the ring that shuts the goal off, an index of `world.walls`, and a point (x, y) of it
    where the line to the goal enters the wall; else None."""


def plan(
    world: Any,
    start: Any,
    goal: Any,
    *,
    range: float = inf,
    noise: float = 0.0,
    rng: int | np.random.Generator | None = None,
) -> Route:
    """The walk of a robot with a range sensor from start to goal (2,) [m] in a PolygonWorld.

    range [m]: how far it sees, more than 0; inf sees as far as walls let it.
    noise [m]: the standard deviation of a reading, at most a fifth of the range; with 0 walls are seen as
    they are.
    rng: seed, Generator or None, drawn from where there is noise; `route.options` keeps the seed.

    The robot keeps just within its range from walls that it follows. route.path is the walk even where no way
    exists; route.evidence is a VoronoiBugEvidence; route.stats counts meet points and branches. Raises
    InputError on a range that is not positive and on noise that is negative or too much. The status is
    "undetermined" where rounding hides how branches hang together, and with noise where the goal has not been
    seen.
    """
    reach = inf if range == inf else float(as_floats(range, "range"))
    if not reach > 0:
        raise InputError(f"range is {reach:g}; it must be more than zero [m], or inf")
    deviation = float(as_floats(noise, "noise"))
    if deviation:
        _check_noise(deviation, reach, world)
    options = {"range": reach, "noise": deviation, "rng": seed_of(rng) if deviation else 0}
    made: Route | None
    asked = world, "voronoi_bug", options, VoronoiBugEvidence, world._core, *options.values()
    made = _core._voronoi_bug(*asked, start, goal)
    if made is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        made = _core._voronoi_bug(*asked, *ends)
        assert made is not None
    return made


def _check_noise(deviation: float, reach: float, world: Any) -> None:
    """InputError for noise beyond a fifth of what the sensor can read."""
    xmin, ymin, xmax, ymax = world.bounds
    most = SCAN_NOISE * min(reach, hypot(xmax - xmin, ymax - ymin))
    if not 0 <= deviation <= most:
        raise InputError(
            f"noise is {deviation:g}; it must lie between 0 and {most:g} m, a fifth of the farthest reading"
        )


def trace(route: Route) -> Trace:
    """The walk, step by step: "away" from the nearest wall, "trace" between two, "roll" along one, "back"
    where it has been, "go" straight for the goal.

    start, end: (k, 2) [m]. value [m]: the least distance from walls along that branch, NaN where it is none.
    """
    return Trace(
        WORDS,
        *_core._voronoi_bug_trace(route.world._core, *route.options.values(), route.start, route.goal),
    )


def reason(route: Route) -> str:
    """The verdict in a sentence."""
    found: VoronoiBugEvidence = route.evidence
    branches = counted(found.branches, "branch", "branches")
    took = f"{branches} and {counted(len(found.meets), 'meet point')}"
    if route:
        return f"arrived after {route.length:.6g} m, {took}"
    if route.options["noise"]:
        scans = counted(found.scans, "scan")
        return (
            f"gave up after {route.length:.6g} m, {took}, {scans}: a sensor with noise did not "
            "show the goal, which proves nothing"
        )
    if found.shut is None:
        return f"gave up after {route.length:.6g} m, {took}: rounding hides how branches hang together"
    ring, (x, y) = found.shut
    return (
        f"{took} are exhausted without sight of the goal, and it lies beyond the ring of walls {ring}: "
        f"at ({x:.6g}, {y:.6g}) the line to the goal enters the wall"
    )
