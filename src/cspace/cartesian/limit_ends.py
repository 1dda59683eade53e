"""Where a joint path leaves the limits of position: between its nodes too."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cspace.arrays import Array
from cspace.model import Limits
from cspace.tolerances import LIMIT_ROUNDING
from cspace.trajectory.path import Path
from cspace.trajectory.piece_roots import find_piece_roots


class LimitEnd(NamedTuple):
    """The first place at which a joint path leaves the limits: its parameter and the number of the joint."""

    s: float
    joint: int


def find_limit_end(path: Path, bounds: Limits) -> LimitEnd | None:
    """The first place at which a joint path leaves limits by more than rounding; None if it keeps them.

    A piece lies within the hull of its control points; where these leave the limits, the roots of the
    derivative tell whether the piece does.
    """
    flat = path.control_points.reshape(-1, path.dof)
    if (flat.max(axis=0) <= bounds.upper).all() and (flat.min(axis=0) >= bounds.lower).all():
        return None
    found = [*_ends_above(path, 1.0, bounds.upper), *_ends_above(path, -1.0, -bounds.lower)]
    return min(found, default=None)


def _ends_above(path: Path, sign: float, levels: Array) -> list[LimitEnd]:
    """Where sign · q first exceeds the level of each joint (dof,)."""
    allowed = levels + LIMIT_ROUNDING * np.maximum(1.0, np.abs(levels))
    piece, joint = np.nonzero((sign * path.control_points).max(axis=1) > allowed)
    if not piece.size:
        return []
    c = sign * path.coefficients[piece, :, joint]
    c[:, 0] -= allowed[joint]
    begin, end = np.zeros(len(piece)), path.lengths[piece]
    turns = find_piece_roots(c[:, 1:] * np.arange(1.0, c.shape[1]), begin, end)
    places = np.concatenate([begin[:, None], turns, end[:, None]], axis=1)
    heights = np.polynomial.polynomial.polyval(places.T, c.T, tensor=False).T
    leaves = (heights > 0.0).any(axis=1)
    crossings = find_piece_roots(c[leaves], begin[leaves], end[leaves])
    crossings = np.where(heights[leaves, :1] > 0.0, 0.0, np.nan_to_num(crossings, nan=np.inf))
    s = path.breaks[piece[leaves]] + np.minimum(crossings.min(axis=1), end[leaves])
    return [LimitEnd(float(at), int(j)) for at, j in zip(s, joint[leaves], strict=True)]
