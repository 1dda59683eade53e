"""Ellipses of planar covariances."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot.axes import draw_polygons

SCALE: Final = 2.4477
"""Standard deviations of the ellipse that holds 95 % of a normal distribution of the plane."""
CORNERS: Final = 48


def find_rings(points: Array, covariances: Array) -> Array:
    """Outlines (n, 48, 2) of the ellipses of 95 % about points (n, 2), of covariances (n, 2, 2)."""
    values, vectors = np.linalg.eigh(covariances)
    angles = np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    scaled = SCALE * np.sqrt(np.maximum(values, 0.0))[:, None, :] * around
    return np.asarray(points[:, None, :2] + scaled @ np.swapaxes(vectors, -1, -2))


def draw_ellipses(axes: Any, points: Array, covariances: Array, **style: Any) -> list[Any]:
    """The ellipses of 95 % about points (n, 2)."""
    drawn = {"linewidths": 0.8, "zorder": 5, **style}
    return draw_polygons(axes, find_rings(points, covariances), **drawn)


def turn_to_map(poses: Array, covariances: Array) -> Array:
    """The covariances of positions (n, 2, 2) in axes of the map, of covariances (n, 3, 3) in base."""
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    R = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
    return np.asarray(R @ covariances[:, :2, :2] @ np.swapaxes(R, -1, -2))
