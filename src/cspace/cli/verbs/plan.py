"""`cspace plan`: a free path of an arm among obstacles."""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import (
    add_chain,
    add_degrees,
    add_option,
    add_robot,
    named_value,
    read_angle,
    read_length,
    read_number,
    read_radians,
    read_seed,
    split_numbers,
)
from cspace.cli.exits import Exit, UsageError
from cspace.cli.goals import GOAL_WORDS, Goal, add_goal, goal_of, name_options
from cspace.cli.output import Output, Table, check_format, check_writable
from cspace.cli.progress import show_progress
from cspace.cli.robot import (
    FEWER_DECIMALS,
    degrees_note,
    gripper_note,
    joint_headings,
    joint_texts,
    load_chosen,
    need_chain,
    read_configuration,
)
from cspace.cli.samples_files import check_rate, check_samples_file, write_samples
from cspace.cli.verbs.planners import options_given, typed_value
from cspace.errors import InputError, InputTypeError

if TYPE_CHECKING:
    from cspace.collision import Scene
    from cspace.plan_motion import Motion
    from cspace.planning import Plan
    from cspace.robot import Robot


EXAMPLES: Final = """
cspace plan ur5e --to up --scene cell.toml --plot way.png
cspace plan ur5e --from up --xyz 0.4 0.1 0.3 --rpy 0 180 0 --deg
cspace plan panda --spheres spheres.json --from ready --to 0 0 0 -pi/2 0 pi/2 0 --scene cell.toml -o way.yaml
cspace plan ur5e --xyz 0.4 0.2 0.4 --direction 0 0 -1 --margin 5mm --json
cspace plan ur5e --xyz 0.4 0.2 0.4 --box 0.1 0.1 0 --direction 0 0 -1 --within 20deg
cspace plan panda --from ready --to 1 0.2 0 -1.5 0 1.8 0.8 --trajectory move.yaml --plot move.gif
cspace plan arm.urdf --from 0 0 0 0 0 0 --to 1 0 0 0 0 0 --to -1 0 0 0 0 0 --scene cell.toml --seed 7
"""
HOME: Final = "home"
"""The named pose where a path starts unless another start is given."""
FILM_DPI: Final = 80.0
"""Pixels per inch of a film: a fifth of a megabyte for a second."""
MOST_CORNERS: Final = 20
"""The longest path of which every corner is printed without --details."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "start: a value per joint, or a named pose (default: the pose home)"
    add_option(parser, "--from Q…", text, str, dest="start")
    text = "goal: a value per joint, or a named pose; may be repeated, any will do"
    add_option(parser, "--to Q…", text, str, action="append")
    add_goal(parser)
    add_region(parser)
    add_surroundings(parser)
    add_planner(parser)
    text = "check the path once more with the exact shapes of the links: mesh"
    add_option(parser, "--verify", text, choices=("mesh",))
    add_option(parser, "--details", "all corners of a long path, and the statistics of the search")
    add_option(parser, "-o --output FILE", "write the path (.yaml, .json, .csv)", Path)
    text = "draw the motion in its scene (.png, .svg, .pdf; with --trajectory also .gif, a film)"
    add_option(parser, "--plot FILE", text, Path)
    add_timing(parser)
    add_degrees(parser)
    add_chain(parser)


def add_surroundings(parser: argparse.ArgumentParser) -> None:
    """The words of what is checked: obstacles, the geometry of the robot, and how close both may come."""
    group = parser.add_argument_group("collision")
    add_option(group, "--scene FILE", "the obstacles (.toml, .json, or .scene of MoveIt)", Path)
    text = "what stands for the robot: its collision elements (default), or capsules along the arm"
    add_option(group, "--geometry", text, choices=("collision", "skeleton"))
    add_option(group, "--spheres FILE", "spheres for the links (.json, .toml, .urdf) instead", Path)
    text = "everything keeps so far away from everything else: 0.005, or 5mm (default: 0)"
    add_option(group, "--margin LENGTH", text, read_length, default=0.0)


def add_region(parser: argparse.ArgumentParser) -> None:
    """The words that make a goal of the tip a region."""
    group = parser.add_argument_group("region")
    text = "with --xyz: the tip may be anywhere in a box with these edges around it: 0.1, or 10cm"
    add_option(group, "--box SX SY SZ", text, read_length)
    text = "with --direction or an orientation: by what angle it may deviate: 0.35, or 20deg"
    add_option(group, "--within ANGLE", text, read_angle)


def add_planner(parser: argparse.ArgumentParser) -> None:
    """The words of the search."""
    group = parser.add_argument_group("planner")
    add_option(group, "--planner PLANNER", "name of a planner (default: rrt_connect)", default="rrt_connect")
    text = "an option of the planner (cspace planners NAME); may be repeated"
    add_option(group, "--option NAME=VALUE", text, named_value, action="append", default=[])
    add_option(group, "--seed N", "the seed of its samples (default: 0)", read_seed, default=0)


def add_timing(parser: argparse.ArgumentParser) -> None:
    """The words of the motion in time."""
    group = parser.add_argument_group("trajectory")
    text = (
        "round the corners, time the path, and write the motion: .yaml for ROS (JointTrajectory), .csv, .json"
    )
    add_option(group, "--trajectory FILE", text, Path)
    add_option(group, "--rate HZ", "samples per second (default: 100)", read_number)
    for name, unit in (("acceleration", "rad/s²"), ("jerk", "rad/s³")):
        text = f"largest {name} of all joints [{unit}, or m] (default: that of the robot)"
        add_option(group, f"--{name} V", text, read_number)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the corners of the path, or why there is none; faults name the options, not the keywords."""
    check_targets(args)
    options = options_of_planner(args)
    scene = load_scene(args.scene)
    robot = load_checked(args)
    try:
        start, goal = start_of(args, robot), goal_given(args, robot)
        plan, seconds = find_plan(args, robot, start, goal, scene, options)
        motion = time_found(args, robot, plan, scene)
    except (InputError, InputTypeError) as error:
        raise UsageError(name_options(str(error))) from error
    written = write_files(args, robot, plan, motion, scene)
    if out.as_json:
        out.document(plan_document(args, robot, start, goal, plan, seconds, written, motion))
    else:
        print_plan(args, out, robot, plan, seconds)
        if motion is not None:
            out.sentence(f"trajectory: {motion.reason or f'{motion.duration:.4g} s'}")
        for path in written:
            out.line(f"wrote {path}")
        out.hint(gripper_note(args, robot))
        typed = [*start, *(goal.flat if isinstance(goal, np.ndarray) else ())]
        out.hint(degrees_note(args, robot, typed))
    return Exit.DONE if plan and (motion is None or motion) else Exit.NEGATIVE


def check_targets(args: argparse.Namespace) -> None:
    """Refuse files that cannot be written, before any computation."""
    if args.plot is not None:
        if not (is_film(args.plot) and args.trajectory is not None):
            check_format(args.plot)
        check_writable(args.plot)
    if args.trajectory is not None:
        check_samples_file(args.trajectory, "--trajectory")
    check_rate(args, args.trajectory, "--trajectory FILE of samples (.yaml, .csv)")
    if args.trajectory is None and (args.acceleration is not None or args.jerk is not None):
        raise UsageError("--acceleration and --jerk are of --trajectory; give the file it is written to")
    if args.output is not None:
        from cspace.planning.plan_files import check_ending

        check_ending(args.output)
        check_writable(args.output)


def is_film(path: Path) -> bool:
    """Whether the name of a file is that of a film."""
    return path.suffix.lower() == ".gif"


def time_found(args: argparse.Namespace, robot: Robot, plan: Plan, scene: Scene | None) -> Motion | None:
    """The motion along a plan, if --trajectory asks for one; within the jerk limits of the robot, if it has
    them."""
    if args.trajectory is None or not plan:
        return None
    from cspace.plan_motion import time_plan

    has_jerk = bool(np.isfinite(robot.limits.jerk).all())
    jerk = args.jerk if args.jerk is not None else has_jerk
    with show_progress("timing the path"):
        return time_plan(robot, plan, scene, margin=args.margin, acceleration=args.acceleration, jerk=jerk)


def options_of_planner(args: argparse.Namespace) -> dict[str, Any]:
    """The typed options of the selected planner. Errors as of options_given, and for an unknown planner."""
    from cspace.planning import find_planner

    planner = find_planner(args.planner)
    return options_given(args.option, None, {planner.name: planner})[planner.name]


def load_scene(path: Path | None) -> Scene | None:
    """The scene of a file, None without one."""
    from cspace.collision import Scene

    return None if path is None else Scene.load(path)


def load_checked(args: argparse.Namespace) -> Robot:
    """The robot with its collision geometry, whose making can take seconds."""
    if args.spheres is not None and args.geometry is not None:
        raise UsageError("--spheres and --geometry both give the geometry of the robot: leave one out")
    robot = load_chosen(args)
    need_chain(robot)
    if args.spheres is not None:
        robot = robot.with_spheres(args.spheres)
    with show_progress("covering the robot by spheres"):
        geometry = robot.collision
    if not geometry:
        raise InputError(f"{robot.name} cannot be checked for collisions: {geometry.reason}")
    return robot


def start_of(args: argparse.Namespace, robot: Robot) -> Array:
    """The start (dof,): as typed, or the pose home."""
    if args.start is not None:
        return typed_configuration(args, args.start, robot, "--from")
    if HOME not in robot.named_poses:
        poses = ", ".join(robot.named_poses) or "none"
        raise UsageError(
            f"no start is given, and {robot.name} has no pose {HOME!r}: give --from; poses: {poses}"
        )
    return robot.named_poses[HOME]


def goal_given(args: argparse.Namespace, robot: Robot) -> Array | Goal:
    """The configurations of --to (g, dof), or the goal of the tip."""
    posed = next((name for name in GOAL_WORDS if getattr(args, name) is not None), None)
    if args.to is None:
        if posed is None:
            raise UsageError(
                "no goal is given: give --to with values of the joints or a named pose, or a goal of the tip"
                " (--xyz with --rpy, and the other options of cspace ik)"
            )
        return goal_of(args)
    if posed is not None:
        raise UsageError(f"--to and --{posed.replace('_', '-')} both give a goal: leave one out")
    return np.array([typed_configuration(args, words, robot, "--to") for words in args.to])


def typed_configuration(args: argparse.Namespace, words: list[str], robot: Robot, option: str) -> Array:
    """A named pose, or values of the joints, as a configuration (dof,) [rad, m]."""
    values = split_numbers(words, option)
    if values is None:
        return robot.named_poses[words[0].strip()]
    return read_configuration(values, robot, option, degrees=args.deg)


def find_plan(
    args: argparse.Namespace,
    robot: Robot,
    start: Array,
    goal: Array | Goal,
    scene: Scene | None,
    options: dict[str, Any],
) -> tuple[Plan, float]:
    """The plan of the library, and how long it took [s]."""
    from cspace.plan_motion import plan

    wanted = goal_wanted(args, goal)
    fixed = {"planner": args.planner, "margin": args.margin, "rng": args.seed, "verify": args.verify}
    with show_progress(f"planning with {args.planner}"):
        began = time.perf_counter()
        found = plan(robot, start, wanted, scene, **fixed, **options)
        return found, time.perf_counter() - began


def goal_wanted(args: argparse.Namespace, goal: Array | Goal) -> Any:
    """The goal of `cs.plan`: configurations, keywords of robot.ik, or with --box or --within a Region."""
    from cspace.planning import Region

    if args.box is None and args.within is None:
        return goal.keywords if isinstance(goal, Goal) else goal
    if not isinstance(goal, Goal):
        raise UsageError("--box and --within are about goals of the tip: give --xyz in place of --to")
    parts: dict[str, Any] = {"position": None, "rotation": None, "direction": None}
    parts |= goal.parts if goal.T is None else {"position": goal.T[:3, 3], "rotation": goal.T[:3, :3]}
    others = [name for name in parts if name not in ("position", "rotation", "direction")]
    has_place = parts["position"] is not None and None not in list(parts["position"])
    if others or (args.box is not None and not has_place):
        raise UsageError("--box is around a place of the tip: give --xyz with three numbers, no other place")
    if args.within is not None and parts["rotation"] is None and parts["direction"] is None:
        raise UsageError("--within is about a direction or an orientation: give --direction or --rpy too")
    return Region(
        None if not has_place else (args.box or np.zeros(3), parts["position"]),
        axis="z" if parts["direction"] is None else goal.tool_axis,
        direction=parts["direction"],
        rotation=parts["rotation"],
        within=0.0 if args.within is None else read_radians(args.within, degrees=args.deg),
    )


def write_files(
    args: argparse.Namespace, robot: Robot, plan: Plan, motion: Motion | None, scene: Scene | None
) -> list[Path]:
    """Write what was requested, of a failed descent the picture; the files."""
    written = []
    if args.output is not None and plan:
        plan.save(args.output)
        written.append(args.output)
    if motion:
        write_samples(motion, args.trajectory, args.rate)
        written.append(args.trajectory)
    if args.plot is not None and is_film(args.plot):
        if motion:
            from cspace import plot

            with show_progress("drawing the film"):
                plot.save(plot.animation(motion, robot=robot, scene=scene), args.plot, dpi=FILM_DPI)
            written.append(args.plot)
    elif args.plot is not None and (plan or "rest" in plan.stats):
        from cspace import plot

        with show_progress("drawing the motion"):
            plot.save(plot.plan(plan, title=f"{robot.name}: {plan.reason.partition(':')[0]}"), args.plot)
        written.append(args.plot)
    return written


def plan_document(
    args: argparse.Namespace,
    robot: Robot,
    start: Array,
    goal: Array | Goal,
    plan: Plan,
    seconds: float,
    written: list[Path],
    motion: Motion | None,
) -> dict[str, Any]:
    """The plan as JSON data [rad, m]; numbers that do not exist are null."""
    tip_goal = goal if isinstance(goal, Goal) else Goal()
    configurations = None if isinstance(goal, Goal) else goal
    return {
        "schema": "cspace.plan/1",
        "robot": robot.name,
        "base": robot.base,
        "tip": robot.tip,
        "joints": list(robot.joint_names),
        "start": start,
        "goal": {
            "configurations": configurations,
            **tip_goal.document(),
            "box": args.box,
            "within": None if args.within is None else read_radians(args.within, degrees=args.deg),
        },
        "scene": None if args.scene is None else str(args.scene),
        "margin": args.margin,
        "planner": plan.planner.name,
        "options": {name: typed_value(value) for name, value in plan.planner.values.items()},
        "seed": args.seed,
        "status": plan.status,
        "reason": plan.reason,
        "path": plan.path,
        "cost": finite_number(plan.cost),
        "goal_index": plan.goal if plan else None,
        "certified": plan.certified,
        "clearance": finite_number(plan.clearance),
        "seconds": seconds,
        "stats": {name: name_fields(value) for name, value in plan.stats.items()},
        "duration": motion.duration if motion else None,
        "written": [str(path) for path in written],
    }


def name_fields(value: Any) -> Any:
    """Named tuples as dicts, also inside of others: JSON would drop the names."""
    if hasattr(value, "_asdict"):
        return {name: name_fields(field) for name, field in value._asdict().items()}
    if isinstance(value, (list, tuple)):
        return [name_fields(each) for each in value]
    return value


def finite_number(value: float) -> float | None:
    """A number for JSON; None for infinity."""
    return value if math.isfinite(value) else None


def print_plan(args: argparse.Namespace, out: Output, robot: Robot, plan: Plan, seconds: float) -> None:
    """The verdict, the corners and what is known of them."""
    out.sentence(f"{robot.name}: {plan.reason}", style="bold" if plan else "yellow")
    if not plan:
        return
    rows = plan.path
    most = len(rows) if args.details else MOST_CORNERS
    out.table(corner_table(robot, rows[:most], degrees=args.deg, width=out.width))
    if len(rows) > most:
        out.line(f"… {len(rows) - most} more of {len(rows)} corners; --details prints all")
    facts = {
        "motions": "proved free over their whole length" if plan.certified else "checked at samples",
        "clearance [m]": f"{plan.clearance:.4f}" if math.isfinite(plan.clearance) else "nothing to touch",
        "time [ms]": f"{1e3 * seconds:.3f}",
    }
    if args.details:
        numbers = {name: value for name, value in plan.stats.items() if isinstance(value, (int, float))}
        facts |= {name.replace("_", " "): f"{value:.6g}" for name, value in numbers.items()}
    out.facts(facts)
    out.hint(
        f"angles in {'deg' if args.deg else 'rad'}" + (", slides in m" if "P" in robot.joint_types else "")
    )
    if joint_headings(robot) != list(robot.joint_names):
        names = zip(joint_headings(robot), robot.joint_names, strict=True)
        out.hint(", ".join(f"{short} {name}" for short, name in names))


def corner_table(robot: Robot, rows: Array, *, degrees: bool, width: int | None) -> Table:
    """A row per corner; joints lose decimals until the table fits the width."""
    for fewer in range(FEWER_DECIMALS + 1):
        table = Table(["", *joint_headings(robot)])
        for k, q in enumerate(rows):
            table.add(f"{k + 1}", *joint_texts(q, robot, degrees=degrees, fewer=fewer))
        if width is None or table.width <= width:
            break
    return table
