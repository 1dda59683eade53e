"""The shortest path among polygons in whole fractions: slow, exact, and blind to triangulations.

All outlines are cut where they meet. Around each point where cuts end lie sectors between walls; a place of a
path is a point and one of its free sectors, so that no path slips through a point in which obstacles meet.
Places are joined along walls, and through free space where their points see each other.
"""

from __future__ import annotations

import heapq
import math
from fractions import Fraction
from functools import cmp_to_key
from itertools import combinations, pairwise

from oracles.segments import cross, crossings, is_inside

BLOCKED = -1.0
"""The answer where an end lies inside an obstacle."""


def shortest_length(obstacles, bounds, start, goal) -> float:
    """The length of a shortest path; inf where none exists, BLOCKED where an end is not free.

    obstacles: lists of rings (n, 2); bounds: xmin, ymin, xmax, ymax; start, goal: (2,).
    """
    xmin, ymin, xmax, ymax = bounds
    box = [[(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]]
    given = [start, goal, *(p for rings in (*obstacles, box) for ring in rings for p in ring)]
    scale = math.lcm(*(Fraction(float(x)).denominator for p in given for x in p))

    def whole(p):
        return tuple(int(Fraction(float(x)) * scale) for x in p)

    outlines = []
    for rings in (*obstacles, box):
        points = [[whole(p) for p in ring] for ring in rings]
        outlines.append(
            [(a, b) for ring in points for a, b in zip(ring, ring[1:] + ring[:1], strict=True) if a != b]
        )
    plane = _Plane(outlines, [whole(start), whole(goal)])
    length = plane.shortest(whole(start), whole(goal))
    return length if length == BLOCKED else length / scale


class _Plane:
    def __init__(self, outlines, ends) -> None:
        self.outlines = outlines
        every = {tuple(sorted(edge)) for edges in outlines for edge in edges}
        fractions = {edge: tuple(tuple(map(Fraction, p)) for p in edge) for edge in every}
        self.walls = {wall for edge in every for wall in _cut(edge, fractions, ends)}
        self.points = sorted({p for wall in self.walls for p in wall} | set(ends))
        self.around: dict = {p: [] for p in self.points}
        for a, b in self.walls:
            self.around[a].append(_from(a, b))
            self.around[b].append(_from(b, a))
        for directions in self.around.values():
            directions.sort(key=cmp_to_key(_by_angle))
        self.free = {p: [self._is_free(p, k) for k in range(max(1, len(d)))] for p, d in self.around.items()}

    def shortest(self, start, goal) -> float:
        first = [(start, k) for k, free in enumerate(self.free[start]) if free]
        last = {(goal, k) for k, free in enumerate(self.free[goal]) if free}
        if not first or not last:
            return BLOCKED
        ways = self._ways()
        best = dict.fromkeys(first, 0.0)
        heap = [(0.0, place) for place in first]
        while heap:
            length, place = heapq.heappop(heap)
            if place in last:
                return length
            if length > best[place]:
                continue
            for other, step in ways.get(place, ()):
                if length + step < best.get(other, math.inf):
                    best[other] = length + step
                    heapq.heappush(heap, (length + step, other))
        return math.inf

    def _ways(self):
        ways: dict = {}

        def join(a, i, b, j) -> None:
            if self.free[a][i] and self.free[b][j]:
                step = math.sqrt(float(sum(x * x for x in _from(a, b))))
                ways.setdefault((a, i), []).append(((b, j), step))
                ways.setdefault((b, j), []).append(((a, i), step))

        for a, b in self.walls:
            i, j = self._index(a, _from(a, b)), self._index(b, _from(b, a))
            join(a, i, b, (j - 1) % len(self.around[b]))  # on its left
            join(a, (i - 1) % len(self.around[a]), b, j)
        for a, b in combinations(self.points, 2):
            i, j = self._sector(a, _from(a, b)), self._sector(b, _from(b, a))
            if i is not None and j is not None and self.free[a][i] and self.free[b][j] and self._sees(a, b):
                join(a, i, b, j)
        return ways

    def _sees(self, a, b) -> bool:
        side = {p: cross(a, b, p) for p in self.points}
        ab = _from(a, b)
        for p in self.points:
            if side[p] == 0 and p not in (a, b) and 0 < _dot(ab, _from(a, p)) < _dot(ab, ab):
                return False
        for c, d in self.walls:
            if (side[c] > 0) != (side[d] > 0) and side[c] and side[d]:
                at_a, at_b = cross(c, d, a), cross(c, d, b)
                if (at_a > 0) != (at_b > 0) and at_a and at_b:
                    return False
        return True

    def _index(self, p, direction) -> int:
        return next(k for k, d in enumerate(self.around[p]) if _by_angle(d, direction) == 0)

    def _sector(self, p, direction) -> int | None:
        """Which sector of p a direction points into; None along a wall."""
        before = -1
        for k, d in enumerate(self.around[p]):
            if (order := _by_angle(d, direction)) == 0:
                return None
            if order < 0:
                before = k
        return before % max(1, len(self.around[p]))

    def _is_free(self, p, k) -> bool:
        """Whether what a sector holds near its point is free: asked halfway to the first wall in it."""
        around = self.around[p]
        ahead = _inside(around[k], around[(k + 1) % len(around)]) if around else (1, 0)
        q = p[0] + ahead[0], p[1] + ahead[1]
        first = Fraction(1)
        for a, b in self.walls:
            at_a, at_b = cross(p, q, a), cross(p, q, b)
            of_p, of_q = cross(a, b, p), cross(a, b, q)
            if of_p != of_q and at_a * at_b <= 0 and of_p * (of_p - of_q) > 0:
                first = min(first, Fraction(of_p) / (of_p - of_q))
        near = p[0] + ahead[0] * first / 2, p[1] + ahead[1] * first / 2
        *obstacles, box = self.outlines
        return is_inside(box, near) and not any(is_inside(edges, near) for edges in obstacles)


def _cut(edge, fractions, ends):
    """The pieces of an edge between the points where anything meets it."""
    a, b = fractions[edge]
    cuts = {Fraction(0), Fraction(1)}
    cuts.update(crossings(a, b, [other for key, other in fractions.items() if key != edge]))
    axis = 0 if a[0] != b[0] else 1
    for p in ends:
        if cross(a, b, p) == 0:
            cuts.add((p[axis] - a[axis]) / (b[axis] - a[axis]))
    points = [
        _plain((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))) for t in sorted(cuts) if 0 <= t <= 1
    ]
    return [tuple(sorted(pair)) for pair in pairwise(points)]


def _plain(p):
    return tuple(int(x) if Fraction(x).denominator == 1 else x for x in p)


def _from(a, b):
    return b[0] - a[0], b[1] - a[1]


def _dot(u, v):
    return u[0] * v[0] + u[1] * v[1]


def _by_angle(u, v) -> int:
    """Which direction comes first counterclockwise from (1, 0): −1, 0 if they are one, 1."""
    below_u, below_v = (u[1] < 0 or (u[1] == 0 and u[0] < 0)), (v[1] < 0 or (v[1] == 0 and v[0] < 0))
    if below_u != below_v:
        return 1 if below_u else -1
    turn = u[0] * v[1] - u[1] * v[0]
    return (turn < 0) - (turn > 0)


def _inside(u, v):
    """A direction strictly between u and v, counterclockwise from u."""
    turn = u[0] * v[1] - u[1] * v[0]
    if turn == 0:
        return (-u[0], -u[1]) if _dot(u, v) > 0 else (-u[1], u[0])
    sign = 1 if turn > 0 else -1
    return sign * (u[0] + v[0]), sign * (u[1] + v[1])
