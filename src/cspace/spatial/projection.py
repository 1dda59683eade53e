"""The nearest rotation of a worn matrix, and the mean of several rotations."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial.checks import RotationLike, as_rotation, determinant, orthogonality_error
from cspace.spatial.poses import assemble
from cspace.spatial.quaternions import matrix_of_quaternion, wxyz_of_matrix


def project_rotation(matrix: npt.ArrayLike, *, limit: float = tolerances.ROTATION_PROJECTION) -> Array:
    """The rotation nearest to a matrix that has lost its orthogonality: typed, measured or summed.

    R = U Vᵀ of M = U Σ Vᵀ, the minimum of ‖R − M‖ in the Frobenius norm.

    matrix: M (..., 3, 3) → (..., 3, 3). limit: the largest max |MᵀM − I| mended, by default
    tolerances.ROTATION_PROJECTION. Raises InputError beyond it, and for a reflection (determinant < 0).
    Source: Higham 1986.
    """
    return _nearest(as_floats(matrix, "matrix", last=(3, 3)), "matrix", limit)


def project_pose(matrix: npt.ArrayLike, *, limit: float = tolerances.ROTATION_PROJECTION) -> Array:
    """The pose with the nearest rotation (see project_rotation) and the translation as it is.

    matrix: (..., 4, 4), whose last row is [0, 0, 0, 1] within `limit` → (..., 4, 4).
    Raises InputError where the rotation or the last row is beyond the limit.
    """
    return _nearest_pose(as_floats(matrix, "matrix", last=(4, 4)), limit)


def project_rotation_2d(matrix: npt.ArrayLike, *, limit: float = tolerances.ROTATION_PROJECTION) -> Array:
    """The planar rotation nearest to a worn matrix (..., 2, 2), as project_rotation finds it in space."""
    return _nearest(as_floats(matrix, "matrix", last=(2, 2)), "matrix", limit)


def project_pose_2d(matrix: npt.ArrayLike, *, limit: float = tolerances.ROTATION_PROJECTION) -> Array:
    """The planar pose with the nearest rotation, as project_pose finds it in space.

    matrix: (..., 3, 3), whose last row is [0, 0, 1] within `limit` → (..., 3, 3).
    Raises InputError where the rotation or the last row is beyond the limit.
    """
    return _nearest_pose(as_floats(matrix, "matrix", last=(3, 3)), limit)


def mean_rotation(R: RotationLike, weights: npt.ArrayLike | None = None) -> Array:
    """The rotation with the least sum of squared chordal distances to n rotations.

    The quaternion of the mean is the eigenvector of Σ wᵢ qᵢ qᵢᵀ with the largest eigenvalue; the sign of the
    quaternions does not matter.

    R: (..., n, 3, 3) or poses (..., n, 4, 4), n ≥ 1. weights: (..., n), not negative, not all zero; equal if
    left out. Returns (..., 3, 3). Raises InputError where the mean is not unique, as for opposite rotations.
    Source: Markley, Cheng, Crassidis and Oshman 2007.
    """
    R = as_rotation(R, "rotations")
    if R.ndim < 3 or R.shape[-3] == 0:
        raise InputError(f"rotations have shape {R.shape}, expected (..., n, 3, 3) with n ≥ 1")
    q = wxyz_of_matrix(R)
    w = _weights(weights, q.shape[:-1])
    values, vectors = np.linalg.eigh(np.einsum("...n,...ni,...nj->...ij", w, q, q))
    if (values[..., -1] - values[..., -2] <= tolerances.MEAN_UNIQUENESS * values[..., -1]).any():
        raise InputError(
            "the rotations have no unique mean: they are distributed evenly (for example, two that are "
            "180° apart)"
        )
    return matrix_of_quaternion(vectors[..., -1], "mean")


def _weights(weights: Any, shape: tuple[int, ...]) -> Array:
    if weights is None:
        return np.ones(shape)
    w = as_floats(weights, "weights")
    if w.shape[-1:] != shape[-1:]:
        raise InputError(f"weights have shape {w.shape}, expected (..., {shape[-1]}), one for each rotation")
    largest = w.max(axis=-1, keepdims=True)
    if (w < 0.0).any() or not (largest > 0.0).all():
        raise InputError("weights must not be negative, and not all zero")
    return np.broadcast_to(w / largest, shape)


def _nearest_pose(M: Array, limit: float) -> Array:
    row = [0] * (M.shape[-1] - 1) + [1]
    if (np.abs(M[..., -1, :] - row) > limit).any():
        raise InputError(f"the last row of matrix differs from {row} by more than {limit:g}; no pose is near")
    return assemble(_nearest(M[..., :-1, :-1], "the rotation part of matrix", limit), M[..., :-1, -1])


def _nearest(M: Array, subject: str, limit: float) -> Array:
    error = orthogonality_error(M)
    if not (error <= limit).all():
        worst = float(np.max(error))
        raise InputError(
            f"{subject} is not close to a rotation: MᵀM differs from the identity by {worst:.3g}; "
            f"projection accepts up to {limit:g}"
        )
    if (determinant(M) < 0.0).any():
        raise InputError(
            f"{subject} has a negative determinant (near −1): it is a reflection, and no rotation is near it;"
            " an axis is flipped, or two rows or columns are swapped"
        )
    U, _, Vt = np.linalg.svd(M)
    return np.asarray(U @ Vt)
