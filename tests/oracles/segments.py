"""Whether a path keeps out of obstacles, decided in whole fractions: slow, exact, and blind to how it was
found."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

Point = tuple[Fraction, Fraction]


def exact(point) -> Point:
    return Fraction(float(point[0])), Fraction(float(point[1]))


def cross(a: Point, b: Point, c: Point) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def edges_of(rings) -> list[tuple[Point, Point]]:
    found = []
    for ring in rings:
        points = [exact(p) for p in ring]
        found += list(zip(points, points[1:] + points[:1], strict=True))
    return found


def is_inside(edges, p: Point) -> bool:
    """Whether a point that lies on no edge is surrounded an odd number of times."""
    odd = False
    for a, b in edges:
        if (a[1] > p[1]) != (b[1] > p[1]):
            x = a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1])
            odd ^= x > p[0]
    return odd


def crossings(p: Point, q: Point, edges) -> list[Fraction]:
    """The parameters along p → q at which it meets edges, or the ends of edges on its line."""
    found = []
    left, right = sorted((p[0], q[0]))
    low, high = sorted((p[1], q[1]))
    for a, b in edges:
        if max(a[0], b[0]) < left or min(a[0], b[0]) > right:
            continue
        if max(a[1], b[1]) < low or min(a[1], b[1]) > high:
            continue
        of_a, of_b = cross(p, q, a), cross(p, q, b)
        if of_a == of_b == 0:
            axis = 0 if p[0] != q[0] else 1
            found += [(c[axis] - p[axis]) / (q[axis] - p[axis]) for c in (a, b)]
        elif of_a * of_b <= 0 and cross(a, b, p) != cross(a, b, q):
            found.append(cross(a, b, p) / (cross(a, b, p) - cross(a, b, q)))
    return [t for t in found if 0 <= t <= 1]


def enters(path, obstacles, bounds, *, beside=1e-12, slack=0.0) -> str | None:
    """Where a path (m, 2) is inside an obstacle (a list of rings each) or outside the bounds; None: nowhere.

    A path may run along a wall, but not between two obstacles that share a side: both sides of it are
    looked at, `beside` (a share of a leg's length) away. What is shorter than `slack` [m] is passed over.
    """
    every = [edges_of(rings) for rings in obstacles]
    xmin, ymin, xmax, ymax = map(Fraction, bounds)
    points = [exact(p) for p in path]
    for p, q in pairwise(points):
        if p == q:
            continue
        short = slack / math.hypot(float(q[0] - p[0]), float(q[1] - p[1]))
        cuts = sorted({Fraction(0), Fraction(1), *(t for edges in every for t in crossings(p, q, edges))})
        for low, high in pairwise(cuts):
            if high - low < short:
                continue
            t = (low + high) / 2
            m = p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])
            aside = -(q[1] - p[1]) * Fraction(beside), (q[0] - p[0]) * Fraction(beside)
            sides = [(m[0] + s * aside[0], m[1] + s * aside[1]) for s in (1, -1)]
            blocked = [
                any(is_inside(edges, side) for edges in every)
                or not (xmin <= side[0] <= xmax and ymin <= side[1] <= ymax)
                for side in sides
            ]
            if all(blocked):
                return f"between {tuple(map(float, p))} and {tuple(map(float, q))}"
    return None
