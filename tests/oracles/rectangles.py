"""How deep a rectangle lies in the cells of a grid: corners projected onto every axis, no cell left out."""

from __future__ import annotations

import numpy as np


def corners(pose, rear, front, half_width):
    """The corners (4, 2) of a rectangle about a pose x, y, theta."""
    x, y, theta = pose
    c, s = np.cos(theta), np.sin(theta)
    local = np.array([[-rear, -half_width], [front, -half_width], [front, half_width], [-rear, half_width]])
    return local @ np.array([[c, s], [-s, c]]) + [x, y]


def depth(pose, body, blocked, resolution, origin=(0.0, 0.0)):
    """The deepest overlap of a rectangle with a blocked cell or with the outside; below 0 where it is clear.

    body: rear, front, half width. The overlap of two convex shapes is the least over the axes of both.
    """
    rectangle = corners(pose, *body)
    low, high = np.array(origin), np.array(origin) + resolution * np.array(blocked.shape[::-1])
    outside = max((low - rectangle.min(0)).max(), (rectangle.max(0) - high).max())
    cells = np.argwhere(blocked)
    if not len(cells):
        return outside
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    places = origin + resolution * (cells[:, None, ::-1] + square)
    theta = pose[2]
    overlaps = []
    for axis in (
        np.array([1, 0]),
        np.array([0, 1]),
        np.array([np.cos(theta), np.sin(theta)]),
        np.array([-np.sin(theta), np.cos(theta)]),
    ):
        a, b = rectangle @ axis, places @ axis
        overlaps.append(np.minimum(a.max() - b.min(1), b.max(1) - a.min()))
    return max(outside, np.min(overlaps, axis=0).max())
