"""A* with a potential as heuristic: attraction to the goal and repulsion from walls order the search, which
is complete.

U = d + min(½ k_r (1/ρ − 1/ρ₀)², cap) [m] for a cell at the distance d from the goal and ρ from the nearest
wall, without the second term beyond ρ₀. "exact": A* with h = min(s U, d), which never exceeds the remaining
distance, so its path is a shortest one. "bounded": h = min(s U, w d), so the path is at most w times as
long (Pohl 1970); a cell that is reached again on a shorter path is reopened, because this h need not be
consistent. "greedy": by U alone (Pearl 1984).

The repulsion from walls contains no information about the path around them. Measured on five MovingAI maps:
"exact" expands as many cells as A* with s = 1, where min(s U, d) is d, and up to 1.7 times as many with s =
0.9; "bounded" 0.96 to 1.2 times as many, with paths 0.1 to 1.4 % longer; "greedy" 3 to 34 % of them, with
paths 5 to 23 % longer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, suggest
from cspace.navigation.grid.search import CORNERS, checked_ends
from cspace.navigation.grid.search import reason as reason
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.navigation.route import Route

__all__ = ["clearance_field", "plan", "reason", "trace"]

MODES: Final = ("exact", "bounded", "greedy")
WORDS: Final = ("settle",)


def plan(
    world: Any,
    start: Any,
    goal: Any,
    *,
    mode: str = "bounded",
    k_r: float | None = None,
    rho_0: float | None = None,
    scale: float = 1.0,
    weight: float = 1.5,
    corners: str = "never",
) -> Route:
    """A path over the cells of a grid, found by A* or greedy search with a potential as heuristic.

    start, goal: (2,) [m] in free cells. mode: "exact", "bounded" or "greedy". rho_0 [m]: the distance of
    influence of walls, four cells by default. k_r [m³]: repulsion; by default the value with which cells
    next to walls are rho_0 higher; 0 gives plain A*. scale: s, the factor of the potential before it is
    compared. weight: w, the bound on path length relative to the shortest, for "bounded" alone. corners: as
    for A*.

    The repulsion is capped at the diagonal of the grid. InputError for numbers out of range.
    """
    options: dict[str, Any] = {"mode": mode, **_repulsion(world, k_r, rho_0)}
    options |= {"scale": scale, "weight": weight, "corners": corners}
    ends = checked_ends(world, start, goal)
    settings, rule = _settings(world, **options)
    made: Route = clearance_field(world).potential_route(
        world, world, "potential_a_star", options, *ends, settings, rule
    )
    return made


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion, each from its parent: start, end (k, 2) [m]; value: their
    potential [m]."""
    world = route.world
    settings, rule = _settings(world, **route.options)
    found = clearance_field(world).potential_trace(world, route.start, route.goal, settings, rule)
    return Trace(WORDS, *found)


def clearance_field(grid: Any) -> _core.ClearanceField:
    """The distances of the cells of a grid from walls, cached with it."""
    kept = vars(grid)
    if "_clearance" not in kept:
        kept["_clearance"] = _core.ClearanceField(grid)
    field: _core.ClearanceField = kept["_clearance"]
    return field


def _settings(
    world: Any, mode: str, k_r: float, rho_0: float, scale: float, weight: float, corners: str
) -> tuple[Array, int]:
    """Gain, rho_0 and cap in cells, scale, weight, whether greedy: (6,); and the corner rule's number."""
    if mode not in MODES:
        raise suggest("mode", mode, MODES)
    if not isinstance(corners, str) or corners not in CORNERS:
        raise suggest("corner rule", corners, CORNERS)
    side = float(world.resolution)
    reach, gain = rho_0 / side, k_r / side**3
    s, w = number_of("scale", scale, 0.0), number_of("weight", weight, 1.0)
    cap = float(np.hypot(*world.shape))
    bound = w if mode == "bounded" else 1.0
    return np.array([gain, max(reach, 1e-9), cap, s, bound, float(mode == "greedy")]), CORNERS[corners]


def _repulsion(world: Any, k_r: float | None, rho_0: float | None) -> dict[str, float]:
    """k_r [m³] and rho_0 [m], as given or by default."""
    side = float(world.resolution)
    far = number_of("rho_0", 4 * side if rho_0 is None else rho_0, 0.0)
    if k_r is not None:
        return {"k_r": number_of("k_r", k_r, 0.0), "rho_0": far}
    reach = far / side
    gain = reach / (0.5 * (2 - 1 / reach) ** 2) if reach > 0.5 else 0.0
    return {"k_r": gain * side**3, "rho_0": far}


def number_of(name: str, value: Any, least: float) -> float:
    """One finite number not below its lower bound; InputError names it."""
    number = float(as_floats(value, name).reshape(())) if np.size(value) == 1 else np.nan
    if not number >= least:
        raise InputError(f"{name} is {value!r}; it must be one number of {least:g} or more")
    return number
