"""What the verbs of localisation share: maps and starts as they are typed, pictures, and answers as text."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Final

import numpy as np

from cspace.cli.arguments import add_option, read_radians
from cspace.cli.exits import UsageError
from cspace.cli.output import Output, check_format, check_writable
from cspace.errors import CspaceError

ROS_MAPS: Final = {".yaml", ".yml"}
IMAGES: Final = {".png", ".pgm"}
GRIDS: Final = ROS_MAPS | IMAGES | {".map"}
"""Endings of maps of cells; other files are lists of landmarks."""

OTHER_FRAME: Final = 0.5
"""The error after alignment, over the one before it, below which the frame is what differs."""


def add_pictures(parser: argparse.ArgumentParser, what: str) -> None:
    """--plot and --animate."""
    add_option(parser, "--plot FILE", f"draw {what} (.png, .svg, .pdf)", Path)
    add_option(parser, "--animate FILE.gif", "the drive as a film", Path)


def check_pictures(args: argparse.Namespace) -> None:
    """Refuse files that cannot be written before any work is done for them."""
    for path in (args.plot, args.animate, args.save):
        if path is not None:
            check_writable(path)
    if args.plot is not None:
        check_format(args.plot)
    if args.animate is not None and args.animate.suffix.lower() != ".gif":
        raise UsageError(f"an animation is a GIF file, but {str(args.animate)!r} does not end with .gif")


def load_map(path: Path, resolution: float | None) -> Any:
    """A grid, or Landmarks of a text file. Unknown cells of a ROS map stay unknown: walls they are not."""
    if path.suffix.lower() in ROS_MAPS:
        from cspace.maps import EvidenceGrid

        if resolution is not None:
            raise UsageError(f"--resolution is for images; {path} says how large its cells are")
        return EvidenceGrid.from_ros(path)
    if path.suffix.lower() in IMAGES and resolution is None:
        raise UsageError(f"{path} is an image; say how large its cells are, --resolution 0.05")
    if path.suffix.lower() in GRIDS:
        from cspace.cli.verbs.nav import load_world

        return load_world(path, resolution)
    if resolution is not None:
        raise UsageError(f"--resolution is for images; {path} is a text of landmarks")
    from cspace.localization import Landmarks
    from cspace.localization.log import read_names
    from cspace.localization.logs.lines import read_lines

    lines = read_lines(str(path))
    number, words = next(lines.rows(), (1, []))
    if len(words) not in (3, 5):
        raise lines.error(number, "a map of landmarks has lines NAME X Y, or NAME X Y SX SY")
    rows = lines.table(len(words), "name, x, y and maybe the standard deviations of both")
    spread = None
    if len(words) == 5:
        spread = np.zeros((len(rows), 2, 2))
        spread[:, 0, 0], spread[:, 1, 1] = rows[:, 3] ** 2, rows[:, 4] ** 2
    try:
        return Landmarks(read_names(rows[:, 0], "names", len(rows)), rows[:, 1:3], spread)
    except CspaceError as error:
        raise lines.error(number, str(error)) from None


def read_start(words: list[float], degrees: bool) -> tuple[float, float, float]:
    """The pose of --start X Y THETA."""
    x, y, theta = words
    return x, y, read_radians(theta, degrees=degrees)


def measure_error(answer: Any, truth: Any, align: str | None) -> float | None:
    """The RMSE of the positions [m], or None where no truth is known."""
    if truth is None or not len(truth):
        return None
    from cspace.localization import ate

    return ate(answer, truth, align=align, interpolate=True).rmse


def describe_drive(answer: Any) -> dict[str, Any]:
    """Times, poses and status as JSON data."""
    return {
        "status": answer.status,
        "reason": answer.reason,
        "times": answer.times.tolist(),
        "poses": answer.poses.tolist(),
        "deviations": np.sqrt(np.einsum("nii->ni", answer.covariances).clip(0.0)).tolist(),
    }


def say_errors(answer: Any, truth: Any, error: float | None) -> str:
    """The RMSE, and where the map has another frame than the truth also that after the best motion."""
    aligned = measure_error(answer, truth, "se2") if error is not None else None
    if error is None or aligned is None or aligned > OTHER_FRAME * error:
        return say_length(error)
    return f"{say_length(error)}, {say_length(aligned)} with --align se2: map and truth have other frames"


def draw_drive(args: argparse.Namespace, answer: Any, log: Any, world: Any, align: str | None) -> list[str]:
    """Write the pictures that were asked for; their names."""
    if args.plot is None and args.animate is None:
        return []
    from cspace import plot

    truth = log.truth if log.truth is not None and len(log.truth) else None
    if truth is not None and align is not None:
        truth = bring_truth(truth, answer, align)
    if args.plot is not None:
        plot.save(plot.run(answer, truth=truth, world=world), args.plot)
    if args.animate is not None:
        plot.save(plot.animation(answer, truth=truth, world=world, scans=log.scans), args.animate, dpi=80)
    return [str(path) for path in (args.plot, args.animate) if path is not None]


def bring_truth(truth: Any, answer: Any, align: str) -> Any:
    """The truth in the frame of an answer, which has its own."""
    from cspace.localization import TimedPoses, ate
    from cspace.spatial import inverse_pose_2d, pose_2d, to_xytheta

    T = inverse_pose_2d(ate(answer, truth, align=align, interpolate=True).alignment)
    return TimedPoses(truth.times, to_xytheta(T @ pose_2d(xytheta=truth.poses)))


def print_drive(out: Output, facts: dict[str, str], written: list[str]) -> None:
    """Names and values, and the files."""
    out.facts({name: text for name, text in facts.items() if text})
    for path in written:
        out.line(f"wrote {path}")


def say_length(error: float | None) -> str:
    """An error in metres, nothing where it is unknown."""
    return "" if error is None else f"{error:.4f} m"
