"""From the pixels of a 3-D axes back into space: matplotlib's projection, inverted."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array

__all__ = ["SUPERSAMPLING", "Block", "View", "on_floor", "project"]

SUPERSAMPLING: Final = 2
"""Rays per pixel and direction."""
Block = tuple[int, int, int, int]
"""A block of pixels: columns x0 to x1, rows y0 to y1."""


def project(points: Array, matrix: Array) -> Array:
    """Points (m, 3) through a projection matrix (4, 4): (m, 3), the last one depth."""
    lifted = points @ matrix[:, :3].T + matrix[:, 3]
    return np.asarray(lifted[:, :3] / lifted[:, 3:])


class View:
    """The rays of an axes' pixels: from the projection matrix of matplotlib back into space."""

    def __init__(self, axes: Any, magnification: float) -> None:
        self.matrix = axes.get_proj()
        box = axes.figure.bbox
        self.scale = magnification * SUPERSAMPLING
        self.width = int(np.ceil(box.width * magnification)) * SUPERSAMPLING
        self.height = int(np.ceil(box.height * magnification)) * SUPERSAMPLING
        self.to_display = axes.transData
        elevation, azimuth = np.radians(axes.elev), np.radians(axes.azim)
        self.eye = np.array(
            [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
        )
        self.right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        self.up = np.cross(self.eye, self.right)
        limits = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()])
        middle, self.size = limits.mean(axis=1), float(np.ptp(limits, axis=1).max())
        near_far = middle + np.array([[0.5], [-0.5]]) * self.size * self.eye
        depths = project(near_far, self.matrix)[:, 2]
        self.planes = [self.plane(axes, depth) for depth in depths]

    def plane(self, axes: Any, depth: float) -> Array:
        """The rows (3, 4) that turn (column, row, 1) into the homogeneous point of that projected depth."""
        corners = np.array([[0.5, 0.5], [1.5, 0.5], [0.5, 1.5]]) / self.scale
        flat = axes.transData.inverted().transform(corners)
        lifted = np.column_stack([flat, np.full(3, depth), np.ones(3)]) @ np.linalg.inv(self.matrix).T
        return np.array([lifted[1] - lifted[0], lifted[2] - lifted[0], lifted[0]])

    def seen(self, points: Array) -> Array:
        """Where points (m, 3) appear, in pixels (m, 2)."""
        return np.asarray(self.to_display.transform(project(points, self.matrix)[:, :2])) * self.scale

    def block_of(self, points: Array) -> Block | None:
        """The block of pixels that holds the projected points, or None off the image."""
        seen = self.seen(points)
        low = np.maximum(np.floor(seen.min(axis=0)).astype(int) - 1, 0)
        high = np.minimum(np.ceil(seen.max(axis=0)).astype(int) + 2, [self.width, self.height])
        if (high <= low).any():
            return None
        return int(low[0]), int(high[0]), int(low[1]), int(high[1])

    def rays(self, columns: Any, rows: Any) -> tuple[Array, Array]:
        """Origins before everything and unit ways, (m, 3) each, of some pixels."""
        ends = []
        for plane in self.planes:
            lifted = columns[:, None] * plane[0] + rows[:, None] * plane[1] + plane[2]
            ends.append(lifted[:, :3] / lifted[:, 3:])
        ways = ends[1] - ends[0]
        ways /= np.sqrt(np.einsum("ij,ij->i", ways, ways))[:, None]
        return ends[0] - 4.0 * self.size * ways, ways

    def near_segment(self, ends: Array, radii: Array, block: Block) -> tuple[Any, Any]:
        """The pixels (columns, rows) of a block that a bar between two points (2, 3) [m] may cover."""
        x0, x1, y0, y1 = block
        columns, rows = np.meshgrid(np.arange(x0, x1), np.arange(y0, y1))
        fringe = ends[:, None] + radii[:, None, None] * np.stack([self.right, self.up])
        flat = self.seen(np.concatenate([ends, fringe.reshape(-1, 3)]))
        a, b, reach = (
            flat[0],
            flat[1],
            1.25 * np.linalg.norm(flat[2:].reshape(2, 2, 2) - flat[:2, None], axis=2).max(),
        )
        way = b - a
        share = ((columns - a[0]) * way[0] + (rows - a[1]) * way[1]) / max(float(way @ way), 1e-12)
        share = np.clip(share, 0.0, 1.0)
        away = np.hypot(columns - a[0] - share * way[0], rows - a[1] - share * way[1])
        near = away <= reach + 2.0
        return columns[near], rows[near]


def on_floor(origins: Array, ways: Array, height: float) -> tuple[Array, Any]:
    """Where rays reach the floor (m, 3), and whether they fall at all (m,)."""
    falling = ways[:, 2] < -1e-9
    t = np.where(falling, (height - origins[:, 2]) / np.where(falling, ways[:, 2], -1.0), 0.0)
    return origins + t[:, None] * ways, falling
