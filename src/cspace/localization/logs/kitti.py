"""Trajectories of the KITTI odometry benchmark: twelve numbers per line, the poses of a camera."""

from __future__ import annotations

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import LogError
from cspace.localization.log import Log
from cspace.localization.logs.lines import Lines
from cspace.mobile import Odometry, TimedPoses
from cspace.spatial import project_rotation

COLUMNS = 12


def read_kitti(lines: Lines) -> Log:
    """A trajectory in the plan of a camera as truth, with the odometry that a perfect robot would have
    measured.

    The frame of a camera has z forwards and y down, so the plan is (x, z), seen from above. Heights and tilts
    are left out and noted. The lines have no times: pose k has the time k [s].
    """
    T = read_kitti_poses(lines)
    times, poses = np.arange(len(T), dtype=np.float64), plan_of_camera(T)
    notes = ["the lines have no times: one second per pose", "the plan is x, z of the camera"]
    tilt = float(np.arccos(np.clip(T[:, 1, 1], -1, 1)).max())
    height = float(np.ptp(T[:, 1, 3]))
    if tilt > tolerances.LEVEL_TILT or height > 0:
        notes.append(f"tilts up to {tilt:.3g} rad and heights over {height:.3g} m are left out")
    return Log(Odometry.from_poses(times, poses), truth=TimedPoses(times, poses), notes=tuple(notes))


def read_kitti_poses(lines: Lines) -> Array:
    """The poses of the lines (n, 4, 4); LogError where the first three columns are no rotation."""
    rows = lines.table(COLUMNS, "the upper three rows of a pose")
    if not len(rows):
        raise LogError("the file has no poses", path=lines.path)
    T = np.tile(np.eye(4), (len(rows), 1, 1))
    T[:, :3] = rows.reshape(-1, 3, 4)
    R = T[:, :3, :3]
    miss = np.abs(R @ np.swapaxes(R, 1, 2) - np.eye(3)).max(axis=(1, 2))
    is_bad = (miss > tolerances.PRINTED_ROTATION) | (np.linalg.det(R) < 0)
    lines.refuse(is_bad, "the first three columns of the matrix are no rotation")
    T[:, :3, :3] = project_rotation(R)
    return T


def plan_of_camera(T: Array) -> Array:
    """Rows x, z and the heading of the viewing direction in that plane: (n, 4, 4) → (n, 3)."""
    return np.column_stack([T[:, 0, 3], T[:, 2, 3], np.arctan2(T[:, 2, 2], T[:, 0, 2])])


def camera_of_plan(poses: Array) -> Array:
    """The inverse of `plan_of_camera`, level and at height 0: (n, 3) → (n, 4, 4)."""
    T = np.tile(np.eye(4), (len(poses), 1, 1))
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    T[:, 0, 3], T[:, 2, 3] = poses[:, 0], poses[:, 1]
    T[:, 0, 0], T[:, 0, 2], T[:, 2, 0], T[:, 2, 2] = s, c, -c, s
    return T
