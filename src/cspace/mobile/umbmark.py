"""UMBmark: two systematic errors of a differential drive from where square paths end."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sin

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, positive_number
from cspace.errors import InputError, check_kind
from cspace.mobile.wheels import DifferentialDrive
from cspace.tables import one_line, tabulate


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class SquareTest:
    """What UMBmark finds.

    track_ratio: E_b, the true track over the nominal one. diameter_ratio: E_d, of the right wheel over the
    left. track [m]; radii of the left and right wheel [m], their mean unchanged. most_systematic: the larger
    distance [m] of the mean ends from the start, E_max,syst of the source.
    """

    track_ratio: float
    diameter_ratio: float
    track: float
    radii: tuple[float, float]
    most_systematic: float

    def __repr__(self) -> str:
        text = f"track × {self.track_ratio:.5f}, diameters 1 : {self.diameter_ratio:.5f}"
        return one_line("SquareTest", f"{text}, systematic error {self.most_systematic:.3g} m")


def umbmark(
    clockwise: npt.ArrayLike,
    counterclockwise: npt.ArrayLike,
    vehicle: DifferentialDrive,
    *,
    side: float = 4.0,
) -> SquareTest:
    """Track and wheel diameters of a differential drive from where it ended after driving squares both ways.

    The robot starts along x, drives four sides by its own odometry and turns on the spot by 90° at each
    corner. clockwise, counterclockwise: the true end of each run minus the end by odometry, (k, 2) [m].
    vehicle: the nominal drive. side: of the square [m].

    α = −(y_cw − y_ccw)/4L turns too much by its excess at each corner, β = −(y_cw + y_ccw)/4L bends each
    side. E_b = 90°/(90° − α), R = (L/2)/sin(β/2), E_d = (R + b/2)/(R − b/2); α and β are the means of these
    and of the same from x. Source: Borenstein & Feng 1996, type A and type B errors.
    """
    check_kind("vehicle", vehicle, DifferentialDrive, "give a DifferentialDrive(wheel_radius, track)")
    length = positive_number(side, "side")
    cw, ccw = (
        mean_end(ends, name)
        for ends, name in ((clockwise, "clockwise"), (counterclockwise, "counterclockwise"))
    )
    alpha = -((cw[0] + ccw[0]) + (cw[1] - ccw[1])) / (8.0 * length)
    beta = -((cw[0] - ccw[0]) + (cw[1] + ccw[1])) / (8.0 * length)
    track_ratio = (0.5 * pi) / (0.5 * pi - alpha)
    curvature = sin(0.5 * beta) / (0.5 * length)
    half = 0.5 * vehicle.track * curvature
    diameter_ratio = (1.0 + half) / (1.0 - half)
    left = 2.0 / (diameter_ratio + 1.0)
    radius = vehicle.wheel_radius
    return SquareTest(
        track_ratio,
        diameter_ratio,
        track_ratio * vehicle.track,
        (left * radius, left * diameter_ratio * radius),
        float(max(np.hypot(*cw), np.hypot(*ccw))),
    )


def mean_end(ends: npt.ArrayLike, subject: str) -> Array:
    """The mean of ends (k, 2); InputError where there are none."""
    rows = as_floats(ends, subject, last=(2,)).reshape(-1, 2)
    if not len(rows):
        raise InputError(f"{subject} has no runs; give the end of each, (k, 2) [m]")
    return np.asarray(rows.mean(axis=0))
