"""`cspace ik ROBOT --explain`: how the solver of an arm works, instead of the solutions of a goal."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from cspace.cli.exits import Exit, UsageError
from cspace.cli.freedom import FREEDOM_WORDS, locked_joints
from cspace.cli.goals import GOAL_WORDS, axis_of
from cspace.cli.output import Output

if TYPE_CHECKING:
    from cspace.robot import Robot


NOT_EXPLAINED = (*GOAL_WORDS, *FREEDOM_WORDS, "plot")
"""Options of a goal and its solutions, which an explanation does not accept."""


def add_explanation(parser: argparse.ArgumentParser) -> None:
    """The words of an explanation."""
    group = parser.add_argument_group("explanation", "how the arm is solved, instead of an answer to a goal")
    group.add_argument("--explain", action="store_true", help="the geometry found, the steps, the equations")
    group.add_argument(
        "--goal-parts",
        nargs="+",
        metavar="PART",
        help="for partial goals: position, rotation, direction, look-at, ray, angle-to (alone or together)",
    )
    form = group.add_mutually_exclusive_group()
    form.add_argument("--markdown", action="store_true", help="as Markdown with formulas")
    form.add_argument("--latex", action="store_true", help="as LaTeX, for a document with amsmath")


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
        out.line(getattr(plan, form)().rstrip())
    return Exit.DONE if plan else Exit.NEGATIVE
