"""Rays against tapered capsules and cylinders: what a picture of a robot is made of.

Matplotlib sorts faces by their centres, which leaves teeth where bodies meet and seams where they are
transparent. There are few bodies and few kinds of them, so each pixel's ray is met with each exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cspace.arrays import Array

__all__ = ["Solid", "arrow", "capsule", "cylinder", "meet"]


@dataclass(frozen=True)
class Solid:
    """A body between the points a and b (3,) [m] with the radii at both [m].

    round: the hull of two spheres (a tapered capsule); else a cone or cylinder with flat ends.
    """

    a: Array
    b: Array
    radius_a: float
    radius_b: float
    color: Array
    round: bool = True

    def corners(self) -> Array:
        """The corners (16, 3) of boxes about both ends, which hold the body."""
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, 8).T
        return np.concatenate([self.a + signs * self.radius_a, self.b + signs * self.radius_b])


def capsule(a: Array, b: Array, radius_a: float, radius_b: float, color: Array) -> Solid:
    """The hull of two spheres."""
    return Solid(a, b, radius_a, radius_b, color)


def cylinder(center: Array, axis: Array, radius: float, half: float, color: Array) -> Solid:
    """A cylinder about a unit axis."""
    return Solid(center - half * axis, center + half * axis, radius, radius, color, round=False)


def arrow(origin: Array, way: Array, thickness: float, color: Array) -> list[Solid]:
    """An arrow from `origin` along `way` (3,) [m]: a shaft and a head."""
    length = float(np.linalg.norm(way))
    head = min(0.34 * length, 5.5 * thickness)
    neck = origin + way * (1.0 - head / length)
    return [
        Solid(origin, neck, thickness, thickness, color, round=True),
        Solid(neck, origin + way, 2.3 * thickness, 0.0, color, round=False),
    ]


def meet(solid: Solid, origins: Array, ways: Array) -> tuple[Array, Array]:
    """Where rays first meet a solid: distances (m,), inf where they miss, and outward normals (m, 3).

    origins, ways: (m, 3), ways of unit length; origins outside the solid.
    """
    way = solid.b - solid.a
    length = float(np.linalg.norm(way))
    distance = np.full(len(origins), np.inf)
    normals = np.zeros_like(origins)
    slope = (solid.radius_a - solid.radius_b) / max(length, 1e-12)
    if solid.round:
        for center, radius in ((solid.a, solid.radius_a), (solid.b, solid.radius_b)):
            take(distance, normals, *meet_sphere(center, radius, origins, ways))
        if abs(slope) >= 1.0 or length < 1e-12:
            return distance, normals
        sine, ends = slope, (slope * solid.radius_a, length + slope * solid.radius_b)
    else:
        sine, ends = slope / np.hypot(1.0, slope), (0.0, length)
    cosine = np.sqrt(1.0 - sine * sine)
    start = solid.radius_a if solid.round else solid.radius_a * cosine
    axis = way / length
    take(distance, normals, *meet_side(solid.a, axis, start, sine, cosine, ends, origins, ways))
    if not solid.round:
        for center, radius, side in ((solid.a, solid.radius_a, -1.0), (solid.b, solid.radius_b, 1.0)):
            take(distance, normals, *meet_disc(center, side * axis, radius, origins, ways))
    return distance, normals


def take(distance: Array, normals: Array, found: Array, found_normals: Array) -> None:
    """Keep the nearer of what is known and what was found."""
    nearer = found < distance
    distance[nearer] = found[nearer]
    normals[nearer] = found_normals[nearer]


def meet_sphere(center: Array, radius: float, origins: Array, ways: Array) -> tuple[Array, Array]:
    """|o + t w − c| = r, the nearer root."""
    o = origins - center
    b = np.einsum("ij,ij->i", o, ways)
    inside = b * b - np.einsum("ij,ij->i", o, o) + radius * radius
    t = np.where(inside >= 0.0, -b - np.sqrt(np.maximum(inside, 0.0)), np.inf)
    at = o + np.where(np.isfinite(t), t, 0.0)[:, None] * ways
    return t, at / max(radius, 1e-12)


def meet_side(
    a: Array,
    axis: Array,
    start: float,
    sine: float,
    cosine: float,
    ends: tuple[float, float],
    origins: Array,
    ways: Array,
) -> tuple[Array, Array]:
    """The cone of half angle asin(sine) whose radius at the height y on the axis is (start − sine y)/cosine.

    |o + t w|² − (y + t v)² = (start − sine (y + t v))² / cosine², with y, v the heights of o and w; only
    heights between `ends` count.
    """
    o = origins - a
    y, v = o @ axis, ways @ axis
    k = start - sine * y
    squares = cosine * cosine
    A = 1.0 - v * v - (sine * v) ** 2 / squares
    B = np.einsum("ij,ij->i", o, ways) - y * v + k * sine * v / squares
    C = np.einsum("ij,ij->i", o, o) - y * y - k * k / squares
    inside = B * B - A * C
    root = np.sqrt(np.maximum(inside, 0.0))
    A = np.where(np.abs(A) < 1e-12, 1e-12, A)
    best = np.full(len(o), np.inf)
    for t in ((-B - root) / A, (-B + root) / A):
        height = y + t * v
        good = (inside >= 0.0) & (height >= ends[0]) & (height <= ends[1]) & (start - sine * height >= 0.0)
        best = np.where(good & (t < best), t, best)
    t = np.where(np.isfinite(best), best, 0.0)
    at = o + t[:, None] * ways
    out = at - (at @ axis)[:, None] * axis
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)
    return best, cosine * out + sine * axis


def meet_disc(
    center: Array, normal: Array, radius: float, origins: Array, ways: Array
) -> tuple[Array, Array]:
    """The flat end of a cylinder, seen from outside."""
    falling = ways @ normal
    o = origins - center
    t = -(o @ normal) / np.where(np.abs(falling) < 1e-12, 1e-12, falling)
    at = o + t[:, None] * ways
    good = (falling < 0.0) & (np.einsum("ij,ij->i", at, at) <= radius * radius)
    return np.where(good, t, np.inf), np.broadcast_to(normal, ways.shape)
