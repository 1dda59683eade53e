"""The image of a scene while it grows: floor, shadow, ghosts and solids laid over each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot.raytrace.layer import Layer
from cspace.plot.raytrace.shadow import Shadow
from cspace.plot.raytrace.view import Block, View, affine_at, pixel_centers
from cspace.tolerances import LEAST_DIVISOR, PARALLEL_RAYS

GAP: Final = 0.03
"""Share of the picture's size by which a ghost must be before a solid to be drawn over it: links that two
configurations share coincide, and neither should flicker through the other."""
FAINTER: Final = 0.55
"""Share of a ghost's opacity over a solid that it may coincide with."""
SHADOW: Final = (0.33, 0.37, 0.45)
"""The colour of shadows on the floor."""
PLATE: Final = (0.955, 0.962, 0.972)
LINES: Final = (0.62, 0.67, 0.74)
"""The floor and its lines."""
LINE_WIDTH: Final = 0.45
"""Half the width of the floor's lines [pixel]."""


@dataclass(frozen=True)
class Floor:
    """A round floor: its center (3,) [m], radius [m] and the distance between its lines [m]."""

    center: Array
    radius: float
    step: float

    def rim(self, count: int) -> Array:
        """Points (count, 3) around it, the last of them the first."""
        angle = np.linspace(0.0, 2 * np.pi, count)
        return self.center + self.radius * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)


class Canvas:
    """The image while it grows: colour weighted by coverage, and coverage, row by row."""

    def __init__(self, view: View) -> None:
        self.shape = view.height, view.width
        self.color = np.zeros((view.height * view.width, 3), np.float32)
        self.alpha = np.zeros(view.height * view.width, np.float32)
        self.scale = view.scale
        self.gap = GAP * view.size

    def over(self, color: Any, alpha: Any, pixels: Any) -> None:
        """Lay a colour, times its opacity, of some opacity over some pixels."""
        left = np.float32(1.0) - alpha
        self.color[pixels] = self.color[pixels] * left[:, None] + color
        self.alpha[pixels] = self.alpha[pixels] * left + alpha

    def lay_floor(self, view: View, floor: Floor, shadow: Shadow | None) -> None:
        """Lay the plate, its lines, which fade toward the rim, and the shadow."""
        block = view.block_of(floor.rim(65))
        if block is None or view.eye[2] <= 0.0:
            return
        world = on_floor(view, block, float(floor.center[2]))
        flat = world - floor.center[:2]
        share = np.sqrt(flat[..., 0] ** 2 + flat[..., 1] ** 2) / floor.radius
        per_pixel = np.maximum(np.hypot(*np.gradient(share)), LEAST_DIVISOR)
        inside = np.clip((1.0 - share) / per_pixel + 0.5, 0.0, 1.0)
        away = np.abs(world - floor.step * np.round(world / floor.step))
        across = np.maximum.reduce([np.abs(np.gradient(world, axis=axis)) for axis in (0, 1)])
        line = np.clip(
            LINE_WIDTH * self.scale - away / np.maximum(across, LEAST_DIVISOR) + 0.5, 0.0, 1.0
        ).max(axis=2)
        fade = np.clip(1.0 - share**2, 0.0, 1.0) ** 1.2
        dark = np.zeros(share.shape) if shadow is None else shadow.at(world)
        rows, columns = np.nonzero(inside)
        pixels = (rows + block[2]) * self.shape[1] + columns + block[0]
        plate = inside[rows, columns]
        for color, alpha in (
            (PLATE, plate),
            (LINES, 0.75 * (line * fade)[rows, columns] * plate),
            (SHADOW, 0.34 * dark[rows, columns] * plate),
        ):
            lit = alpha.astype(np.float32)
            self.over(lit[:, None] * np.array(color, np.float32), lit, pixels)

    def lay_ghost(self, layer: Layer, opacity: float, before: Layer | None, alike: Any = None) -> None:
        """Lay a ghost: even inside, stronger along its outline; only where it is before a layer.

        alike (n,): which of the pixels of that layer show what the ghost may coincide with; there it must be
        clearly before, and is fainter.
        """
        alpha = np.where(layer.rim, np.float32(min(1.0, 1.8 * opacity)), np.float32(opacity))
        tone = np.where(layer.rim, np.float32(0.86), np.float32(1.0))
        pixels = layer.pixels
        shown: Any = slice(None)
        if before is not None:
            depth = np.full(len(self.alpha), -np.inf)
            depth[before.pixels] = before.depth - self.gap * alike
            shown = np.flatnonzero(layer.depth < depth[pixels])
            share = np.zeros(len(self.alpha), np.float32)
            share[before.pixels] = before.coverage * np.where(alike, np.float32(FAINTER), np.float32(1.0))
            alpha = alpha * share[pixels]
        tint = layer.color[shown] * (alpha * tone)[shown, None]
        self.over(tint, (alpha * layer.coverage)[shown], pixels[shown])

    def finished(self) -> Any:
        """The image (h, w, 4) of bytes at the renderer's resolution, bottom row first."""
        image = np.zeros((len(self.alpha), 4), np.uint8)
        shown = np.flatnonzero(self.alpha)
        alpha = self.alpha[shown]
        image[shown, :3] = np.minimum(255.0 * self.color[shown] / alpha[:, None] + 0.5, 255.0)
        image[shown, 3] = 255.0 * alpha + 0.5
        return image.reshape(*self.shape, 4)


def on_floor(view: View, block: Block, height: float) -> Array:
    """Where the rays of a block of pixels reach the floor, (h, w, 2) [m]."""
    x0, x1, y0, y1 = block
    x, y = pixel_centers(x0, x1)[None, :], pixel_centers(y0, y1)[:, None]
    o, w = (
        [affine_at(rows[:, axis], x, y) for axis in range(3)] for rows in (view.rays.origin, view.rays.way)
    )
    t = (height - o[2]) / np.minimum(w[2], -PARALLEL_RAYS)
    return np.stack([o[0] + t * w[0], o[1] + t * w[1]], axis=2)
