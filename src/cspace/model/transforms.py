"""Rigid transforms of the readers and writers: elementary motions, roll-pitch-yaw, inverse."""

from __future__ import annotations

import math

import numpy as np

from cspace.arrays import Array

__all__ = ["from_rpy", "from_wxyz", "inverse", "rotation_about", "to_rpy", "translation"]


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
    w, x, y, z = quaternion.tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y), 0.0],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x), 0.0],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y), 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def rotation_about(axis: Array, angle: float) -> Array:
    """The rotation (4, 4) by `angle` [rad] about the unit vector `axis` (3,) (Rodrigues 1840)."""
    x, y, z = axis.tolist()
    c, s = math.cos(angle), math.sin(angle)
    v = 2.0 * math.sin(angle / 2.0) ** 2
    return np.array(
        [
            [c + v * x * x, v * x * y - s * z, v * x * z + s * y, 0.0],
            [v * x * y + s * z, c + v * y * y, v * y * z - s * x, 0.0],
            [v * x * z - s * y, v * y * z + s * x, c + v * z * z, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def translation(vector: Array) -> Array:
    """The translation (4, 4) by `vector` (3,) [m]."""
    result = np.eye(4)
    result[:3, 3] = vector
    return result


def inverse(T: Array) -> Array:
    """The inverse of a rigid transform (4, 4): Rᵀ, −Rᵀ p."""
    result = np.eye(4)
    result[:3, :3] = T[:3, :3].T
    result[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return result
