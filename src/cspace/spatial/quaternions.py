"""Unit quaternions, in either order of their four numbers, to and from rotation matrices."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial.checks import RotationLike, as_rotation
from cspace.spatial.vectors import length_and_direction

__all__ = ["to_wxyz", "to_xyzw"]


def to_wxyz(R: RotationLike) -> Array:
    """The unit quaternion of a rotation or pose, scalar first.

    q = (cos θ/2, u sin θ/2). Of q and −q the one with w > 0 is given; at an exact half turn (w = 0) the one
    whose first entry other than zero is positive.

    R: (..., 3, 3) or (..., 4, 4) → (..., 4), order w, x, y, z.
    """
    return wxyz_of_matrix(as_rotation(R))


def to_xyzw(R: RotationLike) -> Array:
    """The unit quaternion of a rotation or pose, scalar last; signs as in to_wxyz.

    R: (..., 3, 3) or (..., 4, 4) → (..., 4), order x, y, z, w.
    """
    return np.roll(wxyz_of_matrix(as_rotation(R)), -1, axis=-1)


def unit_wxyz(q: object, subject: str) -> Array:
    """Quaternions (..., 4) scaled to unit length; a zero quaternion is refused."""
    length, unit = length_and_direction(as_floats(q, subject, last=(4,)))
    if not (length > 0.0).all():
        raise InputError(f"{subject} is zero; a rotation needs a quaternion of non-zero length")
    return unit


def matrix_of_wxyz(q: Array) -> Array:
    """The rotation matrices (..., 3, 3) of unit quaternions (..., 4), scalar first."""
    w, x, y, z = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    x2, y2, z2 = x + x, y + y, z + z
    xx, yy, zz = x * x2, y * y2, z * z2
    xy, xz, yz = x * y2, x * z2, y * z2
    wx, wy, wz = w * x2, w * y2, w * z2
    R = np.empty((*q.shape[:-1], 3, 3))
    R[..., 0, 0], R[..., 0, 1], R[..., 0, 2] = 1.0 - (yy + zz), xy - wz, xz + wy
    R[..., 1, 0], R[..., 1, 1], R[..., 1, 2] = xy + wz, 1.0 - (xx + zz), yz - wx
    R[..., 2, 0], R[..., 2, 1], R[..., 2, 2] = xz - wy, yz + wx, 1.0 - (xx + yy)
    return R


def wxyz_of_matrix(R: Array) -> Array:
    """The unit quaternions (..., 4) of rotation matrices (..., 3, 3), sign as in to_wxyz.

    4 q qᵀ is linear in R. Of its four columns, each a multiple of q, the one with the largest diagonal entry
    (at least 1) is taken, so that nothing cancels. Source: Shepperd 1978.
    """
    a, b, c = R[..., 0, 0], R[..., 1, 1], R[..., 2, 2]
    K = np.empty((*R.shape[:-2], 4, 4))
    K[..., 0, 0], K[..., 1, 1] = 1.0 + (a + b + c), 1.0 + (a - b - c)
    K[..., 2, 2], K[..., 3, 3] = 1.0 + (b - a - c), 1.0 + (c - a - b)
    K[..., 0, 1] = K[..., 1, 0] = R[..., 2, 1] - R[..., 1, 2]
    K[..., 0, 2] = K[..., 2, 0] = R[..., 0, 2] - R[..., 2, 0]
    K[..., 0, 3] = K[..., 3, 0] = R[..., 1, 0] - R[..., 0, 1]
    K[..., 1, 2] = K[..., 2, 1] = R[..., 0, 1] + R[..., 1, 0]
    K[..., 1, 3] = K[..., 3, 1] = R[..., 0, 2] + R[..., 2, 0]
    K[..., 2, 3] = K[..., 3, 2] = R[..., 1, 2] + R[..., 2, 1]
    best = np.argmax(np.diagonal(K, axis1=-2, axis2=-1), axis=-1)
    q = np.take_along_axis(K, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.sqrt(np.sum(q * q, axis=-1, keepdims=True))
    return np.asarray(q * _sign(q)[..., None])


def _sign(q: Array) -> Array:
    """−1 where q must be turned: the first of w, x, y, z other than zero is to be positive."""
    first = np.take_along_axis(q, np.argmax(q != 0.0, axis=-1)[..., None], axis=-1)[..., 0]
    return np.where(first < 0.0, -1.0, 1.0)
