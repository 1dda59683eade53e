"""What is evaluated: poses of the plane or of space, with times or without, from arrays, answers, files."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.files import path_of
from cspace.localization.graph.checks import read_poses
from cspace.localization.log import Log
from cspace.localization.logs.lines import read_lines
from cspace.localization.logs.mrclam import is_mrclam, list_robots
from cspace.localization.logs.pose_files import PoseFile, read_pose_file
from cspace.localization.logs.read_log import read_by_content, read_log
from cspace.mobile.timed_poses import read_times
from cspace.spatial import embed_pose_2d, pose_2d, to_xytheta


@dataclass(frozen=True)
class Track:
    """Poses T (n, 3, 3) or (n, 4, 4), and times (n,) or None where the rows themselves correspond."""

    times: Array | None
    T: Array
    file: PoseFile | None = None

    def __len__(self) -> int:
        """How many poses there are."""
        return len(self.T)

    @property
    def is_spatial(self) -> bool:
        """Whether the poses are those of space."""
        return bool(self.T.shape[-1] == 4)

    def in_plane(self) -> Track:
        """x, y and the heading; of a file of KITTI x and z."""
        if not self.is_spatial:
            return self
        plan = PoseFile(np.zeros(0), self.T) if self.file is None else self.file
        return Track(self.times, pose_2d(xytheta=plan.plan()))

    def in_space(self) -> Track:
        """Planar poses at height 0."""
        return self if self.is_spatial else Track(self.times, np.asarray(embed_pose_2d(self.T)))

    def rows(self, chosen: Any) -> Track:
        """The poses of some rows."""
        return Track(None if self.times is None else self.times[chosen], self.T[chosen])

    def flat(self) -> Array:
        """Rows x, y, θ (n, 3), or the poses (n, 4, 4)."""
        return self.T if self.is_spatial else np.asarray(to_xytheta(self.T))


def read_track(value: Any, subject: str) -> Track:
    """The poses of TimedPoses, of an answer, of a log (its truth), of an array, or of a file."""
    if isinstance(value, (str, os.PathLike)):
        return read_file(path_of(value), subject)
    if isinstance(value, Log):
        if value.truth is None:
            raise InputError(f"{subject} is a log without reference poses (truth); give poses")
        value = value.truth
    given = getattr(value, "poses", value)
    if given is None or isinstance(given, (bytes, dict, set)):
        raise InputTypeError(
            f"{subject} is {name_type(value)}; give an object with poses, an array (n, 3), or a file"
        )
    rows = read_poses(given, subject)
    if not len(rows):
        raise InputError(f"{subject} has no poses; there is nothing to compare")
    times = getattr(value, "times", None)
    if times is not None:
        times = read_times(times, f"times of {subject}")
        if len(times) != len(rows):
            raise InputError(f"{subject} has {len(rows)} poses and {len(times)} times; give one per pose")
    return Track(times, rows if rows.ndim == 3 else pose_2d(xytheta=rows))


def read_file(path: str, subject: str) -> Track:
    """The poses of a file of TUM, KITTI or CSV, or the truth of a log."""
    if not os.path.isdir(path):
        lines = read_lines(path)
        found = read_pose_file(lines)
        if found is not None:
            return Track(found.times, found.poses, found)
        return read_track(read_by_content(lines), f"{subject} {path}")
    robots = list_robots(Path(path)) if is_mrclam(Path(path)) else []
    if len(robots) > 1:
        named = ", ".join(map(str, robots))
        raise InputError(
            f"{subject} {path} holds robots {named}; say which one: robot= of cspace.read_log, or --robot"
        )
    return read_track(read_log(path), f"{subject} {path}")
