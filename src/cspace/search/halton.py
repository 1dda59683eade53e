"""Halton points: they fill a box evenly (Halton 1960)."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array

BASES: Final = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53)
"""One per dimension."""


def halton_points(first: int, count: int, dimensions: int) -> Array:
    """Points first … first + count − 1 of the sequence (count, dimensions), inside the unit box; first ≥ 0.

    Coordinate k of point n mirrors the digits of n + 1 in the k-th prime base at the point.
    """
    points = np.empty((count, dimensions))
    for column, base in zip(points.T, BASES[:dimensions], strict=True):
        digits = np.arange(first + 1, first + count + 1)
        column[:], place = 0.0, 1.0
        while digits.any():
            place /= base
            column += place * (digits % base)
            digits //= base
    return points
