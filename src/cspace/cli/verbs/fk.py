"""`cspace fk`: where a frame is at given joints."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_joints, add_robot
from cspace.cli.exits import Exit
from cspace.cli.output import DECIMALS, MORE_DECIMALS, Output, tidy_number
from cspace.cli.robot import degrees_note, load_posed

if TYPE_CHECKING:
    from cspace.robot import Robot

EXAMPLES: Final = """
cspace fk ur5e 0 -pi/2 pi/2 0 pi/2 0
cspace fk panda --pose ready
cspace fk puma560 10 -20 30 0 45 0 --deg
cspace fk arm.urdf 0.1 0.2 --frame elbow_link --json
"""
WHOLE_POSE: Final = 6
"""Joints of an arm that reaches every pose nearby."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    add_joints(parser)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the pose of the frame in the base."""
    robot, q, frame = load_posed(args)
    T = robot.fk(q, args.frame)
    if out.as_json:
        ends = {"robot": robot.name, "base": robot.base, "frame": frame}
        out.document({"schema": "cspace.fk/1", **ends, "q": q.tolist(), **pose_document(T)})
    else:
        show_pose(out, T, f"{frame} in {robot.base}", degrees=args.deg, decimals=decimals_of(robot))
        out.hint(degrees_note(args, robot))
    return Exit.DONE


def pose_document(T: Array) -> dict[str, list[Any]]:
    """A pose (4, 4) in every form, [m] and [rad]."""
    from cspace.spatial import to_rpy, to_wxyz, to_xyzw

    forms = {"matrix": T, "xyz": T[:3, 3], "rpy": to_rpy(T), "wxyz": to_wxyz(T), "xyzw": to_xyzw(T)}
    return {name: np.asarray(value).tolist() for name, value in forms.items()}


def decimals_of(robot: Robot) -> int:
    """How many decimals of a pose of a robot to print: an arm with fewer than six joints reaches hardly any
    pose, so that a rounded one is out of its reach.
    """
    return DECIMALS if robot.dof >= WHOLE_POSE else MORE_DECIMALS


def show_pose(out: Output, T: Array, name: str, *, degrees: bool, decimals: int = DECIMALS) -> None:
    """A pose (4, 4) as a matrix and in every other form."""
    forms = pose_document(T)
    rpy = np.degrees(forms["rpy"]) if degrees else np.array(forms["rpy"])
    out.matrix(T, name, decimals)
    out.facts(
        {
            "xyz [m]": join_numbers(forms["xyz"], decimals),
            f"rpy [{'deg' if degrees else 'rad'}]": join_numbers(rpy, decimals) + "  (about fixed x, y, z)",
            "wxyz": join_numbers(forms["wxyz"], decimals) + "  (quaternion, real part first)",
            "xyzw": join_numbers(forms["xyzw"], decimals) + "  (quaternion, real part last)",
        }
    )


def join_numbers(values: Any, decimals: int) -> str:
    """Numbers in a line, rounding noise shown as zero."""
    return "  ".join(f"{tidy_number(x, decimals):.{decimals}f}" for x in values)
