"""Parts of a pose as callers give them, checked and made into a PartialGoal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from cspace.arrays import Array, as_arrays, leading_axes
from cspace.errors import InputError, InputTypeError
from cspace.ik.goals.given import is_open
from cspace.ik.goals.partial import ANY, AXES, BALL, CROSS, KEYWORDS, PartialGoal
from cspace.spatial import as_rotation
from cspace.spatial.vectors import length_and_direction
from cspace.tolerances import FARTHEST

POINTED = ("direction", "look_at", "ray", "angle_to")
"""The keywords that involve the tool axis."""
DIRECTIONS = ("direction", "ray[1]", "angle_to[0]", "tool_axis")
ONE_FOR_ALL = {
    "tool_axis": "(3,): one axis for all goals",
    "angle_to[0]": "(3,): one axis for all goals",
    "angle_to[1]": "one angle for all goals [rad]",
}


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
    if kind not in MAKERS:
        names = " and ".join(name + "=" for name in given)
        raise InputTypeError(
            f"{names} cannot be combined; possible combinations are "
            + ", ".join(" and ".join(part + "=" for part in k.split("+")) for k in MAKERS)
        )
    if kind != "position" and is_open(given.get("position")):
        others = " and ".join(name + "=" for name in given if name != "position")
        raise InputTypeError(f"position= with {others} needs three coordinates; None is not allowed there")
    values = read_values(given, tool_axis)
    return MAKERS[kind](values, values["tool_axis"])


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
    named = [name for name in ("tool_axis", "angle_to[0]") if isinstance(values.get(name), str)]
    for name in named:
        values[name] = axis_named(values[name])
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


def pair_of(value: Any, name: str, words: str) -> Any:
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return value
    raise InputTypeError(f"{name} must be a pair: {words}")


def axis_named(name: str) -> Array:
    sign = -1.0 if name.startswith("-") else 1.0
    if name.removeprefix("-") not in AXES:
        raise InputError(f"axis {name!r} is unknown, expected x, y, z, -x, -y, -z or a direction (3,)")
    return np.asarray(sign * AXES[name.removeprefix("-")])


# --- one kind of goal each --------------------------------------------------------------------------------
def goal_of_position(values: dict[str, Any], axis: Array) -> PartialGoal:
    value = values["position"]
    if not is_open(value):
        return PartialGoal("position", assemble(ANY, value), BALL, {"position": value}, axis)
    p, free = open_point(value)
    before = tuple(("P", np.eye(3)[i]) for i in free)
    return PartialGoal("position", assemble(ANY, p), BALL, {"position": value}, axis, before)


def open_point(value: Any) -> tuple[Array, list[int]]:
    """A point of which some coordinates are None, these at zero, and their indices."""
    if len(value) != 3:
        raise InputError(f"position has {len(value)} coordinates, expected 3 (None where any value will do)")
    free = [i for i in range(3) if value[i] is None]
    if len(free) == 3:
        raise InputError("position has None for all three coordinates; give at least one of them")
    p = [0.0 if v is None else v for v in value]
    return as_arrays({"position": (p, (3,))}, largest=FARTHEST)["position"], free


def rotation(values: dict[str, Any], axis: Array) -> PartialGoal:
    R = values["rotation"]
    return PartialGoal("rotation", assemble(R, np.zeros(3)), CROSS, {"rotation": R}, axis)


def position_and_rotation(values: dict[str, Any], axis: Array) -> PartialGoal:
    p, R = values["position"], values["rotation"]
    if p.ndim > 1 or R.ndim > 2:
        leading_axes(position=p.shape[:-1], rotation=R.shape[:-2])
    return PartialGoal("position+rotation", assemble(R, p), (), {"position": p, "rotation": R}, axis)


def goal_of_direction(values: dict[str, Any], axis: Array) -> PartialGoal:
    d = values["direction"]
    behind = (("R", axis), *CROSS)
    return PartialGoal("direction", assemble(turn_to(axis, d), np.zeros(3)), behind, {"direction": d}, axis)


def position_and_direction(values: dict[str, Any], axis: Array) -> PartialGoal:
    p, d = values["position"], values["direction"]
    value = {"position": p, "direction": d}
    return PartialGoal("position+direction", assemble(turn_to(axis, d), p), (("R", axis),), value, axis)


def look_at(values: dict[str, Any], axis: Array) -> PartialGoal:
    p = values["look_at"]
    return PartialGoal("look_at", assemble(ANY, p), (("P", axis), *BALL), {"look_at": p}, axis)


def goal_of_ray(values: dict[str, Any], axis: Array) -> PartialGoal:
    p, d = values["ray[0]"], values["ray[1]"]
    behind = (("P", axis), ("R", axis))
    foot = p - np.sum(p * d, axis=-1, keepdims=True) * d  # the same line, by its point nearest to the base
    return PartialGoal("ray", assemble(turn_to(axis, d), foot), behind, {"ray": (p, d)}, axis)


def position_and_angle(values: dict[str, Any], axis: Array) -> PartialGoal:
    p, h, tilt = values["position"], values["angle_to[0]"], float(values["angle_to[1]"])
    if not 0 <= tilt <= np.pi:
        raise InputError(f"angle_to[1] is {tilt:g}, expected 0 to π rad, the angle between two directions")
    behind = (("R", axis), ("R", axis))
    value = {"position": p, "angle_to": (h, tilt)}
    return PartialGoal("position+angle_to", assemble(turn_to(axis, h), p), behind, value, axis, (), tilt, h)


MAKERS = {
    "position": goal_of_position,
    "rotation": rotation,
    "direction": goal_of_direction,
    "position+rotation": position_and_rotation,
    "position+direction": position_and_direction,
    "look_at": look_at,
    "ray": goal_of_ray,
    "position+angle_to": position_and_angle,
}


def assemble(R: Array, p: Array) -> Array:
    """Poses (..., 4, 4) from rotations (..., 3, 3) and points (..., 3), one of them perhaps for all."""
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
