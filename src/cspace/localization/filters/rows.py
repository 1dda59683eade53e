"""Poses as rows x, y, θ: composed, compared and differentiated without checks, with any leading axes."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array
from cspace.math.wrapping import wrap_angle
from cspace.mobile.arcs import compose_increments
from cspace.spatial.twists import sinc, x_cot_x


def move_pose(pose: Array, xi: Array) -> Array:
    """Rows of T exp ξ: (..., 3), θ in (−π, π]."""
    half = 0.5 * xi[..., 2]
    a, b = sinc(xi[..., 2]), np.sin(half) * sinc(half)
    x, y = xi[..., 0], xi[..., 1]
    return follow_rows(pose, np.stack([a * x - b * y, b * x + a * y, xi[..., 2]], axis=-1))


def follow_rows(poses: Array, increments: Array) -> Array:
    """Rows of poses followed by increments, θ in (−π, π]: (..., 3)."""
    moved = compose_increments(poses, increments)
    moved[..., 2] = wrap_angle(moved[..., 2])
    return moved


def relate_rows(poses: Array, others: Array) -> Array:
    """Other poses as seen from poses, rows of T⁻¹ T': (..., 3), θ in (−π, π]."""
    c, s = np.cos(poses[..., 2]), np.sin(poses[..., 2])
    dx, dy = others[..., 0] - poses[..., 0], others[..., 1] - poses[..., 1]
    turn = wrap_angle(others[..., 2] - poses[..., 2])
    return np.stack([c * dx + s * dy, c * dy - s * dx, turn], axis=-1)


def find_twist(poses: Array, others: Array) -> Array:
    """log(T⁻¹ T'): (..., 3)."""
    x, y, angle = np.moveaxis(relate_rows(poses, others), -1, 0)
    half = 0.5 * angle
    a = x_cot_x(half)
    return np.stack([a * x + half * y, a * y - half * x, angle], axis=-1)


def adjoin_rows(rows: Array) -> Array:
    """Ad of poses as rows: (..., 3) → (..., 3, 3)."""
    Ad = np.zeros((*rows.shape, 3))
    c, s = np.cos(rows[..., 2]), np.sin(rows[..., 2])
    Ad[..., 0, 0] = Ad[..., 1, 1] = c
    Ad[..., 0, 1], Ad[..., 1, 0] = -s, s
    Ad[..., 0, 2], Ad[..., 1, 2], Ad[..., 2, 2] = rows[..., 1], -rows[..., 0], 1.0
    return Ad


def carry_covariance(A: Array, P: Array) -> Array:
    """A P Aᵀ, (..., 3, 3)."""
    return np.asarray(A @ P @ np.swapaxes(A, -1, -2))
