"""Spheres, cones and discs met by a plane of rays.

A surface dᵀG d + 2 l·d + k = 0, d = p − c, met by the ray p = o + t w is A t² + 2 B t + C = 0 with
A = wᵀG w, B = (o − c)ᵀG w + l·w, C = (o − c)ᵀG (o − c) + 2 l·(o − c) + k. Where all rays share o or all share
w, B is affine in the place (x, y) of a ray and B² − A C a polynomial of degree 2: a few operations per pixel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cspace.arrays import Array
from cspace.plot.raytrace.view import Rays, affine_at
from cspace.tolerances import LEAST_DIVISOR

LAST = np.array([0.0, 0.0, 1.0])


class Piece(Protocol):
    """A surface that rays can meet."""

    def meet(self, rays: Rays, x: Array, y: Array) -> Array:
        """The t where the rays of the places x, y (which broadcast) first meet it from outside, else inf."""

    def normals(self, points: Array) -> Array:
        """The outward unit normals (m, 3) at its points (m, 3)."""

    def balls(self) -> list[tuple[Array, float]]:
        """Two balls, center (3,) and radius, whose hull contains it."""


def evaluate_quadratic(form: Array, x: Array, y: Array) -> Array:
    """(x, y, 1) form (x, y, 1)ᵀ."""
    f = form + form.T
    square = (0.5 * f[0, 0] * x + f[0, 2]) * x + 0.5 * f[2, 2]
    return np.asarray((f[0, 1] * x + (0.5 * f[1, 1] * y + f[1, 2])) * y + square)


class Quadric:
    """The polynomials of a quadric under rays: B as a row (3,), A and B² − A C as forms (3, 3)."""

    def __init__(self, rays: Rays, center: Array, G: Array, line: Array, k: float) -> None:
        o = rays.origin - np.outer(LAST, center)
        w = rays.way
        self.A = w @ G @ w.T
        mixed = o @ G @ w.T + np.outer(LAST, w @ line)
        C = o @ G @ o.T + 2.0 * np.outer(LAST, o @ line)
        C[2, 2] += k
        if rays.parallel:
            self.B = mixed[:, 2]
            self.inside = np.outer(self.B, self.B) - self.A[2, 2] * C
        else:
            self.B = mixed[2]
            self.inside = np.outer(self.B, self.B) - C[2, 2] * self.A

    def roots(self, x: Array, y: Array) -> list[Array]:
        """The nearer root, NaN where there is none; both where a ray looks along a cone (A ≤ 0)."""
        inside = evaluate_quadratic(self.inside, x, y)
        root = np.sqrt(inside, out=np.full_like(inside, np.nan), where=inside >= 0.0)
        A = evaluate_quadratic(self.A, x, y) if self.A[:2].any() else self.A[2, 2]
        B = affine_at(self.B, x, y)
        if np.min(A) > 0.0:
            return [(-B - root) / A]
        A = np.where(np.abs(A) < LEAST_DIVISOR, LEAST_DIVISOR, A)
        return [(-B - root) / A, (root - B) / A]


@dataclass(frozen=True)
class Sphere:
    """|p − center| = radius."""

    center: Array
    radius: float

    def meet(self, rays: Rays, x: Array, y: Array) -> Array:
        quadric = Quadric(rays, self.center, np.eye(3), np.zeros(3), -(self.radius**2))
        t = quadric.roots(x, y)[0]
        return np.asarray(np.fmin(t, np.inf))

    def normals(self, points: Array) -> Array:
        return (points - self.center) / self.radius

    def balls(self) -> list[tuple[Array, float]]:
        return [(self.center, self.radius)] * 2


@dataclass(frozen=True)
class Side:
    """The side of a cone about a unit axis: at the height h above `start` its radius is radius − slope h.

    ends: the heights between which it exists.
    """

    start: Array
    axis: Array
    radius: float
    slope: float
    ends: tuple[float, float]

    def meet(self, rays: Rays, x: Array, y: Array) -> Array:
        G = np.eye(3) - (1.0 + self.slope**2) * np.outer(self.axis, self.axis)
        quadric = Quadric(rays, self.start, G, self.radius * self.slope * self.axis, -(self.radius**2))
        base = affine_at((rays.origin - np.outer(LAST, self.start)) @ self.axis, x, y)
        rise = affine_at(rays.way @ self.axis, x, y)
        best: Array | None = None
        low, high = self.ends
        for t in quadric.roots(x, y):
            height = base + t * rise
            t = np.where((height >= low) & (height <= high), t, np.inf)
            best = t if best is None else np.minimum(best, t)
        assert best is not None
        return best

    def normals(self, points: Array) -> Array:
        d = points - self.start
        out = d - np.outer(d @ self.axis, self.axis)
        out /= np.maximum(np.sqrt(np.einsum("ij,ij->i", out, out)), LEAST_DIVISOR)[:, None]
        cosine = 1.0 / np.sqrt(1.0 + self.slope**2)
        return np.asarray(cosine * (out + self.slope * self.axis))

    def balls(self) -> list[tuple[Array, float]]:
        return [(self.start + h * self.axis, self.radius - self.slope * h) for h in self.ends]


@dataclass(frozen=True)
class Disc:
    """A flat disc, seen from the side its unit normal points to."""

    center: Array
    normal: Array
    radius: float

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

    def balls(self) -> list[tuple[Array, float]]:
        return [(self.center, self.radius)] * 2
