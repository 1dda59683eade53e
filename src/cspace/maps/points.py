"""Checks points and paths that are passed to worlds."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, one_number
from cspace.errors import InputError


def as_point(point: ArrayLike, subject: str) -> tuple[float, float]:
    """x and y of a point (2,) [m]; InputError for other shapes and numbers that are not finite."""
    given = as_floats(point, subject, last=(2,))
    if given.ndim != 1:
        raise InputError(f"{subject} has shape {given.shape}, expected (2,)")
    return float(given[0]), float(given[1])


def as_path(path: ArrayLike) -> Array:
    """A path as an array (m, 2) [m], contiguous; InputError for other shapes."""
    points = as_floats(path, "path", last=(2,))
    if points.ndim != 2:
        raise InputError(f"path has shape {points.shape}, expected (m, 2)")
    return np.ascontiguousarray(points)


def check_inflation(radius: float) -> float:
    """A radius [m] by which obstacles are grown; InputError for a negative one."""
    if (grown := one_number(radius, "radius")) < 0:
        raise InputError(f"radius is {grown:g}; it must be zero or more [m]")
    return grown
