"""`cspace traj`: a motion in time, between configurations, through waypoints, or along a line of the tip."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import (
    add_chain,
    add_degrees,
    add_option,
    add_robot,
    read_angle,
    read_length,
    read_number,
    read_radians,
)
from cspace.cli.exits import Exit, UsageError
from cspace.cli.goals import name_options
from cspace.cli.output import Output, Table, check_format, check_writable
from cspace.cli.progress import show_progress
from cspace.cli.robot import (
    degrees_note,
    joint_headings,
    joint_texts,
    load_chosen,
    need_chain,
)
from cspace.cli.samples_files import check_rate, check_samples_file, write_samples
from cspace.cli.verbs.plan import FILM_DPI, is_film, start_of, typed_configuration
from cspace.errors import InputError, InputTypeError

if TYPE_CHECKING:
    from cspace.model import Limits
    from cspace.robot import Robot
    from cspace.trajectory import Trajectory

EXAMPLES: Final = """
cspace traj panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8 --plot move.png
cspace traj panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8 --profile trapezoidal --rate 500 -o move.yaml
cspace traj ur5e --waypoints way.csv --blend 0.1 --acceleration 8 --torque --json
cspace traj panda --from ready --line 0.4 0.2 0.4 --speed 25cm --turn-rate 1 --plot line.gif
"""

PROFILES: Final = ("double_s", "trapezoidal", "cubic", "quintic", "septic", "minimum_jerk")
"""Of motions from one configuration to another."""

ROWS: Final = 10
"""How many states a table shows."""

GOALS: Final = ("to", "waypoints", "line")
"""The options that say where the motion goes."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "start: a value per joint, or a named pose (default: the pose home)"
    add_option(parser, "--from Q…", text, str, dest="start")
    group = parser.add_argument_group("goal")
    add_option(group, "--to Q…", "a value per joint, or a named pose", str)
    text = "a file of configurations, a row of numbers per waypoint (.csv); the first is the start"
    add_option(group, "--waypoints FILE", text, Path)
    text = "the tip on a straight line to X Y Z in the base, or X Y Z R P Y with roll, pitch, yaw"
    add_option(group, "--line X…", text, read_angle)
    group = parser.add_argument_group("motion")
    text = f"from a configuration to another: {', '.join(PROFILES)} (default: double_s)"
    add_option(group, "--profile", text, choices=PROFILES, metavar="PROFILE")
    add_option(group, "--duration S", "how long [s] (default: as short as the limits allow)", read_number)
    text = "round the corners of --waypoints within this distance [rad, m] (default: a spline through them)"
    add_option(group, "--blend D", text, read_number)
    for name, unit in (("velocity", "rad/s"), ("acceleration", "rad/s²"), ("jerk", "rad/s³")):
        text = f"largest {name} of all joints [{unit}, or m] (default: that of the robot)"
        add_option(group, f"--{name} V", text, read_number)
    add_option(group, "--torque", "keep the efforts of the robot too, by its dynamics")
    add_option(group, "--speed V", "largest speed of the tip [m/s]: 0.25, or 25cm", read_length)
    add_option(group, "--turn-rate W", "largest angular velocity of the tip [rad/s]", read_number)
    text = "write samples: .yaml for ROS (JointTrajectory), or .csv; or the motion itself: .json"
    add_option(parser, "-o --output FILE", text, Path)
    add_option(parser, "--rate HZ", "samples per second of -o and --json (default: 100)", read_number)
    text = "draw position to jerk, torques and tip speed with the limits (.png, .svg, .pdf), or a film (.gif)"
    add_option(parser, "--plot FILE", text, Path)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the motion, or why there is none."""
    check_files(args)
    robot = load_chosen(args)
    need_chain(robot)
    try:
        motion = find_motion(args, robot)
    except (InputError, InputTypeError) as error:
        raise UsageError(name_options(str(error))) from error
    written = write_files(args, robot, motion) if motion else []
    if out.as_json:
        out.document(describe_motion(args, robot, motion, written))
    else:
        print_motion(args, out, robot, motion)
        for path in written:
            out.line(f"wrote {path}")
        out.hint(degrees_note(args, robot))
    return Exit.DONE if motion else Exit.NEGATIVE


def check_files(args: argparse.Namespace) -> None:
    """Refuse files that cannot be written, before any computation."""
    if args.plot is not None:
        if not is_film(args.plot):
            check_format(args.plot)
        check_writable(args.plot)
    if args.output is not None:
        check_samples_file(args.output, "-o")
    check_rate(
        args, Path("stdout") if args.json else args.output, "-o FILE of samples (.yaml, .csv) or --json"
    )


def find_motion(args: argparse.Namespace, robot: Robot) -> Trajectory:
    """The motion of the library for the goal that is given."""
    given = [name for name in GOALS if getattr(args, name) is not None]
    if len(given) != 1:
        said = " and ".join(f"--{name}" for name in given) or "none"
        raise UsageError(f"one of --to, --waypoints and --line says where the motion goes; given: {said}")
    limits = {name: getattr(args, name) for name in ("velocity", "acceleration", "jerk")}
    path_limits = {"speed": args.speed, "turn_rate": args.turn_rate, "torque": args.torque or None}
    if given == ["to"]:
        refuse_options(args, "--to", ("blend", "torque", "speed", "turn_rate"))
        profile = args.profile or "double_s"
        start, goal = start_of(args, robot), typed_configuration(args, args.to, robot, "--to")
        return robot.move_to(goal, start=start, profile=profile, duration=args.duration, **limits)
    refuse_options(args, f"--{given[0]}", ("profile", "duration"))
    if given == ["line"]:
        refuse_options(args, "--line", ("blend",))
        start = start_of(args, robot)
        T = line_goal(args, robot, start)
        return robot.move_linear(T, start=start, **limits, **path_limits)
    if args.start is not None:
        raise UsageError("--from and --waypoints both give the start: leave --from out")
    return time_waypoints(args, robot, limits | path_limits)


def refuse_options(args: argparse.Namespace, goal: str, names: tuple[str, ...]) -> None:
    """Raises UsageError for options that do not go with a goal."""
    for name in names:
        value = getattr(args, name)
        if value is not None and value is not False:
            raise UsageError(f"--{name.replace('_', '-')} does not go with {goal}; leave it out")


def line_goal(args: argparse.Namespace, robot: Robot, start: Array) -> Array:
    """The pose (4, 4) at the end of --line; with three numbers the rotation stays."""
    from cspace.spatial import pose

    if len(args.line) not in (3, 6):
        raise UsageError(f"--line has {len(args.line)} numbers; it takes X Y Z, or X Y Z R P Y")
    if len(args.line) == 3:
        T = np.array(robot.fk(start))
        T[:3, 3] = args.line
        return T
    angles = [read_radians(angle, degrees=args.deg) for angle in args.line[3:]]
    return pose(args.line[:3], rpy=angles)


def time_waypoints(args: argparse.Namespace, robot: Robot, limits: dict[str, Any]) -> Trajectory:
    """The fastest motion through the waypoints of a file."""
    from cspace.model import Limits
    from cspace.trajectory import blend, spline, time_parametrize

    waypoints = read_waypoint_file(args.waypoints, robot.joint_names, degrees=args.deg)
    path = spline(waypoints) if args.blend is None else blend(waypoints, args.blend)
    motion = time_parametrize(path, robot, positions=False, **limits)
    if motion and not (check := motion.check(Limits(robot.limits.lower, robot.limits.upper))):
        outside = (waypoints < robot.limits.lower) | (waypoints > robot.limits.upper)
        advice = "" if args.blend is not None else "; --blend keeps between the waypoints"
        if outside.any():
            advice = f"; row {int(np.argwhere(outside)[0, 0]) + 1} of the waypoints itself is beyond"
        motion.reason = check.reason + advice
    return motion


def read_waypoint_file(path: Path, names: Sequence[str], *, degrees: bool) -> Array:
    """The rows (k, dof) of a table of numbers. A first line of words may name the joints, in any order; other
    words are skipped."""
    from cspace.errors import DescriptionError
    from cspace.files import read_text

    rows: list[list[float]] = []
    order = list(range(len(names)))
    lines = read_text(path, "CSV", LARGEST_FILE, DescriptionError).splitlines()
    for number, line in enumerate(lines, start=1):
        if not line.strip(" \t,;") or line.lstrip().startswith("#"):
            continue
        apart = ";" if ";" in line else "," if "," in line else None
        cells = [cell.strip() for cell in line.split(apart)]
        try:
            row = [read_radians(read_angle(cell), degrees=degrees) for cell in cells]
        except (ValueError, argparse.ArgumentTypeError):
            if not rows and number == 1:
                if set(cells) == set(names):
                    order = [cells.index(name) for name in names]
                continue
            raise DescriptionError("the row is not numbers", path=str(path), line=number) from None
        if len(row) != len(names):
            raise DescriptionError(
                f"the row has {len(row)} numbers, the robot {len(names)} joints", path=str(path), line=number
            )
        rows.append([row[k] for k in order])
    if len(rows) < 2:
        raise DescriptionError("the file has fewer than two waypoints", path=str(path), line=len(lines) or 1)
    return np.array(rows)


LARGEST_FILE: Final = 1 << 28
"""Bytes of a file of waypoints."""


def write_files(args: argparse.Namespace, robot: Robot, motion: Trajectory) -> list[Path]:
    """Write the samples and the picture that were requested; the files."""
    written = []
    if args.output is not None:
        write_samples(motion, args.output, args.rate)
        written.append(args.output)
    if args.plot is not None:
        from cspace import plot

        if is_film(args.plot):
            with show_progress("drawing the film"):
                plot.save(plot.animation(motion, robot=robot), args.plot, dpi=FILM_DPI)
        else:
            rates = {"speed": args.speed, "turn_rate": args.turn_rate}
            plot.save(
                plot.trajectory(motion, limits=kept_limits(args, robot), robot=robot, **rates), args.plot
            )
        written.append(args.plot)
    return written


def kept_limits(args: argparse.Namespace, robot: Robot) -> Limits:
    """The limits of the robot, or those given where they are lower."""
    from cspace.model import Limits

    own = robot.limits
    lowest = {
        name: np.minimum(getattr(own, name), np.inf if getattr(args, name) is None else getattr(args, name))
        for name in ("velocity", "acceleration", "jerk")
    }
    return Limits(own.lower, own.upper, **lowest)


def describe_motion(
    args: argparse.Namespace, robot: Robot, motion: Trajectory, written: list[Path]
) -> dict[str, Any]:
    """The motion as JSON data [s, rad, m]."""
    samples = motion.sample(args.rate) if motion else None
    check = motion.check(robot.limits) if motion else None
    return {
        "schema": "cspace.traj/1",
        "robot": robot.name,
        "joints": list(robot.joint_names),
        "kind": type(motion).__name__,
        "duration": motion.duration,
        "reason": motion.reason,
        "exceeded": [] if check is None else [f"{each.joint}: {each.limit}" for each in check.violations],
        "times": [] if samples is None else samples.times.tolist(),
        "q": [] if samples is None else samples.q.tolist(),
        "qd": [] if samples is None else samples.qd.tolist(),
        "qdd": [] if samples is None else samples.qdd.tolist(),
        "written": [str(path) for path in written],
    }


def print_motion(args: argparse.Namespace, out: Output, robot: Robot, motion: Trajectory) -> None:
    """Some states as a table, then what the motion keeps."""
    if not motion:
        out.sentence(f"{robot.name}: no motion: {motion.reason}{radians_note(args)}", style="yellow")
        return
    table = Table(["time [s]", *joint_headings(robot)])
    for t in np.linspace(0.0, motion.duration, ROWS + 1):
        table.add(f"{t:.4g}", *joint_texts(motion(t), robot, degrees=args.deg))
    out.table(table)
    out.line()
    check = motion.check(robot.limits)
    out.facts(
        {
            "duration": f"{motion.duration:.6g} s",
            "limits": "kept" if check else check.reason + radians_note(args),
        }
    )


def radians_note(args: argparse.Namespace) -> str:
    """What to add to a reason where all other angles are in degrees."""
    return " (angles in rad)" if args.deg else ""
