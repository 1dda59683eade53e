"""Spheres, cones, discs and polygons met by a plane of rays, and the bodies that they bound.

Matplotlib sorts faces by their centres, which leaves teeth where bodies meet and seams where they are
transparent. There are few bodies and few kinds of them, so each pixel's ray is met with each exactly.
A surface dᵀG d + 2 l·d + k = 0, d = p − c, met by the ray p = o + t w is A t² + 2 B t + C = 0 with
A = wᵀG w, B = (o − c)ᵀG w + l·w, C = (o − c)ᵀG (o − c) + 2 l·(o − c) + k. Where all rays share o or all share
w, B is affine in the place (x, y) of a ray and B² − A C a polynomial of degree 2: a few operations per pixel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from cspace.arrays import Array
from cspace.plot.raytrace.view import Rays, affine_at
from cspace.tolerances import LEAST_DIVISOR

LAST = np.array([0.0, 0.0, 1.0])


def evaluate_quadratic(form: Array, x: Array, y: Array) -> Array:
    """(x, y, 1) form (x, y, 1)ᵀ."""
    f = form + form.T
    square = (0.5 * f[0, 0] * x + f[0, 2]) * x + 0.5 * f[2, 2]
    return np.asarray((f[0, 1] * x + (0.5 * f[1, 1] * y + f[1, 2])) * y + square)


@dataclass(frozen=True)
class Quadric:
    """The surface dᵀG d + 2 line·d + k = 0, d = p − center, whose left side grows outward.

    balls: centers (3,) and radii of balls whose hull contains it. axis, ends: a unit vector (3,) and the
    heights along it between which the surface exists; None of a whole sphere.
    """

    center: Array
    G: Array
    line: Array
    k: float
    balls: list[tuple[Array, float]]
    axis: Array
    ends: tuple[float, float] | None = None

    def meet(self, rays: Rays, x: Array, y: Array) -> Array:
        """The t where the rays of the places x, y (which broadcast) first meet it from outside, else inf."""
        o, w = rays.origin - np.outer(LAST, self.center), rays.way
        roots = self.roots(o, w, x, y, parallel=rays.parallel)
        if self.ends is None:
            return np.asarray(np.fmin(roots[0], np.inf))
        base, rise = affine_at(o @ self.axis, x, y), affine_at(w @ self.axis, x, y)
        low, high = self.ends
        heights = [base + t * rise for t in roots]
        within = [np.where((h >= low) & (h <= high), t, np.inf) for h, t in zip(heights, roots, strict=True)]
        return np.asarray(reduce(np.minimum, within))

    def roots(self, o: Array, w: Array, x: Array, y: Array, *, parallel: bool) -> list[Array]:
        """The nearer root, NaN where there is none; both where a ray looks along a cone (A ≤ 0)."""
        A_form = w @ self.G @ w.T
        mixed = o @ self.G @ w.T + np.outer(LAST, w @ self.line)
        C = o @ self.G @ o.T + 2.0 * np.outer(LAST, o @ self.line)
        C[2, 2] += self.k
        B_row = mixed[:, 2] if parallel else mixed[2]
        product = A_form[2, 2] * C if parallel else C[2, 2] * A_form
        inside = evaluate_quadratic(np.outer(B_row, B_row) - product, x, y)
        root = np.sqrt(inside, out=np.full_like(inside, np.nan), where=inside >= 0.0)
        A = A_form[2, 2] if parallel else evaluate_quadratic(A_form, x, y)
        B = affine_at(B_row, x, y)
        if np.min(A) > 0.0:
            return [(-B - root) / A]
        A = np.where(np.abs(A) < LEAST_DIVISOR, LEAST_DIVISOR, A)
        return [(-B - root) / A, (root - B) / A]

    def normals(self, points: Array) -> Array:
        """The outward unit normals (m, 3) at its points (m, 3): the gradient, scaled."""
        out = (points - self.center) @ self.G + self.line
        out /= np.maximum(np.sqrt(np.einsum("ij,ij->i", out, out)), LEAST_DIVISOR)[:, None]
        return np.asarray(out)


def make_sphere(center: Array, radius: float) -> Quadric:
    """|p − center| = radius."""
    return Quadric(center, np.eye(3), np.zeros(3), -(radius**2), [(center, radius)], LAST)


def make_side(start: Array, axis: Array, radius: float, slope: float, ends: tuple[float, float]) -> Quadric:
    """The side of a cone about a unit axis: at the height h above `start` its radius is radius − slope h.

    ends: the heights between which it exists.
    """
    G = np.eye(3) - (1.0 + slope**2) * np.outer(axis, axis)
    balls = [(start + h * axis, radius - slope * h) for h in ends]
    return Quadric(start, G, radius * slope * axis, -(radius**2), balls, axis, ends)


@dataclass(frozen=True)
class Disc:
    """A flat disc, seen from the side its unit normal points to."""

    center: Array
    normal: Array
    radius: float

    @property
    def balls(self) -> list[tuple[Array, float]]:
        return [(self.center, self.radius)]

    def meet(self, rays: Rays, x: Array, y: Array) -> Array:
        offset = rays.origin - np.outer(LAST, self.center)
        falling = affine_at(rays.way @ self.normal, x, y)
        above = affine_at(offset @ self.normal, x, y)
        t = -above / np.where(falling < -LEAST_DIVISOR, falling, np.nan)
        away = np.zeros(t.shape)
        for axis in range(3):
            away = away + (affine_at(offset[:, axis], x, y) + t * affine_at(rays.way[:, axis], x, y)) ** 2
        return np.asarray(np.where(away <= self.radius**2, t, np.inf))

    def normals(self, points: Array) -> Array:
        return np.broadcast_to(self.normal, points.shape)


@dataclass(frozen=True)
class Facet:
    """A flat convex polygon of corners (k, 3) [m], seen from the side where they go counter-clockwise."""

    corners: Array

    @cached_property
    def normal(self) -> Array:
        """The unit normal of the side that is seen: the area vector, scaled."""
        spokes = self.corners[1:] - self.corners[0]
        area = np.cross(spokes[:-1], spokes[1:]).sum(axis=0)
        return np.asarray(area / max(float(np.linalg.norm(area)), LEAST_DIVISOR))

    @cached_property
    def inward(self) -> Array:
        """Directions (k, 3) in the plane, each from an edge to the inside."""
        return np.cross(self.normal, np.roll(self.corners, -1, axis=0) - self.corners)

    @property
    def balls(self) -> list[tuple[Array, float]]:
        return [(corner, 0.0) for corner in self.corners]

    def meet(self, rays: Rays, x: Array, y: Array) -> Array:
        """The t where the rays of the places x, y (which broadcast) meet it from its seen side, else inf."""
        falling = affine_at(rays.way @ self.normal, x, y)
        if np.min(falling) >= -LEAST_DIVISOR:
            return np.full(np.broadcast(x, y).shape, np.inf)
        above = affine_at((rays.origin - np.outer(LAST, self.corners[0])) @ self.normal, x, y)
        t = -above / np.where(falling < -LEAST_DIVISOR, falling, np.nan)
        inside = np.isfinite(t) if rays.parallel else t > 0.0  # those of an eye begin there
        for corner, inward in zip(self.corners, self.inward, strict=True):
            start = affine_at((rays.origin - np.outer(LAST, corner)) @ inward, x, y)
            inside &= start + t * affine_at(rays.way @ inward, x, y) >= 0.0
        return np.asarray(np.where(inside, t, np.inf))

    def normals(self, points: Array) -> Array:
        return np.broadcast_to(self.normal, points.shape)


Piece = Quadric | Disc | Facet
"""A surface that rays can meet."""


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

    def lowest(self) -> float:
        """The height of its lowest point [m]."""
        way = self.b - self.a
        upright = 0.0 if self.round else way[2] / max(float(np.linalg.norm(way)), LEAST_DIVISOR)
        down = np.sqrt(max(0.0, 1.0 - upright**2))
        return float(min(self.a[2] - down * self.radius_a, self.b[2] - down * self.radius_b))


@dataclass(frozen=True)
class Facets:
    """A body bounded by flat convex polygons: corners (k, 3) [m] of each, counter-clockwise from outside."""

    polygons: list[Array]
    color: Array
    round: bool = False

    def lowest(self) -> float:
        """The height of its lowest point [m]."""
        return float(min(corners[:, 2].min() for corners in self.polygons))


Body = Solid | Facets
"""What a group of a scene consists of."""


def make_cylinder(center: Array, axis: Array, radius: float, half: float, color: Array) -> Solid:
    """A cylinder about a unit axis."""
    return Solid(center - half * axis, center + half * axis, radius, radius, color, round=False)


def make_arrow(origin: Array, way: Array, thickness: float, color: Array) -> list[Solid]:
    """An arrow from `origin` along `way` (3,) [m]: a shaft and a head."""
    length = float(np.linalg.norm(way))
    head = min(0.34 * length, 5.5 * thickness)
    neck = origin + way * (1.0 - head / length)
    return [
        Solid(origin, neck, thickness, thickness, color, round=True),
        Solid(neck, origin + way, 2.3 * thickness, 0.0, color, round=False),
    ]


def bounding_pieces(solid: Body) -> list[Piece]:
    """The surfaces that bound a solid."""
    if isinstance(solid, Facets):
        return [Facet(corners) for corners in solid.polygons]
    way = solid.b - solid.a
    length = float(np.linalg.norm(way))
    slope = (solid.radius_a - solid.radius_b) / max(length, LEAST_DIVISOR)
    if solid.round:
        if length < LEAST_DIVISOR or abs(slope) >= 1.0:  # one sphere holds the other
            larger = solid.a if solid.radius_a >= solid.radius_b else solid.b
            return [make_sphere(larger, max(solid.radius_a, solid.radius_b))]
        ends = slope * solid.radius_a, length + slope * solid.radius_b
        cosine = float(np.sqrt(1.0 - slope * slope))
        side = make_side(solid.a, way / length, solid.radius_a / cosine, slope / cosine, ends)
        return [side, make_sphere(solid.a, solid.radius_a), make_sphere(solid.b, solid.radius_b)]
    axis = way / length
    caps = (Disc(solid.a, -axis, solid.radius_a), Disc(solid.b, axis, solid.radius_b))
    side = make_side(solid.a, axis, solid.radius_a, slope, (0.0, length))
    return [side, *(cap for cap in caps if cap.radius > 0.0)]
