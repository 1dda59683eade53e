"""What the simulator answers: where the vehicle went, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import name_type
from cspace.mobile import Car
from cspace.tables import one_line, tabulate

OUTCOMES: Final = ("arrived", "stuck", "collision", "timeout", "missed")
"""How a run may end, in the order of the compiled core."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Run:
    """One run of a vehicle, a row per step of the simulator; truthy if it arrived.

    times (n,) [s]. poses (n, 3): x, y [m], theta [rad]. controls (n, 2): the speed [m/s] and the turn of the
    step that led there, of a car its steering angle [rad], of a unicycle its turn rate [rad/s]. cross_track
    (n,) [m]: distance from the path, above zero to its left, of the point that the controller guides: the
    front axle for Stanley, else the place of the vehicle. progress (n,) [m]: how far along the path. status:
    "arrived"; "stuck", where it came no farther along the path for too long; "collision", at whose first
    touch the run ends; "timeout"; "missed", where it stopped at the end of the path but beside it. believed
    (n, 3): where the vehicle took itself to be, at its poses unless `estimate` said otherwise; cross_track
    and progress are those of these poses.
    """

    vehicle: Any
    controller: str
    times: Array
    poses: Array
    controls: Array
    cross_track: Array
    progress: Array
    status: str
    believed: Array
    _goal: Array
    _tightest: float = np.inf  # the least radius of a bend of the path [m]

    def __bool__(self) -> bool:
        return self.status == "arrived"

    def __len__(self) -> int:
        """How many steps there are."""
        return len(self.times)

    @property
    def path(self) -> Array:
        """Where the vehicle went, (n, 2) [m]."""
        return self.poses[:, :2]

    @property
    def reason(self) -> str:
        """The end of the run as one sentence."""
        missing = float(np.hypot(*(self.poses[-1, :2] - self._goal)))
        at = f"after {self.times[-1]:.4g} s"
        if self.status == "arrived":
            return f"arrived {at}, {missing:.2g} m from the end of the path"
        if self.status == "collision":
            x, y = self.poses[-1, :2]
            return (
                f"touched an obstacle {at}, at ({x:.4g}, {y:.4g}), {missing:.4g} m before the end of the path"
            )
        if self.status == "missed":
            return f"stopped {at} next to the end of the path, {missing:.2g} m from it{self._hint}"
        if self.status == "stuck":
            return f"came no farther along the path {at}, {missing:.4g} m before its end{self._hint}"
        return f"the time limit was reached {at}, {missing:.4g} m before the end of the path"

    @property
    def _hint(self) -> str:
        """The cause if the path bends more tightly than a car can turn, or bends under Stanley."""
        if not isinstance(self.vehicle, Car):
            return ""
        if self._tightest >= self.vehicle.turning_radius:
            cuts = (
                "; the front axle is guided, and the rear axle cuts bends (pure_pursuit guides the rear axle)"
            )
            return cuts if self.controller == "stanley" else ""
        radius = f"a bend of the path has a radius of {self._tightest:.2g} m"
        return f"; {radius}, the car needs {self.vehicle.turning_radius:.2g} m (hybrid_a_star keeps to it)"

    def __repr__(self) -> str:
        return one_line("Run", f"of {name_type(self.vehicle)} by {self.controller}: {self.reason}")
