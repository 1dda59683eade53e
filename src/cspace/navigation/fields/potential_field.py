"""Potential field: gradient descent on an attractive potential of the goal and repulsive potentials of
walls.

Khatib 1986, "Real-time obstacle avoidance for manipulators and mobile robots". U(p) = U_goal(d) + Σ ½ k_r
(1/ρ − 1/ρ₀)² over the boundary loops nearer than ρ₀, where d is the distance to the goal and ρ that to the
nearest point of a loop. U_goal is ½ k d² within `cone` of the goal and grows with the constant slope k ·
cone beyond it, so that the force is limited. A robot senses walls within ρ₀ only. It may stop in a local
minimum away from the goal, which the verdict then states.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.maps import PolygonWorld
from cspace.maps.outlines import longer_side
from cspace.navigation.cache import keep_with
from cspace.navigation.checks import need_polygons
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.search import option
from cspace.tables import count_things, show_fields
from cspace.tolerances import DESCENT_LOOKS, LEAST_REACH

RESTS: Final = ("goal", "minimum", "saddle", "crease", "wall", "budget")
SAID: Final = {
    "minimum": "the potential rises in every direction",
    "saddle": "the force vanishes, and the potential is too flat to find a descent; try a slightly different "
    "start or another rho_0=",
    "crease": "one boundary loop blocks the robot from two sides",
    "wall": "the robot touches a wall; a larger k_r= keeps it away",
}


@show_fields
class PotentialRest(NamedTuple):
    """Where and how a descent ended."""

    kind: str
    """ "goal"; "minimum" or "crease", where the potential is proven to rise all around; otherwise "saddle",
    "wall", or "budget": the limit of potential evaluations was reached on the way down."""
    force: float
    """The remaining force, in units of k times metres."""
    saddles: int
    """The number of equilibria that the descent left again."""
    gains: dict[str, float]
    """k, k_r, rho_0, cone and step as they were used."""


@dataclass(frozen=True, eq=False)
class PotentialField(PlanePlanner):
    """Gradient descent on the potential from start until the robot reaches the goal or stops.

    A step is never longer than half the clearance, and stops at the bottom of a valley that it would cross.
    The status is "local_minimum" where the robot stops away from the goal and the potential is proven to
    rise all around. It is "undetermined" where that is not proven or the limit of potential evaluations was
    reached. route.evidence, a PotentialRest, records how the descent ended. The trace contains the steps:
    "descend", and "rest" where it stops away from the goal; its value is the potential.
    """

    name = "potential_field"
    summary = "descent of an attractive and repulsive potential"
    events = ("descend", "rest")

    k: float = option(1.0, "attraction.", above=0)
    k_r: float | None = option(
        None,
        "repulsion; by default ¼ k ρ₀⁴, with which a wall balances the goal's attraction at half of ρ₀.",
        unit="m⁴",
        above=0,
    )
    rho_0: float | None = option(
        None,
        "the distance of influence of walls; by default a twentieth of the longer side of the bounds.",
        unit="m",
        above=0,
    )
    cone: float | None = option(
        None,
        "the distance from the goal beyond which the attractive force is constant; by default rho_0.",
        unit="m",
        above=0,
    )
    step: float | None = option(None, "the longest step; by default a quarter of rho_0.", unit="m", above=0)

    def _fill_in(self, world: Any) -> PotentialField:
        reach = longer_side(world.bounds) / 20 if self.rho_0 is None else self.rho_0
        if not LEAST_REACH < reach < 1 / LEAST_REACH:
            raise InputError(f"rho_0 is {reach:g} m; give one from {LEAST_REACH:g} to {1 / LEAST_REACH:g} m")
        return self._in_force(
            k_r=0.25 * self.k * reach**4 if self.k_r is None else self.k_r,
            rho_0=reach,
            cone=reach if self.cone is None else self.cone,
            step=min(0.25 * reach if self.step is None else self.step, reach),
        )

    def _settings(self) -> tuple[float, ...]:
        """k, k_r, rho_0, cone, step, evaluations."""
        return *self.values.values(), float(DESCENT_LOOKS)

    def _walls_of(self, world: Any) -> Any:
        """The NearWalls within rho_0, cached with the world."""
        reach: float = self.values["rho_0"]
        return keep_with(world, "_near_walls", reach, lambda: _core.NearWalls(world._core, reach))

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        def describe_rest(rest: int, force: float, saddles: int) -> PotentialRest:
            return PotentialRest(RESTS[rest], force, saddles, dict(self.values))

        settings = self._walls_of(world), *self._settings(), describe_rest
        return _core._potential_field(traced, world, world._core, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        rest: PotentialRest = route.evidence
        if route:
            over = f", over {count_things(rest.saddles, 'saddle')}" if rest.saddles else ""
            return f"descended the potential for {route.length:.6g} m{over}"
        x, y = route.path[-1]
        left = float(np.hypot(x - route.goal[0], y - route.goal[1]))
        if rest.kind == "budget":
            return (
                f"the descent was at ({x:.6g}, {y:.6g}), {left:.6g} m from the goal, when the limit of "
                f"{DESCENT_LOOKS} evaluations was reached; {self._suggest_gain()}"
            )
        near = "; the goal itself is near a wall" if left < self.values["rho_0"] else ""
        return f"the descent ended at ({x:.6g}, {y:.6g}), {left:.6g} m from the goal: {SAID[rest.kind]}{near}"

    def _suggest_gain(self) -> str:
        """The option that gets farther: the step, or the repulsion where the clearance limits steps."""
        step, rho_0, k_r = (self.values[name] for name in ("step", "rho_0", "k_r"))
        if step < 0.1 * rho_0:
            return f"a longer step= than {step:g} m gets farther"
        return f"a larger k_r= than {k_r:g} keeps it farther from walls, where steps are longer"


def potential(
    world: PolygonWorld,
    goal: ArrayLike,
    points: ArrayLike,
    *,
    k: float = 1.0,
    k_r: float | None = None,
    rho_0: float | None = None,
    cone: float | None = None,
) -> Array:
    """The potential of a goal (2,) [m] at points (..., 2) [m]: (...), infinite inside obstacles.

    k, k_r, rho_0, cone: as for the planner "potential_field". InputTypeError for worlds other than
    polygons.
    """
    need_polygons(world)
    planner = PotentialField(k, k_r, rho_0, cone)._fill_in(world)
    at = as_floats(points, "points", last=(2,))
    given = (
        world.check_free(goal, "goal"),
        np.ascontiguousarray(at.reshape(-1, 2)),
        np.array(planner._settings()),
    )
    found: Array = planner._walls_of(world).values(world._core, *given)
    return found.reshape(at.shape[:-1])
