"""The law of a motion along an interval of a path: its squared speed is quadratic by place.

With the place σ as a share of the interval the squared speed has Bernstein coefficients X₀, X₁, X₂, so that
the path acceleration is linear in σ and σ a combination of hyperbolic or of trigonometric functions of time.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array

SERIES: Final = 0.01
"""Argument below which a series of six terms stands for a quotient: its error is a rounding."""


def move_within(squares: Array, length: Array, t: Array) -> tuple[Array, Array, Array, Array]:
    """Share of an interval, path speed, acceleration and jerk (m,) a time t (m,) after its begin.

    squares (m, 3): its squared speed; length (m,) of the interval.
    """
    first, second = 2.0 * (squares[:, 1] - squares[:, 0]), squares @ [1.0, -2.0, 1.0]
    begin = np.sqrt(squares[:, 0])
    # With t in units of the length, σ'' = second σ + first / 2.
    sine, versed = _sine_and_versed(second, t / length)
    share = begin * sine + 0.5 * first * versed
    speed = np.maximum(0.0, begin * (1.0 + second * versed) + 0.5 * first * sine)
    return share, speed, (0.5 * first + second * share) / length, second * speed / length**2


def seconds_between(squares: Array, length: Array, begin: Array, end: Array) -> Array:
    """The time from one share of an interval to another: length ∫ dσ / √x."""
    second = squares @ np.array([1.0, -2.0, 1.0])

    def speed(t: Array) -> Array:
        s = 1.0 - t
        x = s * s * squares[:, 0] + 2.0 * s * t * squares[:, 1] + t * t * squares[:, 2]
        return np.sqrt(np.maximum(x, 0.0))

    total = speed(begin) + speed(end)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (end - begin) / total
        z = second * ratio * ratio
    return np.asarray(2.0 * length * ratio * _inverse_tangent(z))


def _inverse_tangent(z: Array) -> Array:
    """artanh(√z) / √z, which is arctan(√−z) / √−z for negative z."""
    root = np.sqrt(np.abs(z))
    with np.errstate(divide="ignore", invalid="ignore"):
        exact = np.where(z > 0.0, np.arctanh(root), np.arctan(root)) / root
    series = 1.0 + z * (1 / 3 + z * (1 / 5 + z * (1 / 7 + z * (1 / 9 + z * (1 / 11 + z / 13)))))
    return np.where(np.abs(z) < SERIES, series, exact)


def _sine_and_versed(a: Array, t: Array) -> tuple[Array, Array]:
    """sinh(√a t) / √a and (cosh(√a t) − 1) / a; sine and cosine for negative a."""
    z = a * t * t
    root = np.sqrt(np.abs(z))
    with np.errstate(divide="ignore", invalid="ignore"):
        sine = np.where(z > 0.0, np.sinh(root), np.sin(root)) / root
        half = np.where(z > 0.0, np.sinh(0.5 * root), np.sin(0.5 * root)) / (0.5 * root)
    near = np.abs(z) < SERIES
    quarter = 0.25 * z
    sine = np.where(near, _sine_series(z), sine)
    half = np.where(near, _sine_series(quarter), half)
    return t * sine, 0.5 * t * t * half * half


def _sine_series(z: Array) -> Array:
    """sinh(√z) / √z near zero."""
    return 1.0 + z / 6.0 * (1.0 + z / 20.0 * (1.0 + z / 42.0 * (1.0 + z / 72.0 * (1.0 + z / 110.0))))


def derive_polynomials(c: Array) -> Array:
    """The derivative of polynomials (..., n), lowest power first; one coefficient at least."""
    return c[..., 1:] * np.arange(1.0, c.shape[-1]) if c.shape[-1] > 1 else np.zeros_like(c)


def multiply_polynomials(p: Array, x: Array) -> Array:
    """The products of polynomials (k, dof, m) with those of the intervals (k, n)."""
    made = np.zeros((*p.shape[:2], p.shape[2] + x.shape[1] - 1))
    for i in range(x.shape[1]):
        made[..., i : i + p.shape[2]] += x[:, None, i : i + 1] * p
    return made


def add_polynomials(a: Array, b: Array) -> Array:
    n = max(a.shape[-1], b.shape[-1])
    first, second = (np.pad(each, ((0, 0), (0, 0), (0, n - each.shape[-1]))) for each in (a, b))
    return np.asarray(first + second)
