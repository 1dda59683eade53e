"""Polygons as convex pieces: what the compiled core takes for obstacles."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.maps import PolygonWorld
from cspace.tolerances import SAME_CORNER


@dataclass(frozen=True, eq=False)
class Piece:
    """All points within `radius` [m] of the convex hull of corners (n, 2), counter-clockwise [m]."""

    corners: Array
    radius: float


def cut_polygons(obstacles: PolygonWorld | Sequence[ArrayLike]) -> dict[str, list[Piece]]:
    """The convex pieces of polygons, by "obstacle 0", "obstacle 1", …

    obstacles: a PolygonWorld, whose bounds do not count, or what it takes as obstacles. GeometryError for a
    polygon that crosses itself or has no area, InputError for coordinates that are not finite numbers.
    """
    world = obstacles if isinstance(obstacles, PolygonWorld) else PolygonWorld(obstacles)
    return {f"obstacle {k}": cut_polygon(rings) for k, rings in enumerate(world.obstacles)}


def cut_polygon(rings: list[Array]) -> list[Piece]:
    """The convex pieces of a polygon: its outline (n, 2), then holes."""
    if len(rings) == 1 and (convex := as_convex(rings[0])) is not None:
        return [Piece(convex, 0.0)]
    points = np.vstack(rings)
    low, high = points.min(axis=0), points.max(axis=0)
    wide = float((high - low).max())
    # Inside out: the polygon is the free space of an obstacle around it.
    (x0, y0), (x1, y1) = low - 2.0 * wide, high + 2.0 * wide
    around = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    inverse = PolygonWorld([[around, *rings]], [*(low - wide), *(high + wide)], repair=True)
    return [Piece(drop_straight(corners), 0.0) for corners in inverse._core.convex_polygons()]


def as_convex(ring: Array) -> Array | None:
    """The corners of a convex ring, counter-clockwise; None for another ring."""
    corners = drop_straight(ring)
    sides = np.roll(corners, -1, axis=0) - corners
    after = np.roll(sides, -1, axis=0)
    turns = sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]
    if (turns < 0.0).all():
        return as_convex(corners[::-1])
    angles = np.arctan2(turns, np.sum(sides * after, axis=1))
    once = abs(float(angles.sum()) - 2.0 * np.pi) < 1.0
    return corners if (turns > 0.0).all() and once else None


def drop_straight(ring: Array) -> Array:
    """A ring (n, 2) without corners that lie on the line between their neighbours."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    kept = before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]
    return ring[kept] if kept.sum() >= 3 else ring


def convex_hull(points: Array) -> Array:
    """The corners (k, 2) of the convex hull of points (n, 2), counter-clockwise (Andrew 1979).

    Points closer than rounding are one, and corners that straight are none: one corner where all points are
    one, two where they lie on a line.
    """
    size = SAME_CORNER * float(np.ptp(points, axis=0).max())
    ordered = np.unique(points, axis=0).tolist()
    lower, upper = half_hull(ordered, size), half_hull(reversed(ordered), size)
    return np.array(lower[:-1] + upper[:-1] if len(lower) > 1 else lower)


def half_hull(points: Iterable[list[float]], size: float) -> list[list[float]]:
    """The chain of points in order that turns left everywhere, by more than `size` [m]."""
    chain: list[list[float]] = []
    for p in points:
        while len(chain) > 1:
            (ax, ay), (bx, by) = chain[-2:]
            area = (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax)
            if area > size * math.hypot(p[0] - ax, p[1] - ay):
                break
            chain.pop()
        if len(chain) == 1 and math.hypot(p[0] - chain[0][0], p[1] - chain[0][1]) <= size:
            continue
        chain.append(p)
    return chain
