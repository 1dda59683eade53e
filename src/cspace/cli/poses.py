"""Poses as people type them and read them."""

from __future__ import annotations

import argparse
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import number
from cspace.cli.exits import UsageError
from cspace.cli.output import Output

__all__ = ["add_goal", "goal_of", "pose_document", "show_pose"]

FORMS: Final = ("rpy", "wxyz", "xyzw")
"""The forms of an orientation."""


def add_goal(parser: argparse.ArgumentParser) -> None:
    """A pose, or a point alone."""
    group = parser.add_argument_group("goal", "the tip in the base: a point, or a point and one orientation")

    def add(name: str, letters: str, text: str) -> None:
        words = tuple(letters)
        group.add_argument(f"--{name}", nargs=len(words), metavar=words, type=number, help=text)

    add("xyz", "XYZ", "position [m]")
    add("xy", "XY", "position of a planar arm [m]")
    add("rpy", "RPY", "roll, pitch, yaw about fixed x, y, z")
    add("wxyz", "WXYZ", "quaternion, real part first")
    add("xyzw", "XYZW", "quaternion, real part last")
    group.add_argument("--matrix", nargs=16, metavar="M", type=number, help="the whole pose, row by row")


def goal_of(args: argparse.Namespace) -> tuple[Array | None, Array | None]:
    """The goal as a pose (4, 4), or as a point (2,) or (3,) alone: (T, None) or (None, p)."""
    from cspace.spatial import as_pose, pose

    places = [name for name in ("xyz", "xy", "matrix") if getattr(args, name) is not None]
    forms = [name for name in FORMS if getattr(args, name) is not None]
    if len(places) != 1:
        given = "nothing" if not places else " and ".join("--" + name for name in places)
        raise UsageError(f"the goal needs one of --xyz, --xy and --matrix; {given} was given")
    if len(forms) > 1:
        raise UsageError(f"one orientation only; {' and '.join('--' + name for name in forms)} were given")
    if args.matrix is not None:
        if forms:
            raise UsageError(f"--matrix holds the orientation already; leave --{forms[0]} out")
        return as_pose(np.reshape(args.matrix, (4, 4)), "--matrix"), None
    if args.xy is not None:
        if forms:
            raise UsageError(f"--xy is a point of the plane; with --{forms[0]} give --xyz")
        return None, np.array(args.xy)
    if not forms:
        return None, np.array(args.xyz)
    rotation = np.array(getattr(args, forms[0]))
    if forms[0] == "rpy" and args.deg:
        rotation = np.radians(rotation)
    arguments: dict[str, Any] = {forms[0]: rotation}
    return pose(args.xyz, **arguments), None


def pose_document(T: Array) -> dict[str, list[Any]]:
    """A pose (4, 4) in every form, [m] and [rad]."""
    from cspace.spatial import to_rpy, to_wxyz, to_xyzw

    forms = {"matrix": T, "xyz": T[:3, 3], "rpy": to_rpy(T), "wxyz": to_wxyz(T), "xyzw": to_xyzw(T)}
    return {name: np.asarray(value).tolist() for name, value in forms.items()}


def show_pose(out: Output, T: Array, name: str, *, degrees: bool) -> None:
    """A pose (4, 4) as a matrix and in every other form."""
    forms = pose_document(T)
    rpy = np.degrees(forms["rpy"]) if degrees else np.array(forms["rpy"])
    out.matrix(T, name)
    out.facts(
        {
            "xyz [m]": numbers(forms["xyz"]),
            f"rpy [{'deg' if degrees else 'rad'}]": numbers(rpy) + "  (about fixed x, y, z)",
            "wxyz": numbers(forms["wxyz"]) + "  (quaternion, real part first)",
            "xyzw": numbers(forms["xyzw"]) + "  (quaternion, real part last)",
        }
    )


def numbers(values: Any) -> str:
    """Numbers in a line, rounding noise shown as zero."""
    return "  ".join(f"{0.0 if abs(x) < 5e-7 else x:.6f}" for x in values)
