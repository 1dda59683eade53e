"""Blends: straight legs between waypoints, whose corners are rounded by no more than a stated deviation."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, check_known
from cspace.tables import count_things
from cspace.tolerances import REVERSED_TURN, SHORTEST_BLEND, STRAIGHT_TURN
from cspace.trajectory.path import Path, hermite_quintics, raise_degree
from cspace.trajectory.waypoints import read_waypoints

KINDS: Final = ("quintic", "circular")
"""Of blends."""

GENTLE_RATIO: Final = 1.0 / 3.0
"""Spacing of the control points over the length of a blend: within a tenth of the peak curvature of the
circle, for turns up to 90°."""
SHARP_RATIO: Final = 1.0 / 4.0
"""The same for sharper turns."""

ARC_PIECE: Final = 0.2
"""Largest turn [rad] of a quintic piece of a circular blend: it leaves the circle by 2e-9 of the radius."""


def blend(waypoints: ArrayLike, deviation: ArrayLike, *, kind: str = "quintic") -> Path:
    """The polyline through waypoints with rounded corners: straight legs, joined by blends.

    waypoints (k, dof) [rad or m]. deviation: the largest distance of the path from each corner [rad or m, L2
    norm], one for all or (k,) one per waypoint, of which the first and last are not used; 0 stops at the
    corner. No blend takes more than half of a leg. kind: "quintic" Bézier blends have a continuous second
    derivative; "circular" ones do not, so that they do not suit jerk limits.

    At turns near 180° the path stops instead, and so it says in its `stops`. Waypoints that are the same as
    the one before are merged. Returns a Path within the hull of the waypoints. Raises InputError for a wrong
    shape, NaN, a negative deviation and waypoints that are all the same, UnknownNameError for another kind.
    Source: Kunz and Stilman 2012 for circular blends.
    """
    check_known("kind of blend", kind, KINDS)
    given = read_waypoints(waypoints)
    allowed = _read_deviations(deviation, len(np.asarray(waypoints)), len(given.q))
    legs = np.diff(given.q, axis=0)
    directions = legs / given.distances[:, None]
    inner = directions[:-1], directions[1:]
    # tan(α / 2) from the difference and the sum of the directions is exact for small turns and near 180°.
    turns = 2.0 * np.arctan2(
        np.linalg.norm(inner[1] - inner[0], axis=1), np.linalg.norm(inner[1] + inner[0], axis=1)
    )
    half = 0.5 * np.minimum(given.distances[:-1], given.distances[1:])
    reach = _blend_reach(turns, allowed, kind)
    blended = (turns > STRAIGHT_TURN) & (turns < np.pi - REVERSED_TURN) & (reach > 0.0)
    size = max(float(given.distances.sum()), float(np.abs(given.q).max()))
    tiny = blended & (reach < SHORTEST_BLEND * size)
    blended &= ~tiny
    reach = np.where(blended, np.minimum(reach, half), 0.0)
    pieces = _Pieces()
    at = given.q[0]
    for i, (corner, turn, l) in enumerate(zip(given.q[1:-1], turns, reach, strict=True)):
        begin = corner - l * directions[i]
        left = 0.0 if l == half[i] and i > 0 and reach[i - 1] + l >= given.distances[i] else 1.0
        if left:
            pieces.add_line(at, begin)
        if l > 0.0:
            add = pieces.add_quintic if kind == "quintic" else pieces.add_arc
            add(corner, directions[i], directions[i + 1], float(turn), float(l))
        at = corner + l * directions[i + 1]
    pieces.add_line(at, given.q[-1])
    reversals = int((turns >= np.pi - REVERSED_TURN).sum())
    remarks = given.remarks + ([f"stops at {count_things(reversals, 'turn')} near 180°"] if reversals else [])
    if tiny.any():
        remarks.append(f"stops at {count_things(int(tiny.sum()), 'corner')} whose deviation is too small")
    return pieces.make_path(remarks)


def _read_deviations(deviation: ArrayLike, given: int, kept: int) -> Array:
    """The deviations at the inner waypoints."""
    allowed = as_floats(deviation, "deviation", finite=False)
    if not (allowed >= 0.0).all():
        bad = float(allowed[~(allowed >= 0.0)].flat[0])
        raise InputError(f"deviation contains {bad:g}; it must be 0 or more, and 0 stops at the corner")
    if allowed.ndim == 0:
        return np.full(kept - 2, float(allowed))
    if allowed.shape != (given,):
        raise InputError(f"deviation has shape {allowed.shape}, expected () or ({given},), one per waypoint")
    if kept != given:
        raise InputError("one deviation per waypoint needs waypoints that differ; some are the same")
    inner: Array = allowed[1:-1]
    return inner


def _spacing_ratio(turn: Array) -> Array:
    return np.where(turn <= 0.5 * np.pi, GENTLE_RATIO, SHARP_RATIO)


def _blend_reach(turns: Array, deviation: Array, kind: str) -> Array:
    """How far before and behind a corner the blends that deviate so much begin and end."""
    sine = np.sin(0.5 * turns)
    with np.errstate(divide="ignore", invalid="ignore"):
        if kind == "quintic":
            reach = deviation / ((1.0 - 25.0 / 16.0 * _spacing_ratio(turns)) * sine)
        else:
            # δ = r (1 / cos(α/2) − 1) and r = l / tan(α/2); 1 − cos = 2 sin².
            reach = deviation * sine / (2.0 * np.sin(0.25 * turns) ** 2)
    return np.where(deviation > 0.0, reach, 0.0)


class _Pieces:
    """Quintic pieces of a path, one after the other."""

    def __init__(self) -> None:
        self.lengths: list[float] = []
        self.controls: list[Array] = []

    def add_line(self, begin: Array, end: Array) -> None:
        """A straight leg at unit speed."""
        length = float(np.linalg.norm(end - begin))
        if length > 0.0:
            self.controls.append(raise_degree(np.stack([begin, end])[None], 5)[0])
            self.lengths.append(length)

    def add_quintic(self, corner: Array, a: Array, b: Array, turn: float, l: float) -> None:
        """A Bézier blend whose control points lie on the legs at l, l − e and l − 2e from the corner."""
        e = float(_spacing_ratio(np.array(turn))) * l
        near = np.array([l, l - e, l - 2.0 * e])[:, None]
        self.controls.append(np.concatenate([corner - near * a, corner + near[::-1] * b]))
        self.lengths.append(5.0 * e)

    def add_arc(self, corner: Array, a: Array, b: Array, turn: float, l: float) -> None:
        """An arc in quintic pieces that attain its slope and bend at their ends."""
        radius = l / np.tan(0.5 * turn)
        normal = (b - np.cos(turn) * a) / np.sin(turn)
        count = int(np.ceil(turn / ARC_PIECE))
        angle = turn * np.arange(count + 1.0)[:, None] / count
        bulge = 2.0 * np.sin(0.5 * angle) ** 2  # 1 − cos, exact for small turns
        q = corner - l * a + radius * (np.sin(angle) * a + bulge * normal)
        slope = np.cos(angle) * a + np.sin(angle) * normal
        bend = (np.cos(angle) * normal - np.sin(angle) * a) / radius
        q[-1] = corner + l * b
        h = np.full(count, radius * turn / count)
        self.controls.extend(hermite_quintics(h, q, slope, bend))
        self.lengths.extend(h.tolist())

    def make_path(self, remarks: list[str]) -> Path:
        """All pieces as a path."""
        return Path(
            np.concatenate([[0.0], np.cumsum(self.lengths)]), np.array(self.controls), remarks=remarks
        )
