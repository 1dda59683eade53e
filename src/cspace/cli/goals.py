"""The goal of `cspace ik`: a pose, or the parts of one that matter, by the words of robot.ik."""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import (
    OPEN,
    add_option,
    read_angle,
    read_coordinate,
    read_number,
    read_radians,
)
from cspace.cli.exits import UsageError

if TYPE_CHECKING:
    from cspace.robot import Robot

ORIENTATIONS: Final = ("rpy", "wxyz", "xyzw", "rotation")
"""The forms of an orientation."""
LINEAR: Final = ("vx", "vy", "vz")
"""The rows of the Jacobian that move a place, coordinate by coordinate."""
POINTED: Final = ("direction", "look_at", "ray", "angle_to")
"""Parts of a goal that constrain the tool axis."""
GOAL_WORDS: Final = ("xyz", "xy", "angle", *ORIENTATIONS, "matrix", *POINTED)
"""Every word of a goal."""
KEYWORDS: Final = re.compile(
    r"\b(position|rotation|direction|look_at|ray|angle_to|angle|tool_axis|locked|swivel|samples|near"
    r"|least_squares|goal_parts|velocity|acceleration|jerk|duration|speed|turn_rate|torque)=(?=[^=]|$)"
)
"""The keywords of robot.ik and of motions that are options here."""
NO_GOAL: Final = (
    "no goal is given: give a pose (--matrix, or --xyz with one of --rpy, --wxyz, --xyzw and --rotation), or"
    " the parts of one that matter (--xyz, --xy, --direction, --look-at, --ray, an orientation alone)"
)


@dataclass(frozen=True)
class Goal:
    """A goal: a pose T (4, 4), or parts of one by the keywords of robot.ik, with the tool axis."""

    T: Array | None = None
    parts: dict[str, Any] = field(default_factory=dict)
    tool_axis: Any = "z"

    def ask(self, robot: Robot, **options: Any) -> Any:
        """The result of robot.ik."""
        return robot.ik(**self.keywords, **options)

    @property
    def keywords(self) -> dict[str, Any]:
        """The keywords of robot.ik."""
        return {"goal": self.T, **self.parts, "tool_axis": self.tool_axis}

    @property
    def rows(self) -> str | tuple[str, ...]:
        """The rows of the Jacobian that count where joints are judged by this goal."""
        if set(self.parts) == {"rotation"}:
            return "angular"
        if set(self.parts) != {"position"}:
            return "auto"
        place = self.parts["position"]
        asked = [row for row, value in zip(LINEAR, place, strict=False) if value is not None]
        return tuple(asked) if len(place) == 3 else "linear"

    @property
    def mark(self) -> Array | None:
        """What a picture can show of the goal: a pose (4, 4), a point (3,) or (2,), or nothing."""
        if self.T is not None:
            return self.T
        point = self.parts.get("position", self.parts.get("look_at"))
        return None if point is None or None in point else np.array(point)

    def document(self) -> dict[str, Any]:
        """The goal as JSON data, [rad] and [m]; null for parts that are not given."""
        asked = {name: self.parts.get(name) for name in ("position", "rotation", "angle", *POINTED)}
        pointed = any(name in self.parts for name in POINTED)
        return {"matrix": self.T, **asked, "tool_axis": self.tool_axis if pointed else None}


def add_goal(parser: argparse.ArgumentParser) -> None:
    """The words of a goal."""
    group = parser.add_argument_group(
        "goal", "the tip in the base: a pose (a place and an orientation), or the parts of it that matter"
    )

    text = f"position [m]; {OPEN}: does not matter"
    add_option(group, "--xyz --position X Y Z", text, read_coordinate)
    add_option(group, "--xy X Y", "position of a planar arm [m]", read_number)
    add_option(group, "--angle A", "with --xy: the angle of the tip's x axis", read_angle)
    add_option(group, "--rpy R P Y", "orientation: roll, pitch, yaw about fixed x, y, z", read_angle)
    add_option(group, "--wxyz W X Y Z", "orientation: quaternion, real part first", read_number)
    add_option(group, "--xyzw X Y Z W", "orientation: quaternion, real part last", read_number)
    add_option(group, "--rotation R", "orientation: matrix, row by row", read_number, nargs=9)
    add_option(group, "--matrix M", "the whole pose, row by row", read_number, nargs=16)
    add_option(group, "--direction X Y Z", "direction of the tool axis", read_number)
    add_option(group, "--look-at X Y Z", "a point on the tool axis, ahead of the tip [m]", read_number)
    text = "a point [m] and the direction of the line of the tool axis"
    add_option(group, "--ray X Y Z DX DY DZ", text, read_number)
    add_option(group, "--angle-to AXIS A", "with --xyz: an axis of the base, and the angle to it")
    add_option(group, "--tool-axis AXIS…", "the tool axis in the tip: z, -x, or 3 numbers")


def goal_of(args: argparse.Namespace) -> Goal:
    """The goal that the options describe. Raises UsageError for options that do not describe one."""
    from cspace.spatial import as_pose, pose, project_pose

    given = [name for name in GOAL_WORDS if getattr(args, name) is not None]
    if not given:
        raise UsageError(NO_GOAL)
    if args.matrix is not None:
        if len(given) > 1:
            other = next(name for name in given if name != "matrix").replace("_", "-")
            raise UsageError(f"--matrix is the whole pose already; leave --{other} out")
        T = np.reshape(args.matrix, (4, 4))
        T = project_pose(T) if is_rounded(T[:3, :3]) else as_pose(T, "--matrix")
        return Goal(T, tool_axis=axis_of(args))
    place, R = place_of(args), rotation_of(args)
    parts = {"position": place, "rotation": R, **pointing_of(args)}
    parts = {name: value for name, value in parts.items() if value is not None}
    if set(parts) == {"angle_to"}:
        raise UsageError("--angle-to needs a position: give --xyz too")
    if set(parts) == {"position", "rotation"} and None not in parts["position"]:
        return Goal(pose(np.array(place), matrix=R), tool_axis=axis_of(args))
    if args.angle is not None:
        parts["angle"] = read_radians(args.angle, degrees=args.deg)
    return Goal(None, parts, axis_of(args))


def name_options(message: str) -> str:
    """A message of the library with the options of the command line: near= is --near."""
    return KEYWORDS.sub(lambda match: "--" + match[1].replace("_", "-"), message)


def is_rounded(R: Array) -> bool:
    """Whether a matrix (3, 3) is a rotation typed with few decimals: the nearest rotation is meant."""
    from cspace.spatial.checks import orthogonality_error
    from cspace.tolerances import ROTATION_ERROR, TYPED_ROTATION

    return bool(ROTATION_ERROR < orthogonality_error(R) <= TYPED_ROTATION)


def place_of(args: argparse.Namespace) -> list[float | None] | None:
    """The given position, of three coordinates or two."""
    if args.xyz is not None and args.xy is not None:
        raise UsageError("--xyz and --xy both give a position: leave one out")
    if args.angle is not None and args.xy is None:
        raise UsageError("--angle is for planar arms: give --xy with it")
    if args.xy is not None:
        forms = [name for name in ORIENTATIONS if getattr(args, name) is not None]
        if forms:
            raise UsageError(f"--xy is a point of the plane: instead of --{forms[0]} give --angle, or --xyz")
        return list(args.xy)
    return None if args.xyz is None else list(args.xyz)


def rotation_of(args: argparse.Namespace) -> Array | None:
    """The given orientation (3, 3), in one of its forms."""
    from cspace.spatial import as_rotation, pose, project_rotation

    forms = [name for name in ORIENTATIONS if getattr(args, name) is not None]
    if len(forms) > 1:
        raise UsageError(f"one orientation only; {' and '.join('--' + name for name in forms)} were given")
    if not forms:
        return None
    values = getattr(args, forms[0])
    if forms[0] == "rotation":
        R = np.reshape(values, (3, 3))
        return project_rotation(R) if is_rounded(R) else np.asarray(as_rotation(R, "--rotation"))
    if forms[0] == "rpy":
        values = [read_radians(value, degrees=args.deg) for value in values]
    arguments: dict[str, Any] = {forms[0]: np.array(values)}
    return np.asarray(pose(np.zeros(3), **arguments)[:3, :3])


def pointing_of(args: argparse.Namespace) -> dict[str, Any]:
    """The constraints on the tool axis."""
    parts: dict[str, Any] = {"direction": args.direction, "look_at": args.look_at}
    if args.ray is not None:
        parts["ray"] = (args.ray[:3], args.ray[3:])
    if args.angle_to is not None:
        axis, angle = args.angle_to
        try:
            value = read_angle(angle)
        except argparse.ArgumentTypeError as error:
            raise UsageError(f"--angle-to takes an axis and an angle: {error}") from None
        parts["angle_to"] = (axis.strip(), read_radians(value, degrees=args.deg))
    return parts


def axis_of(args: argparse.Namespace) -> Any:
    """The tool axis: a name, or a direction in the tip."""
    words = args.tool_axis or ["z"]
    if len(words) == 1:
        return words[0].strip()
    try:
        axis = [read_number(word) for word in words]
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"--tool-axis takes a name or three numbers: {error}") from None
    if len(axis) != 3:
        raise UsageError(f"--tool-axis takes a name or three numbers, got {len(axis)}")
    return axis
