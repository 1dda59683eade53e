"""partial goals.

What a goal leaves open is a motion, and joints that do not exist make it: a tip asked to be at a point may
turn about it, as on a ball joint. With such joints behind the tip (or before the base) the goal is a pose of
a longer arm, and its solutions, those joints left out, are the goal's.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import InputError, InputTypeError
from cspace.spatial import as_rotation
from cspace.spatial.vectors import length_and_direction
from cspace.tolerances import FARTHEST

__all__ = ["KEYWORDS", "PartialGoal", "check_tool_axis", "partial_goal"]

KEYWORDS = ("position", "rotation", "direction", "look_at", "ray", "angle_to")
X, Y, Z = np.eye(3)
BALL = (("R", X), ("R", Y), ("R", Z))
ANY = np.array([[0, -0.6, 0.8], [0.8, -0.48, -0.36], [0.6, 0.64, 0.48]])
"""The orientation to which BALL turns the tip back: in line with no arm, so that no two of its axes become
one."""
CROSS = (("P", X), ("P", Y), ("P", Z))
AXES = {"x": X, "y": Y, "z": Z}
POINTED = ("direction", "look_at", "ray", "angle_to")
"""The keywords that ask something of the tool axis."""


@dataclass(frozen=True, eq=False)
class PartialGoal:
    """One kind of goal, of one tool axis, for one or many values.

    kind: its keywords, joined by "+". T (..., 4, 4): poses that meet the goals. behind: the joints behind the
    tip that may move it within the goal, each ("R" or "P", axis in the tip), with a fixed turn before the
    last one, if any, as `tilt` [rad]; before: those before the base. value: what the user gave.
    """

    kind: str
    T: Array
    behind: tuple[tuple[str, Array], ...]
    value: dict[str, Any]
    axis: Array = field(default_factory=lambda: Z)
    before: tuple[tuple[str, Array], ...] = ()
    tilt: float = 0.0
    base_axis: Array = field(default_factory=lambda: Z)

    @property
    def key(self) -> tuple[Any, ...]:
        """What the longer arm depends on."""
        joints = tuple((kind, *axis.tolist()) for kind, axis in (*self.before, *self.behind))
        return self.kind, joints, len(self.before), self.tilt

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names for the joints of the goal, before and behind: what they let the base or the tool do."""
        names: list[str] = []
        for i, (kind, axis) in enumerate((*self.before, *self.behind)):
            body = "base" if i < len(self.before) else "tool"
            letter = next((f"_{name}" for name, e in AXES.items() if abs(axis @ e) == 1.0), "")
            name = f"goal_{body}_{'turn' if kind == 'R' else 'slide'}{letter}"
            names.append(name if name not in names else f"{name}_again")
        return tuple(names)

    @property
    def text(self) -> str:
        """The goal in words."""
        return " and ".join(WORDS[name] for name in self.kind.split("+"))

    def take(self, index: Any) -> PartialGoal:
        """One of many goals."""
        value = {
            name: v[index] if isinstance(v, np.ndarray) and v.ndim > BARE.get(name, 9) else v
            for name, v in self.value.items()
        }
        return PartialGoal(
            self.kind, self.T[index], self.behind, value, self.axis, self.before, self.tilt, self.base_axis
        )

    def residual(self, T: Array) -> Array:
        """How far poses (k, 4, 4) are from the goal (or from k goals), (k,): the largest of its distances
        [m] and angles [rad].
        """
        distances, angles = self.misses(T)
        return np.asarray(np.max(distances + angles, axis=0))

    def misses(self, T: Array) -> tuple[list[Array], list[Array]]:
        """How far poses (k, 4, 4) are from what the goal asks for: distances [m] and angles [rad], (k,)."""
        p, a = T[..., :3, 3], T[..., :3, :3] @ self.axis
        goal, d = self.T[..., :3, 3], self.T[..., :3, :3] @ self.axis
        distances, angles = [], []
        for name in self.kind.split("+"):
            if name == "position":
                asked = np.array([kind != "P" for kind in self._open_coordinates])
                distances.append(np.linalg.norm((p - goal) * asked, axis=-1))
            elif name == "rotation":
                gap = np.linalg.norm(T[..., :3, :3] - self.T[..., :3, :3], axis=(-2, -1))
                angles.append(2 * np.arcsin(np.minimum(gap / np.sqrt(8), 1.0)))
            elif name == "angle_to":
                angles.append(np.abs(angle(a, np.broadcast_to(self.base_axis, a.shape)) - self.tilt))
            elif name == "direction":
                angles.append(angle(a, d))
            elif name == "ray":
                distances.append(from_line(p - goal, d))
                angles.append(angle(a, d))
            else:  # look_at
                away = goal - p
                is_behind = np.sum(away * a, axis=-1) < 0
                distances.append(np.where(is_behind, np.linalg.norm(away, axis=-1), from_line(away, a)))
        return distances, angles

    def distance_in_words(self, T: Array) -> str:
        """By how much a pose (4, 4) misses the goal."""
        distances, angles = self.misses(T)
        words = [f"{max(distances):.4g} m"] if distances else []
        return " and ".join(words + ([f"{np.degrees(max(angles)):.4g}°"] if angles else []))

    @property
    def _open_coordinates(self) -> tuple[str, str, str]:
        slides = [axis for kind, axis in self.before if kind == "P"]
        marks = tuple("P" if any(axis[i] for axis in slides) else "R" for i in range(3))
        return marks  # type: ignore[return-value]


WORDS = {
    "position": "the position",
    "rotation": "the orientation",
    "direction": "the direction of the tool axis",
    "look_at": "the point to look at",
    "ray": "the ray",
    "angle_to": "the angle of the tool axis",
}
BARE = {"position": 1, "rotation": 2, "direction": 1, "look_at": 1}
"""Dimensions of the value of one goal."""


def angle(a: Array, b: Array) -> Array:
    """The angle between unit vectors (..., 3) [rad], with all its digits."""
    return np.asarray(2 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1)))


def from_line(away: Array, d: Array) -> Array:
    """The distances of points (..., 3) from lines through the origin along unit vectors."""
    along = np.sum(away * d, axis=-1, keepdims=True)
    return np.asarray(np.linalg.norm(away - along * d, axis=-1))


def check_tool_axis(tool_axis: Any, names: Iterable[str]) -> None:
    """Refuse a tool axis where nothing is asked of it: it would change nothing."""
    if (isinstance(tool_axis, str) and tool_axis == "z") or any(name in POINTED for name in names):
        return
    raise InputTypeError(
        f"tool_axis= goes with {', '.join(name + '=' for name in POINTED)}: nothing else asks where the tool "
        "points; leave it out"
    )


def partial_goal(given: dict[str, Any], tool_axis: Any) -> PartialGoal:
    """The goal that some of KEYWORDS ask for; `given` holds those that are not None.

    Raises InputTypeError for keywords that do not go together, InputError for values outside their range.
    """
    axis = one_axis(tool_axis, "tool_axis")
    kind = "+".join(name for name in KEYWORDS if name in given)
    makers = {
        "position": position,
        "rotation": rotation,
        "direction": direction,
        "position+rotation": position_and_rotation,
        "position+direction": position_and_direction,
        "look_at": look_at,
        "ray": ray,
        "position+angle_to": position_and_angle,
    }
    if kind not in makers:
        raise InputTypeError(
            f"{' and '.join(name + '=' for name in given)} make no goal; what goes together is "
            + ", ".join(" and ".join(part + "=" for part in k.split("+")) for k in makers)
        )
    if kind != "position" and is_open(given.get("position")):
        others = " and ".join(name + "=" for name in given if name != "position")
        raise InputTypeError(f"position= goes beside {others} with all three coordinates, none left open")
    return makers[kind](given, axis)


def position(given: dict[str, Any], axis: Array) -> PartialGoal:
    value = given["position"]
    if not is_open(value):
        p = point(value, "position")
        return PartialGoal("position", pose(p, ANY), BALL, {"position": p}, axis)
    p, free = open_point(value)
    before = tuple(("P", np.eye(3)[i]) for i in free)
    return PartialGoal("position", pose(p, ANY), BALL, {"position": value}, axis, before)


def rotation(given: dict[str, Any], axis: Array) -> PartialGoal:
    R = turned(given["rotation"])
    return PartialGoal("rotation", pose(np.zeros(3), R), CROSS, {"rotation": R}, axis)


def position_and_rotation(given: dict[str, Any], axis: Array) -> PartialGoal:
    p, R = point(given["position"], "position"), turned(given["rotation"])
    leading_axes(position=p.shape[:-1], rotation=R.shape[:-2])
    return PartialGoal("position+rotation", pose(p, R), (), {"position": p, "rotation": R}, axis)


def direction(given: dict[str, Any], axis: Array) -> PartialGoal:
    d = unit(given["direction"], "direction")
    behind = (("R", axis), *CROSS)
    return PartialGoal("direction", pose(np.zeros(3), turn_to(axis, d)), behind, {"direction": d}, axis)


def position_and_direction(given: dict[str, Any], axis: Array) -> PartialGoal:
    p, d = point(given["position"], "position"), unit(given["direction"], "direction")
    leading_axes(position=p.shape[:-1], direction=d.shape[:-1])
    value = {"position": p, "direction": d}
    return PartialGoal("position+direction", pose(p, turn_to(axis, d)), (("R", axis),), value, axis)


def look_at(given: dict[str, Any], axis: Array) -> PartialGoal:
    p = point(given["look_at"], "look_at")
    return PartialGoal("look_at", pose(p, ANY), (("P", axis), *BALL), {"look_at": p}, axis)


def ray(given: dict[str, Any], axis: Array) -> PartialGoal:
    value = given["ray"]
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise InputTypeError("ray must be a pair: a point on it (3,) and its direction (3,)")
    p, d = point(value[0], "ray[0]"), unit(value[1], "ray[1]")
    leading_axes(**{"ray[0]": p.shape[:-1], "ray[1]": d.shape[:-1]})
    behind = (("P", axis), ("R", axis))
    foot = p - np.sum(p * d, axis=-1, keepdims=True) * d  # the same line, by its point nearest to the base
    return PartialGoal("ray", pose(foot, turn_to(axis, d)), behind, {"ray": (p, d)}, axis)


def position_and_angle(given: dict[str, Any], axis: Array) -> PartialGoal:
    value = given["angle_to"]
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise InputTypeError("angle_to must be a pair: an axis of the base and the angle to it [rad]")
    h = one_axis(value[0], "angle_to[0]")
    angle = as_floats(value[1], "angle_to[1]")
    if angle.ndim:
        raise InputError(f"angle_to[1] has shape {angle.shape}, expected one angle for all goals [rad]")
    tilt = float(angle)
    if not 0 <= tilt <= np.pi:
        raise InputError(f"angle_to[1] is {tilt:g}, expected 0 to π rad, the angle between two directions")
    p = point(given["position"], "position")
    behind = (("R", axis), ("R", axis))
    goal = pose(p, turn_to(axis, h))
    value = {"position": p, "angle_to": (h, tilt)}
    return PartialGoal("position+angle_to", goal, behind, value, axis, (), tilt, h)


def is_open(value: Any) -> bool:
    return isinstance(value, (tuple, list)) and any(v is None for v in value)


def open_point(value: Any) -> tuple[Array, list[int]]:
    """A point some of whose coordinates may be anything (None), those at zero, and which they are."""
    if len(value) != 3:
        raise InputError(f"position has {len(value)} coordinates, expected 3 (None where any value will do)")
    free = [i for i in range(3) if value[i] is None]
    if len(free) == 3:
        raise InputError("position leaves all three coordinates open and asks for nothing; give one of them")
    return point([0.0 if v is None else v for v in value], "position"), free


def point(value: Any, subject: str) -> Array:
    p = as_floats(value, subject, last=(3,), largest=FARTHEST)
    if p.ndim == 0 or p.shape[-1] != 3:
        raise InputError(f"{subject} has shape {p.shape}, expected (..., 3)")
    return p


def unit(value: Any, subject: str) -> Array:
    d = as_floats(value, subject, last=(3,), largest=FARTHEST)
    size, direction = length_and_direction(d)
    if (size == 0).any():
        raise InputError(f"{subject} is zero and has no direction")
    return direction


def one_axis(value: Any, subject: str) -> Array:
    """A unit vector (3,), by its name or as a direction."""
    axis = axis_named(value) if isinstance(value, str) else unit(value, subject)
    if axis.ndim != 1:
        raise InputError(f"{subject} has shape {axis.shape}, expected (3,): one axis for all goals")
    return axis


def axis_named(name: str) -> Array:
    sign = -1.0 if name.startswith("-") else 1.0
    if name.removeprefix("-") not in AXES:
        raise InputError(f"axis {name!r} is unknown, expected x, y, z, -x, -y, -z or a direction (3,)")
    return np.asarray(sign * AXES[name.removeprefix("-")])


def turned(value: Any) -> Array:
    return np.asarray(as_rotation(value, "rotation"), dtype=np.float64)


def pose(p: Array, R: Array | None = None) -> Array:
    """Poses (..., 4, 4) from points (..., 3) and rotations (..., 3, 3), one of them perhaps for all."""
    rotation = np.eye(3) if R is None else R
    many = np.broadcast_shapes(p.shape[:-1], rotation.shape[:-2])
    T = np.zeros((*many, 4, 4))
    T[..., :3, :3], T[..., :3, 3], T[..., 3, 3] = rotation, p, 1.0
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
