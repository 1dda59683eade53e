"""How far apart rotations and poses are."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial.checks import PoseLike, RotationLike, as_pose, as_rotation
from cspace.spatial.poses import broadcast_batches
from cspace.spatial.rotations import rotvec_of_matrix
from cspace.spatial.vectors import length_and_direction

__all__ = ["pose_distance", "rotation_distance", "translation_distance"]


def rotation_distance(R_a: RotationLike, R_b: RotationLike) -> Array:
    """The angle of the turn from one rotation to another, |log(R_aᵀ R_b)|, in [0, π].

    It does not depend on the frame on either side. Small angles are accurate, unlike acos of the trace.

    R_a, R_b: (..., 3, 3) or poses, broadcast → (...) [rad].
    """
    return _angle_between(as_rotation(R_a, "first rotation"), as_rotation(R_b, "second rotation"))[()]


def translation_distance(T_a: PoseLike, T_b: PoseLike) -> Array:
    """The distance between the origins of two poses: (..., 4, 4), broadcast → (...) [m]."""
    return _length_between(as_pose(T_a, "first pose"), as_pose(T_b, "second pose"))[()]


def pose_distance(T_a: PoseLike, T_b: PoseLike, *, length: float) -> Array:
    """The weighted distance of two poses, √(d² + (L θ)²).

    d: distance of the origins [m]. θ: angle between the rotations [rad]. L: the `length` [m] that makes a
    radian worth a distance, such as the size of the moving body; no value suits every task: it must be said.
    A metric on poses that does not depend on the base frame; none is free of both frames (Park 1995).

    T_a, T_b: (..., 4, 4), broadcast → (...) [m]. Raises InputError unless length is a number ≥ 0.
    """
    first, second = as_pose(T_a, "first pose"), as_pose(T_b, "second pose")
    weight = as_floats(length, "length")
    if weight.ndim != 0 or weight < 0.0:
        raise InputError(f"length is {length!r}; it must be one number ≥ 0 [m]")
    angle = _angle_between(first[..., :3, :3], second[..., :3, :3])
    return np.asarray(np.hypot(_length_between(first, second), weight * angle))[()]


def _angle_between(R_a: Array, R_b: Array) -> Array:
    broadcast_batches(R_a.shape[:-2], R_b.shape[:-2], "first", "second")
    return length_and_direction(rotvec_of_matrix(np.swapaxes(R_a, -1, -2) @ R_b))[0]


def _length_between(T_a: Array, T_b: Array) -> Array:
    broadcast_batches(T_a.shape[:-2], T_b.shape[:-2], "first", "second")
    return length_and_direction(T_b[..., :3, 3] - T_a[..., :3, 3])[0]
