"""From the pixels of a 3-D axes back into space: matplotlib's projection, inverted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.tolerances import PARALLEL_RAYS

Block = tuple[int, int, int, int]
"""A block of pixels: columns x0 to x1, rows y0 to y1."""


def project_points(points: Array, matrix: Array) -> Array:
    """Points (m, 3) through a projection matrix (4, 4): (m, 3), the last one depth."""
    lifted = points @ matrix[:, :3].T + matrix[:, 3]
    return np.asarray(lifted[:, :3] / lifted[:, 3:])


def affine_at(row: Array, x: Array, y: Array) -> Array:
    """row · (x, y, 1), where x and y broadcast."""
    return np.asarray((row[0] * x + row[2]) + row[1] * y)


def pixel_centers(first: int, last: int) -> Array:
    """The middles of the pixels from `first` to before `last`."""
    return np.arange(first, last, dtype=np.float64) + 0.5


def look_along(elevation: float, azimuth: float) -> tuple[Array, Array, Array]:
    """The unit vectors (3,) right, up and toward the eye of a view from two angles [deg]."""
    e, a = np.radians(elevation), np.radians(azimuth)
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    return right, np.cross(eye, right), eye


@dataclass(frozen=True)
class Rays:
    """One ray per place (x, y) of a plane: the points o + t w with o, w affine in x and y.

    origin, way: (3, 3), the rows multiply x, y and 1. One of the two is the same for all rays: the origin for
    the rays of an eye, the way for those of a far light; the meeting with a quadric is simpler then.
    """

    origin: Array
    way: Array

    @property
    def parallel(self) -> bool:
        """Whether all rays have the same direction."""
        return not self.way[:2].any()

    def points(self, x: Array, y: Array, t: Array) -> Array:
        """The points (m, 3) of some rays, x, y, t: (m,)."""
        points = np.empty((len(t), 3))
        for axis in range(3):  # by hand: threads of a matrix product cost more than they save here
            w = affine_at(self.way[:, axis], x, y)
            points[:, axis] = affine_at(self.origin[:, axis], x, y) + t * w
        return points


class View:
    """What an axes sees: its rays, one unit of t for one metre of depth, and where points appear."""

    def __init__(self, axes: Any, magnification: float) -> None:
        self.matrix = axes.get_proj()
        box = axes.figure.bbox
        self.scale = magnification
        self.width = int(np.ceil(box.width * magnification))
        self.height = int(np.ceil(box.height * magnification))
        self.to_display = axes.transData
        self.right, self.up, self.eye = look_along(axes.elev, axes.azim)
        limits = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()])
        middle, self.size = limits.mean(axis=1), float(np.ptp(limits, axis=1).max())
        near_far = middle + np.array([[0.5], [-0.5]]) * self.size * self.eye
        depths = project_points(near_far, self.matrix)[:, 2]
        near, far = (self.plane(axes, depth) for depth in depths)
        self.rays = rays_through(near, (far - near) / self.size)

    def plane(self, axes: Any, depth: float) -> Array:
        """The rows (3, 3) that turn (column, row, 1) into the point of that projected depth."""
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) / self.scale
        flat = axes.transData.inverted().transform(corners)
        lifted = np.column_stack([flat, np.full(3, depth), np.ones(3)]) @ np.linalg.inv(self.matrix).T
        # Planes of one projected depth are planes: affine in the pixel.
        points = lifted[:, :3] / lifted[:, 3:]
        return np.array([points[1] - points[0], points[2] - points[0], points[0]])

    def block_of(self, points: Array) -> Block | None:
        """The block of pixels that contains the projected points (m, 3), or None off the image."""
        flat = self.to_display.transform(project_points(points, self.matrix)[:, :2])
        return block_about(np.asarray(flat) * self.scale, self.width, self.height)


def rays_through(near: Array, way: Array) -> Rays:
    """The rays that leave the places of the plane `near` (3, 3) along `way` (3, 3), with t = 0 there or, for
    rays that meet in an eye, with t = 0 at the eye.
    """
    turning = way[:2]
    if np.abs(turning).max() * 1e4 < PARALLEL_RAYS * np.abs(way[2]).max():
        return Rays(near, np.array([np.zeros(3), np.zeros(3), way[2]]))
    back = -float(np.vdot(near[:2], turning) / np.vdot(turning, turning))
    eye = near[2] + back * way[2]
    return Rays(np.array([np.zeros(3), np.zeros(3), eye]), way)


def block_about(places: Array, width: int, height: int) -> Block | None:
    """The pixels of an image that places (m, 2) on it span, or None where there are none."""
    low, high = places.min(axis=0), places.max(axis=0)
    x0, y0 = max(int(low[0]) - 1, 0), max(int(low[1]) - 1, 0)
    x1, y1 = min(int(high[0]) + 2, width), min(int(high[1]) + 2, height)
    return (x0, x1, y0, y1) if x1 > x0 and y1 > y0 else None
