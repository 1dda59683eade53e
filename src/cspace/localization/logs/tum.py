"""Trajectories of the TUM RGB-D benchmark: time, position and quaternion per line."""

from __future__ import annotations

import numpy as np

from cspace import tolerances
from cspace.errors import LogError
from cspace.localization.log import Log
from cspace.localization.logs.lines import Lines
from cspace.mobile import Odometry, TimedPoses
from cspace.spatial import rotation

COLUMNS = 8


def read_tum(lines: Lines) -> Log:
    """A trajectory as truth, with the odometry that a perfect robot would have measured.

    Lines `time x y z qx qy qz qw`. Of poses of space x, y and the heading are read; heights and tilts are
    left out and noted. LogError for a quaternion of zero, or times that run backwards.
    """
    rows = lines.table(COLUMNS, "time, x, y, z, qx, qy, qz, qw")
    lengths = np.linalg.norm(rows[:, 4:], axis=1)
    numbers = [number for number, _ in lines.rows()]
    if (lengths == 0).any():
        raise lines.error(numbers[int((lengths == 0).argmax())], "the quaternion is zero; it has no rotation")
    back = np.flatnonzero(np.diff(rows[:, 0]) < 0)
    if len(back):
        raise lines.error(numbers[int(back[0]) + 1], "the time runs backwards; sort the lines by time")
    if not len(rows):
        raise LogError("the file has no poses", path=lines.path)
    R = rotation(xyzw=rows[:, 4:] / lengths[:, None])
    heading = np.arctan2(R[:, 1, 0], R[:, 0, 0])
    times, poses = rows[:, 0] - rows[0, 0], np.column_stack([rows[:, 1:3], heading])
    tilt, height = float(np.arccos(np.clip(R[:, 2, 2], -1, 1)).max()), float(np.ptp(rows[:, 3]))
    notes = []
    if tilt > tolerances.LEVEL_TILT or height > 0:
        notes.append(f"tilts up to {tilt:.3g} rad and heights over {height:.3g} m are left out")
    return Log(Odometry.from_poses(times, poses), truth=TimedPoses(times, poses), notes=tuple(notes))
