"""Partial goals: parts of a pose of the tip.

A partial goal leaves some motions of the tip free, and virtual joints stand for them: a tip that only has to
be at a point may turn about it, as on a ball joint. With such joints behind the tip (or before the base) the
goal is a pose of a longer arm. The solutions of that pose, without the virtual joints, are those of the goal.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.model import Chain
from cspace.spatial import exp_so3
from cspace.spatial.vectors import AXES, X, Y, Z, perpendicular

KEYWORDS = ("position", "rotation", "direction", "look_at", "ray", "angle_to")
BALL = (("R", X), ("R", Y), ("R", Z))
ANY = np.array([[0, -0.6, 0.8], [0.8, -0.48, -0.36], [0.6, 0.64, 0.48]])
"""The orientation to which BALL turns the tip back: in line with no arm, so that no two of its axes become
one."""
CROSS = (("P", X), ("P", Y), ("P", Z))


@dataclass(frozen=True, eq=False)
class PartialGoal:
    """One kind of goal, of one tool axis, for one or many values.

    kind: its keywords, joined by "+". T (..., 4, 4): poses that meet the goals. behind: the virtual joints
    behind the tip, each ("R" or "P", axis in the tip), with a fixed turn `tilt` [rad] before the last one,
    if any; before: those before the base. value: as the user gave it.
    """

    kind: str
    T: Array
    behind: tuple[tuple[str, Array], ...]
    value: dict[str, Any]
    axis: Array = field(default_factory=lambda: Z)
    before: tuple[tuple[str, Array], ...] = ()
    tilt: float = 0.0

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
        if "pose" in self.value:
            return "the goal"
        return " and ".join(WORDS[name] for name in self.kind.split("+"))

    def extend_chain(self, chain: Chain) -> Chain:
        """The chain with the goal's joints before its base and behind its tip."""
        names = self.joint_names
        for name, (kind, axis) in reversed(list(zip(names, self.before, strict=False))):
            chain = chain.prepend(name, kind, axis)
        last = len(self.behind) - 1
        for i, (name, (kind, axis)) in enumerate(zip(names[len(self.before) :], self.behind, strict=True)):
            if self.tilt and i == last:
                chain = chain.turn_tip(exp_so3(self.tilt * perpendicular(axis)))
            lower = 0.0 if kind == "P" and "look_at" in self.kind else -np.inf  # the point lies ahead
            chain = chain.append(name, kind, axis, lower)
        return chain

    def own_joints(self, q: Array) -> Array:
        """The arm's own joints of configurations (..., n) of the arm with the goal's joints."""
        return q[..., len(self.before) : q.shape[-1] - len(self.behind)]

    def take(self, index: Any) -> PartialGoal:
        """One of many goals."""
        shape = self.T.shape[:-2]

        def part(v: Any, own: int) -> Any:
            if isinstance(v, tuple):
                return tuple(part(one, 1) for one in v)
            if not isinstance(v, np.ndarray) or v.ndim <= own:
                return v
            return np.broadcast_to(v, (*shape, *v.shape[v.ndim - own :]))[index]

        value = {name: part(v, BARE.get(name, 1)) for name, v in self.value.items()}
        return replace(self, T=self.T[index], value=value)

    def spread(self, shape: tuple[int, ...]) -> PartialGoal:
        """The same goals, as many as a shape says."""
        return replace(self, T=np.broadcast_to(self.T, (*shape, 4, 4)))

    def residual(self, T: Array) -> Array:
        """The largest distance [m] or angle [rad] of poses (k, 4, 4) from the goal, or from k goals, (k,)."""
        distances, angles = self.misses(T)
        return np.asarray(np.max(distances + angles, axis=0))

    def misses(self, T: Array) -> tuple[list[Array], list[Array]]:
        """How far poses (k, 4, 4) are from what the goal asks for: distances [m] and angles [rad], (k,)."""
        p, goal = T[..., :3, 3], self.T[..., :3, 3]
        distances, angles = [], []
        for name in self.kind.split("+"):
            if name not in ("position", "rotation"):  # what involves the tool axis
                a, d = T[..., :3, :3] @ self.axis, self.T[..., :3, :3] @ self.axis
            if name == "position":
                open_coordinates = sum((axis for _, axis in self.before), np.zeros(3))
                distances.append(np.linalg.norm((p - goal) * (1.0 - open_coordinates), axis=-1))
            elif name == "rotation":
                # ‖R − R_goal‖_F = 2√2 sin(angle/2), which keeps its digits for small angles.
                gap = np.linalg.norm(T[..., :3, :3] - self.T[..., :3, :3], axis=(-2, -1))
                angles.append(2 * np.arcsin(np.minimum(gap / np.sqrt(8), 1.0)))
            elif name == "angle_to":
                angles.append(np.abs(measure_angle(a, self.value[name][0]) - self.tilt))
            elif name == "direction":
                angles.append(measure_angle(a, d))
            elif name == "ray":
                distances.append(from_line(p - goal, d))
                angles.append(measure_angle(a, d))
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


WORDS = {
    "position": "the position",
    "rotation": "the orientation",
    "direction": "the direction of the tool axis",
    "look_at": "the point to look at",
    "ray": "the ray",
    "angle_to": "the angle of the tool axis",
}
BARE = {"rotation": 2, "pose": 2}
"""Dimensions of the value of one goal, where it is no vector."""


def plain_goal(goal: Array) -> PartialGoal:
    """Whole poses (..., 4, 4) or points (..., 3) by their parts, without virtual joints."""
    if goal.shape[-1] == 4:
        return PartialGoal("position+rotation", goal, (), {"pose": goal})
    return PartialGoal("position", position_goal(goal), (), {"position": goal})


def position_goal(p: Array) -> Array:
    """Points (..., 3) in the shape of poses, their rotations unknown."""
    T = np.full((*p.shape[:-1], 4, 4), np.nan)
    T[..., :3, 3] = p
    return T


def measure_angle(a: Array, b: Array) -> Array:
    """The angle between unit vectors (..., 3) [rad], with all its digits."""
    return np.asarray(2 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1)))


def from_line(away: Array, d: Array) -> Array:
    """The distances of points (..., 3) from lines through the origin along unit vectors."""
    along = np.sum(away * d, axis=-1, keepdims=True)
    return np.asarray(np.linalg.norm(away - along * d, axis=-1))
