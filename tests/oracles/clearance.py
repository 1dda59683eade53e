"""How far points are from walls, by looking at every wall; the widest way over a fine grid of points."""

from __future__ import annotations

import numpy as np


def rings_of(world):
    """Every outline of a PolygonWorld and its bounds, (n, 2) each."""
    left, low, right, high = world.bounds
    around = np.array([(left, low), (right, low), (right, high), (left, high)], dtype=float)
    return [around, *(ring for rings in world.obstacles for ring in rings)]


def nearest(points, rings):
    """The distance (n,) from points (n, 2) to the nearest wall, and the wall's point (n, 2)."""
    points = np.asarray(points, dtype=float)
    best = np.full(len(points), np.inf)
    foot = np.zeros_like(points)
    for ring in rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            along = b - a
            t = np.clip((points - a) @ along / (along @ along), 0, 1)
            at = a + t[:, None] * along
            d = np.hypot(*(points - at).T)
            closer = d < best
            best[closer], foot[closer] = d[closer], at[closer]
    return best, foot


def is_free(points, world):
    """Whether points (n, 2) lie in the bounds and in no obstacle, by the parity of crossed outlines."""
    points = np.asarray(points, dtype=float)
    x, y = points.T
    left, low, right, high = world.bounds
    free = (x > left) & (x < right) & (y > low) & (y < high)
    for rings in world.obstacles:
        odd = np.zeros(len(points), dtype=bool)
        for ring in rings:
            for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
                spans = (ay > y) != (by > y)
                with np.errstate(divide="ignore", invalid="ignore"):
                    odd ^= spans & (x < ax + (bx - ax) * (y - ay) / (by - ay))
        free &= ~odd
    return free


def widest_over_grid(clearance, start, goal):
    """The largest least clearance of a way between two cells of an array (rows, columns), by steps to the
    eight cells around: cells are joined from the widest on until start and goal hang together."""
    rows, columns = clearance.shape
    flat = clearance.ravel()
    parent = np.full(flat.size, -1)

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    start, goal = start[0] * columns + start[1], goal[0] * columns + goal[1]
    for i in np.argsort(-flat, kind="stable"):
        if flat[i] <= 0:
            return 0.0
        parent[i] = i
        r, c = divmod(int(i), columns)
        for u in range(max(r - 1, 0), min(r + 2, rows)):
            for v in range(max(c - 1, 0), min(c + 2, columns)):
                j = u * columns + v
                if parent[j] >= 0:
                    parent[root(j)] = root(i)
        if parent[start] >= 0 and parent[goal] >= 0 and root(start) == root(goal):
            return float(flat[i])
    return 0.0
