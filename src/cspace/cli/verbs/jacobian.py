"""`cspace jacobian`: how the tip moves with the joints, and how near it is to losing a freedom."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, Final

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_joints, add_option, add_robot
from cspace.cli.exits import Exit
from cspace.cli.output import Output, Table, tidy_number
from cspace.cli.robot import degrees_note, joint_headings, load_posed

if TYPE_CHECKING:
    from cspace.robot import Robot


EXAMPLES: Final = """
cspace jacobian ur5e 0 -90 90 0 90 0 --deg
cspace jacobian puma560 0 0.3 0.2 0 0.5 0 --expressed-in tip --json
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    add_joints(parser)
    text = "the axes of the rows (default: base)"
    add_option(parser, "--expressed-in", text, choices=("base", "tip"), default="base")
    text = "the rows that count for singularity (default: linear for arms that position a point)"
    add_option(parser, "--rows", text, choices=("auto", "all", "linear", "angular"), default="auto")
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the Jacobian and its distance to a singularity."""
    from cspace import kinematics
    from cspace.kinematics.manipulability import counting_rows

    robot, q, frame = load_posed(args)
    more: dict[str, Any] = {"expressed_in": args.expressed_in, "rows": args.rows}
    J = robot.jacobian(q, args.frame, expressed_in=args.expressed_in)
    near = kinematics.singularity(robot, q, args.frame, **more)
    facts: dict[str, Any] = {
        "rows": counting_rows(robot, args.frame) if args.rows == "auto" else args.rows,
        "singular_values": kinematics.singular_values(robot, q, args.frame, **more).tolist(),
        "manipulability": float(kinematics.manipulability(robot, q, args.frame, **more)),
        "distance_to_singularity": near.distance,
        "singular": bool(near),
        "lost_direction": near.direction.tolist(),
        "lost_by": list(near.joints),
    }
    if out.as_json:
        ends = {"robot": robot.name, "base": robot.base, "frame": frame}
        given = {"expressed_in": args.expressed_in, "q": q.tolist(), "joints": list(robot.joint_names)}
        out.document({"schema": "cspace.jacobian/1", **ends, **given, "jacobian": J.tolist(), **facts})
    else:
        print_jacobian(out, robot, J, facts, str(near))
        out.hint(degrees_note(args, robot))
    return Exit.DONE


def print_jacobian(out: Output, robot: Robot, J: Array, facts: dict[str, Any], text: str) -> None:
    """The matrix and the facts for people."""
    from cspace.kinematics.manipulability import ROWS

    table = Table(["", *joint_headings(robot)])
    for name, row in zip(ROWS, J, strict=True):
        table.add(name, *(f"{tidy_number(x):.6f}" for x in row))
    out.table(table)
    out.line()
    out.facts(
        {
            "rows that count": facts["rows"],
            "singular values": "  ".join(f"{x:.6f}" for x in facts["singular_values"]),
            "manipulability": f"{facts['manipulability']:.6g}",
            "distance to singularity": f"{facts['distance_to_singularity']:.6g}",
            "nearest singularity": text,
        }
    )
