"""Files of a motion: what several verbs write."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from cspace.cli.exits import UsageError
from cspace.cli.output import check_writable

if TYPE_CHECKING:
    from cspace.trajectory import Trajectory

ENDINGS: Final = (".yaml", ".yml", ".csv", ".json")
"""Of files of motions."""


def check_samples_file(path: Path, option: str) -> None:
    """Refuse a file that cannot be written, before any computation."""
    if path.suffix not in ENDINGS:
        raise UsageError(f"{option} {path} ends with {path.suffix!r}; it must be .yaml, .csv or .json")
    check_writable(path)


def write_samples(motion: Trajectory, path: Path, rate: float) -> None:
    """Write a motion: the motion itself as JSON, or samples as CSV or a JointTrajectory of ROS."""
    from cspace.trajectory import to_csv, to_json, to_ros

    if path.suffix == ".json":
        to_json(motion, path)
        return
    write = to_csv if path.suffix == ".csv" else to_ros
    write(motion, path, rate=rate)
