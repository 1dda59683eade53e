"""`cspace evaluate`: absolute and relative errors of a trajectory."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.arguments import add_option, read_number
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table

if TYPE_CHECKING:
    from cspace.localization import PoseErrors

EXAMPLES: Final = """
cspace evaluate found.tum small_drive
cspace evaluate found.tum small_drive --align none --interpolate --rpe 1 m --rpe 5 s --json
"""

ALIGNMENTS: Final = ("se2", "se3", "none")


def arguments(parser: argparse.ArgumentParser) -> None:
    text = "trajectory: TUM, KITTI, CSV, or a log whose reference poses count"
    parser.add_argument("estimate", metavar="EST", type=Path, help=f"estimated {text}")
    parser.add_argument("truth", metavar="TRUTH", type=Path, help=f"true {text}")
    add_option(parser, "--robot N", "which robot of an MRCLAM folder", int)
    text = "the motion that is taken out first: in the plane, in space, or none (default: se2)"
    add_option(parser, "--align", text, choices=ALIGNMENTS, default="se2")
    text = "relative errors over DELTA m, s or frames; may be repeated (default: 1 m)"
    parser.add_argument("--rpe", nargs=2, action="append", metavar=("DELTA", "UNIT"), help=text)
    add_option(parser, "--interpolate", "interpolate the denser trajectory instead of taking nearest times")
    text = "the most that the times of two poses of a pair differ [s] (default: 0.01)"
    add_option(parser, "--max-difference S", text, read_number, default=0.01)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the errors in one table."""
    from cspace.localization import ate, rpe

    options: dict[str, Any] = {
        "align": None if args.align == "none" else args.align,
        "interpolate": args.interpolate,
        "max_difference": args.max_difference,
    }
    stretches = [read_stretch(*words) for words in args.rpe or [["1", "m"]]]
    estimate, truth = (choose_robot(path, args.robot) for path in (args.estimate, args.truth))
    absolute = ate(estimate, truth, **options)
    relative = [rpe(estimate, truth, delta=delta, unit=unit, **options) for delta, unit in stretches]
    if out.as_json:
        out.document(
            {
                "schema": "cspace.evaluate/1",
                "estimate": str(args.estimate),
                "truth": str(args.truth),
                "align": options["align"],
                "ate": describe_errors(absolute),
                "rpe": [
                    {"delta": delta, "unit": unit, **describe_errors(found)}
                    for (delta, unit), found in zip(stretches, relative, strict=True)
                ],
                "alignment": absolute.alignment.tolist(),
            }
        )
    else:
        print_errors(out, [absolute, *relative])
    return Exit.DONE


def choose_robot(path: Path, robot: int | None) -> Any:
    """The log of one robot of a folder, or the path of any other trajectory."""
    from cspace.localization import read_log

    return read_log(path, robot=robot) if robot is not None and path.is_dir() else path


def read_stretch(word: str, unit: str) -> tuple[float, str]:
    """The length of the motions that are compared, a whole number of frames."""
    if unit not in ("m", "s", "frames"):
        raise UsageError(f"--rpe {word} {unit}: the unit must be m, s or frames")
    try:
        delta = read_number(word)
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"--rpe: {error}") from None
    if unit == "frames" and delta != round(delta):
        raise UsageError(f"--rpe {word} frames: the number of frames must be whole")
    return (int(delta) if unit == "frames" else delta), unit


def describe_errors(found: PoseErrors) -> dict[str, Any]:
    """The statistics as JSON data."""
    numbers = {name: getattr(found, name) for name in ("rmse", "mean", "median", "max")}
    return {"count": len(found), **numbers, "turn_rmse": found.turn_rmse, "turn_max": found.turn_max}


def print_errors(out: Output, errors: list[PoseErrors]) -> None:
    """A line per measure: metres and degrees."""
    table = Table(["error", "count", "rmse [m]", "mean [m]", "median [m]", "max [m]", "turn rmse [deg]"])
    for found in errors:
        lengths = (found.rmse, found.mean, found.median, found.max)
        turn = f"{math.degrees(found.turn_rmse):.4f}"
        table.add(found.kind, str(len(found)), *(f"{length:.6f}" for length in lengths), turn)
    out.table(table)
