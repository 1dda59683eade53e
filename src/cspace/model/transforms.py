"""Rigid transforms of the readers and writers: elementary motions, roll-pitch-yaw, inverse."""

from __future__ import annotations

import math

import numpy as np

from cspace.arrays import Array
from cspace.spatial import single


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


def to_rpy(R: Array) -> tuple[float, float, float]:
    """Roll, pitch and yaw [rad] with R = Rz(yaw) Ry(pitch) Rx(roll), R (3, 3).

    Roll and pitch are read from Rz(−yaw) R, so that near pitch = ±90° an error of yaw is made good by roll
    and the product keeps R to rounding.
    """
    yaw = math.atan2(R[1, 0], R[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    pitch = math.atan2(-R[2, 0], c * R[0, 0] + s * R[1, 0])
    roll = math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return roll, pitch, yaw


def from_wxyz(quaternion: Array) -> Array:
    """The rotation (4, 4) of a unit quaternion (4,), its scalar first."""
    return embed_rotation(single.quaternion(*quaternion.tolist()))


def rotation_about(axis: Array, angle: float) -> Array:
    """The rotation (4, 4) by `angle` [rad] about the unit vector `axis` (3,)."""
    return embed_rotation(single.turn(axis.tolist(), angle))


def embed_rotation(entries: single.Nine) -> Array:
    """The rotation (4, 4) of the nine entries of a matrix, row by row."""
    T = np.eye(4)
    T[:3, :3] = np.reshape(entries, (3, 3))
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
