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

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cspace import _core
from cspace.navigation.cache import clearance_field
from cspace.navigation.grid.search import CORNERS, SearchPlanner, corners_option
from cspace.search import option
from cspace.tolerances import LEAST_INFLUENCE

MODES: Final = ("exact", "bounded", "greedy")


@dataclass(frozen=True, eq=False)
class PotentialAStar(SearchPlanner):
    """A path over the cells of a grid, found by A* or greedy search with a potential as heuristic.

    The repulsion is capped at the diagonal of the grid. The trace contains the event "settle": the segment
    from a cell's parent to the cell; its value is the cell's potential [m].
    """

    name = "potential_a_star"
    summary = "search over cells with a potential as heuristic"

    mode: str = option("bounded", '"exact", "bounded" or "greedy".', choices=MODES)
    k_r: float | None = option(
        None,
        "repulsion; by default the value with which cells next to walls are rho_0 higher; 0 gives plain A*.",
        unit="m³",
        minimum=0,
    )
    rho_0: float | None = option(
        None, "the distance of influence of walls, four cells by default.", unit="m", minimum=0
    )
    scale: float = option(1.0, "s, the factor of the potential before it is compared.", minimum=0)
    weight: float = option(
        1.5, 'w, the bound on path length relative to the shortest, for "bounded" alone.', minimum=1
    )
    corners: str = corners_option()

    def _fill_in(self, world: Any) -> PotentialAStar:
        side = float(world.resolution)
        far = 4 * side if self.rho_0 is None else self.rho_0
        if self.k_r is not None:
            return self._in_force(rho_0=far)
        reach = far / side
        gain = reach / (0.5 * (2 - 1 / reach) ** 2) if reach > 0.5 else 0.0
        return self._in_force(k_r=gain * side**3, rho_0=far)

    def _settings_of(self, world: Any) -> tuple[float, ...]:
        """Gain, rho_0 and cap in cells, scale, weight, whether greedy, the number of the corner rule."""
        side, given = float(world.resolution), self.values
        cap = float(np.hypot(*world.shape))
        bound = self.weight if self.mode == "bounded" else 1.0
        gain, reach = given["k_r"] / side**3, max(given["rho_0"] / side, LEAST_INFLUENCE)
        return gain, reach, cap, self.scale, bound, self.mode == "greedy", CORNERS[self.corners]

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        settings = clearance_field(world), *self._settings_of(world)
        return _core._potential_a_star(traced, world, world, self, start, goal, *settings)
