"""Gates: quantiles of χ², and which landmark a reading without a name belongs to."""

from __future__ import annotations

from functools import cache
from math import erf, exp, pi, sqrt

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.localization.filters.measurements import linearize_points, see_point
from cspace.localization.log import Landmarks
from cspace.localization.sensors import RangeBearing
from cspace.math.wrapping import wrap_angle


@cache
def chi2_quantile(share: float, dof: int) -> float:
    """The value below which a share of χ² with 1, 2 or 3 degrees of freedom lies, by bisection."""
    if dof not in (1, 2, 3):
        raise InputError(f"dof is {dof}; gates are for measurements of 1, 2 or 3 numbers")
    low, high = 0.0, 1.0
    while chi2_share(high, dof) < share and high < LARGEST_GATE:
        high *= 2.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if chi2_share(middle, dof) < share else (low, middle)
    return high


LARGEST_GATE = 1e4
"""χ² whose tail is below the rounding of a share."""
BISECTIONS = 100
"""Halvings that reach the last digit."""


def chi2_share(value: float, dof: int) -> float:
    """The share of χ² below a value, in closed form."""
    if dof == 2:
        return 1.0 - exp(-0.5 * value)
    tail = sqrt(2.0 * value / pi) * exp(-0.5 * value) if dof == 3 else 0.0
    return erf(sqrt(0.5 * value)) - tail


def associate_reading(
    pose: Array,
    P: Array,
    value: Array,
    used: npt.NDArray[np.intp],
    landmarks: Landmarks,
    sensor: RangeBearing,
) -> int:
    """The row of the landmark that most likely made a reading, among those that the sensor can see; −1
    without any.

    Least νᵀ S⁻¹ ν + log det S (maximum likelihood). The gate is tested afterwards, as for named readings.
    """
    by_point, H, noise = linearize_points(landmarks.points, pose, sensor)
    p = see_point(landmarks.points, pose, sensor.mount)
    seen = np.stack([np.hypot(p[:, 0], p[:, 1]), np.arctan2(p[:, 1], p[:, 0])], axis=-1)
    in_view = (seen[:, 0] <= sensor.most_range) & (np.abs(seen[:, 1]) <= 0.5 * sensor.field_of_view)
    if not in_view.any():
        return -1
    nu = value - seen[:, used]
    nu[:, used == 1] = wrap_angle(nu[:, used == 1])
    S = (H @ P @ np.swapaxes(H, 1, 2) + noise)[:, used][:, :, used]
    if landmarks.covariances is not None:
        turn = pose[2] + sensor.mount[2]
        c, s = np.cos(turn), np.sin(turn)
        J = (by_point @ np.array([[c, s], [-s, c]]))[:, used]
        S = S + J @ landmarks.covariances @ np.swapaxes(J, 1, 2)
    cost = np.einsum("ni,ni->n", nu, np.linalg.solve(S, nu[..., None])[..., 0]) + np.linalg.slogdet(S)[1]
    cost[~in_view] = np.inf
    return int(np.argmin(cost))
