"""The potential of a goal among rings of walls, by all distances; and whether a path passes through walls, in
fractions."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np


def distance_to_ring(ring, p):
    """From a point to the nearest of the segments of a ring (n, 2)."""
    a, along = ring, np.roll(ring, -1, axis=0) - ring
    share = np.clip(((p - a) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    return np.hypot(*(a + share[:, None] * along - p).T).min()


def potential(rings, goal, p, k, k_r, rho_0, cone):
    d = np.hypot(*(np.asarray(p) - goal))
    total = 0.5 * k * d * d if d < cone else k * cone * (d - cone / 2)
    for ring in rings:
        rho = distance_to_ring(ring, np.asarray(p))
        if rho < rho_0:
            total += 0.5 * k_r * (1 / rho - 1 / rho_0) ** 2
    return total


def side(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(v)) for v in p] for p in (a, b, c))
    det = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (det > 0) - (det < 0)


def passes_through(rings, path):
    """Whether a path (m, 2) passes from one side of a wall to the other; exact."""
    for p, q in itertools.pairwise(path):
        low, high = np.minimum(p, q), np.maximum(p, q)
        for ring in rings:
            ends = np.roll(ring, -1, axis=0)
            near = (np.minimum(ring, ends) <= high).all(axis=1) & (np.maximum(ring, ends) >= low).all(axis=1)
            for a, b in zip(ring[near], ends[near], strict=True):
                if side(a, b, p) * side(a, b, q) < 0 and side(p, q, a) * side(p, q, b) < 0:
                    return True
    return False
