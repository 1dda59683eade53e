"""Minkowski sum of polygonal obstacles and a disc: the configuration space of the disc's centre.

The exact sum has an arc around each corner. Here each arc is replaced by a circumscribed polygon whose
sides touch the disc in chosen directions. In those directions the polygon adds nothing to the exact sum.
The directions are evenly spread ones, the normals of the two walls at the corner, and the directions to
each corner and wall that the disc can just pass. A gap is therefore open exactly if the disc fits.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, whole_number
from cspace.errors import InputError
from cspace.maps.outlines import Outline
from cspace.tolerances import MOST_SIDES, TIGHT_GAP

TURN: Final = 2**40
"""Directions are quantised to integers, this many per revolution: those that differ by rounding become
equal, and opposite directions are exactly opposite."""
BLOCK: Final = 64
"""The number of corners compared at once with the walls near them."""

Directions = npt.NDArray[np.int64]


def grow_outlines(
    outlines: list[Outline], bounds: Array, reach: float, sides: int, keep: Array
) -> tuple[list[Outline], Array]:
    """The sum of the obstacles and polygons around a disc of radius `reach` [m], inside shrunk bounds.

    keep: (k, 2), positions of the centre in whose direction the corner polygons add nothing to the exact
    sum. The sum of a polygon and a disc is the union of the polygon, the disc at each corner and a strip
    along each edge.
    """
    whole_number(sides, "sides", 4, MOST_SIDES)
    xmin, ymin, xmax, ymax = map(float, bounds)
    if not (xmin + reach < xmax - reach and ymin + reach < ymax - reach):
        raise InputError(
            f"radius {reach:g} leaves no free space inside the bounds, of {xmax - xmin:g} × {ymax - ymin:g} m"
        )
    rings = [ring for obstacle in outlines for ring in obstacle]
    corners = np.vstack([np.empty((0, 2)), *rings])
    nexts = np.vstack([np.empty((0, 2)), *(np.roll(ring, -1, axis=0) for ring in rings)])
    ahead = _quantise_directions(nexts - corners)
    across = _find_tight_directions(corners, nexts, ahead, reach, sides, keep)
    axes = np.arange(4) * (TURN // 4)  # normals of the bounds
    even = np.concatenate([axes, np.rint(np.arange(sides) * (TURN / sides)).astype(np.int64)])
    first = 0
    made: list[Outline] = []
    for ring in rings:
        at = np.arange(first, first + len(ring))
        discs = []
        for here, before in zip(at, np.roll(at, 1), strict=True):
            walls = np.array([ahead[here], ahead[before]])
            quarter = np.concatenate([walls + TURN // 4, walls - TURN // 4])
            touches = np.unique(np.concatenate([even, quarter, across[here]]) % TURN)
            discs.append((touches, corners[here] + _circumscribe_disc(reach, touches)))
        made += [[corner] for _, corner in discs]
        for k, here in enumerate(at):
            made.append([_make_strip(int(ahead[here]), discs[k], discs[(k + 1) % len(ring)])])
        first += len(ring)
    return [*outlines, *made], np.array([xmin + reach, ymin + reach, xmax - reach, ymax - reach])


def _quantise_directions(vectors: Array) -> Directions:
    """Angles of vectors (n, 2), counterclockwise from x."""
    angle = np.arctan2(vectors[:, 1], vectors[:, 0])
    return np.rint(angle * (TURN / (2 * np.pi))).astype(np.int64) % TURN


def _circumscribe_disc(radius: float, touches: Directions) -> Array:
    """The polygon (m, 2) whose sides touch a disc in directions (m,): side i precedes corner i."""
    wide = np.diff(touches, append=touches[:1]) % TURN
    middle = (touches + wide / 2) * (2 * np.pi / TURN)
    away = radius / np.cos(wide * (np.pi / TURN))
    return np.asarray(away[:, None] * np.stack([np.cos(middle), np.sin(middle)], axis=1))


def _make_strip(ahead: int, one: tuple[Directions, Array], other: tuple[Directions, Array]) -> Array:
    """The strip along an edge (4, 2) that leads `ahead` from one corner to the next, between the corner
    polygons. Its sides end at the polygon sides that touch in the two directions normal to the edge."""
    right, left = (ahead - TURN // 4) % TURN, (ahead + TURN // 4) % TURN
    (i, j), (k, n) = (np.searchsorted(touches, [right, left]) for touches, _ in (one, other))
    return np.array([one[1][i], other[1][k - 1], other[1][n], one[1][j - 1]])


def _find_tight_directions(
    corners: Array, nexts: Array, ahead: Directions, radius: float, sides: int, keep: Array
) -> list[Directions]:
    """For each corner the directions of corners, walls and points of `keep` that the disc can just pass."""
    found: list[list[Directions]] = [[np.empty(0, np.int64)] for _ in corners]
    near, far = 2 * radius * (1 - TIGHT_GAP), 2 * radius / np.cos(np.pi / sides)
    low, high = np.minimum(corners, nexts) - far, np.maximum(corners, nexts) + far
    for first in range(0, len(corners), BLOCK):
        some = corners[first : first + BLOCK]
        beside = np.flatnonzero(np.all((low <= some.max(axis=0)) & (high >= some.min(axis=0)), axis=1))
        begin, along = corners[beside], nexts[beside] - corners[beside]
        back = some[:, None] - begin
        apart = np.hypot(back[..., 0], back[..., 1])
        for i, j in zip(*np.nonzero((apart >= near) & (apart <= far)), strict=True):
            found[first + i].append(_quantise_directions(-back[i, j : j + 1]))
        share = np.einsum("ijk,jk->ij", back, along) / np.einsum("jk,jk->j", along, along)
        off = np.abs(along[:, 0] * back[..., 1] - along[:, 1] * back[..., 0]) / np.hypot(*along.T)
        tight = (share > 0) & (share < 1) & (off >= near) & (off <= far)
        for i, j in zip(*np.nonzero(tight), strict=True):
            left = ahead[beside[j]] + TURN // 4
            found[first + i].append(np.array([left, left - TURN // 2]) % TURN)
    for p in keep:
        apart = np.hypot(*(p - corners).T)
        for i in np.flatnonzero((apart > 0) & (apart <= far / 2)):
            found[i].append(_quantise_directions((p - corners[i])[None]))
    return [np.concatenate(each) for each in found]
