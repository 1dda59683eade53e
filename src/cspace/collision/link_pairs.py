"""Pairs of links: which are checked against each other, and why the others are not."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from cspace.arrays import Array

SAMPLES: Final = 256
"""Random configurations at which a pair must touch to be allowed: one free in fifty is missed once in 170."""

FIRST_SAMPLES: Final = 4
"""Configurations that are tried first: few pairs touch in all of them."""

Allowed = tuple[str, str, str]
"""Two links, and why they are not checked against each other."""


def adjacent_pairs(bodies: Sequence[int], parents: Sequence[int]) -> list[tuple[int, int]]:
    """The pairs of links whose bodies are joined by one joint, or by bodies without links, by number.

    bodies: of each link, 0 the base and k + 1 what joint k carries, ascending. parents: per joint the joint
    that carries it, −1 for the base.
    """
    used = set(bodies)

    def carrier(body: int) -> int:
        while body > 0:
            body = parents[body - 1] + 1
            if body in used:
                return body
        return -1

    above = {body: carrier(body) for body in used}
    n = range(len(bodies))
    return [(a, b) for a in n for b in n if above[bodies[b]] == bodies[a]]


def always_touching(
    pairs: Iterable[tuple[int, int]], spheres: Sequence[Array], radii: Sequence[Array]
) -> list[tuple[int, int]]:
    """The pairs of links that touch in every sample.

    spheres: per link the centres (samples, n, 3) [m], radii: per link (n,).
    """
    return [
        (a, b) for a, b in pairs if touches_always(spheres[a], radii[a], spheres[b], radii[b], FIRST_SAMPLES)
    ]


def touches_always(p: Array, r: Array, q: Array, s: Array, count: int) -> bool:
    """Whether two sets of spheres touch in each of the first `count` samples, and then in all."""
    for k in (slice(None, count), slice(count, None)):
        for one, other in zip(p[k], q[k], strict=True):
            apart = np.linalg.norm(one[:, None] - other, axis=-1) - r[:, None] - s
            if apart.min() > 0.0:
                return False
    return True
