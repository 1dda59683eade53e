"""A sensor of landmarks from a log with reference poses: biases, deviations, delay."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, check_kind
from cspace.localization.filters.measurements import see_point
from cspace.localization.log import UNKNOWN, Landmarks, Readings
from cspace.localization.sensors import RangeBearing
from cspace.math.wrapping import wrap_angle
from cspace.mobile import TimedPoses
from cspace.mobile.timed_poses import NO_REFERENCE

MOST_DELAY: Final = 0.5
"""Largest delay [s], either way, that is tried."""
DELAY_STEP: Final = 0.01
"""Between two delays that are tried [s]."""
FEWEST_READINGS: Final = 20
"""Readings below which deviations are not determined."""
NORMAL_MEDIAN: Final = 1.4826
"""The standard deviation of a normal distribution over the median of its absolute deviations."""


def calibrate_sensor(
    readings: Readings, landmarks: Landmarks, reference: TimedPoses, *, max_gap: float = 1.0
) -> RangeBearing:
    """Biases, deviations and delay of a sensor of landmarks, from reference poses (n, 3).

    Biases are medians of the residuals, deviations 1.4826 times the median of their distances from it, so
    that false readings do not count; the delay is that of the least deviation of the bearings. max_gap:
    longest gap of the reference to interpolate in [s]. Raises InputError for fewer than 20 readings that can
    be compared.
    """
    check_kind("readings", readings, Readings, "give cspace.localization.Readings, such as log.readings")
    check_kind("landmarks", landmarks, Landmarks, "give cspace.localization.Landmarks, such as log.landmarks")
    check_kind("reference", reference, TimedPoses, NO_REFERENCE)
    named = readings.subset(readings.landmark != UNKNOWN)
    points = landmarks.points[landmarks.rows_of(named.landmark)]

    def compare(delay: float) -> tuple[Array, Array]:
        poses = reference.at(named.times - delay, max_gap=max_gap)
        p = see_point(points, poses, (0.0, 0.0, 0.0))
        far = named.range - np.hypot(p[:, 0], p[:, 1])
        return far, wrap_angle(named.bearing - np.arctan2(p[:, 1], p[:, 0]))

    delays = np.arange(-MOST_DELAY, MOST_DELAY + 0.5 * DELAY_STEP, DELAY_STEP)
    spreads = [measure_spread(compare(delay)[1])[1] for delay in delays]
    delay = float(delays[int(np.nanargmin(spreads))]) if np.isfinite(spreads).any() else 0.0
    ranges, bearings = compare(delay)
    count = int(np.isfinite(ranges).sum() + np.isfinite(bearings).sum())
    if count < FEWEST_READINGS:
        raise InputError(
            f"{count} readings of named landmarks have a reference pose; {FEWEST_READINGS} are needed"
        )
    (range_bias, range_sigma), (bearing_bias, bearing_sigma) = map(measure_spread, (ranges, bearings))
    fallback = RangeBearing()
    return RangeBearing(
        range_sigma=range_sigma if range_sigma > 0 else fallback.range_sigma,
        bearing_sigma=bearing_sigma if bearing_sigma > 0 else fallback.bearing_sigma,
        range_bias=0.0 if np.isnan(range_bias) else range_bias,
        bearing_bias=0.0 if np.isnan(bearing_bias) else bearing_bias,
        delay=round(delay, 3),
    )


def measure_spread(residuals: Array) -> tuple[float, float]:
    """Median and robust standard deviation of numbers that are not NaN; NaN without any."""
    known = residuals[np.isfinite(residuals)]
    if not len(known):
        return float("nan"), float("nan")
    middle = float(np.median(known))
    return middle, float(NORMAL_MEDIAN * np.median(np.abs(known - middle)))
