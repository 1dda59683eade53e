"""Rigid transforms of the readers and writers: elementary motions, roll-pitch-yaw."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cspace.arrays import Array
from cspace.spatial import single
from cspace.spatial.checks import embed_rotation
from cspace.spatial.quaternions import matrix_of_quaternion
from cspace.spatial.rotations import matrix_of_axis_angle


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
