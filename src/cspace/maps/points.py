"""Checks points and paths that are passed to worlds."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array, one_number
from cspace.errors import InputError


def as_point(point: ArrayLike, subject: str) -> tuple[float, float]:
    """x and y of a point (2,) [m]; InputError for other shapes and numbers that are not finite."""
    x, y = one_array(point, subject, (2,)).tolist()
    return x, y


def as_path(path: ArrayLike) -> Array:
    """A path as an array (m, 2) [m], contiguous; InputError for other shapes."""
    return one_array(path, "path", (None, 2))


def check_inflation(radius: float) -> float:
    """A radius [m] by which obstacles are grown; InputError for a negative one."""
    if (grown := one_number(radius, "radius")) < 0:
        raise InputError(f"radius is {grown:g}; it must be zero or more [m]")
    return grown
