"""Which poses of two trajectories belong together: those of nearest times, or interpolated ones."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, truth_value
from cspace.errors import InputError
from cspace.localization.evaluation.tracks import Track
from cspace.mobile import TimedPoses
from cspace.spatial import interpolate_decoupled, pose_2d, to_xytheta

Rows = npt.NDArray[np.intp]


def associate_tracks(
    estimate: Track, truth: Track, *, interpolate: bool, max_difference: float, max_gap: float
) -> tuple[Track, Track]:
    """Both trajectories with equally many poses, row by row those of the same time.

    The one with fewer poses keeps its times. Without times of one or both the rows correspond. InputError if
    nothing does.
    """
    if estimate.times is None or truth.times is None:
        if len(estimate) != len(truth):
            without = "the estimate" if estimate.times is None else "the truth"
            raise InputError(
                f"{without} has no times, and there are {len(estimate)} poses of the estimate and"
                f" {len(truth)} of the truth; give times, or a pose per pose"
            )
        return estimate, truth
    is_truth_shorter = len(estimate) > len(truth)
    short, long = (truth, estimate) if is_truth_shorter else (estimate, truth)
    assert short.times is not None
    assert long.times is not None
    if truth_value(interpolate, "interpolate"):
        found = interpolate_track(long, short.times, max_gap)
        known = np.flatnonzero(np.isfinite(found[:, 0, 0]))
        first, second = short.rows(known), Track(short.times[known], found[known])
    else:
        of_short, of_long = match_times(short.times, long.times, max_difference)
        first, second = short.rows(of_short), long.rows(of_long)
    if not len(first):
        raise InputError(describe_mismatch(estimate.times, truth.times, interpolate, max_difference))
    return (second, first) if is_truth_shorter else (first, second)


def match_times(times: Array, others: Array, most: float) -> tuple[Rows, Rows]:
    """Rows of times (n,) and of the nearest of other times (m,), where they differ by at most `most`."""
    after = np.searchsorted(others, times, side="right")
    before = np.clip(after - 1, 0, None)
    after = np.clip(after, None, len(others) - 1)
    is_before = np.abs(times - others[before]) <= np.abs(others[after] - times)
    nearest = np.where(is_before, before, after)
    kept = np.flatnonzero(np.abs(times - others[nearest]) <= most)
    return kept, nearest[kept]


def interpolate_track(track: Track, times: Array, max_gap: float) -> Array:
    """Poses at times (n, d, d), the heading the short way; NaN outside, and in gaps longer than max_gap."""
    assert track.times is not None
    if not track.is_spatial:
        rows = TimedPoses(track.times, to_xytheta(track.T)).at(times, max_gap=max_gap)
        return unless_nan(rows)
    before = np.clip(np.searchsorted(track.times, times, side="right") - 1, 0, len(track) - 1)
    after = np.clip(np.searchsorted(track.times, times, side="left"), 0, len(track) - 1)
    span = track.times[after] - track.times[before]
    share = np.divide(times - track.times[before], span, out=np.zeros_like(times), where=span > 0)
    found = np.array(interpolate_decoupled(track.T[before], track.T[after], np.clip(share, 0.0, 1.0)))
    found[(times < track.times[0]) | (times > track.times[-1]) | (span > max_gap)] = np.nan
    return found


def unless_nan(rows: Array) -> Array:
    """Poses (n, 3, 3) of rows x, y, θ, NaN where the rows are."""
    known = np.isfinite(rows[:, 0])
    found = np.full((len(rows), 3, 3), np.nan)
    found[known] = pose_2d(xytheta=rows[known])
    return found


def describe_mismatch(estimate: Array, truth: Array, interpolate: bool, most: float) -> str:
    """Why no poses correspond, with a remedy."""
    spans = (
        f"the estimate spans {estimate[0]:.9g} to {estimate[-1]:.9g} s and the truth {truth[0]:.9g} to"
        f" {truth[-1]:.9g} s"
    )
    if estimate[-1] < truth[0] or truth[-1] < estimate[0] or interpolate:
        return f"no times correspond: {spans}; give both by one clock"
    return f"no times are within {most:g} s of each other: {spans}; try interpolate=True"
