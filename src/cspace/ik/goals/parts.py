"""Parts of a pose as callers give them, checked and made into a PartialGoal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from cspace.arrays import Array, as_arrays, leading_axes, one_array
from cspace.errors import InputError, InputTypeError
from cspace.ik.goals.given import is_open
from cspace.ik.goals.partial import ANY, BALL, CROSS, KEYWORDS, PartialGoal
from cspace.spatial import as_rotation
from cspace.spatial.vectors import AXES, length_and_direction
from cspace.tolerances import FARTHEST

POINTED = ("direction", "look_at", "ray", "angle_to")
"""The keywords that involve the tool axis."""
DIRECTIONS = ("direction", "ray[1]", "angle_to[0]", "tool_axis")
MAY_BE_OPEN = ("position", "look_at")
"""The points of which some coordinates may be None, where any value will do."""
ONE_FOR_ALL = {
    "tool_axis": "(3,): one axis for all goals",
    "angle_to[0]": "(3,): one axis for all goals",
    "angle_to[1]": "one angle for all goals [rad]",
}


TURN, SLIDE = ("R", None), ("P", None)
"""Joints about and along the tool axis."""
BEHIND: dict[str, tuple[tuple[str, Array | None], ...]] = {
    "position": BALL,
    "rotation": CROSS,
    "direction": (TURN, *CROSS),
    "position+rotation": (),
    "position+direction": (TURN,),
    "look_at": (SLIDE, *BALL),
    "ray": (SLIDE, TURN),
    "position+angle_to": (TURN, TURN),
}
"""The virtual joints behind the tip for what each kind of goal leaves free."""


def check_tool_axis(tool_axis: Any, names: Iterable[str]) -> None:
    """Raise InputTypeError for a tool axis that no other keyword involves."""
    if (isinstance(tool_axis, str) and tool_axis == "z") or any(name in POINTED for name in names):
        return
    raise InputTypeError(
        f"tool_axis= can only be combined with {', '.join(name + '=' for name in POINTED)}, because no other"
        " keyword involves the direction of the tool; leave it out"
    )


def partial_goal(given: dict[str, Any], tool_axis: Any) -> PartialGoal:
    """The goal that some of KEYWORDS make; `given` contains those that are not None.

    Raises InputTypeError for keywords that do not go together, InputError for values outside their range.
    """
    kind = "+".join(name for name in KEYWORDS if name in given)
    if kind not in BEHIND:
        names = " and ".join(name + "=" for name in given)
        raise InputTypeError(
            f"{names} cannot be combined; possible combinations are "
            + ", ".join(" and ".join(part + "=" for part in k.split("+")) for k in BEHIND)
        )
    if kind != "position" and is_open(given.get("position")):
        others = " and ".join(name + "=" for name in given if name != "position")
        raise InputTypeError(f"position= with {others} needs three coordinates; None is not allowed there")
    return assemble_goal(kind, read_values(given, tool_axis))


def read_values(given: dict[str, Any], tool_axis: Any) -> dict[str, Any]:
    """The values as arrays, directions as unit vectors, pairs as their two parts."""
    values: dict[str, Any] = {"tool_axis": tool_axis}
    for name, value in given.items():
        if name == "ray":
            values["ray[0]"], values["ray[1]"] = pair_of(value, name, "a point (3,) and a direction (3,)")
        elif name == "angle_to":
            words = "an axis of the base and the angle to it [rad]"
            values["angle_to[0]"], values["angle_to[1]"] = pair_of(value, name, words)
        elif name == "rotation":
            values[name] = np.asarray(as_rotation(value, name), dtype=np.float64)
        else:
            values[name] = value
    named = [name for name in ("tool_axis", "angle_to[0]", "direction") if isinstance(values.get(name), str)]
    for name in named:
        values[name] = axis_named(values[name])
    for name in (name for name in values if name not in MAY_BE_OPEN):
        if is_open(values[name]):
            raise InputTypeError(
                f"{name} contains None, expected numbers; only coordinates of "
                f"{' and '.join(point + '=' for point in MAY_BE_OPEN)} may be None"
            )
    read = [name for name, v in values.items() if name not in named and name != "rotation" and not is_open(v)]
    if read:
        shapes = {name: (values[name], () if name == "angle_to[1]" else (3,)) for name in read}
        values |= as_arrays(shapes, largest=FARTHEST)
    for name, expected in ONE_FOR_ALL.items():
        if name in values and np.ndim(values[name]) != (name != "angle_to[1]"):
            raise InputError(f"{name} has shape {np.shape(values[name])}, expected {expected}")
    for name in DIRECTIONS:
        if name in read:
            size, values[name] = length_and_direction(values[name])
            if (size == 0).any():
                raise InputError(f"{name} is zero and has no direction")
    return values


def check_one_goal(function: str, goal: Any, given: dict[str, Any], tool_axis: Any) -> None:
    """Raise InputTypeError unless there is one goal, a pose or parts of one, and a tool axis only for it."""
    check_tool_axis(tool_axis, given)
    if (goal is None) == (not given):
        raise InputTypeError(
            f"{function} needs one goal: robot.{function}(T) with the pose of the tip in the base, or parts"
            f" of it by name, such as robot.{function}(position=p)"
        )


def pair_of(value: Any, name: str, words: str) -> Any:
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return value
    raise InputTypeError(f"{name} must be a pair: {words}")


def axis_named(name: str) -> Array:
    if name not in AXES:
        raise InputError(f"axis {name!r} is unknown, expected x, y, z, -x, -y, -z or a direction (3,)")
    return AXES[name]


def assemble_goal(kind: str, values: dict[str, Any]) -> PartialGoal:
    """The goal of a kind from its values: a pose that meets it, and the virtual joints for what is free."""
    axis, tilt = values["tool_axis"], 0.0
    value: dict[str, Any] = {}
    before: tuple[tuple[str, Array], ...] = ()
    p, R, pointing = np.zeros(3), ANY, None
    for name in kind.split("+"):
        value[name] = values.get(name)
        if name == "rotation":
            R = values[name]
        elif name == "direction":
            pointing = values[name]
        elif name == "ray":
            value[name] = p, pointing = values["ray[0]"], values["ray[1]"]
            p = p - np.sum(p * pointing, axis=-1, keepdims=True) * pointing  # its point nearest to the base
        elif name == "angle_to":
            value[name] = pointing, tilt = values["angle_to[0]"], float(values["angle_to[1]"])
            if not 0 <= tilt <= np.pi:
                raise InputError(
                    f"angle_to[1] is {tilt:g}, expected 0 to π rad, the angle between two directions"
                )
        elif is_open(values[name]):
            p, before = open_point(values[name], name)
        else:  # position, look_at
            p = values[name]
    if pointing is not None:
        R = turn_to(axis, pointing)
    behind = tuple((joint, axis if h is None else h) for joint, h in BEHIND[kind])
    if p.ndim > 1 and R.ndim > 2:
        leading_axes(position=p.shape[:-1], rotation=R.shape[:-2])
    return PartialGoal(kind, assemble(R, p), behind, value, axis, before, tilt)


def open_point(value: Any, name: str) -> tuple[Array, tuple[tuple[str, Array], ...]]:
    """A point of which some coordinates are None, these at zero, and a prismatic joint along each of them."""
    if len(value) != 3:
        raise InputError(f"{name} has {len(value)} coordinates, expected 3 (None where any value will do)")
    free = [i for i in range(3) if value[i] is None]
    if len(free) == 3:
        raise InputError(f"{name} has None for all three coordinates; give at least one of them")
    p = one_array([0.0 if v is None else v for v in value], name, (3,), largest=FARTHEST)
    return p, tuple(("P", np.eye(3)[i]) for i in free)


def assemble(R: Array, p: Array) -> Array:
    """As of the room of poses, but unchecked: the parts of a goal are checked already."""
    T = np.zeros((*np.broadcast_shapes(p.shape[:-1], R.shape[:-2]), 4, 4))
    T[..., :3, :3], T[..., :3, 3], T[..., 3, 3] = R, p, 1.0
    return T


def turn_to(a: Array, d: Array) -> Array:
    """A rotation (..., 3, 3) that takes the unit vector a (3,) to d (..., 3)."""
    backwards = np.sum(a * d, axis=-1)[..., None] < 0
    start = np.where(backwards, -a, a)  # so that the middle of start and d is long
    middle = start + d
    middle = middle / np.linalg.norm(middle, axis=-1, keepdims=True)
    square = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
    flip = np.where(backwards[..., None], half_turn(square / np.linalg.norm(square)), np.eye(3))
    return np.asarray(half_turn(middle) @ half_turn(a) @ flip)


def half_turn(h: Array) -> Array:
    """The rotations (..., 3, 3) by π about unit vectors (..., 3)."""
    return np.asarray(2 * h[..., :, None] * h[..., None, :] - np.eye(3))
