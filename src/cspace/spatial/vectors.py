"""Vectors of three numbers, batched over leading axes; lengths that neither overflow nor underflow."""

from __future__ import annotations

from functools import reduce

import numpy as np

from cspace.arrays import Array

X, Y, Z = np.eye(3)
NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])
"""The axes after each one, in the order of the right hand."""
AXES = {"x": X, "y": Y, "z": Z, "-x": -X, "-y": -Y, "-z": -Z}


def length_and_direction(v: Array) -> tuple[Array, Array]:
    """(..., k) → length (...) and unit direction (..., k); the direction of a zero vector is zero.

    The largest entry is divided out first, so that 1e-320 and 1e300 keep their direction.
    """
    parts = [v[..., k] for k in range(v.shape[-1])]
    largest = reduce(np.maximum, map(np.abs, parts))
    scale = np.where(largest > 0.0, largest, 1.0)
    scaled = [part / scale for part in parts]
    length = np.sqrt(sum(part * part for part in scaled))
    safe = np.where(largest > 0.0, length, 1.0)
    direction = np.empty(v.shape)
    for k, part in enumerate(scaled):
        direction[..., k] = part / safe
    with np.errstate(over="ignore"):
        return np.asarray(scale * length), direction


def cross(a: Array, b: Array) -> Array:
    """a × b for (..., 3) and (..., 3), broadcast; numpy's own costs several times as much."""
    result: Array = a.take(NEXT, -1) * b.take(LAST, -1) - a.take(LAST, -1) * b.take(NEXT, -1)
    return result


def perpendicular(h: Array) -> Array:
    """A unit vector (3,) perpendicular to a unit vector (3,); to a coordinate axis another one."""
    across = cross(h, np.eye(3)[int(np.argmin(np.abs(h)))])
    return np.asarray(across / np.linalg.norm(across))


def frame_along(axis: Array) -> Array:
    """A rotation (3, 3) whose third column is the unit axis (3,); a coordinate axis is only permuted."""
    y = perpendicular(axis)
    return np.column_stack([cross(y, axis), y, axis])
