"""Pairs of links: which are checked against each other, and why the others are not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import numpy as np

from cspace.arrays import Array

SAMPLES: Final = 256
"""Random configurations at which a pair must touch to be allowed: one free in fifty is missed once in 170."""

FIRST_SAMPLES: Final = 4
"""Configurations that are tried first: few pairs touch in all of them."""

Allowed = tuple[str, str, str]
"""Two links, and why they are not checked against each other."""


def adjacent_pairs(links: Sequence[str], parents: Mapping[str, str]) -> list[tuple[int, int]]:
    """The pairs of links between which the tree has no other of these links, by number.

    parents: of each link of the tree but the root, the link that carries it. A link that is welded to another
    one is no neighbour of those that the other one's joints carry.
    """
    number = {name: k for k, name in enumerate(links)}
    pairs = []
    for name, k in number.items():
        above = parents.get(name)
        while above is not None and above not in number:
            above = parents.get(above)
        if above is not None:
            pairs.append((min(k, number[above]), max(k, number[above])))
    return pairs


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
