"""Obstacles grown by the radius of a disc: the world that its centre moves in."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.maps.outlines import Outline

__all__ = ["grown"]


def grown(outlines: list[Outline], bounds: Array, radius: float, sides: int) -> tuple[list[Outline], Array]:
    """The Minkowski sum of the obstacles with a regular polygon around the disc, inside bounds that are
    shrunk.

    The sum of a polygon and a convex polygon is the union of the first with the sums of its edges, each of
    which is convex: the hull of the second at both ends of the edge.
    """
    if (reach := float(as_floats(radius, "radius"))) < 0:
        raise InputError(f"radius is {reach:g}; it must be zero or more [m]")
    if sides < 4:
        raise InputError(f"sides is {sides}; a polygon around a disc needs four or more here")
    xmin, ymin, xmax, ymax = map(float, bounds)
    if not (xmin + reach < xmax - reach and ymin + reach < ymax - reach):
        raise InputError(
            f"radius {reach:g} leaves no room inside the bounds, of {xmax - xmin:g} × {ymax - ymin:g} m"
        )
    angles = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    disc = reach / np.cos(np.pi / sides) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    obstacles: list[Outline] = []
    for rings in outlines:
        obstacles.append(rings)
        for ring in rings:
            ends = zip(ring, np.roll(ring, -1, axis=0), strict=True)
            obstacles.extend([_swept(disc, a, b)] for a, b in ends)
    return obstacles, np.array([xmin + reach, ymin + reach, xmax - reach, ymax - reach])


def _swept(disc: Array, a: Array, b: Array) -> Array:
    """The hull (m, 2) of a convex polygon (n, 2) at two places: half of it at each, by which side is
    foremost."""
    along = b - a
    normals = np.roll(disc, -1, axis=0) + disc  # of the sides: side i leads from corner i to the next
    ahead = normals @ along > 0
    first = int(np.argmax(ahead & ~np.roll(ahead, 1)))  # the first side that looks ahead
    order = np.roll(np.arange(len(disc)), -first)
    count = int(ahead.sum())
    return np.vstack([b + disc[order[: count + 1]], a + disc[order[count:]], a + disc[order[:1]]])
