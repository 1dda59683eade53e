"""The formulas of this room for one rotation, in Python numbers: numpy costs a microsecond per operation.

Rotations come and go as nine numbers, row by row. The tests hold these against the batched formulas.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, inf, sin, sqrt, tan

import numpy as np

from cspace.arrays import Array

Nine = tuple[float, float, float, float, float, float, float, float, float]
"""The entries of a 3×3 matrix, row by row."""


def matrix(entries: Nine) -> Array:
    """The 3×3 array of nine numbers."""
    return np.array(entries).reshape(3, 3)


def pose(entries: Sequence[float], p: Sequence[float]) -> Array:
    """The 4×4 array of a rotation and a translation."""
    (a, b, c, d, e, f, g, h, i), (x, y, z) = entries, p
    return np.array([[a, b, c, x], [d, e, f, y], [g, h, i, z], [0.0, 0.0, 0.0, 1.0]])


def inverse(T: Array) -> Array:
    """The inverse of one 4×4 pose by transposition."""
    (a, b, c, x), (d, e, f, y), (g, h, i, z), _ = T.tolist()
    p = [-(a * x + d * y + g * z), -(b * x + e * y + h * z), -(c * x + f * y + i * z)]
    return pose((a, d, g, b, e, h, c, f, i), p)


def direction(v: list[float]) -> tuple[float, list[float]] | None:
    """Length and unit direction, step by step as length_and_direction; None for zero or on overflow."""
    largest = max(map(abs, v))
    if largest == 0.0:
        return None
    scaled = [x / largest for x in v]
    square = 0.0
    for x in scaled:
        square += x * x
    norm = sqrt(square)
    length = largest * norm
    return (length, [x / norm for x in scaled]) if length < inf else None


def wxyz(R: Array) -> tuple[float, float, float, float]:
    """The unit quaternion of a 3×3 array (Shepperd), with the sign of to_wxyz."""
    (a, b, c), (d, e, f), (g, h, i) = R.tolist()
    largest = max(a, e, i)
    trace = a + e + i
    if trace >= largest:
        q = (1.0 + trace, h - f, c - g, d - b)
    elif a == largest:
        q = (h - f, 1.0 + (a - e - i), b + d, c + g)
    elif e == largest:
        q = (c - g, b + d, 1.0 + (e - a - i), f + h)
    else:
        q = (d - b, c + g, f + h, 1.0 + (i - a - e))
    w, x, y, z = q
    first = w or x or y or z
    scale = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    if first < 0.0:
        scale = -scale
    return w * scale, x * scale, y * scale, z * scale


def rotvec(R: Array) -> tuple[float, list[float]] | None:
    """Angle in [0, π] and unit axis of a 3×3 array; None for the identity."""
    w, *v = wxyz(R)
    split = direction(v)
    if split is None:
        return None
    sine, axis = split
    return 2.0 * atan2(sine, w), axis


def euler(axes: tuple[int, int, int], angles: Sequence[float]) -> Nine:
    """R_i(a) R_j(b) R_k(c): each rotation mixes two columns of the product."""
    columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    for axis, angle in zip(axes, angles, strict=True):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        c, s = cos(angle), sin(angle)
        p, q = columns[u], columns[v]
        columns[u] = [c * p[0] + s * q[0], c * p[1] + s * q[1], c * p[2] + s * q[2]]
        columns[v] = [c * q[0] - s * p[0], c * q[1] - s * p[1], c * q[2] - s * p[2]]
    (a, d, g), (b, e, h), (c, f, i) = columns
    return a, b, c, d, e, f, g, h, i


def helix(axis: list[float], angle: float, v: list[float]) -> list[float]:
    """V v of exp_se3: where the origin gets to on a twist."""
    half = 0.5 * angle
    return _spun(axis, v, sin(half) * (sin(half) / half), 1.0 - sin(angle) / angle)


def straightened(axis: list[float], angle: float, p: list[float]) -> list[float]:
    """V⁻¹ p of log_se3: the v of the twist that gets the origin to p."""
    half = 0.5 * angle
    return _spun(axis, p, -half, 1.0 - half / tan(half))


def _spun(u: list[float], v: list[float], first: float, second: float) -> list[float]:
    """v + first (u × v) + second (u × (u × v))."""
    a, b, c = u
    x, y, z = v
    l, m, n = b * z - c * y, c * x - a * z, a * y - b * x
    return [
        x + first * l + second * (b * n - c * m),
        y + first * m + second * (c * l - a * n),
        z + first * n + second * (a * m - b * l),
    ]
