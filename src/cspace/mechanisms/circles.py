"""Where circles of the plane meet, and spheres of space: the closed forms of linkages."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array
from cspace.spatial.vectors import cross, perpendicular
from cspace.tolerances import LOOP_CLOSED


def intersect_circles(first: Array, r: float, second: Array, s: float) -> tuple[Array, float]:
    """The points (k, 2) of two circles, left of the line from the first centre (2,) to the second before
    right.

    Two points, one where they touch, or none; with the distance [m] that is then missing, zero otherwise.
    Equal circles give one point, that along the x axis.
    """
    across = second - first
    d, size = float(np.hypot(*across)), max(r, s)
    gap = max(d - r - s, abs(r - s) - d)
    if gap > LOOP_CLOSED * size:
        return np.empty((0, 2)), gap
    if d <= LOOP_CLOSED * size:
        return first[None] + [r, 0.0], 0.0
    along = (d * d + (r - s) * (r + s)) / (2.0 * d)
    height = np.sqrt(max((r - along) * (r + along), 0.0))
    u = across / d
    foot, left = first + along * u, height * np.array([-u[1], u[0]])
    if gap >= -LOOP_CLOSED * size:
        return foot[None], 0.0
    return np.array([foot + left, foot - left]), 0.0


def intersect_spheres(centers: Array, r: float) -> tuple[Array, float]:
    """The points (k, 3) of three spheres of one radius about centers (3, 3).

    Two points, the one against the normal of the centres' plane (by the right hand) first; one where the
    centres lie on a circle of this radius; or none, with the length [m] by which r is too small, infinite for
    three centres in line. Where centres coincide, one of a continuum of points.
    """
    a, b, c = centers
    ab, ac = b - a, c - a
    normal = cross(ab, ac)
    area = float(normal @ normal)
    size = max(float(ab @ ab), float(ac @ ac), r * r)
    if area <= (LOOP_CLOSED * size) ** 2:
        return _intersect_in_line(centers, r)
    to_middle = (cross(normal, ab) * (ac @ ac) + cross(ac, normal) * (ab @ ab)) / (2.0 * area)
    radius = float(np.linalg.norm(to_middle))
    if radius - r > LOOP_CLOSED * np.sqrt(size):
        return np.empty((0, 3)), radius - r
    up = np.sqrt(max((r - radius) * (r + radius), 0.0)) * normal / np.sqrt(area)
    middle = a + to_middle
    if radius - r >= -LOOP_CLOSED * np.sqrt(size):
        return middle[None], 0.0
    return np.array([middle - up, middle + up]), 0.0


def _intersect_in_line(centers: Array, r: float) -> tuple[Array, float]:
    """A point (1, 3) of spheres about centers (3, 3) in line, of which at least two must coincide."""
    apart = np.linalg.norm(centers - np.roll(centers, -1, axis=0), axis=1)
    if apart.min() > LOOP_CLOSED * max(r, float(apart.max())):
        return np.empty((0, 3)), np.inf
    first = int(apart.argmax())
    half = 0.5 * (centers[(first + 1) % 3] - centers[first])
    away = float(np.linalg.norm(half))
    if away > r:
        return np.empty((0, 3)), away - r
    down = -perpendicular(half / away) if away > 0.0 else np.array([0.0, 0.0, -1.0])
    return (centers[first] + half + np.sqrt((r - away) * (r + away)) * down)[None], 0.0
