"""How far apart rotations and poses are."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array, bounded_number, leading_axes
from cspace.spatial.checks import (
    PoseLike,
    RotationLike,
    as_pose,
    as_pose_2d,
    as_rotation,
    as_rotation_2d,
)
from cspace.spatial.planar import angle_of
from cspace.spatial.rotations import rotvec_of_matrix
from cspace.spatial.vectors import length_and_direction


def rotation_distance(R_a: RotationLike, R_b: RotationLike) -> Array:
    """The angle of the rotation from one rotation to another, |log(R_aᵀ R_b)|, in [0, π].

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
    radian worth a distance, such as the size of the moving body; no default suits every task.
    A metric on poses that does not depend on the base frame; none is free of both frames (Park 1995).

    T_a, T_b: (..., 4, 4), broadcast → (...) [m]. Raises InputError unless length is a number ≥ 0.
    """
    first, second = as_pose(T_a, "first pose"), as_pose(T_b, "second pose")
    angle = _angle_between(first[..., :3, :3], second[..., :3, :3])
    return _weighted(_length_between(first, second), angle, length)


def rotation_distance_2d(R_a: Any, R_b: Any) -> Array:
    """The angle between the headings of two planar rotations, |log(R_aᵀ R_b)|, in [0, π].

    R_a, R_b: (..., 2, 2) or planar poses (..., 3, 3), broadcast → (...) [rad].
    """
    first, second = (
        as_rotation_2d(R_a, "first planar rotation"),
        as_rotation_2d(R_b, "second planar rotation"),
    )
    return _angle_between(first, second)[()]


def translation_distance_2d(T_a: Any, T_b: Any) -> Array:
    """The distance between the origins of two planar poses: (..., 3, 3), broadcast → (...) [m]."""
    return _length_between(as_pose_2d(T_a, "first planar pose"), as_pose_2d(T_b, "second planar pose"))[()]


def pose_distance_2d(T_a: Any, T_b: Any, *, length: float) -> Array:
    """The weighted distance of two planar poses, √(d² + (L θ)²); d, θ and `length` L as in pose_distance.

    T_a, T_b: (..., 3, 3), broadcast → (...) [m]. Raises InputError unless length is a number ≥ 0.
    """
    first, second = as_pose_2d(T_a, "first planar pose"), as_pose_2d(T_b, "second planar pose")
    angle = _angle_between(first[..., :2, :2], second[..., :2, :2])
    return _weighted(_length_between(first, second), angle, length)


def _weighted(distance: Array, angle: Array, length: float) -> Array:
    weight = bounded_number(length, "length", 0.0, "it must be one number ≥ 0 [m]")
    return np.asarray(np.hypot(distance, weight * angle))[()]


def _angle_between(R_a: Array, R_b: Array) -> Array:
    leading_axes(first=R_a.shape[:-2], second=R_b.shape[:-2])
    between = np.swapaxes(R_a, -1, -2) @ R_b
    if between.shape[-1] == 2:
        return np.abs(angle_of(between))
    return length_and_direction(rotvec_of_matrix(between))[0]


def _length_between(T_a: Array, T_b: Array) -> Array:
    leading_axes(first=T_a.shape[:-2], second=T_b.shape[:-2])
    return length_and_direction(T_b[..., :-1, -1] - T_a[..., :-1, -1])[0]
