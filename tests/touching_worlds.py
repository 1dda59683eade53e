"""Worlds of small whole numbers in which walls touch: what is passed at a point and what is not, is decided
exactly."""

from __future__ import annotations

import numpy as np


def slanted_touch(rng, side, more=2):
    """A corner on a slanted edge that is crossed elsewhere: obstacles (n, 2) each, in a square of that side.

    The crossed edge is a–b, the corner on it w. Both obstacles reach the border, each from its side of the
    edge, so that they often part free space; the third one crosses the edge, and up to `more` are anywhere.
    """
    while True:
        w, along = rng.integers(1, side, 2), rng.integers(-3, 4, 2)
        a, b = w - rng.integers(1, 3) * along, w + rng.integers(1, 3) * along
        left, right = on_border(rng, side), np.array([on_border(rng, side), on_border(rng, side)])
        slanted = along.all() and min(*a, *b) >= 0 and max(*a, *b) <= side
        if not slanted or area(a, b, left) == 0 or (area(a, b, right) * area(a, b, left) > 0).any():
            continue
        touching, crossed, crossing = np.vstack([[w], right]), np.array([a, b, left]), triangle(rng, side)
        beyond = np.sign(area(a, b, crossing))
        if area(*touching) != 0 and {-1, 1} <= set(beyond.tolist()):
            break
    others = [triangle(rng, side) for _ in range(rng.integers(more + 1))]
    return [touching, crossed, crossing, *others]


def diamond_on_border(rng, side):
    """An obstacle whose corner touches the border of a square, sometimes beside another one that touches the
    same point: obstacles, and the point."""
    x, half, depth = rng.integers(2, side - 1), rng.integers(1, 3), rng.integers(1, 4)
    below, sideways = side - depth, rng.integers(-1, 2)
    diamond = [(x, side), (x - half, below), (x + sideways, below - rng.integers(1, 3)), (x + half, below)]
    obstacles = [np.array(diamond)]
    if rng.random() < 0.5:
        near = x + rng.choice([-1, 1]) * rng.integers(1, 3)
        obstacles.append(np.array([(x, side), (near, side), (near, below)]))
    return obstacles, np.array([x, side])


def on_border(rng, side):
    """A whole point on the border of a square."""
    point = rng.integers(0, side + 1, 2)
    point[rng.integers(2)] = side * rng.integers(2)
    return point


def triangle(rng, side):
    while True:
        corners = rng.integers(0, side + 1, (3, 2))
        if area(*corners):
            return corners


def area(a, b, c):
    """Twice the area of the triangle a, b, c (..., 2)."""
    u, v = np.subtract(b, a), np.subtract(c, a)
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
