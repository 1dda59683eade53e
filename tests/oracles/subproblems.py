"""The six subproblems as their defining equations, and what a dense sweep over the angles says of them."""

from __future__ import annotations

import numpy as np


def turned(k, theta, p):
    """Rot(k, θ) p: k, p (..., 3), theta (...); the sum of Rodrigues 1840."""
    k, p, theta = np.asarray(k, float), np.asarray(p, float), np.asarray(theta, float)[..., None]
    k = k / np.linalg.norm(k, axis=-1, keepdims=True)
    along = (k * p).sum(-1, keepdims=True) * k
    return along + np.cos(theta) * (p - along) + np.sin(theta) * np.cross(k, p)


def gap_1(k, p1, p2, t):
    return np.linalg.norm(turned(k, t[..., 0], p1) - p2, axis=-1)


def gap_2(k1, k2, p1, p2, t):
    return np.linalg.norm(turned(k1, t[..., 0], p1) - turned(k2, t[..., 1], p2), axis=-1)


def gap_3(k, p1, p2, d, t):
    return np.abs(np.linalg.norm(turned(k, t[..., 0], p1) - p2, axis=-1) - d)


def gap_4(h, k, p, d, t):
    return np.abs(turned(k, t[..., 0], p) @ np.asarray(h, float) - d)


def gap_5(p0, p1, p2, p3, p4, k1, k2, k3, t):
    inner = p3 + turned(k3, t[..., 2], p4)
    return np.linalg.norm(p0 + turned(k1, t[..., 0], p1) - p2 - turned(k2, t[..., 1], inner), axis=-1)


def gap_6(h, k, p, d, t):
    def side(i):
        first = turned(k[2 * i], t[..., 0], p[2 * i]) @ h[2 * i]
        return first + turned(k[2 * i + 1], t[..., 1], p[2 * i + 1]) @ h[2 * i + 1] - d[i]

    return np.hypot(side(0), side(1))


def grid(angles, steps):
    """All combinations of `steps` values per angle: (steps**angles, angles)."""
    axis = np.linspace(-np.pi, np.pi, steps, endpoint=False)
    return np.stack(np.meshgrid(*[axis] * angles, indexing="ij"), axis=-1).reshape(-1, angles)


def sign_changes(values):
    """How often values sampled around a circle change sign."""
    return int(np.count_nonzero(np.sign(values) * np.sign(np.roll(values, 1)) < 0))
