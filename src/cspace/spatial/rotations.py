"""Rotations of space: skew matrices, the exponential and the logarithm of SO(3), the axis and the angle."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial import single
from cspace.spatial.checks import RotationLike, as_rotation
from cspace.spatial.quaternions import wxyz_of_matrix
from cspace.spatial.vectors import length_and_direction

SHORT: Final = 3.6
"""Entries [rad] up to here make a vector of less than the 6.3 rad that the compiled formula takes."""


def hat_so3(w: npt.ArrayLike) -> Array:
    """The skew matrix [w] of a vector, so that [w] x = w × x.

    w: (..., 3) → (..., 3, 3).
    """
    return skew(as_floats(w, "vector", last=(3,)))


def vee_so3(W: npt.ArrayLike) -> Array:
    """The vector of a skew matrix, the inverse of hat_so3: ([w])ᵛ = w.

    W: (..., 3, 3) → (..., 3); of a matrix that is not skew the skew part is read.
    """
    return unskew(as_floats(W, "skew matrix", last=(3, 3)))


def exp_so3(rotvec: npt.ArrayLike) -> Array:
    """The rotation by the angle |w| about the direction of w (Rodrigues).

    exp [w] = cos θ I + sin θ [u] + (1 − cos θ) u uᵀ,  θ = |w|, u = w / θ.

    rotvec: w (..., 3) [rad] → (..., 3, 3). Raises InputError if |w| overflows.
    Source: Murray, Li and Sastry 1994, eq. 2.14.
    """
    return matrix_of_rotvec(as_floats(rotvec, "rotation vector", last=(3,)), "rotation vector")


def log_so3(R: RotationLike) -> Array:
    """The shortest rotation vector of a rotation: exp_so3(log_so3(R)) = R.

    w = θ u with 0 ≤ θ ≤ π. Of the two vectors of an exact half turn the one whose first entry other than
    zero is positive is given.

    R: (..., 3, 3), or the rotation of (..., 4, 4) → (..., 3) [rad].
    The angle is 2 atan2(|v|, w) of the unit quaternion, accurate from 1e-300 to π.
    """
    return rotvec_of_matrix(as_rotation(R))


def to_rotvec(R: RotationLike) -> Array:
    """The rotation vector of a rotation or pose: axis times angle, length in [0, π] (see log_so3).

    R: (..., 3, 3) or (..., 4, 4) → (..., 3) [rad].
    """
    return rotvec_of_matrix(as_rotation(R))


def to_axis_angle(R: RotationLike) -> tuple[Array, Array]:
    """The unit axis and the angle in [0, π] of a rotation or pose.

    The axis of the identity is free: z is given. Of the two axes of an exact half turn the one whose first
    entry other than zero is positive is given.

    R: (..., 3, 3) or (..., 4, 4) → axis (..., 3), angle (...) [rad].
    """
    q = wxyz_of_matrix(as_rotation(R))
    sine, axis = length_and_direction(q[..., 1:])
    axis = np.where((sine == 0.0)[..., None], np.array([0.0, 0.0, 1.0]), axis)
    return axis, np.asarray(2.0 * np.arctan2(sine, q[..., 0]))[()]


def skew(w: Array) -> Array:
    """hat_so3 without checks."""
    W = np.zeros((*w.shape[:-1], 3, 3))
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    W[..., 0, 1], W[..., 0, 2] = -z, y
    W[..., 1, 0], W[..., 1, 2] = z, -x
    W[..., 2, 0], W[..., 2, 1] = -y, x
    return W


def unskew(W: Array) -> Array:
    """vee_so3 without checks."""
    twice = [W[..., 2, 1] - W[..., 1, 2], W[..., 0, 2] - W[..., 2, 0], W[..., 1, 0] - W[..., 0, 1]]
    return 0.5 * np.stack(twice, axis=-1)


def checked_angle_and_axis(w: Array, subject: str) -> tuple[Array, Array]:
    """Length and direction of rotation vectors; an overflowing length is refused."""
    angle, axis = length_and_direction(w)
    if not np.isfinite(angle).all():
        raise InputError(f"{subject} is so long that its norm overflows; angles must be finite")
    return angle, axis


def matrix_of_rotvec(w: Array, subject: str) -> Array:
    """exp_so3 of checked numbers."""
    R = np.empty((*w.shape[:-1], 3, 3))
    rows, matrices = np.ascontiguousarray(w).reshape(-1, 3), R.reshape(-1, 3, 3)
    if not _core.rotvec_matrices(rows, matrices):
        long = np.abs(rows).max(axis=-1) > SHORT
        angle, axis = checked_angle_and_axis(rows[long], subject)  # to the last digit: it shows in the matrix
        matrices[long] = matrix_of_axis_angle(axis, angle)
    return R


def matrix_of_axis_angle(axis: Array, angle: Array) -> Array:
    """The rotations (..., 3, 3) by angles (...) about axes (..., 3) of any length but zero, broadcast."""
    shape = np.broadcast_shapes(axis.shape[:-1], angle.shape)
    R = np.empty((*shape, 3, 3))
    angles = np.ascontiguousarray(np.broadcast_to(angle, shape)).reshape(-1)
    axes = np.ascontiguousarray(np.broadcast_to(axis, (*shape, 3))).reshape(-1, 3)
    if not _core.axis_angle_matrices(axes, angles, R.reshape(-1, 3, 3)):  # the square of a length overflows
        length, unit = length_and_direction(axes)
        if not (length > 0.0).all():
            raise InputError(
                "axis is zero; a rotation axis needs a direction (for the identity give any axis and angle 0)"
            )
        _core.axis_angle_matrices(unit, angles, R.reshape(-1, 3, 3))
    return R


def rotvec_of_matrix(R: Array) -> Array:
    """log_so3 without checks."""
    if R.ndim == 2 and (split := single.rotvec(R)):
        return np.array([split[0] * x for x in split[1]])
    q = wxyz_of_matrix(R)
    sine, axis = length_and_direction(q[..., 1:])
    return axis * (2.0 * np.arctan2(sine, q[..., 0]))[..., None]
