"""What callers pass as a pose or a rotation becomes a checked float64 array here, or a clear error."""

from __future__ import annotations

from typing import Any, TypeAlias, cast

import numpy as np

from cspace import tolerances
from cspace.arrays import Array, as_floats
from cspace.errors import InputError

PoseLike: TypeAlias = Any
"""(..., 4, 4) numbers, or an object that provides such a matrix: `__array__`, `as_matrix()` or `.A`."""

RotationLike: TypeAlias = Any
"""(..., 3, 3) numbers or an object that provides them; a pose counts too, for its rotation."""


def as_pose(value: PoseLike, subject: str = "pose") -> Array:
    """Poses as checked float64 arrays of shape (..., 4, 4); an array that is one already is not copied.

    value: (..., 4, 4) numbers, an object with `__array__`, `as_matrix()` (scipy's RigidTransform, and
    Rotation, which gets a zero translation) or a 4×4 `.A`. subject: its name in messages.
    Raises InputError on a wrong shape, NaN, inf, a last row other than [0, 0, 0, 1], or a rotation part whose
    RᵀR differs from the identity by more than tolerances.ROTATION_ERROR or which reflects.
    """
    if (
        type(value) is np.ndarray
        and value.shape == (4, 4)
        and value.dtype == np.float64
        and value.flags.aligned
        and _is_pose(value)
    ):
        return value
    T, from_method = _held_matrix(value, subject)
    if from_method and T.shape[-2:] == (3, 3):
        return embed_rotation(as_rotation(T, subject))
    if T.shape == (4, 4) and _is_pose(T):
        return T
    if T.shape[-2:] != (4, 4):
        raise InputError(f"{subject} has shape {T.shape}, expected (..., 4, 4){_shape_hint(T.shape)}")
    _check_homogeneous(T, subject)
    _check_rotation(T[..., :3, :3], f"the rotation part of {subject}")
    return T


def one_pose(value: PoseLike, subject: str = "pose") -> Array:
    """One pose as a checked contiguous array (4, 4); InputError for several, and as as_pose."""
    T = as_pose(value, subject)
    if T.ndim != 2:
        raise InputError(f"{subject} has shape {T.shape}, expected one pose (4, 4)")
    return np.ascontiguousarray(T)


def as_rotation(value: RotationLike, subject: str = "rotation") -> Array:
    """Rotations as checked float64 arrays of shape (..., 3, 3); of a pose (..., 4, 4) the rotation part.

    Raises InputError on a wrong shape, NaN, inf, or a matrix whose RᵀR differs from the identity by more than
    tolerances.ROTATION_ERROR or which reflects (determinant −1).
    """
    plain = type(value) is np.ndarray and value.shape == (3, 3) and value.dtype == np.float64
    if plain and _is_rotation(*value.ravel().tolist()):
        return cast(Array, value)
    R, _ = _held_matrix(value, subject)
    if R.shape[-2:] == (4, 4):
        return as_pose(R, subject)[..., :3, :3]
    if R.shape == (3, 3) and _is_rotation(*R.ravel().tolist()):
        return R
    if R.shape[-2:] != (3, 3):
        raise InputError(f"{subject} has shape {R.shape}, expected (..., 3, 3) or a pose (..., 4, 4)")
    _check_finite(R, subject)
    _check_rotation(R, subject)
    return R


def as_pose_2d(value: Any, subject: str = "planar pose") -> Array:
    """Planar poses as checked float64 arrays of shape (..., 3, 3); the rules are those of as_pose."""
    T, _ = _held_matrix(value, subject)
    if T.shape[-2:] != (3, 3):
        remedy = "; cspace.pose_2d(xytheta=...) makes one of x, y, θ" if T.shape[-1:] == (3,) else ""
        raise InputError(
            f"{subject} has shape {T.shape}, expected (..., 3, 3): rotation, translation, 0 0 1{remedy}"
        )
    _check_homogeneous(T, subject)
    _check_rotation(T[..., :2, :2], f"the rotation part of {subject}")
    return T


def as_rotation_2d(value: Any, subject: str = "planar rotation") -> Array:
    """Planar rotations as checked arrays (..., 2, 2); of a planar pose (..., 3, 3) the rotation part."""
    R, _ = _held_matrix(value, subject)
    if R.shape[-2:] == (3, 3):
        return as_pose_2d(R, subject)[..., :2, :2]
    if R.shape[-2:] != (2, 2):
        raise InputError(f"{subject} has shape {R.shape}, expected (..., 2, 2) or a planar pose (..., 3, 3)")
    _check_finite(R, subject)
    _check_rotation(R, subject)
    return R


def _is_pose(T: Array) -> bool:
    """One 4×4, quickly, in Python numbers: True if it is a pose; False lets the full check speak."""
    (a, b, c, x), (d, e, f, y), (g, h, i, z), (k, l, m, n) = T.tolist()
    return bool(
        k == l == m == 0.0
        and n == 1.0
        and x - x == y - y == z - z == 0.0
        and _is_rotation(a, b, c, d, e, f, g, h, i)
    )


def _is_rotation(
    a: float, b: float, c: float, d: float, e: float, f: float, g: float, h: float, i: float
) -> bool:
    """Nine numbers, row by row: orthogonal columns of unit length, determinant +1; False for NaN and inf."""
    tol = tolerances.ROTATION_ERROR
    return (
        abs(a * a + d * d + g * g - 1.0) <= tol
        and abs(b * b + e * e + h * h - 1.0) <= tol
        and abs(c * c + f * f + i * i - 1.0) <= tol
        and abs(a * b + d * e + g * h) <= tol
        and abs(a * c + d * f + g * i) <= tol
        and abs(b * c + e * f + h * i) <= tol
        and a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g) > 0.0
    )


def _held_matrix(value: Any, subject: str) -> tuple[Array, bool]:
    """The numbers in an object; and whether `as_matrix()` gave them: a 3×3 from there is a rotation."""
    if isinstance(value, np.ndarray):
        return as_floats(value, subject, finite=False), False
    as_matrix = getattr(value, "as_matrix", None)
    if callable(as_matrix):
        return as_floats(as_matrix(), subject, finite=False), True
    held = getattr(value, "A", None)
    return as_floats(value if held is None else held, subject, finite=False), False


def embed_rotation(R: Array) -> Array:
    """The poses (..., 4, 4) of rotations (..., 3, 3), with zero translations."""
    T = np.zeros((*R.shape[:-2], 4, 4))
    T[..., :3, :3] = R
    T[..., 3, 3] = 1.0
    return T


def _shape_hint(shape: tuple[int, ...]) -> str:
    if shape[-2:] == (3, 3):
        return "; cspace.pose(matrix=R) converts a rotation, and cspace.embed_pose_2d(T) a planar pose"
    if shape[-2:] == (3, 4):
        return "; the last row [0, 0, 0, 1] is missing"
    if shape[-1:] in {(6,), (7,)}:
        return "; cspace.pose(xyz=…, rpy=…), or wxyz= or xyzw=, makes a pose from numbers"
    return ""


def _check_finite(matrix: Array, subject: str) -> None:
    if not np.isfinite(matrix).all():
        as_floats(matrix, subject)


def _check_homogeneous(T: Array, subject: str) -> None:
    """The last row is [0 … 0 1]; a translation found there instead is named as a transposed matrix."""
    _check_finite(T, subject)
    wanted = np.zeros(T.shape[-1])
    wanted[-1] = 1.0
    off = np.abs(T[..., -1, :] - wanted).max(axis=-1, initial=0.0) > tolerances.LAST_ROW_ERROR
    if not off.any():
        return
    where = np.argwhere(off)[0]
    item = T[tuple(where)]
    text = f"{subject}{_at(where)} has the last row {item[-1].tolist()}, expected {wanted.tolist()}"
    if np.abs(item[:, -1] - wanted).max() <= tolerances.LAST_ROW_ERROR:
        text += "; its translation stands in the last row: transpose it"
    raise InputError(text)


def _check_rotation(R: Array, subject: str) -> None:
    """RᵀR = I within tolerances.ROTATION_ERROR and det R > 0, for (..., 2, 2) or (..., 3, 3)."""
    error = orthogonality_error(R)
    bad = ~(error <= tolerances.ROTATION_ERROR)
    if bad.any():
        where = np.argwhere(bad)[0]
        raise InputError(
            _why_not_a_rotation(R[tuple(where)], float(error[tuple(where)]), subject + _at(where))
        )
    mirrored = determinant(R) < 0.0
    if mirrored.any():
        where = np.argwhere(mirrored)[0]
        raise InputError(
            f"{subject}{_at(where)} has determinant −1: it is a reflection, not a rotation; "
            "an axis is flipped, or two rows or columns are swapped"
        )


def _why_not_a_rotation(R: Array, error: float, subject: str) -> str:
    text = (
        f"{subject} is not a rotation: RᵀR differs from the identity by {error:.3g}, "
        f"allowed {tolerances.ROTATION_ERROR:g} (tolerances.ROTATION_ERROR)"
    )
    if error <= tolerances.ROTATION_PROJECTION:
        return text + "; cspace.project_rotation (or project_pose) gives the nearest one"
    scale = np.sqrt(np.sum(R * R) / len(R)) if np.isfinite(error) else np.nan
    if scale > 0.0 and orthogonality_error(R / scale) <= tolerances.ROTATION_ERROR:
        return text + f"; it is a rotation scaled by {scale:.6g}: divide by it"
    return text + "; this is too far from any rotation for a projection"


def orthogonality_error(R: Array) -> Array:
    """max |RᵀR − I| of (..., n, n), shape (...); inf or NaN where the squares overflow."""
    n = R.shape[-1]
    error = np.zeros(R.shape[:-2])
    with np.errstate(over="ignore", invalid="ignore"):
        for i in range(n):
            for j in range(i, n):
                product = R[..., 0, i] * R[..., 0, j]
                for k in range(1, n):
                    product = product + R[..., k, i] * R[..., k, j]
                np.maximum(error, np.abs(product - (i == j)), out=error)
    return error


def determinant(R: Array) -> Array:
    """det R of (..., 2, 2) or (..., 3, 3), by expansion: no factorisation, no warning."""
    if R.shape[-1] == 2:
        return np.asarray(R[..., 0, 0] * R[..., 1, 1] - R[..., 0, 1] * R[..., 1, 0])
    (a, b, c), (d, e, f), (g, h, i) = (tuple(R[..., k, j] for j in range(3)) for k in range(3))
    return np.asarray(a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g))


def _at(where: Array | np.ndarray[Any, np.dtype[np.intp]]) -> str:
    """' [2, 1]' for an item of a batch, nothing for a single matrix."""
    return f" [{', '.join(str(int(i)) for i in where)}]" if len(where) else ""
