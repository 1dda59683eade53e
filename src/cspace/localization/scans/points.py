"""Points of scans in base: read, thinned along the walls, and put right for the motion during a scan."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace._core import thin_scans
from cspace.arrays import Array, one_array
from cspace.errors import InputError
from cspace.localization.log import Scans
from cspace.mobile import Odometry
from cspace.spatial import exp_se2, to_xytheta

MOST_BEAMS: Final = 180
"""Points of a scan that are matched: more of them cost time and tell hardly anything new."""
NEAREST: Final = 0.1
"""Ranges below this [m] are reflections within the housing or on the robot."""


def read_scan(scan: Any, subject: str) -> Array:
    """The points (m, 2) of one scan, or points as they are; InputError for others, or none."""
    if isinstance(scan, Scans):
        if len(scan) != 1:
            raise InputError(f"{subject} has {len(scan)} scans; give one, such as log.scans[7]")
        points = scan.points(0)
    else:
        points = one_array(scan, subject, (None, 2), "rows x, y of points in base")
    if not len(points):
        raise InputError(f"{subject} has no points; a scan without returns cannot be matched")
    return np.ascontiguousarray(points)


def thin_scan(points: Array, most: int) -> Array:
    """At most so many points of one scan (m, 2) in the order of its beams, evenly spread along the walls."""
    kept, _ = thin_scans(points, np.array([0, len(points)], np.int32), most)
    return np.asarray(kept)


def place_beams(scans: Scans, odometry: Odometry, max_range: float) -> tuple[Array, npt.NDArray[np.int32]]:
    """The points of all scans in base at their times (M, 2), and the row at which each scan begins (n + 1,).

    Where the beams of a scan follow one another by scans.time_increment, each is moved by the twist of the
    odometry from its own time to that of the scan. Points beyond max_range [m] are left out.
    """
    heading = find_heading(scans.T_base_laser)
    directions = np.stack([np.cos(scans.angles + heading), np.sin(scans.angles + heading)], axis=-1)
    twists = None
    if scans.time_increment and len(odometry):
        twists = scans.time_increment * find_twists(odometry, scans.times)
    returns = scans.returns
    parts: list[Array] = []
    counts = [np.zeros(1, np.int32)]
    for begin in range(0, len(scans), SCANS_AT_ONCE):
        some = slice(begin, begin + SCANS_AT_ONCE)
        near = returns[some] & (scans.ranges[some] <= max_range) & (scans.ranges[some] > NEAREST)
        row, beam = np.nonzero(near)
        ranges = scans.ranges[some][row, beam].astype(np.float64)
        points = ranges[:, None] * directions[beam] + scans.T_base_laser[:2, 2]
        if twists is not None:
            T = exp_se2(twists[some][row] * beam[:, None])
            points = np.einsum("kij,kj->ki", T[:, :2, :2], points) + T[:, :2, 2]
        first = np.concatenate([[0], np.cumsum(near.sum(axis=1))]).astype(np.int32)
        kept, begins = thin_scans(np.ascontiguousarray(points), first, MOST_BEAMS)
        parts.append(np.asarray(kept).reshape(-1, 2))
        counts.append(np.diff(begins))
    return np.concatenate(parts), np.cumsum(np.concatenate(counts), dtype=np.int32)


SCANS_AT_ONCE: Final = 128
"""Scans whose points are placed together: a few milliseconds between two looks at Ctrl-C and time limits."""


def find_heading(T: Array) -> float:
    """The heading of a pose (3, 3) [rad]."""
    return float(np.arctan2(T[1, 0], T[0, 0]))


def find_twists(odometry: Odometry, times: Array) -> Array:
    """The body twists (k, 3) of the steps of odometry in which times (k,) lie."""
    step = np.searchsorted(odometry.times, times, side="right") - 1
    return np.asarray(odometry.twists[np.clip(step, 0, len(odometry) - 1)])


def find_view(scans: Scans) -> tuple[float, float, Array]:
    """The first direction of the laser and the span of all of them [rad], and its pose on the robot (3,):
    x, y [m], θ [rad]. Beams on both sides of a gap as wide as others see all around."""
    low, high = float(scans.angles.min()), float(scans.angles.max())
    gaps = np.diff(np.sort(scans.angles))
    widest = float(gaps.max()) if len(gaps) else 0.0
    is_whole = high - low + GAP * widest >= 2 * np.pi
    return low, 2 * np.pi if is_whole else high - low, np.asarray(to_xytheta(scans.T_base_laser))


GAP: Final = 1.5
"""The gap between the last beam and the first in widest gaps between beams: more is an edge of the view."""
