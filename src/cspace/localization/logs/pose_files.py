"""Files of poses: TUM, KITTI and CSV, read and written."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, LogError, check_known
from cspace.files import path_of, write_text
from cspace.localization.graph.checks import read_poses as read_pose_rows
from cspace.localization.logs import kitti, tum
from cspace.localization.logs.csv_poses import find_heading, read_csv_poses
from cspace.localization.logs.lines import Lines, is_number, read_lines
from cspace.mobile import TimedPoses
from cspace.spatial import to_xyzw
from cspace.tolerances import LARGEST_LOGGED

FORMATS = ("tum", "kitti", "csv")


@dataclass(frozen=True)
class PoseFile:
    """What a file of poses holds: times (n,) of TUM and CSV, or None of KITTI, and poses (n, 4, 4)."""

    times: Array | None
    poses: Array

    def plan(self) -> Array:
        """Rows x, y, θ (n, 3); of KITTI, whose frame is that of a camera, x and z."""
        return kitti.plan_of_camera(self.poses) if self.times is None else tum.plan_of_space(self.poses)


def read_poses(path: str | os.PathLike[str]) -> TimedPoses:
    """The planar poses of a file of TUM, KITTI or CSV, with the times of the file.

    path: lines `time x y z qx qy qz qw`; or twelve numbers, the upper rows of the pose of a camera, whose
    plan is x, z, where pose k has the time k [s]; or a table under a heading that names time, x, y and theta,
    or time, x, y, z, qx, qy, qz and qw, in any order. Raises LogError with file and line for anything else.
    """
    lines = read_lines(path_of(path, "a file of poses is given by its path"))
    found = read_pose_file(lines)
    if found is None:
        text = "the lines have neither 8 columns (TUM) nor 12 (KITTI), nor a heading that names them (CSV)"
        raise LogError(text, path=lines.path)
    times = np.arange(len(found.poses), dtype=np.float64) if found.times is None else found.times
    return TimedPoses(times, found.plan())


def read_pose_file(lines: Lines) -> PoseFile | None:
    """The poses of a file, or None if its first line is that of another format."""
    heading = find_heading(lines)
    if heading is not None:
        return PoseFile(*read_csv_poses(lines, heading)[:2])
    _, words = next(lines.rows(), (0, [""]))
    if not all(map(is_number, words)) or len(words) not in (tum.COLUMNS, kitti.COLUMNS):
        return None
    if len(words) == kitti.COLUMNS:
        return PoseFile(None, kitti.read_kitti_poses(lines))
    return PoseFile(*tum.read_tum_poses(lines))


def write_poses(path: str | os.PathLike[str], poses: Any, *, format: str = "tum") -> None:
    """Write poses to a file that `read_poses` and other tools read.

    poses: TimedPoses, a Localization, or anything with `times` (n,) and `poses` (n, 3) or (n, 4, 4). format:
    "tum" (time, position, quaternion), "kitti" (twelve numbers without time; planar poses become x, z of a
    camera), or "csv" (time, x, y, theta, and of poses (n, 4, 4) time, position, quaternion, under their
    names). Numbers are written with all their digits. Raises InputError for poses without times, but of
    KITTI, for none, and for numbers that are too large to be read.
    """
    check_known("format", format, FORMATS)
    rows = read_pose_rows(getattr(poses, "poses", poses), "poses")
    times = getattr(poses, "times", None)
    if format == "kitti":
        T = kitti.camera_of_plan(rows) if rows.ndim == 2 else rows
        numbers = T[:, :3].reshape(-1, kitti.COLUMNS)
    elif times is None:
        needs = format.upper()
        raise InputError(f'poses have no times, which {needs} needs; give TimedPoses, or format="kitti"')
    else:
        stamps = TimedPoses(times, np.zeros((len(rows), 3))).times
        is_table = format == "csv" and rows.ndim == 2
        numbers = np.column_stack([stamps, rows if is_table else list_quaternions(rows)])
    if not len(numbers):
        raise InputError("there are no poses to write; a file needs one at least")
    as_floats(numbers, "the table of poses", largest=LARGEST_LOGGED)
    separator, heading = " ", ""
    if format == "csv":
        separator = ","
        heading = "time,x,y,theta\n" if rows.ndim == 2 else "time,x,y,z,qx,qy,qz,qw\n"
    text = heading + "".join(separator.join(map(repr, row)) + "\n" for row in numbers.tolist())
    write_text(path_of(path), text)


def list_quaternions(poses: Array) -> npt.NDArray[np.float64]:
    """Positions and quaternions x, y, z, w of poses (n, 3) or (n, 4, 4): (n, 7)."""
    if poses.ndim == 3:
        return np.concatenate([poses[:, :3, 3], to_xyzw(poses[:, :3, :3])], axis=1)
    half, zero = 0.5 * poses[:, 2], np.zeros(len(poses))
    return np.column_stack([poses[:, :2], zero, zero, zero, np.sin(half), np.cos(half)])
