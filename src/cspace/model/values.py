"""Numbers of a description, checked once, then read-only; rigid transforms of the readers and writers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from cspace.arrays import Array, one_array
from cspace.errors import InputError, InputTypeError, name_type, shown
from cspace.spatial import single
from cspace.spatial.checks import embed_rotation, one_pose
from cspace.spatial.quaternions import matrix_of_quaternion
from cspace.spatial.rotations import matrix_of_axis_angle
from cspace.tolerances import AXIS_LENGTH, LARGEST_NUMBER

BEYOND = f"no robot has numbers beyond {LARGEST_NUMBER:g} in SI units"
"""The rule that a number broke which is larger than tolerances.LARGEST_NUMBER."""


def freeze_array(array: Array) -> Array:
    """The array itself, made read-only."""
    array.setflags(write=False)
    return array


IDENTITY: Array = freeze_array(np.eye(4))
"""The placement that moves nothing."""

X_AXIS: Array = freeze_array(np.array([1.0, 0.0, 0.0]))
"""The axis of a joint that names none (URDF)."""


def name_of(value: object, subject: str) -> str:
    """A name: a non-empty string."""
    if not isinstance(value, str):
        raise InputTypeError(f"the name of a {subject} must be a string, got {type(value).__name__}")
    if not value.strip():
        raise InputError(f"the name of a {subject} is empty")
    if not value.isascii() and any("\ud800" <= letter <= "\udfff" for letter in value):
        raise InputError(f"the name {value!r} of a {subject} contains half of a character; leave it out")
    return value


def read_joint_names(names: Sequence[str] | None, count: int | None = None) -> tuple[str, ...] | None:
    """Names of so many joints as a tuple, each once; None is none.

    Raises InputTypeError for anything but a list of texts, InputError for another number of names, and for
    one that is empty or there twice.
    """
    if names is None:
        return None
    if isinstance(names, str) or not isinstance(names, Iterable) or getattr(names, "ndim", 1) == 0:
        raise InputTypeError(f"joint_names is {name_type(names)}; give a list of texts")
    made = tuple(name_of(name, "joint in joint_names") for name in names)
    if count is not None and len(made) != count:
        raise InputError(f"joint_names has {len(made)} names, expected {count}")
    if len(set(made)) < len(made):
        doubled = next(name for name in made if made.count(name) > 1)
        raise InputError(f"joint_names contains {doubled!r} twice; the names must differ")
    return made


def check_number(value: Any, subject: str) -> float:
    """A float that is not NaN; infinities are accepted, for limits."""
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputTypeError(f"{subject} must be a number, got {shown(value)}") from None
    if math.isnan(result):
        raise InputError(f"{subject} is NaN; it must be a number")
    return result


def finite_number(value: Any, subject: str) -> float:
    """A float that is neither NaN nor infinite nor beyond tolerances.LARGEST_NUMBER."""
    result = check_number(value, subject)
    if math.isinf(result):
        raise InputError(f"{subject} is {result}; it must be finite")
    if abs(result) > LARGEST_NUMBER:
        raise InputError(f"{subject} is {result:g}; {BEYOND}")
    return result


def check_size(array: Array, subject: str) -> Array:
    """The array itself, if no number is beyond tolerances.LARGEST_NUMBER."""
    largest = max(array.ravel().tolist(), key=abs, default=0.0)
    if abs(largest) > LARGEST_NUMBER:
        raise InputError(f"{subject} contains {largest:g}; {BEYOND}")
    return array


def check_placement(value: object, subject: str) -> Array:
    """A read-only (4, 4) rigid transform, copied from `value`; InputError as from spatial.as_pose."""
    if value is IDENTITY:
        return IDENTITY
    pose = one_pose(value, subject).copy()
    pose[3] = IDENTITY[3]
    check_size(pose[:3, 3], subject)
    return freeze_array(pose)


def unit_axis(value: Any, subject: str) -> Array:
    """A read-only unit vector (3,) along `value`.

    Raises InputError for a vector shorter than tolerances.AXIS_LENGTH.
    """
    vector = one_array(value, subject, (3,))
    length = math.hypot(*vector.tolist())
    if length < AXIS_LENGTH:
        raise InputError(f"{subject} is {vector.tolist()}, which has no direction; an axis must not be zero")
    if abs(length - 1.0) <= 2.0**-51:  # a unit vector to rounding stays as it is, bit for bit
        return freeze_array(np.array(vector))
    scaled: Array = vector / length
    return freeze_array(scaled)


def from_rpy(xyz: tuple[float, float, float], rpy: tuple[float, float, float]) -> Array:
    """The transform with translation xyz [m] and rotation Rz(yaw) Ry(pitch) Rx(roll), rpy in rad."""
    return single.pose(single.euler((2, 1, 0), rpy[::-1]), xyz)


def from_wxyz(quaternion: Sequence[float], subject: str) -> Array:
    """The rotation (4, 4) of a quaternion (4,) of any length, its scalar first; InputError for a zero one."""
    return embed_rotation(matrix_of_quaternion(quaternion, subject))


def rotation_about(axis: Array, angle: float) -> Array:
    """The rotation (4, 4) by `angle` [rad] about the unit vector `axis` (3,)."""
    return embed_rotation(matrix_of_axis_angle(axis, np.asarray(angle)))


def translation_by(vector: Array) -> Array:
    """The translation (4, 4) by `vector` (3,) [m]."""
    result = np.eye(4)
    result[:3, 3] = vector
    return result
