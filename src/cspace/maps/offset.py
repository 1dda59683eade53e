"""Offset curves: the exact free space of a disc's centre, bounded by segments along walls and arcs around
corners.

Every wall, and every corner that free space bends around, contributes a segment or an arc at the distance
of the radius. These are cut at their intersections. The pieces with no wall nearer than the radius are
kept.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from cspace.arrays import Array, positive_number
from cspace.math.wrapping import wrap_above
from cspace.tables import show_fields
from cspace.tolerances import OFFSET_PIECE, OFFSET_SLACK

Clearance = Callable[[Array], Any]


@show_fields
class OffsetCurve(NamedTuple):
    """A closed curve of k pieces, with the free space of the disc's centre on its left."""

    start: Array
    """(k, 2) [m]: the start of each piece."""
    end: Array
    """(k, 2) [m]: the end of each piece."""
    center: Array
    """(k, 2) [m]: the centre of an arc; NaN for a segment."""
    angles: Array
    """(k, 2) [rad]: the start and end angle of an arc around its centre, clockwise; NaN for a segment."""

    def points(self, chord: float) -> Array:
        """The curve as a closed polygon (m, 2) [m] whose sides deviate from it by at most `chord` [m]."""
        made = []
        for start, center, (begin, end) in zip(self.start, self.center, self.angles, strict=True):
            if np.isnan(begin):
                made.append(start[None])
                continue
            radius = float(np.hypot(*(start - center)))
            step = 2 * np.arccos(max(0.0, 1 - chord / radius))
            at = np.linspace(begin, end, 1 + int(np.ceil((begin - end) / step)))[:-1]
            made.append(center + radius * np.stack([np.cos(at), np.sin(at)], axis=1))
        return np.vstack(made)


@show_fields
class Offset(NamedTuple):
    """The free space of the centre of a disc."""

    radius: float
    """Radius of the disc [m]."""
    curves: list[OffsetCurve]

    @property
    def length(self) -> float:
        """Total length of all curves [m]."""
        total = 0.0
        for curve in self.curves:
            turns = np.nan_to_num(curve.angles[:, 0] - curve.angles[:, 1])
            straight = np.isnan(curve.angles[:, 0])
            total += float(np.hypot(*(curve.end - curve.start)[straight].T).sum() + self.radius * turns.sum())
        return total

    @property
    def area(self) -> float:
        """Area of the free space of the disc's centre [m²]."""
        total = 0.0
        for curve in self.curves:
            (x, y), (u, v) = (curve.start - curve.start[0]).T, (curve.end - curve.start[0]).T
            turns = np.nan_to_num(curve.angles[:, 0] - curve.angles[:, 1])
            caps = self.radius**2 * (turns - np.sin(turns))  # the area between arcs and their chords
            total += 0.5 * float(np.sum(x * v - y * u) - np.sum(caps))
        return total


class _Tracks(NamedTuple):
    """m segments (turn 0) and arcs at the radius from walls and corners."""

    start: Array
    along: Array  # unit vectors of segments
    size: Array  # lengths of segments, turns of arcs [rad]
    center: Array  # NaN for segments
    angle: Array  # where arcs begin

    def at(self, k: int, t: Array, radius: float) -> Array:
        if np.isnan(self.angle[k]):
            return np.asarray(self.start[k] + t[:, None] * self.along[k])
        angle = self.angle[k] - t
        return np.asarray(self.center[k] + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def find_offset(walls: list[Array], clearance: Clearance, wide: float, radius: float) -> Offset:
    """The free space of a disc's centre; InputError for a radius that is not positive [m].

    walls: rings (n, 2) [m] with free space on their left; clearance: of points (m, 2) [m], from all walls;
    wide [m]: the longer side of the bounds.
    """
    reach = positive_number(radius, "radius", "it must be positive [m]", largest=sys.float_info.max)
    if reach > wide:
        return Offset(reach, [])  # no point in the bounds is that far from them
    slack = OFFSET_SLACK * wide
    tracks = _make_tracks(walls, reach)
    pieces = [
        piece for k in range(len(tracks.size)) for piece in _keep_pieces(clearance, tracks, k, reach, slack)
    ]
    return Offset(reach, _link_pieces(tracks, pieces, reach, slack))


def _make_tracks(walls: list[Array], radius: float) -> _Tracks:
    """Walls are rings with free space on their left."""
    rows = []
    nothing = (np.nan, np.nan)
    for ring in walls:
        after = np.roll(ring, -1, axis=0)
        along = (after - ring) / np.hypot(*(after - ring).T)[:, None]
        normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
        for k in range(len(ring)):
            f = (k + 1) % len(ring)
            length = float(np.hypot(*(after[k] - ring[k])))
            rows.append((*(ring[k] + radius * normal[k]), *along[k], length, *nothing, np.nan))
            turn = along[k, 0] * along[f, 1] - along[k, 1] * along[f, 0]
            if turn < 0 or (turn == 0 and along[k] @ along[f] < 0):
                sweep = float(wrap_above(np.arctan2(-turn, along[k] @ along[f]), 0.0))
                begin = float(np.arctan2(normal[k, 1], normal[k, 0]))
                rows.append((*(after[k] + radius * normal[k]), *nothing, sweep, *after[k], begin))
    table = np.array(rows, float).reshape(-1, 8)
    return _Tracks(table[:, :2], table[:, 2:4], table[:, 4], table[:, 5:7], table[:, 7])


def _keep_pieces(
    clearance: Clearance, tracks: _Tracks, k: int, radius: float, slack: float
) -> Iterator[tuple[int, float, float]]:
    """The pieces of a track, as (track, from, to), with no wall nearer than the radius."""
    size = float(tracks.size[k])
    fine = OFFSET_PIECE * size
    cuts = np.unique(np.concatenate([[0.0, size], np.clip(_find_cuts(tracks, k, radius), 0.0, size)]))
    cuts = cuts[np.concatenate([[True], np.diff(cuts) > fine])]
    free = clearance(tracks.at(k, (cuts[1:] + cuts[:-1]) / 2, radius)) >= radius - slack
    edges = np.flatnonzero(np.diff(np.concatenate([[0], free.astype(np.int8), [0]])))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        yield k, float(cuts[first]), float(cuts[last])


def _find_cuts(tracks: _Tracks, k: int, radius: float) -> Array:
    """Where other tracks cross a track: lengths along a segment, clockwise angles along an arc."""
    lines, arcs = np.isnan(tracks.angle), ~np.isnan(tracks.angle)
    u, p = tracks.along[lines], tracks.start[lines]
    with np.errstate(divide="ignore", invalid="ignore"):
        if lines[k]:
            start, along = tracks.start[k], tracks.along[k]
            away = p - start
            by_lines = _cross_product(away, u) / _cross_product(along, u)
            off = tracks.center[arcs] - start
            half = np.sqrt(radius**2 - _cross_product(along, off) ** 2)
            by_arcs = off @ along + np.array([[1.0], [-1.0]]) * half
            found: Array = np.concatenate([by_lines, by_arcs.ravel()])
            return found[np.isfinite(found)]
        center = tracks.center[k]
        away = p - center
        half = np.sqrt(radius**2 - _cross_product(u, away) ** 2)
        feet = away - np.einsum("ij,ij->i", away, u)[:, None] * u
        off = tracks.center[arcs] - center
        apart = np.hypot(*off.T)
        high = (
            np.sqrt(radius**2 - apart**2 / 4)[:, None] * np.stack([-off[:, 1], off[:, 0]], 1) / apart[:, None]
        )
        meets = [feet + half[:, None] * u, feet - half[:, None] * u, off / 2 + high, off / 2 - high]
        at = np.vstack(meets)
        turn = wrap_above(tracks.angle[k] - np.arctan2(at[:, 1], at[:, 0]), 0.0)
        return np.asarray(turn[np.isfinite(turn) & (turn < tracks.size[k])])


def _cross_product(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _link_pieces(
    tracks: _Tracks, pieces: list[tuple[int, float, float]], radius: float, slack: float
) -> list[OffsetCurve]:
    """Closed curves of pieces; each piece is followed by the piece that starts nearest to its end."""
    if not pieces:
        return []
    ends = np.array([tracks.at(k, np.array([begin, end]), radius) for k, begin, end in pieces])
    left = np.ones(len(pieces), bool)
    curves = []
    while left.any():
        chain = [int(np.argmax(left))]
        left[chain[0]] = False
        while left.any():
            here = ends[chain[-1], 1]
            apart = np.where(left, np.hypot(*(ends[:, 0] - here).T), np.inf)
            if np.hypot(*(ends[chain[0], 0] - here)) <= max(slack, apart.min()):
                break
            chain.append(int(np.argmin(apart)))
            left[chain[-1]] = False
        track = np.array([pieces[i][0] for i in chain], np.int64)
        angles: Array = tracks.angle[track, None] - np.array([pieces[i][1:] for i in chain])
        curves.append(OffsetCurve(ends[chain, 0], ends[chain, 1], tracks.center[track], angles))
    return curves
