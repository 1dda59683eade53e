"""Which beams of a scan a filter uses: ends spread evenly along what the scan saw."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.localization.log import Ids, Scans

LONGEST_GAP: Final = 0.5
"""Between the ends of two beams on one wall [m]: across a longer gap nothing was seen, and an end between two
of them is more likely a false one, which counts like any other beam."""


def read_ends(scan: Scans, row: int, least: float, most: float) -> tuple[Array, Ids]:
    """The ends of the beams of a scan in base (m, 2) [m] whose ranges lie between two bounds, in the order of
    their angles, and which beams they are (m,)."""
    ranges = scan.ranges[row]
    beams = np.flatnonzero((ranges >= least) & (ranges < min(most, scan.most)))
    reach, angles = ranges[beams].astype(np.float64), scan.angles[beams]
    in_laser = np.stack([reach * np.cos(angles), reach * np.sin(angles)], axis=-1)
    return in_laser @ scan.T_base_laser[:2, :2].T + scan.T_base_laser[:2, 2], beams


def thin_ends(ends: Array, most: int) -> Ids:
    """At most so many of ends (m, 2) in order, evenly along the line through them: (k,) rows.

    Near walls have more ends per metre than far ones, so every k-th beam would weigh them more.
    """
    if len(ends) <= most:
        return np.arange(len(ends))
    steps = np.hypot(*np.diff(ends, axis=0).T)
    on_wall = steps <= LONGEST_GAP
    if not on_wall.all():
        steps[~on_wall] = np.median(steps[on_wall]) if on_wall.any() else LONGEST_GAP
    along = np.concatenate([[0.0], np.cumsum(steps)])
    rows = np.searchsorted(along, np.linspace(0.0, along[-1], most))
    rows = np.minimum(rows, len(ends) - 1)
    return np.asarray(rows[np.concatenate([[True], rows[1:] > rows[:-1]])])
