"""Potential field: gradient descent on an attractive potential of the goal and repulsive potentials of
walls.

Khatib 1986, "Real-time obstacle avoidance for manipulators and mobile robots". U(p) = U_goal(d) + Σ ½ k_r
(1/ρ − 1/ρ₀)² over the boundary loops nearer than ρ₀, where d is the distance to the goal and ρ that to the
nearest point of a loop. U_goal is ½ k d² within `cone` of the goal and grows with the constant slope k ·
cone beyond it, so that the force is limited. A robot senses walls within ρ₀ only. It may stop in a local
minimum away from the goal, which the verdict then states.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError
from cspace.maps import PolygonWorld
from cspace.navigation.text import counted
from cspace.search.trace import Trace
from cspace.tolerances import DESCENT_LOOKS, LEAST_REACH

if TYPE_CHECKING:
    from cspace.navigation.route import Route

__all__ = ["PotentialRest", "plan", "potential", "reason", "trace"]

WORDS: Final = ("descend", "rest")
GAINS: Final = ("k", "k_r", "rho_0", "cone", "step")
RESTS: Final = ("goal", "minimum", "saddle", "crease", "wall", "budget")
SAID: Final = {
    "minimum": "the potential rises in every direction",
    "saddle": "no force is left, and the potential is too flat to tell which way is down; a start a little "
    "aside, or another rho_0=, may tell",
    "crease": "one ring of walls holds it from two sides",
    "wall": "it is pressed against a wall; a larger k_r= holds it off",
}


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


def plan(
    world: Any,
    start: Any,
    goal: Any,
    *,
    k: float = 1.0,
    k_r: float | None = None,
    rho_0: float | None = None,
    cone: float | None = None,
    step: float | None = None,
) -> Route:
    """Gradient descent on the potential from start until the robot reaches the goal or stops.

    start, goal: (2,) [m]. k: attraction. rho_0 [m]: the distance of influence of walls; by default a
    twentieth of the longer side of the bounds. k_r [m⁴]: repulsion; by default ¼ k ρ₀⁴, with which a wall
    balances the goal's attraction at half of ρ₀. cone [m]: the distance from the goal beyond which the
    attractive force is constant; by default rho_0. step [m]: the longest step; by default a quarter of
    rho_0.

    A step is never longer than half the clearance, and stops at the bottom of a valley that it would cross.
    The status is "local_minimum" where the robot stops away from the goal and the potential is proven to
    rise all around. It is "undetermined" where that is not proven or the limit of potential evaluations was
    reached. route.evidence, a PotentialRest, records how the descent ended. InputError for a gain or a
    length that is not positive.
    """
    ends = world.check_free(start, "start"), world.check_free(goal, "goal")
    settings = _settings(world, k, k_r, rho_0, cone, step)
    walls = _walls(world, settings[2])
    gains = dict(zip(GAINS, map(float, settings), strict=False))

    def evidence(rest: int, force: float, saddles: int) -> PotentialRest:
        return PotentialRest(RESTS[rest], force, saddles, gains)

    made: Route = walls.route(world._core, world, "potential_field", gains, *ends, settings, evidence)
    return made


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    rest: PotentialRest = route.evidence
    if route:
        over = f", over {counted(rest.saddles, 'saddle')}" if rest.saddles else ""
        return f"went down the potential for {route.length:.6g} m{over}"
    x, y = route.path[-1]
    left = float(np.hypot(x - route.goal[0], y - route.goal[1]))
    if rest.kind == "budget":
        return (
            f"the robot was still going down at ({x:.6g}, {y:.6g}), {left:.6g} m from the goal, when "
            f"{DESCENT_LOOKS} looks at the potential were spent; {_remedy(rest.gains)}"
        )
    near = "; the goal itself is near a wall" if left < rest.gains["rho_0"] else ""
    return f"the robot rests at ({x:.6g}, {y:.6g}), {left:.6g} m from the goal: {SAID[rest.kind]}{near}"


def _remedy(gains: dict[str, float]) -> str:
    """The cause that limits the step length: an option, or the clearance."""
    if gains["step"] < 0.1 * gains["rho_0"]:
        return f"a longer step= than {gains['step']:g} m gets farther"
    return f"a larger k_r= than {gains['k_r']:g} keeps it farther from walls, where steps are longer"


def trace(route: Route) -> Trace:
    """The steps: "descend", and "rest" where it stops away from the goal. start, end: (k, 2) [m]; value:
    the potential."""
    world = route.world
    settings = _settings(world, **route.options)
    return Trace(WORDS, *_walls(world, settings[2]).trace(world._core, route.start, route.goal, settings))


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
    if not isinstance(world, PolygonWorld):
        raise InputTypeError(f"world is a {type(world).__name__}; give a PolygonWorld")
    settings = _settings(world, k, k_r, rho_0, cone, None)
    at = as_floats(points, "points", last=(2,))
    rows = np.ascontiguousarray(at.reshape(-1, 2))
    walls = _walls(world, settings[2])
    found: Array = walls.values(world._core, world.check_free(goal, "goal"), rows, settings)
    return found.reshape(at.shape[:-1])


def _settings(
    world: Any, k: float, k_r: float | None, rho_0: float | None, cone: float | None, step: float | None
) -> Array:
    """k, k_r, rho_0, cone, step, evaluations: (6,)."""
    xmin, ymin, xmax, ymax = world.bounds
    reach = _positive("rho_0", max(xmax - xmin, ymax - ymin) / 20 if rho_0 is None else rho_0)
    if not LEAST_REACH < reach < 1 / LEAST_REACH:
        raise InputError(f"rho_0 is {reach:g} m; give one from {LEAST_REACH:g} to {1 / LEAST_REACH:g} m")
    pull = _positive("k", k)
    push = _positive("k_r", 0.25 * pull * reach**4 if k_r is None else k_r)
    limit = _positive("cone", reach if cone is None else cone)
    longest = min(_positive("step", 0.25 * reach if step is None else step), reach)
    return np.array([pull, push, reach, limit, longest, float(DESCENT_LOOKS)])


def _positive(name: str, value: float) -> float:
    number = float(as_floats(value, name).reshape(())) if np.size(value) == 1 else np.nan
    if not number > 0:
        raise InputError(f"{name} is {value!r}; it must be one positive number")
    return number


def _walls(world: Any, reach: float) -> _core.NearWalls:
    """The data that the core has computed for the walls, cached with the world."""
    kept = vars(world)
    walls: _core.NearWalls | None = kept.get("_near_walls")
    if walls is None or walls.reach != reach:
        walls = kept["_near_walls"] = _core.NearWalls(world._core, reach)
    return walls
