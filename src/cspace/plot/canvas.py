"""The image of a scene while it grows: floor, shadow, ghosts and solids laid over each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot.solids import Solid, meet
from cspace.plot.view import SUPERSAMPLING, Block, View, on_floor

__all__ = ["Canvas", "Floor", "Layer", "look", "mean_depth", "shadow_of"]

GAP: Final = 0.03
"""Share of the picture's size by which a ghost must be before a solid to be drawn over it: links that two
configurations share coincide, and neither should flicker through the other."""
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


@dataclass
class Layer:
    """A group as seen on a block of pixels: colour (h, w, 3), depth (h, w), inf where there is nothing."""

    block: Block
    color: Array
    depth: Array

    @property
    def place(self) -> tuple[slice, slice]:
        """Where the block lies in the image."""
        x0, x1, y0, y1 = self.block
        return slice(y0, y1), slice(x0, x1)


def mean_depth(layer: Layer) -> float:
    """The mean depth of what a layer shows."""
    shown = np.isfinite(layer.depth)
    return float(layer.depth[shown].mean()) if shown.any() else np.inf


def look(view: View, solids: list[Solid]) -> Layer:
    """Solids as seen and lit."""
    whole = view.block_of(np.concatenate([solid.corners() for solid in solids])) if solids else None
    x0, x1, y0, y1 = whole or (0, 0, 0, 0)
    layer = Layer((x0, x1, y0, y1), np.zeros((y1 - y0, x1 - x0, 3)), np.full((y1 - y0, x1 - x0), np.inf))
    normals = np.zeros_like(layer.color)
    for solid in solids:
        block = view.block_of(solid.corners())
        if block is None:
            continue
        ends, radii = np.array([solid.a, solid.b]), np.array([solid.radius_a, solid.radius_b])
        columns, rows = view.near_segment(ends, radii if solid.round else 1.42 * radii, block)
        distance, normal = meet(solid, *view.rays(columns, rows))
        nearer = distance < layer.depth[rows - y0, columns - x0]
        at = rows[nearer] - y0, columns[nearer] - x0
        layer.depth[at] = distance[nearer]
        normals[at] = normal[nearer]
        layer.color[at] = solid.color
    shown = np.isfinite(layer.depth)
    layer.color[shown] = lit(layer.color[shown], normals[shown], view)
    return layer


def lit(colors: Array, normals: Array, view: View) -> Array:
    """The colours under a key light over the viewer's left shoulder, a fill light and a faint gloss."""
    key = 0.55 * view.eye + 0.75 * view.up - 0.45 * view.right
    key /= np.linalg.norm(key)
    half = (key + view.eye) / np.linalg.norm(key + view.eye)
    diffuse = np.clip(normals @ key, 0.0, None)
    fill = np.clip(normals @ (0.5 * view.eye + 0.8 * view.right), 0.0, None)
    rim = (1.0 - np.clip(normals @ view.eye, 0.0, 1.0)) ** 3
    gloss = np.clip(normals @ half, 0.0, None) ** 40
    shade = 0.56 + 0.42 * diffuse + 0.10 * fill - 0.16 * rim
    return np.asarray(np.clip(colors * shade[:, None] + 0.16 * gloss[:, None], 0.0, 1.0))


def shadow_of(view: View, solids: list[Solid], floor: float) -> Array:
    """How much light each pixel of the floor lacks, (h, w) in [0, 1], softened."""
    dark = np.zeros((view.height, view.width))
    light = np.array([0.10, -0.07, 1.0]) / np.linalg.norm([0.10, -0.07, 1.0])
    for solid in solids:
        corners = solid.corners()
        block = view.block_of(corners - (corners[:, 2:] - floor) / light[2] * light)
        if block is None:
            continue
        ends, radii = np.array([solid.a, solid.b]), np.array([solid.radius_a, solid.radius_b])
        cast = ends - (ends[:, 2:] - floor) / light[2] * light
        columns, rows = view.near_segment(cast, 1.5 * radii, block)
        ground, falling = on_floor(*view.rays(columns, rows), floor)
        ground -= 10.0 * view.size * light
        distance, _ = meet(solid, ground, np.broadcast_to(light, ground.shape))
        hit = np.isfinite(distance) & falling
        dark[rows[hit], columns[hit]] = 1.0
    return soften(dark, max(2, round(0.012 * view.height)))


def soften(image: Array, reach: int) -> Array:
    """Three running means along each direction, close to a Gaussian."""
    soft = np.pad(image, 2 * reach)
    for axis in (0, 1) * 3:
        total = np.cumsum(soft, axis=axis)
        ahead, behind = (
            np.roll(total, -(reach // 2), axis=axis),
            np.roll(total, reach - reach // 2, axis=axis),
        )
        soft = np.clip((ahead - behind) / reach, 0.0, 1.0)
    return np.asarray(soft[2 * reach : -2 * reach, 2 * reach : -2 * reach])


def shrunk(mask: Any) -> Any:
    """A mask without its border pixels."""
    inner = mask.copy()
    inner[1:] &= mask[:-1]
    inner[:-1] &= mask[1:]
    inner[:, 1:] &= mask[:, :-1]
    inner[:, :-1] &= mask[:, 1:]
    return inner


class Canvas:
    """The image while it grows: colour weighted by coverage, and coverage."""

    def __init__(self, view: View) -> None:
        self.color = np.zeros((view.height, view.width, 3))
        self.alpha = np.zeros((view.height, view.width))
        self.scale = view.scale
        self.gap = GAP * view.size

    def over(self, color: Array, alpha: Array, place: Any = ...) -> None:
        """Lay a colour of some opacity over what is there."""
        self.color[place] = color * alpha[..., None] + self.color[place] * (1.0 - alpha[..., None])
        self.alpha[place] = alpha + self.alpha[place] * (1.0 - alpha)

    def lay_floor(self, view: View, floor: Floor) -> None:
        """Lay the plate and its lines, which fade toward the rim."""
        angle = np.linspace(0.0, 2 * np.pi, 65)
        rim = floor.center + floor.radius * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
        block = view.block_of(rim)
        if block is None:
            return
        x0, x1, y0, y1 = block
        columns, rows = np.meshgrid(np.arange(x0, x1), np.arange(y0, y1))
        ground, falling = on_floor(*view.rays(columns.ravel(), rows.ravel()), float(floor.center[2]))
        flat = (ground - floor.center)[:, :2].reshape(*columns.shape, 2)
        share = np.linalg.norm(flat, axis=2) / floor.radius
        place = slice(y0, y1), slice(x0, x1)
        inside = (share <= 1.0) & falling.reshape(share.shape)
        self.over(np.broadcast_to(np.array(PLATE), (*share.shape, 3)), inside.astype(np.float64), place)
        world = flat + floor.center[:2]
        away = np.abs(world - floor.step * np.round(world / floor.step))
        across = np.maximum.reduce([np.abs(np.gradient(world, axis=axis)) for axis in (0, 1)])
        line = np.clip(LINE_WIDTH * self.scale - away / np.maximum(across, 1e-12) + 0.5, 0.0, 1.0).max(axis=2)
        fade = np.clip(1.0 - share**2, 0.0, 1.0) ** 1.2
        self.over(np.broadcast_to(np.array(LINES), (*share.shape, 3)), 0.75 * line * fade * inside, place)

    def shade(self, dark: Array) -> None:
        """Lay the shadow on the floor."""
        self.over(np.broadcast_to(np.array(SHADOW), self.color.shape), 0.34 * dark)

    def lay(self, layer: Layer) -> None:
        """Lay an opaque layer."""
        self.over(layer.color, np.isfinite(layer.depth).astype(np.float64), layer.place)

    def lay_ghost(self, layer: Layer, opacity: float, before: Layer | None) -> None:
        """Lay a ghost: even inside, stronger along its outline; only where it is clearly before a layer."""
        shown = np.isfinite(layer.depth)
        inner = shown
        for _ in range(max(1, round(0.7 * self.scale))):
            inner = shrunk(inner)
        alpha = np.where(inner, opacity, np.where(shown, min(1.0, 2.1 * opacity), 0.0))
        if before is not None:
            depth = np.full(self.alpha.shape, -np.inf)
            depth[before.place] = np.where(np.isfinite(before.depth), before.depth, -np.inf)
            alpha = np.where(layer.depth < depth[layer.place] - self.gap, alpha, 0.0)
        self.over(layer.color * np.where(inner, 1.0, 0.86)[..., None], alpha, layer.place)

    def finished(self) -> Any:
        """The image (h, w, 4) of bytes at the renderer's resolution, bottom row first."""
        s = SUPERSAMPLING
        h, w = self.alpha.shape[0] // s, self.alpha.shape[1] // s
        color = self.color.reshape(h, s, w, s, 3).mean(axis=(1, 3))
        alpha = self.alpha.reshape(h, s, w, s).mean(axis=(1, 3))
        straight = color / np.maximum(alpha, 1e-9)[..., None]
        image = np.concatenate([straight, alpha[..., None]], axis=2)
        return np.ascontiguousarray(np.round(255.0 * np.clip(image, 0.0, 1.0)).astype(np.uint8))
