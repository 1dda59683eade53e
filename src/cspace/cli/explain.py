"""`cspace ik ROBOT --explain`: how the solver of an arm works, instead of an answer to a goal."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output

if TYPE_CHECKING:
    from cspace.robot import Robot

__all__ = ["add_explanation", "explain", "explanation_asked"]

GOAL_WORDS = ("xyz", "xy", "rpy", "wxyz", "xyzw", "matrix", "near", "plot")
"""What belongs to a goal, and not to an explanation."""


def add_explanation(parser: argparse.ArgumentParser) -> None:
    """The words of an explanation."""
    group = parser.add_argument_group("explanation", "how the arm is solved, instead of an answer to a goal")
    group.add_argument("--explain", action="store_true", help="the geometry found, the steps, the equations")
    group.add_argument(
        "--asked",
        nargs="+",
        metavar="PART",
        help="goals of parts: position, rotation, direction, look_at, ray, angle_to (alone or together)",
    )
    group.add_argument("--tool-axis", metavar="AXIS", help="with --asked: x, y, z, or =-z, in the tip")
    form = group.add_mutually_exclusive_group()
    form.add_argument("--markdown", action="store_true", help="as Markdown with formulas")
    form.add_argument("--latex", action="store_true", help="as LaTeX, for a document with amsmath")


def explanation_asked(args: argparse.Namespace) -> bool:
    """Whether an explanation is asked for; words of a goal beside it or its forms without it are refused."""
    if not args.explain:
        for name in ("markdown", "latex", "asked", "tool_axis"):
            if getattr(args, name):
                raise UsageError(f"--{name.replace('_', '-')} belongs to the explanation: add --explain")
        return False
    for name in GOAL_WORDS:
        if getattr(args, name) is not None:
            raise UsageError(f"--explain is about the arm, not about a goal: leave --{name} out")
    return True


def explain(args: argparse.Namespace, robot: Robot, out: Output) -> int:
    """Print the explanation; an arm that nothing solves is a negative answer, with what its axes share."""
    plan = robot.ik_plan(asked=args.asked, tool_axis=args.tool_axis or "z")
    if out.as_json:
        out.document({"schema": "cspace.ik_plan/1", **plan.to_dict()})
    else:
        form = "to_markdown" if args.markdown else "to_latex" if args.latex else "to_text"
        out.line(getattr(plan, form)().rstrip())
    return Exit.DONE if plan else Exit.NEGATIVE
