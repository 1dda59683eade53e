"""The arrays of a pose graph as given: the right shapes, or an error that names the first row at fault."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, any_array, as_floats, one_array
from cspace.errors import InputError, InputTypeError
from cspace.spatial import as_pose
from cspace.tolerances import LARGEST_IN_GRAPH, SINGULAR_INFORMATION, SYMMETRIC_INFORMATION

Ids = npt.NDArray[np.int64]
Rows = npt.NDArray[np.int32]
Mask = npt.NDArray[np.bool_]


def read_poses(value: Any, subject: str) -> Array:
    """Rows x, y, θ (n, 3), or poses (n, 4, 4)."""
    array = as_floats(value, subject, largest=LARGEST_IN_GRAPH)
    if array.ndim == 2 and array.shape[1] == 3:
        return np.ascontiguousarray(array)
    if array.ndim == 3 and array.shape[1:] == (4, 4):
        return np.ascontiguousarray(as_pose(array, subject))
    raise InputError(
        f"{subject} has shape {array.shape}; poses of the plane are (n, 3), rows x, y, θ, and poses in space"
        " (n, 4, 4)"
    )


def read_pairs(value: Any, subject: str, first: int, second: int, meaning: str) -> Rows:
    """Rows of two indices (k, 2), below `first` and `second`."""
    array = any_array(value, subject)
    if array.size == 0:
        return np.zeros((0, 2), np.int32)
    if array.dtype.kind not in "iu":
        raise InputTypeError(f"{subject} are {array.dtype}; they must be whole numbers, {meaning}")
    if array.ndim != 2 or array.shape[1] != 2:
        raise InputError(f"{subject} has shape {array.shape}, expected (k, 2): {meaning}")
    for column, most in enumerate((first, second)):
        bad = np.flatnonzero((array[:, column] < 0) | (array[:, column] >= most))
        if len(bad):
            raise InputError(
                f"{subject} holds {array[bad[0], column]} at row {bad[0]}; its column {column} must be 0 to"
                f" {most - 1}: {meaning}"
            )
    return np.ascontiguousarray(array, dtype=np.int32)


def read_information(value: Any, subject: str, count: int, size: int) -> Array:
    """Symmetric positive definite matrices (k, size, size); one matrix serves all rows."""
    array = as_floats(value, subject, largest=LARGEST_IN_GRAPH)
    if not count and not array.size:
        return np.zeros((0, size, size))
    if array.shape == (size, size):
        array = np.broadcast_to(array, (count, size, size))
    array = one_array(array, subject, (None, size, size), "a matrix per measurement")
    if len(array) != count:
        raise InputError(
            f"{subject} has {len(array)} matrices and there are {count} measurements; give one each"
        )
    across = np.abs(array - np.swapaxes(array, 1, 2)).max(axis=(1, 2), initial=0.0)
    bad = np.flatnonzero(across > SYMMETRIC_INFORMATION * np.abs(array).max(axis=(1, 2), initial=0.0))
    if len(bad):
        raise InputError(f"{subject} is not symmetric at row {bad[0]}; give the inverse of a covariance")
    array = 0.5 * (array + np.swapaxes(array, 1, 2))
    values = np.linalg.eigvalsh(array)
    bad = np.flatnonzero(values[:, 0] <= SINGULAR_INFORMATION * values[:, -1])
    if len(bad):
        k = int(bad[0])
        kind = "negative" if values[k, 0] < -SINGULAR_INFORMATION * abs(values[k, -1]) else "singular"
        raise InputError(
            f"{subject} is {kind} at row {k}, with the least eigenvalue {values[k, 0]:.3g}; it must be"
            " positive"
            " definite, the inverse of a covariance"
        )
    return np.ascontiguousarray(array)


def read_ids(value: Any, subject: str, count: int) -> Ids:
    """Whole numbers (n,), each once."""
    array = any_array(value, subject)
    if array.dtype.kind not in "iu" and array.size:
        raise InputTypeError(f"{subject} are {array.dtype}; they must be whole numbers")
    if array.shape != (count,):
        raise InputError(f"{subject} has shape {array.shape}, expected ({count},): one per row")
    names, counts = np.unique(array, return_counts=True)
    if (counts > 1).any():
        raise InputError(f"{subject} holds {names[counts > 1][0]} twice; each must differ")
    return np.array(array, dtype=np.int64)


def read_rows(value: Any, subject: str, count: int) -> npt.NDArray[np.intp]:
    """Row numbers (k,) below `count`, sorted, each once."""
    array = any_array(value, subject)
    if array.size == 0:
        return np.zeros(0, np.intp)
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise InputTypeError(f"{subject} is {value!r:.60}; give a list of row numbers")
    if (array < 0).any() or (array >= count).any():
        raise InputError(f"{subject} holds a row outside of 0 to {count - 1}")
    return np.unique(array).astype(np.intp)


def freeze_array(array: Any) -> Any:
    """The array, which nobody can write to any more."""
    array.flags.writeable = False
    return array


def check_points(points: Array, ranged: Mask, subject: str) -> None:
    """InputError for sightings that are not finite, or whose bearings are degrees."""
    missing = np.isnan(points)
    as_floats(np.where(missing, 0.0, points), subject, finite=False, largest=LARGEST_IN_GRAPH)
    bad = np.flatnonzero(missing.all(axis=1) | (missing.any(axis=1) & ~ranged) | np.isinf(points).any(axis=1))
    if len(bad):
        raise InputError(
            f"{subject} holds {points[bad[0]]} at row {bad[0]}; all must be finite, and NaN stands only for a"
            " range or a bearing that was not measured"
        )
    if points.shape[1] == 3 and ranged.any():
        raise InputError("ranged is true in space; sightings in space are points, in the frame of the pose")
    bearings = points[ranged & ~missing[:, -1], -1] if len(points) else np.zeros(0)
    if len(bearings) and (np.abs(bearings) > 2 * np.pi).all():
        raise InputError(
            f"the bearing of the first ranged sighting is {bearings[0]:g} and all others lie beyond ±2π too;"
            " give radians"
        )
