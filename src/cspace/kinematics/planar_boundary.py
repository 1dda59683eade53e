"""The boundary of what a planar arm reaches, from its singular curves.

A point of the boundary is reached where no motion within the limits leads across it: the joints that are
not at a limit have then lost a direction, which in the plane means that their centres and the tip lie on
one line. Holding every choice of joints at every choice of limits, and folding the others onto a line,
gives arcs of circles; those parts of them that have unreachable points on one side are the boundary (Kumar
and Waldron 1981).

Angles here are absolute turns αᵢ of link i against link i − 1, counter-clockwise; α₁ against the first axis
of the plane. A range is (start, width) with width ≤ 2π. Points are complex numbers x + iy [m].
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.math.wrapping import TURN, wrap_above
from cspace.tolerances import SAME_PLACE, TANGENT_PLACE

Flags = npt.NDArray[np.bool_]
Points = npt.NDArray[np.complexfloating]


@dataclass(frozen=True, eq=False)
class PlanarArm:
    """Links of lengths (n,) [m], each rotating within ranges (n, 2): start and width of αᵢ [rad]."""

    lengths: Array
    ranges: Array

    @property
    def reach(self) -> float:
        """The length of the stretched arm [m]."""
        return float(self.lengths.sum())

    def beyond_first(self) -> PlanarArm:
        """The arm that the first link carries."""
        return PlanarArm(self.lengths[1:], self.ranges[1:])


@dataclass(frozen=True)
class Arc:
    """The points center + radius · exp(iφ), φ from start to start + width."""

    center: complex
    radius: float
    start: float
    width: float

    def at(self, angle: float | Array) -> Points:
        """The points (...) at the angles (...)."""
        return self.center + self.radius * np.exp(1j * angle)


def is_within(angle: Array, start: float, width: float) -> Flags:
    """Whether angles lie in a range modulo 2π; its ends count, up to rounding."""
    if width >= TURN:
        return np.ones(np.shape(angle), dtype=bool)
    past = wrap_above(angle - start, -SAME_PLACE)
    return np.asarray(past <= width + SAME_PLACE)


def critical_arcs(arm: PlanarArm) -> list[Arc]:
    """The arcs on which the tip is where the joints away from their limits lie on a line with it."""
    n = len(arm.lengths)
    # Per joint: locked at either limit, or free; a free joint after the first free one is straight or folded.
    choices = [("free", "low", "high") if width < TURN else ("free",) for _, width in arm.ranges]
    arcs = []
    for holds in product(*choices):
        free = [i for i in range(n) if holds[i] == "free"]
        for folds in product((0.0, np.pi), repeat=max(len(free) - 1, 0)) if free else ():
            arc = _arc(arm, holds, free, folds)
            if arc is not None and arc.radius > SAME_PLACE * arm.reach:
                arcs.append(arc)
    return arcs


def _arc(arm: PlanarArm, holds: tuple[str, ...], free: list[int], folds: tuple[float, ...]) -> Arc | None:
    """The arc of one choice, or None if a fold is outside the limits."""
    n, first = len(arm.lengths), free[0]
    angle = arm.ranges[:, 0] + np.where(np.array(holds) == "high", arm.ranges[:, 1], 0.0)
    headings = np.cumsum(angle[:first])
    center = complex(np.sum(arm.lengths[:first] * np.exp(1j * headings)))
    # From the first free joint on, with that joint at 0: rigid pieces from one free joint to the next.
    along, straight, tip = 0.0, 0.0, 0j
    for joint, until, fold in zip(free, [*free[1:], n], (None, *folds), strict=True):
        inner = np.cumsum([0.0, *angle[joint + 1 : until]])
        piece = complex(np.sum(arm.lengths[joint:until] * np.exp(1j * inner)))
        if fold is None:
            straight = cmath.phase(piece)
        else:
            turn = straight + fold - cmath.phase(piece) - along
            if not is_within(np.array(turn), *arm.ranges[joint]):
                return None
            along += turn
        tip += piece * np.exp(1j * along)
        along += float(inner[-1])
    start, width = arm.ranges[first]
    begin = float(np.sum(angle[:first])) + start + cmath.phase(tip)
    return Arc(center, abs(tip), begin, float(width))


def is_reachable(arm: PlanarArm, points: Points) -> Flags:
    """Whether the tip of an arm of two or more links gets to points (m,), exactly up to rounding."""
    if len(arm.lengths) == 2:
        return _reachable_by_two(arm, points)
    rest = arm.beyond_first()
    circles = critical_arcs(rest)
    return np.array([_reachable_by_more(arm, rest, circles, point) for point in points], dtype=bool)


def _reachable_by_two(arm: PlanarArm, points: Points) -> Flags:
    """The two elbow positions by the law of cosines."""
    a, b = arm.lengths
    cosine = (np.abs(points) ** 2 - a * a - b * b) / (2.0 * a * b)
    bend = np.arccos(np.clip(cosine, -1.0, 1.0))
    found = np.zeros(len(points), dtype=bool)
    for elbow in (bend, -bend):
        first = np.angle(points) - np.angle(a + b * np.exp(1j * elbow))
        found |= is_within(elbow, *arm.ranges[1]) & is_within(first, *arm.ranges[0])
    return np.asarray(found & (np.abs(cosine) <= 1.0))


def _reachable_by_more(arm: PlanarArm, rest: PlanarArm, circles: list[Arc], point: complex) -> bool:
    """Turn the first link through its range: what the rest reaches changes on its critical circles only."""
    start, width = arm.ranges[0]
    changes = [0.0, float(width)]
    for arc in circles:
        center = arm.lengths[0] + arc.center
        if point == 0.0 or center == 0.0:
            continue
        cosine = (abs(point) ** 2 + abs(center) ** 2 - arc.radius**2) / (2.0 * abs(point) * abs(center))
        if abs(cosine) <= 1.0:
            middle, opening = cmath.phase(point / center) - start, math.acos(cosine)
            past = wrap_above(middle + np.array([opening, -opening]), 0.0)
            changes += [change for change in past if change < width]
    ordered = np.sort(np.array(changes))
    turns = start + (ordered[1:] + ordered[:-1]) / 2.0
    return bool(is_reachable(rest, point * np.exp(-1j * turns) - arm.lengths[0]).any())


def trace_boundary(arm: PlanarArm, *, step: float = TURN / 256) -> list[Points]:
    """The boundary as closed curves (m,), first point repeated, what is reachable to the left.

    step: largest angle [rad] of an arc between two points of a curve.
    """
    if len(arm.lengths) == 1:  # a line with nothing inside: there and back it closes
        start, width = map(float, arm.ranges[0])
        line = _points(Arc(0j, arm.reach, start, width), start, start + width, step)
        return [np.concatenate([line, line[-2::-1]])]
    if len(arm.lengths) > 3 and (arm.ranges[:, 1] >= TURN).all():
        inner = 2.0 * float(arm.lengths.max()) - arm.reach
        outside, hole = (
            _points(Arc(0j, radius, 0.0, TURN), 0.0, TURN, step) for radius in (arm.reach, inner)
        )
        return [_closed(outside)] + [_closed(hole[::-1])] * (inner > SAME_PLACE * arm.reach)
    arcs = critical_arcs(arm)
    pieces: dict[complex, Points] = {}
    for arc in arcs:
        for low, high in _split(arc, arcs):
            place = complex(np.round(arc.at((low + high) / 2.0) / (TANGENT_PLACE * arm.reach)))
            if place in pieces:  # arcs of one circle overlap; they were cut at each other's ends
                continue
            if side := _side(arm, arc, (low + high) / 2.0):
                points = _points(arc, low, high, step)
                pieces[place] = points if side > 0 else points[::-1]
    return _joined(list(pieces.values()), 100.0 * TANGENT_PLACE * arm.reach)


def _split(arc: Arc, others: list[Arc]) -> list[tuple[float, float]]:
    """The arc cut wherever it meets the circle of another: ranges of its angle."""
    cuts = {arc.start, arc.start + arc.width}
    for other in others:
        offset = other.center - arc.center
        away = abs(offset)
        if away <= SAME_PLACE * (arc.radius + other.radius):
            if abs(arc.radius - other.radius) <= SAME_PLACE * arc.radius:  # the same circle: its ends cut
                cuts |= {_onto(arc, end) for end in (other.start, other.start + other.width)}
            continue
        cosine = (arc.radius**2 + away**2 - other.radius**2) / (2.0 * arc.radius * away)
        if abs(cosine) <= 1.0 + SAME_PLACE:
            opening = float(np.arccos(np.clip(cosine, -1.0, 1.0)))
            bearing = cmath.phase(offset)
            cuts |= {_onto(arc, bearing + opening), _onto(arc, bearing - opening)}
    ordered = sorted(cut for cut in cuts if cut <= arc.start + arc.width)
    return [(a, b) for a, b in pairwise(ordered) if b - a > TANGENT_PLACE]


def _onto(arc: Arc, angle: float) -> float:
    """The angle shifted by a multiple of 2π to the first value at or after the start of the arc."""
    return float(wrap_above(np.asarray(angle), arc.start))


def _side(arm: PlanarArm, arc: Arc, angle: float) -> int:
    """+1 if next to the arc's point at an angle only the inside is reachable, −1 only the outside, or 0."""
    aside = min(10.0 * SAME_PLACE * arm.reach, 0.5 * arc.radius)
    radii = arc.radius + np.array([-aside, aside])
    inside, outside = is_reachable(arm, arc.center + radii * np.exp(1j * angle))
    return int(inside) - int(outside)


def _points(arc: Arc, low: float, high: float, step: float) -> Points:
    return arc.at(np.linspace(low, high, 2 + int((high - low) / step)))


def _closed(curve: Points) -> Points:
    """The curve with its first point in place of the last, which is the same but for rounding."""
    return np.concatenate([curve[:-1], curve[:1]])


def _joined(pieces: list[Points], gap: float) -> list[Points]:
    """Directed pieces linked end to start, where they are within a gap, into closed curves."""
    left, curves = list(pieces), []
    while left:
        curve = left.pop()
        while left and abs(curve[0] - curve[-1]) > gap:
            distances = [abs(piece[0] - curve[-1]) for piece in left]
            if min(distances) > gap:
                break
            nearest = int(np.argmin(distances))
            curve = np.concatenate([curve, left.pop(nearest)[1:]])
        extent = max(np.ptp(curve.real), np.ptp(curve.imag))
        if extent > gap:  # smaller curves are remainders where circles touch
            curves.append(_closed(curve))
    return curves
