"""`cspace slam`: the trajectory and the map of a log, or the optimum of a pose graph."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Final

import numpy as np

from cspace.cli.arguments import add_degrees, add_option, read_angle, read_seed
from cspace.cli.drives import (
    ROS_MAPS,
    add_pictures,
    check_pictures,
    describe_drive,
    draw_drive,
    measure_error,
    print_drive,
    read_start,
    say_length,
)
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, check_writable
from cspace.cli.progress import show_progress

EXAMPLES: Final = """
cspace slam two_rounds.g2o --robust dcs --save optimum.g2o
cspace slam small_drive --method ekf --save mapped.tum --json
cspace slam intel.log.gz --save found.tum --save-map map.yaml --plot map.png
"""

GRAPHS: Final = (".g2o", ".graph", ".toro", ".zip")
"""Endings of files of pose graphs; other files are told apart by their first word."""
METHODS: Final = ("graph", "ekf", "fastslam")
ROBUST: Final = ("dcs", "gnc", "best")


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="LOG|GRAPH", type=Path, help="a log, or a pose graph (.g2o, TORO)")
    text = "of logs: graph matches scans, ekf and fastslam see landmarks (default: graph)"
    add_option(parser, "--method", text, choices=METHODS, default="graph")
    add_option(parser, "--robot N", "which robot of an MRCLAM folder", int)
    text = "the pose at which trajectory and map of a log begin (default: 0 0 0)"
    add_option(parser, "--start X Y THETA", text, read_angle)
    text = "of pose graphs: how false loops are found and rejected"
    add_option(parser, "--robust", text, choices=ROBUST)
    add_option(parser, "--seed N", "the seed of fastslam", read_seed)
    text = "write the optimum as .g2o, or the poses of a log as a TUM trajectory"
    add_option(parser, "--save FILE", text, Path)
    text = "write the map of --method graph as a ROS map: FILE.yaml and an image FILE.pgm"
    add_option(parser, "--save-map FILE.yaml", text, Path)
    add_pictures(parser, "the graph before and after, or the drive")
    add_degrees(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Optimize a pose graph, or run SLAM over a log."""
    check_pictures(args)
    if args.save_map is not None:
        check_writable(args.save_map)
        if args.save_map.suffix.lower() not in ROS_MAPS:
            raise UsageError(f"a map is a ROS map, but {str(args.save_map)!r} does not end with .yaml")
    return run_graph(args, out) if is_graph(args.file) else run_log(args, out)


def is_graph(path: Path) -> bool:
    """Whether a file is that of a pose graph, by its ending or its first word."""
    if path.is_dir() or path.suffix.lower() in GRAPHS:
        return not path.is_dir()
    from cspace.localization.logs.lines import read_lines

    words = next(read_lines(str(path)).rows(), (0, [""]))[1]
    return words[0].startswith(("VERTEX", "EDGE", "FIX"))


def run_graph(args: argparse.Namespace, out: Output) -> int:
    """The optimum of a pose graph."""
    from cspace.localization import PoseGraph

    of_logs = (args.animate, args.seed, args.save_map, args.start, args.robot)
    if args.method != "graph" or any(given is not None for given in of_logs):
        raise UsageError(
            "a pose graph is optimized; --method, --robot, --animate, --save-map, --seed and --start are for"
            " logs"
        )
    with show_progress(f"reading {args.file}"):
        graph = PoseGraph.read(args.file)
    with show_progress("optimizing"):
        answer = graph.optimize(robust=args.robust)
    written = []
    if args.plot is not None:
        from cspace import plot

        with show_progress("drawing"):
            plot.save(plot.graph(answer), args.plot)
        written.append(str(args.plot))
    if args.save is not None:
        save_graph(graph, answer, args.save)
        written.append(str(args.save))
    if out.as_json:
        out.document(describe_graph(args, answer, written))
    else:
        facts = {
            "poses": str(len(answer.poses)),
            "edges": str(len(graph.edges)),
            "landmarks": str(len(answer.landmarks) or ""),
            "status": answer.status,
            "reason": answer.reason,
            "chi2": f"{answer.chi2:.6g}, dof {answer.dof}",
            "rejected": ", ".join(f"{loop.first}-{loop.second}" for loop in answer.rejected[:SHOWN])
            + (f" … {len(answer.rejected)} in all" if len(answer.rejected) > SHOWN else ""),
            "notes": "; ".join(graph.notes),
        }
        print_drive(out, facts, written)
    return Exit.DONE if answer else Exit.NEGATIVE


SHOWN: Final = 12
"""Rejected loops that are listed."""


def save_graph(graph: Any, answer: Any, path: Path) -> None:
    """The optimum as a g2o file: the graph with the answer as its start, without the rejected edges."""
    from dataclasses import replace

    kept = np.ones(len(graph.edges), dtype=np.bool_)
    kept[[loop.edge for loop in answer.rejected]] = False
    edges = {name: getattr(graph, name)[kept] for name in ("edges", "motions", "information")}
    replace(graph, poses=answer.poses, landmarks=answer.landmarks, start_given=True, **edges).to_g2o(path)


def describe_graph(args: argparse.Namespace, answer: Any, written: list[str]) -> dict[str, Any]:
    """The optimum as JSON data."""
    return {
        "schema": "cspace.slam/1",
        "file": str(args.file),
        "method": "graph" if args.robust is None else args.robust,
        "status": answer.status,
        "reason": answer.reason,
        "times": None,
        "poses": answer.poses.tolist(),
        "deviations": None,
        "landmarks": answer.landmarks.tolist(),
        "chi2": float(answer.chi2),
        "dof": int(answer.dof),
        "rejected": [loop._asdict() for loop in answer.rejected],
        "rmse": None,
        "written": written,
    }


def run_log(args: argparse.Namespace, out: Output) -> int:
    """The trajectory and the map of a log."""
    from cspace.localization import read_log, slam, write_poses

    if args.robust is not None:
        raise UsageError("--robust is for pose graphs; SLAM of logs rejects false loops always")
    if args.save is not None and args.save.suffix.lower() == ".g2o" and args.method != "graph":
        raise UsageError(f"--method {args.method} has no pose graph; --save FILE.tum writes its poses")
    if args.save_map is not None and args.method != "graph":
        raise UsageError(f"--method {args.method} makes no map of cells; --save-map is for --method graph")
    if args.seed is not None and args.method != "fastslam":
        raise UsageError(f"--seed is the seed of --method fastslam, and has no effect with {args.method}")
    with show_progress(f"reading {args.file}"):
        log = read_log(args.file, robot=args.robot)
    check_method(args.method, log)
    more: dict[str, Any] = {} if args.start is None else {"start": read_start(args.start, args.deg)}
    with show_progress(f"SLAM by {args.method}"):
        answer: Any = slam(log, method=args.method, rng=args.seed, **more)
    error = measure_error(answer, log.truth, "se2")
    world: Any = getattr(answer, "map", None)
    with show_progress("drawing"):
        written = draw_drive(args, answer, log, world, "se2")
    if args.save is not None:
        is_tum = args.save.suffix.lower() != ".g2o"
        write_poses(args.save, answer) if is_tum else answer.graph.to_g2o(args.save)
        written.append(str(args.save))
    if args.save_map is not None:
        world.save_ros(args.save_map)
        written += [str(args.save_map), str(args.save_map.with_suffix(".pgm"))]
    points = getattr(getattr(answer, "landmarks", None), "points", np.zeros((0, 2)))
    if out.as_json:
        document = {"schema": "cspace.slam/1", "file": str(args.file), "method": args.method}
        nothing: dict[str, Any] = {"chi2": None, "dof": None, "rejected": []}
        results = {"landmarks": points.tolist(), **nothing, "rmse": error, "written": written}
        out.document({**document, **describe_drive(answer), **results})
    else:
        facts = {"method": args.method, "poses": str(len(answer)), "landmarks": str(len(points) or "")}
        facts |= {"status": answer.status, "reason": answer.reason, "rmse": say_length(error)}
        print_drive(out, {**facts, "notes": "; ".join(log.notes)}, written)
    return Exit.DONE if answer else Exit.NEGATIVE


def check_method(method: str, log: Any) -> None:
    """Refuse a method that the log has no measurements for, with those that it has."""
    if method == "graph" and log.scans is None and log.readings is not None:
        raise UsageError("the log has no scans, but readings of landmarks; take --method ekf or fastslam")
    if method != "graph" and log.readings is None and log.scans is not None:
        raise UsageError("the log has no readings of landmarks, but scans; take --method graph")
