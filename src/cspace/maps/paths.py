"""Checks the paths that are passed to worlds."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError

__all__ = ["as_path"]


def as_path(path: ArrayLike) -> Array:
    """A path as an array (m, 2) [m], contiguous; InputError for other shapes."""
    points = as_floats(path, "path", last=(2,))
    if points.ndim != 2:
        raise InputError(f"path has shape {points.shape}, expected (m, 2)")
    return np.ascontiguousarray(points)
