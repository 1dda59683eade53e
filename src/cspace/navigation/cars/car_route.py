"""The result of hybrid A*: a path of a car, or the reason why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import Renamed
from cspace.navigation.curves.curve import Curve
from cspace.navigation.route import Stats
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import CAR_POSES

REASONS: Final = (
    "found",
    "unreachable: not even a disc within the vehicle passes from start to goal",
    "no path on this lattice: every reachable pose was expanded; try a smaller box",
    "stopped after max_nodes poses; increase max_nodes or box",
)
"""The reasons for the end of a search, in the order of the compiled core."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class CarRoute(Renamed):
    """The result of hybrid A*; truthy if a path was found.

    curve: the path as segments, None without one. start, goal (3,): x, y [m] and theta [rad]. status:
    "found", "unreachable" (proven) or "undetermined". stats: poses expanded, segments tested, seconds.
    """

    grid: Any
    vehicle: Any
    start: Array
    goal: Array
    curve: Curve | None
    status: str
    stats: Stats
    _cause: int

    def __bool__(self) -> bool:
        return self.curve is not None

    @property
    def length(self) -> float:
        """Length of the path [m], the sum of forward and reverse driving; inf without one."""
        return np.inf if self.curve is None else self.curve.length

    @cached_property
    def poses(self) -> Array:
        """Poses along the path, (m, 3), a twentieth of the turning radius apart; (0, 3) without one."""
        if self.curve is None:
            return np.empty((0, 3))
        return self.curve.sample(self.curve.radius / CAR_POSES)

    @property
    def path(self) -> Array:
        """Positions along the path, (m, 2) [m], of its poses."""
        return self.poses[:, :2]

    @property
    def reason(self) -> str:
        """The verdict as one sentence."""
        if self.curve is None:
            return REASONS[self._cause]
        changes = len(self.curve.cusps)
        gears = count_things(changes, "change") + " of direction" if changes else "one direction"
        return f"found, {self.length:.6g} m in {gears}"

    def __repr__(self) -> str:
        return one_line("CarRoute", self.reason)
