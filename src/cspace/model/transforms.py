"""Rigid transforms of the readers and writers: elementary motions, roll-pitch-yaw, inverse."""

from __future__ import annotations

import math

import numpy as np

from cspace.arrays import Array
from cspace.spatial.quaternions import matrix_of_quaternion
from cspace.spatial.rotations import matrix_of_axis_angle


def from_rpy(xyz: tuple[float, float, float], rpy: tuple[float, float, float]) -> Array:
    """The transform with translation xyz [m] and rotation Rz(yaw) Ry(pitch) Rx(roll), rpy in rad."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle), math.sin(angle)) for angle in rpy)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, xyz[0]],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, xyz[1]],
            [-sp, cp * sr, cp * cr, xyz[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def from_wxyz(quaternion: Array) -> Array:
    """The rotation (4, 4) of a unit quaternion (4,), its scalar first."""
    return embed_rotation(matrix_of_quaternion(quaternion, "quaternion"))


def rotation_about(axis: Array, angle: float) -> Array:
    """The rotation (4, 4) by `angle` [rad] about the unit vector `axis` (3,)."""
    return embed_rotation(matrix_of_axis_angle(axis, np.asarray(angle)))


def embed_rotation(R: Array) -> Array:
    """The rotation (4, 4) of a matrix (3, 3)."""
    T = np.eye(4)
    T[:3, :3] = R
    return T


def translation_by(vector: Array) -> Array:
    """The translation (4, 4) by `vector` (3,) [m]."""
    result = np.eye(4)
    result[:3, 3] = vector
    return result


def invert_transform(T: Array) -> Array:
    """The inverse of a rigid transform (4, 4): Rᵀ, −Rᵀ p."""
    result = np.eye(4)
    result[:3, :3] = T[:3, :3].T
    result[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return result
