"""The robot of a command line, and configurations typed for it."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import read_radians
from cspace.cli.exits import UsageError
from cspace.cli.output import tidy_number
from cspace.math.wrapping import TURN

if TYPE_CHECKING:
    from cspace.robot import Robot


GRIPPER: Final = re.compile("grip|jaw|finger|claw", re.IGNORECASE)
"""What joints and links of grippers are called."""
FEWER_DECIMALS: Final = 2
"""How many decimals joints may lose where a terminal is narrow."""


def load_chosen(args: argparse.Namespace, *, floating: bool | None = None) -> Robot:
    """The robot that the words name, with the chosen ends. floating: as in load_robot."""
    from cspace.robots import load_robot

    return load_robot(
        args.robot,
        base=getattr(args, "base", None),
        tip=getattr(args, "tip", None),
        floating=floating,
        package_paths=args.package_path,
        xacro_args=dict(args.xacro_arg),
        calibration=args.calibration,
        right_angles=args.right_angles,
        geometry=getattr(args, "geometry", None) or "collision",
    )


def load_posed(args: argparse.Namespace) -> tuple[Robot, Array, str | None]:
    """The robot, the configuration typed for it, and the name of the selected frame, by default the tip."""
    robot = load_chosen(args)
    if args.frame is None:
        need_chain(robot)
    return robot, read_posed(args, robot), args.frame or robot.tip


def read_posed(args: argparse.Namespace, robot: Robot) -> Array:
    """The configuration (n,) that is typed, or named by --pose."""
    if args.pose is None:
        return read_configuration(args.q, robot, "q", degrees=args.deg)
    if args.q:
        raise UsageError(f"give either values of the joints or --pose {args.pose}, not both")
    return robot.named_poses[args.pose]


def need_chain(robot: Robot) -> None:
    """Refuse a tree where a verb speaks of one tip, naming the links that could be it."""
    from cspace.kinematics.assembly import tip_choices

    if robot.tip is None:
        raise UsageError(
            f"{robot.name} branches, so its tip must be selected: --tip with one of "
            f"{tip_choices(robot.leaves)}"
        )


def read_configuration(values: Sequence[float], robot: Robot, subject: str, *, degrees: bool) -> Array:
    """Typed values as a configuration (n,) [rad, m]; with `degrees` the angles were typed in degrees."""
    n = len(robot.joint_names)
    if len(values) != n:
        names = ", ".join(robot.joint_names)
        raise UsageError(f"{robot.name} has {n} joints, {subject} has {len(values)} values; joints: {names}")
    typed = zip(values, robot.joint_types, strict=True)
    return np.array([read_radians(value, degrees=degrees and kind == "R") for value, kind in typed])


def degrees_note(args: argparse.Namespace, robot: Robot, typed: Sequence[float] | None = None) -> str:
    """A remark on typed angles beyond a full revolution, which were probably meant in degrees.

    typed: values of the joints, one configuration after the other, if not those of --near or of the verb.
    """
    joints = typed or getattr(args, "near", None) or getattr(args, "q", None) or []
    turning = (
        value
        for value, kind in zip(joints, cycle(robot.joint_types), strict=False)
        if kind == "R" and not isinstance(value, tuple)  # JOINT=VALUE
    )
    angles = [*turning, *(getattr(args, "rpy", None) or []), getattr(args, "angle", None) or 0.0]
    if args.deg or max(map(abs, angles)) <= TURN:
        return ""
    return "an angle exceeds 2π rad; --deg reads and prints degrees"


def gripper_note(args: argparse.Namespace, robot: Robot) -> str:
    """What to type where the last joint of a file is named like a gripper's and nobody chose the tip.

    The arms of the catalogue, which name their sources, have no grippers.
    """
    catalogued = robot.description.provenance.sources
    if args.tip is not None or robot.tip is None or not robot.joint_names or catalogued:
        return ""
    last = robot.joint_names[-1]
    joint = next(joint for joint in robot.description.joints if joint.name == last)
    if not GRIPPER.search(f"{joint.name} {joint.child}"):
        return ""
    return f"{joint.name} seems to belong to a gripper; --tip {joint.parent} ends the arm before it"


def joint_headings(robot: Robot) -> list[str]:
    """Column headings of the joints: their names where they are short, else q1, q2, …"""
    names = list(robot.joint_names)
    return names if max(map(len, names), default=0) <= 8 else [f"q{k + 1}" for k in range(len(names))]


def joint_called(word: str, robot: Robot) -> str:
    """The joint of a name, or of a heading: q3 is the third. Raises UnknownNameError with similar names."""
    from cspace.ik.locked_joints import joint_named

    return robot.joint_names[joint_named(robot, word)]


def joint_texts(q: Array, robot: Robot, *, degrees: bool, fewer: int = 0) -> list[str]:
    """A configuration (n,) as texts: angles in the selected unit, prismatic joints in metres.

    fewer: how many decimals are left out.
    """
    texts = []
    for value, kind in zip(q, robot.joint_types, strict=True):
        in_degrees = kind == "R" and degrees
        decimals = (3 if in_degrees else 5) - fewer
        texts.append(f"{tidy_number(np.degrees(value) if in_degrees else value, decimals):.{decimals}f}")
    return texts
