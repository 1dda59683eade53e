"""Trajectories of the TUM RGB-D benchmark: time, position and quaternion per line."""

from __future__ import annotations

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import LogError
from cspace.localization.log import Log
from cspace.localization.logs.lines import Lines
from cspace.mobile import Odometry, TimedPoses
from cspace.spatial import pose

COLUMNS = 8


def read_tum(lines: Lines) -> Log:
    """A trajectory as truth, with the odometry that a perfect robot would have measured.

    Lines `time x y z qx qy qz qw`. Of poses of space x, y and the heading are read; heights and tilts are
    left out and noted.
    """
    stamps, T = read_tum_poses(lines)
    times, poses = stamps - stamps[0], plan_of_space(T)
    tilt = float(np.arccos(np.clip(T[:, 2, 2], -1, 1)).max())
    height = float(np.ptp(T[:, 2, 3]))
    notes = []
    if tilt > tolerances.LEVEL_TILT or height > 0:
        notes.append(f"tilts up to {tilt:.3g} rad and heights over {height:.3g} m are left out")
    return Log(Odometry.from_poses(times, poses), truth=TimedPoses(times, poses), notes=tuple(notes))


def read_tum_poses(lines: Lines) -> tuple[Array, Array]:
    """The times of the file (n,) and the poses (n, 4, 4).

    LogError for a quaternion of zero, times that run backwards, or no lines at all.
    """
    rows = lines.table(COLUMNS, "time, x, y, z, qx, qy, qz, qw")
    lengths = np.linalg.norm(rows[:, 4:], axis=1)
    lines.refuse(lengths == 0, "the quaternion is zero; it has no rotation")
    backwards = np.diff(rows[:, 0], prepend=rows[:1, 0]) < 0
    lines.refuse(backwards, "the time runs backwards; sort the lines by time")
    if not len(rows):
        raise LogError("the file has no poses", path=lines.path)
    return rows[:, 0], pose(xyz=rows[:, 1:4], xyzw=rows[:, 4:] / lengths[:, None])


def plan_of_space(T: Array) -> Array:
    """Rows x, y and the heading of the x axis: (n, 4, 4) → (n, 3)."""
    return np.column_stack([T[:, :2, 3], np.arctan2(T[:, 1, 0], T[:, 0, 0])])
