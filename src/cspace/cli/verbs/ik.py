"""`cspace ik`: every joint configuration that reaches a pose."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_option, add_robot
from cspace.cli.exits import Exit, UsageError
from cspace.cli.freedom import FREEDOM_WORDS, add_freedom, locked_joints, options_of
from cspace.cli.goals import GOAL_WORDS, Goal, add_goal, axis_of, goal_of, name_options
from cspace.cli.output import Output, check_format, check_writable
from cspace.cli.robot import degrees_note, gripper_note, load_chosen, need_chain, read_configuration
from cspace.cli.solutions import print_solutions, solution_rows, solutions_document
from cspace.errors import InputError, InputTypeError

if TYPE_CHECKING:
    from cspace.robot import Robot


EXAMPLES: Final = """
cspace ik ur5e --xyz 0.4 0.1 0.3 --rpy 0 180 0 --deg
cspace ik puma560 --xyz 0.5 0 0.3 --wxyz 0 1 0 0 --near 0 0 0 0 0 0 --plot puma.png
cspace ik planar_2r --xy 0.6 0.3 --limits drop --json
cspace ik panda --xyz 0.4 0.1 0.4 --rpy pi 0 0 --locked panda_joint7=pi/4
cspace ik iiwa14 --xyz 0.5 0.1 0.4 --rpy 0 180 0 --swivel 30 --deg
cspace ik ur5e --xyz 0.4 0.1 0.3 --direction 0 0 -1
cspace ik ur5e --look-at 0.6 0.2 0 --near 0,-1.2,1.4,-0.8,0.7,0
cspace ik ur5e --explain
cspace ik so101 --explain --goal-parts position direction --tool-axis x --markdown
"""
MOST_NUMBERED: Final = 24
"""Most solutions whose numbers a picture shows; of more, those of one branch share an entry and a colour."""
NOT_EXPLAINED = (*GOAL_WORDS, *FREEDOM_WORDS, "plot")
"""Options of a goal and its solutions, which an explanation does not accept."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    add_goal(parser)
    add_freedom(parser)
    text = "mark solutions out of limits (default), drop them, or keep all without a check"
    add_option(parser, "--limits", text, choices=("mark", "drop", "keep"), default="mark")
    add_option(parser, "--details", "all columns: limits, singularity, the branch in full, residual")
    add_explanation(parser)
    add_option(parser, "--plot FILE", "write a picture (png, svg, pdf)", Path)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print one row per solution, or the explanation; faults name the options, not the keywords of Python."""
    if args.plot is not None:
        check_format(args.plot)
        check_writable(args.plot)
    robot = load_chosen(args)
    need_chain(robot)
    try:
        return (
            print_explanation(args, robot, out) if wants_explanation(args) else answer_goal(args, robot, out)
        )
    except (InputError, InputTypeError) as error:
        raise UsageError(name_options(str(error))) from error


def answer_goal(args: argparse.Namespace, robot: Robot, out: Output) -> int:
    """Solve a goal; no solution is a negative answer, with its reason."""
    goal, options = goal_of(args), options_of(args, robot)
    near = None if args.near is None else read_configuration(args.near, robot, "--near", degrees=args.deg)
    found = solve_goal(robot, goal, near, None if args.limits != "keep" else False, options)
    if args.limits == "drop":
        found = found.within()
    rows = solution_rows(robot, found, near, check=args.limits != "keep", counting=goal.rows)
    if out.as_json:
        out.document(solutions_document(robot, found, rows, goal, options))
    else:
        print_solutions(out, robot, found, rows, degrees=args.deg, details=args.details)
        out.hint(gripper_note(args, robot))
        out.hint(degrees_note(args, robot))
    if found and args.plot is not None:
        out.hint(f"drawing {len(rows)} configuration{'s' if len(rows) > 1 else ''} …")
        draw_solutions(args.plot, robot, rows, goal.mark)
        out.hint(f"picture written to {args.plot}")
    return Exit.DONE if found else Exit.NEGATIVE


def solve_goal(
    robot: Robot, goal: Goal, near: Array | None, limits: bool | None, options: dict[str, Any]
) -> Any:
    """Every solution; where the goal leaves freedom, and no list is whole, the one nearest to `near`.

    limits: False lifts those of the robot for the nearest.
    """
    found = goal.ask(robot, **options)
    leaves_freedom = found.freedom or found.status == "singular"
    return (
        found if near is None or not leaves_freedom else goal.ask(robot, near=near, limits=limits, **options)
    )


def draw_solutions(path: Path, robot: Robot, rows: list[dict[str, Any]], goal: Array | None) -> None:
    """Write the picture of all solutions, the first row within limits solid."""
    from cspace import plot

    said = "one configuration reaches" if len(rows) == 1 else f"{len(rows)} configurations reach"
    order = sorted(range(len(rows)), key=lambda k: bool(rows[k]["out_of_limits"]))
    within = [not rows[k]["out_of_limits"] for k in order]
    numbers = [f"{k + 1}  " if len(rows) <= MOST_NUMBERED else "" for k in order]
    labels = [
        f"{number}{rows[k]['branch']}" + ("" if fits else " (out of limits)")
        for number, k, fits in zip(numbers, order, within, strict=True)
    ]
    q, title = [rows[k]["q"] for k in order], f"{robot.name}: {said} the goal"
    plot.save(plot.solutions(robot, q, goal, labels=labels, within=within, title=title), path)


# --- --explain: how the solver works, instead of solutions ------------------------------------------------
def add_explanation(parser: argparse.ArgumentParser) -> None:
    """The words of an explanation."""
    group = parser.add_argument_group("explanation", "how the arm is solved, instead of an answer to a goal")
    add_option(group, "--explain", "the geometry found, the steps, the equations")
    text = "for partial goals: position, rotation, direction, look-at, ray, angle-to (alone or together)"
    add_option(group, "--goal-parts PART…", text)
    form = group.add_mutually_exclusive_group()
    add_option(form, "--markdown", "as Markdown with formulas")
    add_option(form, "--latex", "as LaTeX, for a document with amsmath")


def wants_explanation(args: argparse.Namespace) -> bool:
    """Whether an explanation is requested. Raises UsageError for options that do not fit."""
    if not args.explain:
        for name in ("markdown", "latex", "goal_parts"):
            if getattr(args, name):
                raise UsageError(f"--{name} can only be used with --explain")
        return False
    for name in NOT_EXPLAINED:
        if getattr(args, name) is not None:
            option = "--" + name.replace("_", "-")
            raise UsageError(f"--explain explains the arm and takes no goal: leave {option} out")
    return True


def print_explanation(args: argparse.Namespace, robot: Robot, out: Output) -> int:
    """Print the explanation; an arm without a solver is a negative answer, with the relations of its axes."""
    locked = None if args.locked is None else locked_joints(args, robot)
    goal_parts = None if args.goal_parts is None else [part.replace("-", "_") for part in args.goal_parts]
    plan = robot.ik_plan(goal_parts=goal_parts, locked=locked, tool_axis=axis_of(args))
    if out.as_json:
        out.document({"schema": "cspace.ik_plan/1", **plan.to_dict()})
    else:
        form = "to_markdown" if args.markdown else "to_latex" if args.latex else "to_text"
        (out.page if form == "to_text" else out.line)(getattr(plan, form)().rstrip())
    return Exit.DONE if plan else Exit.NEGATIVE
