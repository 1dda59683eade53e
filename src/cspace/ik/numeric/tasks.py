"""What a robot is asked to do, several things at once: tasks with targets, weights and gains."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np

from cspace.arrays import Array, as_floats, one_array, positive_number
from cspace.errors import InputError
from cspace.spatial.checks import PoseLike, one_pose
from cspace.spatial.poses import assemble
from cspace.spatial.vectors import length_and_direction
from cspace.tables import show_fields
from cspace.tolerances import FARTHEST

POSE: Final = 0
POSITION: Final = 1
DIRECTION: Final = 2
CENTER_OF_MASS: Final = 3
HEAVIEST: Final = 1e6
TASK_WIDTH: Final = 28


@show_fields
@dataclass(frozen=True, eq=False)
class PoseTask:
    """A frame is to take a pose.

    frame: its name, None for the tip. T (4, 4): the pose in the world. weight: of the error [Δp; rotation
    vector] in the axes of T [m, rad]: one number, or (6,), zeros leaving directions free. gain: the share
    of the error that one step takes away, above 0 and at most 1. Raises InputError for a value that is not
    a pose, and for weights that are negative or all zero.
    """

    frame: str | None
    T: PoseLike
    weight: Any = 1.0
    gain: float = 1.0
    _row: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        _pack(self, POSE, one_pose(self.T, "T"), _weights(self.weight, 6))


@show_fields
@dataclass(frozen=True, eq=False)
class PositionTask:
    """A point of a frame is to come to a place.

    frame: its name, None for the tip. p (3,) [m] in the world. weight: one number, or (3,) along the axes of
    the world. point (3,) [m]: in the frame, its origin unless given. gain: as in PoseTask.
    Raises InputError for wrong shapes, NaN, and weights that are negative or all zero.
    """

    frame: str | None
    p: Any
    weight: Any = 1.0
    point: Any = (0.0, 0.0, 0.0)
    gain: float = 1.0
    _row: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        _pack(self, POSITION, _at(self.p, "p"), _weights(self.weight, 3), _vector(self.point, "point"))


@show_fields
@dataclass(frozen=True, eq=False)
class DirectionTask:
    """An axis of a frame is to point somewhere; turns about it are free.

    frame: its name, None for the tip. axis (3,): in the frame. direction (3,): in the world; lengths do not
    matter. weight: per radian between them. gain: as in PoseTask.
    Raises InputError for wrong shapes, NaN, zero vectors, and weights that are not positive.
    """

    frame: str | None
    axis: Any
    direction: Any
    weight: float = 1.0
    gain: float = 1.0
    _row: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        weight = positive_number(self.weight, "weight")
        target = _at(_unit(self.direction, "direction"), "direction")
        _pack(self, DIRECTION, target, np.full(3, weight), _unit(self.axis, "axis"))


@show_fields
@dataclass(frozen=True, eq=False)
class CenterOfMassTask:
    """The centre of mass is to come to a place.

    p (3,) [m] in the world. weight: one number, or (3,), zeros leaving directions free, such as the height.
    gain: as in PoseTask.
    Raises InputError for wrong shapes, NaN, and weights that are negative or all zero.
    """

    p: Any
    weight: Any = 1.0
    gain: float = 1.0
    _row: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        _pack(self, CENTER_OF_MASS, _at(self.p, "p"), _weights(self.weight, 3))


@show_fields
@dataclass(frozen=True, eq=False)
class PostureTask:
    """The joints are drawn to a configuration; with a small weight this decides what other tasks leave free.

    q (n,) [rad, m]: one value per joint, the base not among them. weight: one number, or (n,), zeros leaving
    joints alone. gain: as in PoseTask.
    Raises InputError for wrong shapes, NaN, and weights that are negative or all zero.
    """

    q: Any
    weight: Any = 1e-4
    gain: float = 1.0
    _row: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        q = as_floats(self.q, "q", last=(None,), largest=FARTHEST)
        if q.ndim != 1 or not q.size:
            raise InputError(f"q has shape {q.shape}, expected (n,): one value for each joint")
        row = np.concatenate([q, _weights(self.weight, q.size), [_gain(self.gain)]])
        object.__setattr__(self, "_row", row)


Task: TypeAlias = "PoseTask | PositionTask | DirectionTask | CenterOfMassTask | PostureTask"


def _pack(task: Any, kind: int, target: Array, weights: Array, point: Array | None = None) -> None:
    """The task as the core reads it: kind, frame (set later), gain, target (16), weights (6), point (3)."""
    row = np.zeros(TASK_WIDTH)
    row[0], row[2] = kind, _gain(task.gain)
    row[3:19] = target.ravel()
    row[19 : 19 + len(weights)] = weights
    if point is not None:
        row[25:28] = point
    object.__setattr__(task, "_row", row)


def _gain(value: Any) -> float:
    gain = positive_number(value, "gain")
    if gain > 1:
        raise InputError(
            f"gain is {gain:g}; it must be above 0 and at most 1, the share of the error that a step removes"
        )
    return gain


def _weights(value: Any, n: int) -> Array:
    weights = as_floats(value, "weight")
    if weights.ndim == 0:
        weights = np.full(n, float(weights))
    if weights.shape != (n,) or (weights < 0).any() or not weights.any() or weights.max() > HEAVIEST:
        raise InputError(
            f"weight must be a number or ({n},), 0 to {HEAVIEST:g}, not all 0; got {weights.tolist()}"
        )
    return weights


def _vector(value: Any, subject: str) -> Array:
    return one_array(value, subject, (3,), largest=FARTHEST)


def _unit(value: Any, subject: str) -> Array:
    length, direction = length_and_direction(_vector(value, subject))
    if not length > 0:
        raise InputError(f"{subject} is zero; it needs a direction")
    return direction


def _at(value: Any, subject: str) -> Array:
    return assemble(np.eye(3), _vector(value, subject))
