"""Navigation functions: potentials whose only minimum is the goal, for sphere worlds and star worlds.

Koditschek & Rimon 1990, "Robot navigation functions on manifolds with boundary"; Rimon & Koditschek 1992,
"Exact robot navigation using artificial potential functions". A sphere world is a disc with smaller discs
removed. There φ = γ / (γ^κ + β)^(1/κ) with γ = |p − goal|² and β the product of the obstacle functions: β₀
= R² − |p − c₀|² for the outer disc, β_i = |p − c_i|² − r_i² for the others. φ is 0 only at the goal and 1
on walls, and has no other minimum if κ is large enough. The required κ is proven here: V = κ log γ − Σ log
β_i increases with φ, and a subdivision of the world shows that it has no other minimum. In a star world a
homeomorphism maps star-shaped obstacles to discs. Descents arrive from everywhere. They can stop only at
saddles, one for each obstacle, and a push moves them off.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.maps import PolygonWorld
from cspace.maps.outlines import longer_side
from cspace.navigation.cache import keep_with
from cspace.navigation.checks import check_ends
from cspace.navigation.planner import NO_EVENTS, PlanePlanner
from cspace.navigation.route import Route, Stats, new_route
from cspace.search import option
from cspace.tables import count_things, show_fields, tabulate
from cspace.tolerances import (
    FARTHEST_POINT,
    NAVIGATION_FUNCTIONS,
    NAVIGATION_SQUARES,
    NAVIGATION_STEPS,
    ON_GOAL_WALL,
    ON_WALL,
)


@show_fields
class NavigationEvidence(NamedTuple):
    """The evidence for a descent on a navigation function."""

    function: NavigationFunction | None
    """None where the world is not a star world, or the goal touches a wall."""
    pushes: int
    """The number of saddles that the descent was pushed off."""
    fault: str
    """The reason why there is no navigation function, as one sentence; empty where there is one."""


@tabulate("kappa", "obstacles", "is_proven", "goal", "saddles")
class NavigationFunction:
    """A navigation function: call it with points (..., 2) [m] for φ (...), 0 at the goal and 1 on walls.

    `kappa` is its power, `is_proven` whether the goal is proven to be its only minimum, `saddles` (k, 2)
    [m] the other stationary points, one for each obstacle. `goal` (2,) [m] is read-only. The object is
    immutable, so a copy is the object itself. Pickles store the data it was built from; loading repeats the
    proof.
    """

    def __init__(
        self,
        core: _core.NavigationCore,
        world: _core.PolygonCore | None,
        goal: Array,
        made_for: tuple[Any, float],
    ) -> None:
        """made_for: discs (n, 3), or outlines and bounds, and the requested kappa, zero for none."""
        self._core, self._world, self._made_for = core, world, made_for
        self.goal = goal.copy()
        self.goal.setflags(write=False)

    @property
    def kappa(self) -> float:
        """The power κ of γ."""
        return self._core.kappa

    @property
    def is_proven(self) -> bool:
        """Whether the goal is proven to be the only minimum."""
        return self._core.is_proven

    @property
    def obstacles(self) -> int:
        """The number of obstacles."""
        return self._core.obstacles

    @property
    def saddles(self) -> Any:
        """The stationary points but minima (k, 2) [m]; one for each obstacle if there is a single minimum."""
        return self._core.saddles()

    def __call__(self, points: ArrayLike) -> Any:
        """φ at points (..., 2) [m]: (...), between 0 and 1; 1 in obstacles and outside. It rounds to 1 in
        places where V of `log_odds` remains distinct."""
        logs = np.asarray(self.log_odds(points))
        return self._core.phi(np.ascontiguousarray(logs.reshape(-1))).reshape(logs.shape)[()]

    def log_odds(self, points: ArrayLike) -> Any:
        """V = κ log γ − Σ log β_i at points (..., 2) [m], lengths in radii of the outer disc: (...),
        infinite on walls and in obstacles. φ = (e^V / (1 + e^V))^(1/κ)."""
        at = as_floats(points, "points", last=(2,))
        found: Array = self._core.log_odds(self._world, np.ascontiguousarray(at.reshape(-1, 2)))
        return found.reshape(at.shape[:-1])[()]

    def descend(self, start: ArrayLike) -> Array | None:
        """The descent from a free point start (2,) [m] to the goal: (m, 2) [m]; None where it did not
        arrive. InputError where start is not free."""
        at = np.ascontiguousarray(as_floats(start, "start", last=(2,)))
        if at.shape != (2,) or np.isposinf(self.log_odds(at)):
            raise InputError(f"start {at.tolist()} lies in an obstacle or on a wall; give a free point (2,)")
        found: Array | None = self._core.path(at)
        return found

    def __copy__(self) -> NavigationFunction:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> NavigationFunction:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """What it was made for: the data that pickle stores."""
        return _make_again, (*self._made_for, self.goal)

    def __repr__(self) -> str:
        proven = "proven" if self.is_proven else "not proven"
        among = count_things(self.obstacles, "obstacle")
        return f"<NavigationFunction: kappa {self.kappa:g}, {among}, one minimum {proven}>"


@dataclass(frozen=True, eq=False)
class RimonKoditschek(PlanePlanner):
    """Descent on a navigation function from start to goal.

    The world around the goal must be a star world: every obstacle, and the outer boundary, has a point from
    which all of it is visible, and no two touch. Otherwise, or if the goal touches a wall, the status is
    "undetermined" and the reason states which. route.evidence is a NavigationEvidence. The trace contains
    the steps "descend"; its value is φ after the step.
    """

    name = "rimon_koditschek"
    summary = "descent of a navigation function among star-shaped obstacles"
    events = ("descend",)

    kappa: float | None = option(
        None,
        "the power of the function; by default the least power of two with which the goal is proven to be "
        "the only minimum.",
        above=0,
    )

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        ends = check_ends(world, start, goal)
        began = time.perf_counter()
        function, fault = _find_function(world, ends[1], self.kappa or 0.0)
        seconds = time.perf_counter() - began
        if function is None:
            stats, evidence = Stats(0, 0, seconds), NavigationEvidence(None, 0, fault)
            if np.array_equal(*ends):
                return new_route(world, self, ends, "found", ends[0][None], 0.0, stats, evidence)
            apart = not set(world._core.components_at(ends[0])) & set(world._core.components_at(ends[1]))
            status = "unreachable" if apart else "undetermined"
            return new_route(world, self, ends, status, np.empty((0, 2)), np.inf, stats, evidence)
        given = world, world._core, self._in_force(kappa=function.kappa), *ends, function._core, seconds
        return _core._navigation_function(
            traced, *given, lambda pushes: NavigationEvidence(function, pushes, fault)
        )

    def explain_route(self, route: Route) -> str:
        evidence: NavigationEvidence = route.evidence
        if route.status == "unreachable":
            return "start and goal lie in different components of free space"
        if evidence.fault:
            return evidence.fault
        function = evidence.function
        assert function is not None
        minima = (
            "with a single minimum, which is proven" if function.is_proven else "whose minima are not known"
        )
        said = f"a navigation function with kappa {function.kappa:g}, {minima}"
        if not route:
            return f"the descent did not end within {NAVIGATION_STEPS} steps, of {said}"
        pushed = f", pushed off {count_things(evidence.pushes, 'saddle')}" if evidence.pushes else ""
        return f"descended {said}, for {route.length:.6g} m{pushed}"

    def _record(self, route: Route) -> Any:
        function = route.evidence.function
        if function is None or route.status == "unreachable":
            return NO_EVENTS
        given = route.world, route.world._core, self, route.start, route.goal, function._core
        return _core._navigation_function(True, *given, 0.0, None)


def navigation_function(world: Any, goal: ArrayLike, *, kappa: float | None = None) -> NavigationFunction:
    """The navigation function of a star or sphere world with a goal (2,) [m].

    world: a PolygonWorld, or discs (n, 3) as rows of x, y, radius [m], the first the outer disc and the
    others obstacles in it. kappa: as for the planner "rimon_koditschek". InputError where obstacles touch
    or are not star-shaped, where the goal is not in the interior of free space, or where no kappa was
    proven.
    """
    power = RimonKoditschek(kappa).kappa or 0.0
    if isinstance(world, PolygonWorld):
        function, fault = _find_function(world, world.check_free(goal, "goal"), power)
        if function is None:
            raise InputError(fault)
        return function
    discs = np.ascontiguousarray(as_floats(world, "world", last=(3,), largest=FARTHEST_POINT))
    at = np.ascontiguousarray(as_floats(goal, "goal", last=(2,), largest=FARTHEST_POINT))
    _check_discs(discs, at)
    core = _core.NavigationCore(discs, at, power, NAVIGATION_SQUARES, NAVIGATION_STEPS)
    if not core.kappa:
        raise InputError("no kappa was proven to leave a single minimum; give kappa= to skip the proof")
    return NavigationFunction(core, None, at, (discs, power))


def _make_again(world: Any, power: float, goal: Array) -> NavigationFunction:
    """The same function, built again."""
    if isinstance(world, tuple):
        outlines, bounds = world
        world = PolygonWorld(outlines, bounds, repair=True)
    return navigation_function(world, goal, kappa=power or None)


def _check_discs(discs: Array, goal: Array) -> None:
    """InputError for discs that touch, or a goal on a wall or in an obstacle."""
    if discs.ndim != 2 or not len(discs) or not np.all(discs[:, 2] > 0):
        raise InputError(f"discs have shape {discs.shape}; give (n, 3) rows of x, y and a positive radius")
    if goal.shape != (2,):
        raise InputError(f"goal has shape {goal.shape}, expected (2,)")
    small = np.flatnonzero(discs[:, 2] <= ON_WALL * np.abs(discs).max())
    if len(small):
        raise InputError(
            f"disc {small[0]} has radius {discs[small[0], 2]:g}; it is below the rounding of coordinates "
            f"of {np.abs(discs).max():g}"
        )
    away = np.linalg.norm(discs[:, None, :2] - discs[None, :, :2], axis=-1)
    reach = discs[:, None, 2] + discs[None, :, 2]
    reach[0], reach[:, 0] = 0, 0
    outside = np.flatnonzero(away[0, 1:] + discs[1:, 2] >= discs[0, 2])
    if len(outside):
        raise InputError(
            f"disc {outside[0] + 1} reaches the wall of the room, disc 0; obstacles must lie within"
        )
    np.fill_diagonal(away, np.inf)
    touching = np.argwhere(away[1:, 1:] <= reach[1:, 1:]) + 1
    if len(touching):
        raise InputError(f"discs {touching[0][0]} and {touching[0][1]} touch; obstacles must be apart")
    far = np.linalg.norm(goal - discs[:, :2], axis=1)
    if far[0] >= discs[0, 2] or np.any(far[1:] <= discs[1:, 2]):
        raise InputError(f"goal {goal.tolist()} is not in the interior of free space; move it off the walls")


def _find_function(world: Any, goal: Array, power: float) -> tuple[NavigationFunction | None, str]:
    """The navigation function of a goal, or None and the obstruction; cached with the world."""
    key, make = (*map(float, goal), power), partial(_make_function, world, goal, power)
    return keep_with(world, "_navigation_functions", key, make, NAVIGATION_FUNCTIONS)


def _make_function(world: Any, goal: Array, power: float) -> tuple[NavigationFunction | None, str]:
    fault = _core.NavigationCore.fault(world._core, goal)
    if fault:
        return None, _explain_fault(world, *fault)
    core = _core.NavigationCore(world._core, goal, power, NAVIGATION_SQUARES, NAVIGATION_STEPS)
    if core.kappa:
        return NavigationFunction(core, world._core, goal, (world.__reduce__()[1], power)), ""
    if world.clearance(goal) <= ON_GOAL_WALL * longer_side(world.bounds):
        return None, "the goal touches a wall, where a navigation function is 1; move it off the wall"
    return None, "no power kappa was proven to leave a single minimum; planner='harmonic' needs none"


def _explain_fault(world: Any, kind: int, x: float, y: float) -> str:
    """Why a world is not a star world, with the obstacle that has a corner at (x, y)."""
    owner = ""
    for number, rings in enumerate(vars(world).get("_outlines", ())):
        if any(np.any(np.all(ring == (x, y), axis=1)) for ring in rings):
            owner = f" of obstacle {number}"
            break
    at = f"the boundary loop{owner} through ({x:.9g}, {y:.9g})"
    rule = "touches another" if kind == 2 else "is not star-shaped: no point sees all of it"
    return f"{at} {rule}; planner='harmonic' takes any shape"
