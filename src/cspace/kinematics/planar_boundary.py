"""The boundary of what a planar arm reaches, from its singular curves.

A point of the boundary is reached where no motion within the limits leads across it: the joints that are
not at a limit have then lost a direction, which in the plane means that their centres and the tip lie on
one line. Holding every choice of joints at every choice of limits, and folding the others onto a line,
gives arcs of circles; those parts of them that have unreachable points on one side are the boundary (Kumar
and Waldron 1981).

Angles here are absolute turns αᵢ of link i against link i − 1, counter-clockwise; α₁ against the first axis
of the plane. A range is (start, width) with width ≤ 2π.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.math.wrapping import TURN
from cspace.tolerances import SAME_PLACE, TANGENT_PLACE

Flags = npt.NDArray[np.bool_]


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
    """The points center + radius · (cos φ, sin φ), φ from start to start + width."""

    center: tuple[float, float]
    radius: float
    start: float
    width: float

    def at(self, angle: Array) -> Array:
        """Points (m, 2) at the angles (m,)."""
        return np.asarray(self.center) + self.radius * np.column_stack([np.cos(angle), np.sin(angle)])


def is_within(angle: Array, start: float, width: float) -> Flags:
    """Whether angles lie in a range modulo 2π; its ends count, up to rounding."""
    if width >= TURN:
        return np.ones(np.shape(angle), dtype=bool)
    past = np.mod(angle - start + SAME_PLACE, TURN)
    return np.asarray(past <= width + 2.0 * SAME_PLACE)


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
    angle = {i: arm.ranges[i, 0] + (arm.ranges[i, 1] if holds[i] == "high" else 0.0) for i in range(n)}
    heading, center = 0.0, np.zeros(2)
    for i in range(first):
        heading += angle[i]
        center = center + arm.lengths[i] * np.array([np.cos(heading), np.sin(heading)])
    # From the first free joint on, with that joint at 0: rigid pieces from one free joint to the next.
    along, tip = 0.0, np.zeros(2)
    straight = None
    for k, joint in enumerate(free):
        until = free[k + 1] if k + 1 < len(free) else n
        piece, inner = np.zeros(2), 0.0
        for i in range(joint, until):
            inner += 0.0 if i == joint else angle[i]
            piece = piece + arm.lengths[i] * np.array([np.cos(inner), np.sin(inner)])
        bearing = float(np.arctan2(piece[1], piece[0]))
        if straight is None:
            turn, straight = 0.0, bearing
        else:
            turn = straight + folds[k - 1] - bearing - along
            if not is_within(np.array(turn), *arm.ranges[joint]):
                return None
        along += turn
        c, s = np.cos(along), np.sin(along)
        tip = tip + np.array([c * piece[0] - s * piece[1], s * piece[0] + c * piece[1]])
        along += inner
    radius, bearing = float(np.hypot(*tip)), float(np.arctan2(tip[1], tip[0]))
    start, width = arm.ranges[first]
    return Arc((float(center[0]), float(center[1])), radius, heading + start + bearing, float(width))


def is_reachable(arm: PlanarArm, points: Array) -> Flags:
    """Whether the tip of an arm of two or more links gets to points (m, 2), exactly up to rounding."""
    if len(arm.lengths) == 2:
        return _reachable_by_two(arm, points)
    rest = arm.beyond_first()
    circles = critical_arcs(rest)
    return np.array([_reachable_by_more(arm, rest, circles, point) for point in points], dtype=bool)


def _reachable_by_two(arm: PlanarArm, points: Array) -> Flags:
    """The two elbow positions by the law of cosines."""
    a, b = arm.lengths
    cosine = (np.sum(points**2, axis=1) - a * a - b * b) / (2.0 * a * b)
    bend = np.arccos(np.clip(cosine, -1.0, 1.0))
    found = np.zeros(len(points), dtype=bool)
    for elbow in (bend, -bend):
        aside = np.arctan2(b * np.sin(elbow), a + b * np.cos(elbow))
        first = np.arctan2(points[:, 1], points[:, 0]) - aside
        found |= is_within(elbow, *arm.ranges[1]) & is_within(first, *arm.ranges[0])
    return np.asarray(found & (np.abs(cosine) <= 1.0))


def _reachable_by_more(arm: PlanarArm, rest: PlanarArm, circles: list[Arc], point: Array) -> bool:
    """Turn the first link through its range: what the rest reaches changes on its critical circles only."""
    start, width = arm.ranges[0]
    distance, bearing = float(np.hypot(*point)), float(np.arctan2(point[1], point[0]))
    changes = [0.0, float(width)]
    for arc in circles:
        center = np.array([arm.lengths[0] + arc.center[0], arc.center[1]])
        away = float(np.hypot(*center))
        if distance == 0.0 or away == 0.0:
            continue
        cosine = (distance**2 + away**2 - arc.radius**2) / (2.0 * distance * away)
        if abs(cosine) <= 1.0:
            for turn in (np.arccos(cosine), -np.arccos(cosine)):
                past = (bearing - np.arctan2(center[1], center[0]) - turn - start) % TURN
                if past < width:
                    changes.append(float(past))
    ordered = np.sort(np.array(changes))
    turns = start + (ordered[1:] + ordered[:-1]) / 2.0
    c, s = np.cos(turns), np.sin(turns)
    seen = np.column_stack([c * point[0] + s * point[1] - arm.lengths[0], c * point[1] - s * point[0]])
    return bool(is_reachable(rest, seen).any())


def trace_boundary(arm: PlanarArm, *, step: float = TURN / 256) -> list[Array]:
    """The boundary as closed curves (m, 2), first point repeated, what is reachable to the left.

    step: largest angle [rad] of an arc between two points of a curve.
    """
    if len(arm.lengths) == 1:  # a line with nothing inside: there and back it closes
        start, width = map(float, arm.ranges[0])
        line = _points(Arc((0.0, 0.0), arm.reach, start, width), start, start + width, step)
        return [np.concatenate([line, line[-2::-1]])]
    if len(arm.lengths) > 3 and (arm.ranges[:, 1] >= TURN).all():
        inner = 2.0 * float(arm.lengths.max()) - arm.reach
        full = Arc((0.0, 0.0), arm.reach, 0.0, TURN)
        rings = [_closed(_points(full, 0.0, TURN, step))]
        if inner > SAME_PLACE * arm.reach:
            hole = Arc((0.0, 0.0), inner, 0.0, TURN)
            rings.append(_closed(_points(hole, 0.0, TURN, step)[::-1]))
        return rings
    arcs = critical_arcs(arm)
    pieces: dict[tuple[int, ...], Array] = {}
    for arc in arcs:
        for low, high in _split(arc, arcs):
            middle = arc.at(np.array([(low + high) / 2.0]))[0]
            place = tuple(np.rint(middle / (TANGENT_PLACE * arm.reach)).astype(int).tolist())
            if place in pieces:  # arcs of one circle overlap; they were cut at each other's ends
                continue
            side = _side(arm, arc, low, high)
            if side:
                points = _points(arc, low, high, step)
                pieces[place] = points if side > 0 else points[::-1]
    return _joined(list(pieces.values()), 100.0 * TANGENT_PLACE * arm.reach)


def _split(arc: Arc, others: list[Arc]) -> list[tuple[float, float]]:
    """The arc cut wherever it meets the circle of another: ranges of its angle."""
    cuts = {arc.start, arc.start + arc.width}
    for other in others:
        offset = np.subtract(other.center, arc.center)
        away = float(np.hypot(*offset))
        if away <= SAME_PLACE * (arc.radius + other.radius):
            if abs(arc.radius - other.radius) <= SAME_PLACE * arc.radius:  # the same circle: its ends cut
                cuts |= {_onto(arc, end) for end in (other.start, other.start + other.width)}
            continue
        cosine = (arc.radius**2 + away**2 - other.radius**2) / (2.0 * arc.radius * away)
        if abs(cosine) <= 1.0 + SAME_PLACE:
            opening = float(np.arccos(np.clip(cosine, -1.0, 1.0)))
            bearing = float(np.arctan2(offset[1], offset[0]))
            cuts |= {_onto(arc, bearing + opening), _onto(arc, bearing - opening)}
    ordered = sorted(cut for cut in cuts if cut <= arc.start + arc.width)
    return [(a, b) for a, b in pairwise(ordered) if b - a > TANGENT_PLACE]


def _onto(arc: Arc, angle: float) -> float:
    """The angle shifted by a multiple of 2π to the first value at or after the start of the arc."""
    return float(arc.start + (angle - arc.start) % TURN)


def _side(arm: PlanarArm, arc: Arc, low: float, high: float) -> int:
    """+1 if next to the middle of a piece only the inside is reachable, −1 only the outside, or 0."""
    middle = np.array([(low + high) / 2.0])
    aside = min(10.0 * SAME_PLACE * arm.reach, 0.5 * arc.radius)
    near = [Arc(arc.center, arc.radius + shift, 0.0, TURN).at(middle)[0] for shift in (-aside, aside)]
    inside, outside = is_reachable(arm, np.array(near))
    return int(inside) - int(outside)


def _points(arc: Arc, low: float, high: float, step: float) -> Array:
    return arc.at(np.linspace(low, high, 2 + int((high - low) / step)))


def _closed(curve: Array) -> Array:
    """The curve with its first point in place of the last, which is the same but for rounding."""
    return np.concatenate([curve[:-1], curve[:1]])


def _joined(pieces: list[Array], gap: float) -> list[Array]:
    """Directed pieces linked end to start, where they are within a gap, into closed curves."""
    left, curves = list(pieces), []
    while left:
        curve = left.pop()
        while left and np.abs(curve[0] - curve[-1]).max() > gap:
            distances = [float(np.abs(piece[0] - curve[-1]).max()) for piece in left]
            nearest = int(np.argmin(distances))
            if distances[nearest] > gap:
                break
            curve = np.concatenate([curve, left.pop(nearest)[1:]])
        if np.ptp(curve, axis=0).max() > gap:  # smaller curves are remainders where circles touch
            curves.append(_closed(curve))
    return curves
