"""Unit quaternions, in either order of their four numbers, to and from rotation matrices."""

from __future__ import annotations

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial import single
from cspace.spatial.checks import RotationLike, as_rotation
from cspace.spatial.vectors import length_and_direction


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
    return np.take(wxyz_of_matrix(as_rotation(R)), (1, 2, 3, 0), axis=-1)


def matrix_of_quaternion(q: object, subject: str, *, scalar_last: bool = False) -> Array:
    """The rotation matrices (..., 3, 3) of quaternions (..., 4) of any length; a zero one is refused."""
    numbers = as_floats(q, subject, last=(4,), finite=False)
    R = np.empty((*numbers.shape[:-1], 3, 3))
    rows = np.ascontiguousarray(numbers).reshape(-1, 4)
    if not _core.quaternion_matrices(
        rows, scalar_last, R.reshape(-1, 3, 3)
    ):  # the square of a length overflows
        length, unit = length_and_direction(as_floats(numbers, subject))
        if not (length > 0.0).all():
            raise InputError(f"{subject} is zero; a rotation needs a quaternion of non-zero length")
        _core.quaternion_matrices(unit.reshape(-1, 4), scalar_last, R.reshape(-1, 3, 3))
    return R


def wxyz_of_matrix(R: Array) -> Array:
    """The unit quaternions (..., 4) of rotation matrices (..., 3, 3), sign as in to_wxyz.

    4 q qᵀ is linear in R. Of its four columns, each a multiple of q, the one with the largest diagonal entry
    (at least 1) is taken, so that nothing cancels. Source: Shepperd 1978.
    """
    if R.ndim == 2:
        return np.array(single.wxyz(R))
    a, b, c = R[..., 0, 0], R[..., 1, 1], R[..., 2, 2]
    squares = [1.0 + (a + b + c), 1.0 + (a - b - c), 1.0 + (b - a - c), 1.0 + (c - a - b)]
    wx, wy, wz = R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]
    xy, xz, yz = R[..., 0, 1] + R[..., 1, 0], R[..., 0, 2] + R[..., 2, 0], R[..., 1, 2] + R[..., 2, 1]
    columns = [
        (squares[0], wx, wy, wz),
        (wx, squares[1], xy, xz),
        (wy, xy, squares[2], yz),
        (wz, xz, yz, squares[3]),
    ]
    best = _largest_of_four(squares)
    w, x, y, z = (np.choose(best, row) for row in columns)
    first = np.where(w != 0.0, w, np.where(x != 0.0, x, np.where(y != 0.0, y, z)))
    scale = np.copysign(1.0, first) / np.sqrt(w * w + x * x + y * y + z * z)
    q = np.empty((*R.shape[:-2], 4))
    q[..., 0], q[..., 1], q[..., 2], q[..., 3] = w * scale, x * scale, y * scale, z * scale
    return q


def _largest_of_four(values: list[Array]) -> np.ndarray[tuple[int, ...], np.dtype[np.intp]]:
    """Which of four arrays is the largest, entry by entry."""
    low, high = values[1] > values[0], values[3] > values[2]
    upper = np.maximum(values[2], values[3]) > np.maximum(values[0], values[1])
    return np.where(upper, 2 + high, low.astype(np.intp))
