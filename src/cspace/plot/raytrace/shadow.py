"""The shadow on the floor: the solids as a far light sees them, on a grid of the floor, softened."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.plot.raytrace.solids import Body, bounding_pieces
from cspace.plot.raytrace.view import Rays, block_about, pixel_centers

LIGHT: Final = np.array([0.10, -0.07, 1.0]) / np.linalg.norm([0.10, -0.07, 1.0])
"""Toward the light."""
CELL: Final = 0.004
"""Size of a cell of the shadow's grid, as a share of the picture's size."""
REACH: Final = 4
"""How far the shadow's edge is softened [cells]."""


@dataclass(frozen=True)
class Shadow:
    """How much light a floor lacks: dark (h, w) on cells of size `cell` [m], the first at `corner` (2,)."""

    corner: Array
    cell: float
    dark: Array

    def at(self, places: Array) -> Array:
        """The darkness (...) at places (..., 2) [m] of the floor, linear between the cells."""
        where = (places - self.corner) / self.cell
        first = np.floor(where).astype(np.int64)
        u, v = np.moveaxis(where - first, -1, 0)
        rows, columns = self.dark.shape
        kept = np.clip(first, 0, (columns - 2, rows - 2))
        flat, start = self.dark.ravel(), kept[..., 1] * columns + kept[..., 0]
        low = flat[start] + u * (flat[start + 1] - flat[start])
        high = flat[start + columns] + u * (flat[start + columns + 1] - flat[start + columns])
        return np.where((first != kept).any(axis=-1), 0.0, low + v * (high - low))


def shadow_of(solids: Sequence[Body], floor: float, size: float) -> Shadow | None:
    """The shadow of solids on the floor at a height [m] in a picture of a size [m]."""
    surfaces = [piece for solid in solids for piece in bounding_pieces(solid)]
    if not surfaces:
        return None
    cell = CELL * size
    spans = [cast_shadow(piece.balls, floor) for piece in surfaces]
    everything = np.concatenate(spans)
    low = everything.min(axis=0) - 3 * REACH * cell
    columns, rows = np.ceil((everything.max(axis=0) - low) / cell).astype(int) + 3 * REACH
    up = np.array([[cell, 0.0, 0.0], [0.0, cell, 0.0], [*low, floor]])
    rays = Rays(up, np.outer([0.0, 0.0, 1.0], -LIGHT))
    dark = np.zeros((rows, columns))
    for piece, span in zip(surfaces, spans, strict=True):
        block = block_about((span - low) / cell, columns, rows)
        if block is not None:
            x0, x1, y0, y1 = block
            t = piece.meet(rays, pixel_centers(x0, x1)[None, :], pixel_centers(y0, y1)[:, None])
            np.copyto(dark[y0:y1, x0:x1], 1.0, where=np.isfinite(t))
    return Shadow(low + 0.5 * cell, cell, soften_image(dark, REACH))


def cast_shadow(balls: list[tuple[Array, float]], floor: float) -> Array:
    """Corners (4 k, 2) on the floor of squares about the shadows of k balls."""
    feet = [(center - (center[2] - floor) / LIGHT[2] * LIGHT)[:2] for center, _ in balls]
    square = np.array([[i, j] for i in (-1, 1) for j in (-1, 1)])
    return np.concatenate(
        [foot + 1.1 * radius * square for foot, (_, radius) in zip(feet, balls, strict=True)]
    )


def soften_image(image: Array, reach: int) -> Array:
    """Three running means along each direction, close to a Gaussian; the image has a border of 3 reach."""
    soft = image
    for axis in (0, 1) * 3:
        total = np.cumsum(soft, axis=axis)
        ahead = np.roll(total, -(reach // 2), axis=axis)
        behind = np.roll(total, reach - reach // 2, axis=axis)
        soft = np.clip((ahead - behind) / reach, 0.0, 1.0)
    return np.asarray(soft)
