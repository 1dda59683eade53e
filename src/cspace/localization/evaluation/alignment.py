"""The rigid motion that brings estimated points closest to true ones, in the sense of least squares."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.spatial import pose, pose_2d
from cspace.tolerances import ALIGNMENT_ROUNDING


def align_points(points: Array, targets: Array) -> Array:
    """T (d + 1, d + 1) that minimises Σ |T p − t|² for points (n, d) in the plane or in space.

    Raises InputError for points that determine no rotation: all at one place, or in space on one line.
    Source: Umeyama 1991, without scale.
    """
    d = points.shape[1]
    middle, center = points.mean(axis=0), targets.mean(axis=0)
    M = (targets - center).T @ (points - middle)
    if d == 2:
        c, s = M[0, 0] + M[1, 1], M[1, 0] - M[0, 1]
        turn = float(np.arctan2(s, c))
        R, strength = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]), np.hypot(c, s)
    else:
        U, values, Vt = np.linalg.svd(M)
        mirror = np.sign(np.linalg.det(U) * np.linalg.det(Vt))
        R, strength = (U * [1.0, 1.0, mirror]) @ Vt, values[1]
    largest = max(np.abs(points).max(), np.abs(targets).max())
    spread = max(np.abs(points - middle).max(), np.abs(targets - center).max())
    if strength <= ALIGNMENT_ROUNDING * len(points) * largest * spread:
        place, remedy = ("at one place", "") if d == 2 else ("on one line", ' or align="se2"')
        raise InputError(
            f"the poses determine no rotation, they lie {place}; align them with align=None{remedy}"
        )
    t = center - R @ middle
    return pose_2d(xytheta=[*t, turn]) if d == 2 else pose(xyz=t, matrix=R)
