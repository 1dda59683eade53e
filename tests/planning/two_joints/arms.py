"""Planar arms and scenes at random, and whether they touch by the distance between segments: an oracle in
plain numpy that knows nothing of arcs."""

from __future__ import annotations

import numpy as np

import cspace as cs


def make_arm(rng, *, limits=False, place=None):
    """A planar arm with random lengths, zero angles and signs, mounted at a place (4, 4)."""
    l1, l2, a, b = *rng.uniform(0.4, 1.2, 2), *rng.uniform(-3, 3, 2)
    elbow = l1 * np.array([np.cos(a), np.sin(a), 0.0])
    T = np.eye(4)
    T[:3, 3] = elbow + l2 * np.array([np.cos(b), np.sin(b), 0.0])
    signs = rng.choice([-1.0, 1.0], 2)
    ranges = {}
    if limits:
        lower = rng.uniform(-6, -0.5, 2)
        ranges = {"lower": lower, "upper": lower + rng.uniform(1, 8, 2)}
    arm = cs.Robot.from_screws(np.outer(signs, [0.0, 0.0, 1.0]), [[0, 0, 0], elbow], T, **ranges)
    return arm if place is None else arm.with_base(place)


def links_of(arm, q):
    """Base, elbow and tip (n, 3, 3) of configurations q (n, 2)."""
    chain = arm.chain
    tips = arm.fk(q)[:, :3, 3]
    axis, start = chain.axes[0], chain.points[0]
    twists = q[:, :1] * np.append(np.cross(start, axis), axis)
    elbows = np.array([(cs.exp_se3(twist) @ np.append(chain.points[1], 1.0))[:3] for twist in twists])
    return np.stack([np.broadcast_to(chain.points[0], tips.shape), elbows, tips], axis=1)


def to_segments(points, a, b):
    """Distances (n, m) of points (n, 2) from segments a–b (m, 2)."""
    way = b - a
    part = np.clip(np.einsum("nmk,mk->nm", points[:, None] - a, way) / np.sum(way**2, axis=1), 0, 1)
    return np.linalg.norm(points[:, None] - a - part[..., None] * way, axis=2)


def cross(u, v):
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def is_inside(points, ring):
    """Whether points (n, 2) lie inside a ring (m, 2), by the even-odd rule."""
    a, b = ring, np.roll(ring, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    spans = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return (spans & (x < at)).sum(axis=1) % 2 == 1


def distance_to_ring(p, r, ring):
    """The distance (n,) of segments p–r (n, 2) from a polygon: zero where they touch."""
    a, b = ring, np.roll(ring, -1, axis=0)
    ends = np.minimum(to_segments(p, a, b).min(axis=1), to_segments(r, a, b).min(axis=1))
    corners = np.array([to_segments(ring, p[k : k + 1], r[k : k + 1]).min() for k in range(len(p))])
    one = cross((r - p)[:, None], a - p[:, None]) * cross((r - p)[:, None], b - p[:, None]) < 0
    other = cross(b - a, p[:, None] - a) * cross(b - a, r[:, None] - a) < 0
    touches = (one & other).any(axis=1) | is_inside(p, ring)
    return np.where(touches, 0.0, np.minimum(ends, corners))


def clearance(links, rings):
    """The least distance (n,) of links (n, 3, 2) from polygons."""
    return np.min(
        [distance_to_ring(links[:, k], links[:, k + 1], ring) for ring in rings for k in (0, 1)], axis=0
    )


def star_polygon(rng, far):
    """A simple polygon around a random centre, away from the origin; seldom convex."""
    bearing, count = rng.uniform(0, 7), rng.integers(3, 9)
    center = rng.uniform(0.5, far) * np.array([np.cos(bearing), np.sin(bearing)])
    angles = 2 * np.pi * (np.arange(count) + rng.uniform(0, 0.8, count)) / count
    radii = rng.uniform(0.1, 0.4, count)
    return center + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
