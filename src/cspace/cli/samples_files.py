"""Files of a motion: what several verbs write."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from cspace.cli.exits import UsageError
from cspace.cli.output import check_writable

if TYPE_CHECKING:
    from cspace.trajectory import Trajectory

DEFAULT_RATE: Final = 100.0
"""Samples per second."""

ENDINGS: Final = (".yaml", ".yml", ".csv", ".json")
"""Of files of motions."""


def check_samples_file(path: Path, option: str) -> None:
    """Refuse a file that cannot be written, before any computation."""
    if path.suffix not in ENDINGS:
        raise UsageError(f"{option} {path} ends with {path.suffix!r}; it must be .yaml, .csv or .json")
    check_writable(path)


def check_rate(args: Namespace, target: Path | None, needed: str) -> None:
    """Set the default of --rate; refuse one that nothing is sampled with. needed: what --rate goes with."""
    if args.rate is None:
        args.rate = DEFAULT_RATE
    elif target is None or target.suffix == ".json":
        raise UsageError(f"--rate has no effect without {needed}; add it, or leave --rate out")


def write_samples(motion: Trajectory, path: Path, rate: float) -> None:
    """Write a motion: the motion itself as JSON, or samples as CSV or a JointTrajectory of ROS."""
    from cspace.trajectory import to_csv, to_json, to_ros

    if path.suffix == ".json":
        to_json(motion, path)
        return
    write = to_csv if path.suffix == ".csv" else to_ros
    write(motion, path, rate=rate)
