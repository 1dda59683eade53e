"""The plane: 2×2 rotations and 3×3 poses made from numbers, read, inverted, applied to points."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats
from cspace.errors import InputTypeError
from cspace.spatial.checks import as_pose_2d, as_rotation_2d
from cspace.spatial.poses import assemble, invert_pose, turn_vectors


def rotation_2d(theta: npt.ArrayLike) -> Array:
    """Planar rotations [[cos θ, −sin θ], [sin θ, cos θ]], counter-clockwise.

    theta: (...) [rad] → (..., 2, 2).
    """
    return matrix_of_angle(as_floats(theta, "theta"))


def pose_2d(
    xy: npt.ArrayLike | None = None,
    *,
    theta: npt.ArrayLike | None = None,
    xytheta: npt.ArrayLike | None = None,
    matrix: Any = None,
) -> Array:
    """Planar poses [[R, xy], [0, 1]] from a translation and a heading.

    xy: (..., 2) [m], zero if left out. theta: heading (...) [rad], zero if left out; or matrix: (..., 2, 2).
    xytheta: both at once (..., 3), alone. Leading axes broadcast. Returns (..., 3, 3).
    Raises InputError if a matrix is not a rotation, InputTypeError if nothing or something twice is given.
    """
    if xytheta is not None:
        if not (xy is None and theta is None and matrix is None):
            raise InputTypeError(
                "pose_2d() got xytheta= and another argument; xytheta= already contains all three numbers"
            )
        numbers = as_floats(xytheta, "xytheta", last=(3,))
        return assemble(matrix_of_angle(numbers[..., 2]), numbers[..., :2])
    if theta is not None and matrix is not None:
        raise InputTypeError("pose_2d() got the rotation twice: theta=, matrix=; give one")
    if xy is None and theta is None and matrix is None:
        raise InputTypeError("pose_2d() needs xy=, theta=, matrix= or xytheta=; the identity is numpy.eye(3)")
    R = rotation_2d(0.0 if theta is None else theta) if matrix is None else as_rotation_2d(matrix, "matrix")
    return assemble(R, np.zeros(2) if xy is None else as_floats(xy, "xy", last=(2,)))


def to_theta(R: Any) -> Array:
    """The heading of planar rotations (..., 2, 2) or poses (..., 3, 3), in (−π, π] → (...) [rad]."""
    return angle_of(as_rotation_2d(R))[()]


def to_xytheta(T: Any) -> Array:
    """Translation and heading of planar poses: (..., 3, 3) → (..., 3), x, y [m], θ in (−π, π] [rad]."""
    T = as_pose_2d(T)
    return np.stack([T[..., 0, 2], T[..., 1, 2], angle_of(T[..., :2, :2])], axis=-1)


def inverse_pose_2d(T: Any) -> Array:
    """The inverse of planar poses by transposition: T_a_b (..., 3, 3) → T_b_a (..., 3, 3)."""
    return invert_pose(as_pose_2d(T))


def transform_points_2d(T: Any, points: npt.ArrayLike) -> Array:
    """Points of the plane turned and moved, p_a = R p_b + t.

    T: T_a_b (..., 3, 3). points: p_b (..., 2) [m]. Leading axes broadcast. Returns p_a (..., 2).
    """
    T = as_pose_2d(T)
    return np.asarray(turn_vectors(T[..., :2, :2], as_floats(points, "points", last=(2,))) + T[..., :2, 2])


def transform_directions_2d(T: Any, directions: npt.ArrayLike) -> Array:
    """Directions of the plane turned but not moved, d_a = R d_b.

    T: T_a_b (..., 3, 3) or rotations (..., 2, 2). directions: d_b (..., 2). Leading axes broadcast.
    Returns d_a (..., 2).
    """
    return turn_vectors(as_rotation_2d(T), as_floats(directions, "directions", last=(2,)))


def embed_pose_2d(T: Any) -> Array:
    """A planar pose as a pose of space that moves in the plane z = 0 and rotates about z.

    T: (..., 3, 3) → (..., 4, 4).
    """
    T = as_pose_2d(T)
    result = np.zeros((*T.shape[:-2], 4, 4))
    result[..., :2, :2] = T[..., :2, :2]
    result[..., :2, 3] = T[..., :2, 2]
    result[..., 2, 2] = result[..., 3, 3] = 1.0
    return result


def matrix_of_angle(theta: Array) -> Array:
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)


def angle_of(R: Array) -> Array:
    """atan2 of the first column, in (−π, π]."""
    angle = np.arctan2(R[..., 1, 0], R[..., 0, 0])
    return np.asarray(np.where(angle == -np.pi, np.pi, angle))
