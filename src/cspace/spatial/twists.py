"""Twists ξ = [v; ω] of space: their 4×4 matrices, the exponential and logarithm of SE(3), adjoints."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats
from cspace.spatial import single
from cspace.spatial.checks import PoseLike, as_pose
from cspace.spatial.poses import assemble
from cspace.spatial.rotations import (
    matrix_of_rotvec,
    rotvec_of_matrix,
    skew,
    unskew,
)
from cspace.spatial.vectors import cross, length_and_direction


def hat_se3(twist: npt.ArrayLike) -> Array:
    """The 4×4 matrix of a twist, [[[ω], v], [0, 0]].

    twist: [v; ω] (..., 6), v [m] or [m/s], ω [rad] or [rad/s] → (..., 4, 4).
    """
    xi = as_floats(twist, "twist", last=(6,))
    matrix = np.zeros((*xi.shape[:-1], 4, 4))
    matrix[..., :3, :3] = skew(xi[..., 3:])
    matrix[..., :3, 3] = xi[..., :3]
    return matrix


def vee_se3(matrix: npt.ArrayLike) -> Array:
    """The twist [v; ω] of a 4×4 matrix [[[ω], v], [0, 0]], the inverse of hat_se3.

    matrix: (..., 4, 4) → (..., 6); of an upper left block that is not skew the skew part is read.
    """
    M = as_floats(matrix, "twist matrix", last=(4, 4))
    return np.concatenate([M[..., :3, 3], unskew(M[..., :3, :3])], axis=-1)


def exp_se3(twist: npt.ArrayLike) -> Array:
    """The pose reached by moving along a constant twist for one unit of time.

    exp ξ = [[exp [ω], V v], [0, 1]],  V v = v + (1 − cos θ)/θ (u × v) + (1 − sin θ/θ) (u × (u × v)),
    with θ = |ω|, u = ω/θ; a twist without rotation moves by v.

    twist: [v; ω] (..., 6) [m, rad] → (..., 4, 4). Raises InputError if |ω| overflows.
    Source: Murray, Li and Sastry 1994, prop. 2.9.
    """
    return exponential_se3(as_floats(twist, "twist", last=(6,)))


def log_se3(T: PoseLike) -> Array:
    """The twist with the smallest rotation that reaches a pose: exp_se3(log_se3(T)) = T.

    ω is log_so3 of the rotation, 0 ≤ |ω| ≤ π, with its rule for half turns, and v = V⁻¹ p,
    V⁻¹ p = p − θ/2 (u × p) + (1 − θ/2 cot θ/2) (u × (u × p)).

    T: (..., 4, 4) → [v; ω] (..., 6) [m, rad]. Source: Murray, Li and Sastry 1994, prop. 2.9.
    """
    return logarithm_se3(as_pose(T))


def adjoint(T: PoseLike) -> Array:
    """The matrix that maps twists from frame b to frame a, ξ_a = Ad(T_a_b) ξ_b, in the order [v; ω].

    Ad(T) = [[R, [p] R], [0, R]]. It multiplies as poses do: Ad(T₁ T₂) = Ad(T₁) Ad(T₂).

    T: T_a_b (..., 4, 4) → (..., 6, 6). Source: Murray, Li and Sastry 1994, eq. 2.58.
    """
    T = as_pose(T)
    R = T[..., :3, :3]
    return stack_blocks(R, skew(T[..., :3, 3]) @ R)


def coadjoint(T: PoseLike) -> Array:
    """The matrix that maps wrenches [f; τ] from frame b to frame a: the power f·v + τ·ω stays the same.

    Ad(T)⁻ᵀ = [[R, 0], [[p] R, R]].

    T: T_a_b (..., 4, 4) → (..., 6, 6).
    """
    Ad = adjoint(T)
    Ad[..., 3:, :3], Ad[..., :3, 3:] = Ad[..., :3, 3:], 0.0
    return Ad


def small_adjoint(twist: npt.ArrayLike) -> Array:
    """The matrix of the Lie bracket, ad(ξ) η = [ξ, η], in the order [v; ω].

    ad(ξ) = [[[ω], [v]], [0, [ω]]], the derivative of Ad: Ad(exp ξ) = exp(ad ξ).

    twist: [v; ω] (..., 6) → (..., 6, 6).
    """
    xi = as_floats(twist, "twist", last=(6,))
    return stack_blocks(skew(xi[..., 3:]), skew(xi[..., :3]))


def stack_blocks(A: Array, B: Array) -> Array:
    """[[A, B], [0, A]] (..., 6, 6) of matrices (..., 3, 3)."""
    stacked = np.zeros((*A.shape[:-2], 6, 6))
    stacked[..., :3, :3] = stacked[..., 3:, 3:] = A
    stacked[..., :3, 3:] = B
    return stacked


def exponential_se3(xi: Array) -> Array:
    """exp_se3 without checks but for an overflowing angle.

    Written with the unit axis, no coefficient cancels or overflows, down to the smallest angles.
    """
    R = matrix_of_rotvec(xi[..., 3:], "the rotation of the twist")
    if xi.ndim == 1 and (split := single.direction(xi[3:].tolist())):
        return single.pose(R.ravel().tolist(), single.helix(split[1], split[0], xi[:3].tolist()))
    v = xi[..., :3]
    angle, axis = length_and_direction(xi[..., 3:])
    half = 0.5 * angle
    u_v = cross(axis, v)
    across, twice = np.sin(half) * sinc(half), 1.0 - sinc(angle)
    return assemble(R, v + across[..., None] * u_v + twice[..., None] * cross(axis, u_v))


def logarithm_se3(T: Array) -> Array:
    """log_se3 without checks."""
    if T.ndim == 2 and (split := single.rotvec(T[:3, :3])):
        angle_of_one, axis_of_one = split
        linear = single.straightened(axis_of_one, angle_of_one, T[:3, 3].tolist())
        return np.array(linear + [angle_of_one * x for x in axis_of_one])
    p = T[..., :3, 3]
    w = rotvec_of_matrix(T[..., :3, :3])
    angle, axis = length_and_direction(w)
    half = 0.5 * angle
    u_p = cross(axis, p)
    v = p - half[..., None] * u_p + (1.0 - x_cot_x(half))[..., None] * cross(axis, u_p)
    return np.concatenate([v, w], axis=-1)


def sinc(x: Array) -> Array:
    """sin x / x, 1 at zero."""
    return np.asarray(np.where(x == 0.0, 1.0, np.sin(x) / np.where(x == 0.0, 1.0, x)))


def x_cot_x(x: Array) -> Array:
    """x cot x for |x| ≤ π/2, 1 at zero."""
    return np.asarray(np.where(x == 0.0, 1.0, x * np.cos(x) / np.where(x == 0.0, 1.0, np.sin(x))))
