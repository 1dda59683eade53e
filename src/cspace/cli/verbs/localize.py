"""`cspace localize`: where a robot was during a log."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Final

from cspace.cli.arguments import (
    add_degrees,
    add_option,
    read_angle,
    read_length,
    read_seed,
)
from cspace.cli.drives import (
    add_pictures,
    check_pictures,
    describe_drive,
    draw_drive,
    load_map,
    measure_error,
    print_drive,
    read_start,
    say_errors,
)
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output
from cspace.cli.progress import show_progress

EXAMPLES: Final = """
cspace localize small_drive --filter ekf --smooth --save found.tum
cspace localize small_drive --filter ukf --start 0 0 0deg --json
cspace localize drive.log --map map.yaml --filter mcl --seed 7 --plot run.png --animate run.gif
"""

FILTERS: Final = ("ekf", "iekf", "ukf", "information", "mcl", "histogram")


def arguments(parser: argparse.ArgumentParser) -> None:
    text = "log: CARMEN, MRCLAM (a folder), Victoria Park, TUM, KITTI or CSV"
    parser.add_argument("log", metavar="LOG", type=Path, help=text)
    add_option(parser, "--robot N", "which robot of an MRCLAM folder", int)
    text = "a grid (.yaml, .map, .png, .pgm), or a text of landmarks NAME X Y (default: the map of the log)"
    add_option(parser, "--map FILE", text, Path)
    add_option(parser, "--resolution M", "side of a cell of an image [m]", read_length)
    text = "Kalman filters on landmarks, or mcl and histogram on grids (default: ekf)"
    add_option(parser, "--filter", text, choices=FILTERS, default="ekf")
    text = "the pose at the first time (default: that of the log's reference; anywhere for mcl and histogram)"
    add_option(parser, "--start X Y THETA", text, read_angle)
    add_option(parser, "--smooth", "poses by all measurements, later ones too (Kalman filters)")
    add_option(parser, "--seed N", "the seed of mcl", read_seed)
    text = "the motion that is taken out of errors and pictures, for maps with another frame than the truth"
    add_option(parser, "--align", f"{text} (default: none)", choices=("se2", "none"), default="none")
    add_option(parser, "--save FILE", "write the poses as a TUM trajectory", Path)
    add_pictures(parser, "the drive, its errors and its consistency")
    add_degrees(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print how well the robot is localised."""
    from cspace.localization import localize, read_log, write_poses

    check_pictures(args)
    if args.resolution is not None and args.map is None:
        raise UsageError("--resolution is of --map, and has no effect without one; leave it out")
    with show_progress(f"reading {args.log}"):
        log = read_log(args.log, robot=args.robot)
        world = None if args.map is None else load_map(args.map, args.resolution)
    if args.seed is not None and args.filter != "mcl":
        raise UsageError(f"--seed is the seed of --filter mcl, and has no effect with {args.filter}")
    if args.smooth and args.filter in ("mcl", "histogram"):
        raise UsageError(f"--smooth is of the Kalman filters, and has no effect with --filter {args.filter}")
    more: dict[str, Any] = {} if args.seed is None else {"rng": args.seed}
    if args.start is not None:
        more["start"] = read_start(args.start, args.deg)
    with show_progress(f"localizing by {args.filter}"):
        found: Any = localize(log, world, filter=args.filter, **more)
        answer = found.smoothed() if args.smooth and hasattr(found, "smoothed") else found
    align = None if args.align == "none" else args.align
    error = measure_error(answer, log.truth, align)
    known = world if world is not None else log.landmarks
    with show_progress("drawing"):
        written = draw_drive(args, answer, log, known, align)
    if args.save is not None:
        write_poses(args.save, answer)
        written.append(str(args.save))
    if out.as_json:
        document = {"schema": "cspace.localize/1", "log": str(args.log), "filter": answer.filter}
        out.document({**document, **describe_drive(answer), "rmse": error, "written": written})
    else:
        facts = {"filter": answer.filter, "poses": str(len(answer)), "status": answer.status}
        notes = "; ".join(log.notes)
        facts |= {"reason": answer.reason, "rmse": say_errors(answer, log.truth, error), "notes": notes}
        print_drive(out, facts, written)
    return Exit.DONE if answer else Exit.NEGATIVE
