"""The Victoria Park data set as lines ODOMETRY and LANDMARK, as gtsam distributes it."""

from __future__ import annotations

import numpy as np

from cspace.localization.log import Log, Readings
from cspace.localization.logs.lines import Lines
from cspace.mobile import Odometry


def read_victoria(lines: Lines) -> Log:
    """Odometry and readings of trees; LogError for a line that is cut, or poses that do not follow each
    other.

    ODOMETRY i j x y θ and the covariance xx xy xθ yy yθ θθ; LANDMARK i l x y and xx xy yy, in base. The lines
    have no times: pose k of the drive is given the time k [s]. Landmarks share their numbering with poses.
    """
    increments: list[list[float]] = []
    seen: list[list[float]] = []  # row of the pose, landmark, x, y
    row_of: dict[int, int] = {}
    for number, words in lines.rows():
        expected = {"ODOMETRY": 12, "LANDMARK": 8}.get(words[0])
        if expected is None:
            raise lines.error(number, f"no record {words[0]!r} is known; expected ODOMETRY or LANDMARK")
        if len(words) != expected:
            raise lines.error(number, f"{words[0]} has {len(words) - 1} values; {expected - 1} expected")
        values = lines.numbers(number, words[1:], words[0])
        first, second = (lines.whole(number, word, "an id") for word in words[1:3])
        if not increments and words[0] == "ODOMETRY":
            row_of[first] = 0
        if first not in row_of:
            raise lines.error(number, f"pose {first} was not reached by an ODOMETRY line before")
        if words[0] == "LANDMARK":
            seen.append([row_of[first], second, *values[2:4]])
        elif row_of[first] != len(increments):
            raise lines.error(number, f"ODOMETRY goes on from pose {first}, not from the last one")
        else:
            increments.append(values[2:5])
            row_of[second] = len(increments)
    rows = np.array(seen, dtype=np.float64).reshape(-1, 4)
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    readings = Readings(
        rows[:, 0],
        rows[:, 1].astype(np.int64),
        np.hypot(rows[:, 2], rows[:, 3]),
        np.arctan2(rows[:, 3], rows[:, 2]),
    )
    odometry = Odometry.from_increments(
        np.arange(len(increments) + 1.0), np.array(increments, dtype=np.float64).reshape(-1, 3)
    )
    notes = (
        "the lines have no times: one second per step",
        "the covariances of the lines are not read",
    )
    return Log(odometry, readings=readings, notes=notes)
