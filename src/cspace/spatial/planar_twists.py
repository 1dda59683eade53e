"""Twists of the plane: exponential and logarithm of SO(2) and SE(2), their matrices, adjoint, pole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial.checks import as_pose_2d
from cspace.spatial.planar import angle_of, matrix_of_angle, to_theta
from cspace.spatial.poses import assemble
from cspace.spatial.twists import sinc, x_cot_x
from cspace.tables import show_fields


def hat_so2(angle: npt.ArrayLike) -> Array:
    """The skew matrix [[0, −ω], [ω, 0]]: (...) → (..., 2, 2)."""
    w = as_floats(angle, "angle")
    return np.stack([np.stack([0.0 * w, -w], axis=-1), np.stack([w, 0.0 * w], axis=-1)], axis=-2)


def vee_so2(matrix: npt.ArrayLike) -> Array:
    """The number of a 2×2 skew matrix, the inverse of hat_so2: (..., 2, 2) → (...)."""
    M = as_floats(matrix, "skew matrix", last=(2, 2))
    return np.asarray(0.5 * (M[..., 1, 0] - M[..., 0, 1]))[()]


def exp_so2(angle: npt.ArrayLike) -> Array:
    """The planar rotation by an angle: (...) [rad] → (..., 2, 2)."""
    return matrix_of_angle(as_floats(angle, "angle"))


def log_so2(R: Any) -> Array:
    """The angle of a planar rotation in (−π, π]; a half turn is π: (..., 2, 2) → (...) [rad]."""
    return to_theta(R)


def hat_se2(twist: npt.ArrayLike) -> Array:
    """The 3×3 matrix [[[ω], v], [0, 0]] of a planar twist [v; ω]: (..., 3) → (..., 3, 3)."""
    xi = as_floats(twist, "planar twist", last=(3,))
    matrix = np.zeros((*xi.shape[:-1], 3, 3))
    matrix[..., :2, :2] = hat_so2(xi[..., 2])
    matrix[..., :2, 2] = xi[..., :2]
    return matrix


def vee_se2(matrix: npt.ArrayLike) -> Array:
    """The planar twist [v; ω] of a 3×3 matrix, the inverse of hat_se2: (..., 3, 3) → (..., 3)."""
    M = as_floats(matrix, "planar twist matrix", last=(3, 3))
    return np.stack([M[..., 0, 2], M[..., 1, 2], 0.5 * (M[..., 1, 0] - M[..., 0, 1])], axis=-1)


def exp_se2(twist: npt.ArrayLike) -> Array:
    """The planar pose reached by moving along a constant twist: an arc about the pole, or a line.

    exp ξ = [[R(ω), V v], [0, 1]],  V = [[a, −b], [b, a]],  a = sin ω/ω,  b = (1 − cos ω)/ω.

    twist: [v; ω] (..., 3) [m, rad] → (..., 3, 3).
    """
    return exponential_se2(as_floats(twist, "planar twist", last=(3,)))


def log_se2(T: Any) -> Array:
    """The planar twist with −π < ω ≤ π that reaches a pose: exp_se2(log_se2(T)) = T.

    T: (..., 3, 3) → [v; ω] (..., 3) [m, rad].
    """
    return logarithm_se2(as_pose_2d(T))


def adjoint_2d(T: Any) -> Array:
    """The matrix that maps planar twists from frame b to frame a, ξ_a = Ad(T_a_b) ξ_b, order [v; ω].

    Ad(T) = [[R, (y, −x)ᵀ], [0, 1]] with (x, y) the translation.

    T: T_a_b (..., 3, 3) → (..., 3, 3).
    """
    Ad = as_pose_2d(T).copy()
    x, y = Ad[..., 0, 2].copy(), Ad[..., 1, 2].copy()
    Ad[..., 0, 2], Ad[..., 1, 2] = y, -x
    return Ad


def exponential_se2(xi: Array) -> Array:
    """exp_se2 without checks."""
    x, y, angle = xi[..., 0], xi[..., 1], xi[..., 2]
    half = 0.5 * angle
    a, b = sinc(angle), np.sin(half) * sinc(half)
    return assemble(matrix_of_angle(angle), np.stack([a * x - b * y, b * x + a * y], axis=-1))


def logarithm_se2(T: Array) -> Array:
    """log_se2 without checks."""
    x, y, angle = T[..., 0, 2], T[..., 1, 2], angle_of(T[..., :2, :2])
    half = 0.5 * angle
    a = x_cot_x(half)
    return np.stack([a * x + half * y, a * y - half * x, angle], axis=-1)


@show_fields
@dataclass(frozen=True, eq=False)
class Pole:
    """The point that a planar displacement leaves in place, if there is one.

    exists: (...) bool. point: (..., 2) [m], NaN where there is no pole. angle: the turn about it (...) in
    (−π, π] [rad], 0 for a pure translation. translation: (..., 2) [m], what a displacement without a pole
    moves by, and zero where there is a pole. False as a condition if no displacement has a pole.
    """

    exists: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    point: Array
    angle: Array
    translation: Array

    def __bool__(self) -> bool:
        return bool(np.any(self.exists))

    @property
    def reason(self) -> str:
        """Why there is no pole; empty if every displacement has one."""
        if np.all(self.exists):
            return ""
        if np.ndim(self.exists) == 0:
            x, y = self.translation
            return f"a pure translation by ({x:g}, {y:g}) has no fixed point"
        missing = int(np.sum(~self.exists))
        return f"{missing} of {np.size(self.exists)} displacements are pure translations and have no pole"


def pole_of(T: Any) -> Pole:
    """The pole of a planar displacement: the point c with R c + t = c, so that T rotates the plane about c.

    c = (t + cot(θ/2) t⊥)/2 with t⊥ = (−t_y, t_x). A turn up to tolerances.PURE_TRANSLATION_ANGLE counts as
    none: a pure translation has no pole, which is an answer (falsy, with `reason`), not an error. The
    identity leaves every point in place: a translation by zero, and no single pole.

    T: (..., 3, 3).
    """
    T = as_pose_2d(T)
    x, y, angle = T[..., 0, 2], T[..., 1, 2], angle_of(T[..., :2, :2])
    exists = np.abs(angle) > tolerances.PURE_TRANSLATION_ANGLE
    cot = 1.0 / np.tan(0.5 * np.where(exists, angle, 1.0))
    point = 0.5 * np.stack([x - cot * y, y + cot * x], axis=-1)
    return Pole(
        exists=np.asarray(exists)[()],
        point=np.where(exists[..., None], point, np.nan),
        angle=np.where(exists, angle, 0.0)[()],
        translation=np.where(exists[..., None], 0.0, T[..., :2, 2]),
    )


def left_jacobian_se2(twist: npt.ArrayLike) -> Array:
    """J with exp(ξ + δ) = exp(J δ) exp(ξ) to first order, in the order [v; ω].

    J = [[a, −b, p x + q y], [b, a, p y − q x], [0, 0, 1]] with a = sin ω/ω, b = (1 − cos ω)/ω,
    p = (1 − a)/ω and q = b/ω.

    twist: ξ = (x, y, ω) (..., 3) [m, rad] → (..., 3, 3). Source: Solà, Deray & Atchuthan 2018, section VI.
    """
    return left_jacobian(as_floats(twist, "planar twist", last=(3,)))


def right_jacobian_se2(twist: npt.ArrayLike) -> Array:
    """J with exp(ξ + δ) = exp(ξ) exp(J δ) to first order: left_jacobian_se2 at −ξ.

    twist: ξ (..., 3) [m, rad] → (..., 3, 3).
    """
    return left_jacobian(-as_floats(twist, "planar twist", last=(3,)))


def left_jacobian_inv_se2(twist: npt.ArrayLike) -> Array:
    """The inverse of left_jacobian_se2.

    twist: ξ (..., 3) [m, rad] → (..., 3, 3). Raises InputError at ω = 2π, 4π, …, where J is singular.
    """
    xi = as_floats(twist, "planar twist", last=(3,))
    half = 0.5 * xi[..., 2]
    if (np.abs(sinc(half)) <= tolerances.WHOLE_TURN).any():
        raise InputError("the Jacobian has no inverse at multiples of 2π other than zero (|ω| = 2π, 4π, …)")
    a = x_cot_x(half)
    inverse = _planar_block(a, -half)
    inverse[..., :2, 2] = -np.einsum("...ij,...j->...i", inverse[..., :2, :2], left_jacobian(xi)[..., :2, 2])
    return inverse


def right_jacobian_inv_se2(twist: npt.ArrayLike) -> Array:
    """The inverse of right_jacobian_se2; the derivative of log(T exp(δ)) with respect to δ.

    twist: ξ (..., 3) [m, rad] → (..., 3, 3). Raises InputError at multiples of 2π other than zero.
    """
    return left_jacobian_inv_se2(-as_floats(twist, "planar twist", last=(3,)))


def left_jacobian(xi: Array) -> Array:
    """left_jacobian_se2 without checks."""
    x, y, angle = xi[..., 0], xi[..., 1], xi[..., 2]
    half = 0.5 * angle
    p, q = _sine_rest(angle), 0.5 * sinc(half) ** 2
    J = _planar_block(sinc(angle), np.sin(half) * sinc(half))
    J[..., 0, 2] = p * x + q * y
    J[..., 1, 2] = p * y - q * x
    return J


def _planar_block(a: Array, b: Array) -> Array:
    """[[a, −b, 0], [b, a, 0], [0, 0, 1]]."""
    J = np.zeros((*np.shape(a), 3, 3))
    J[..., 0, 0] = J[..., 1, 1] = a
    J[..., 1, 0], J[..., 0, 1] = b, -b
    J[..., 2, 2] = 1.0
    return J


def _sine_rest(angle: Array) -> Array:
    """(1 − sin ω/ω)/ω: by its series below a radian, where the difference cancels."""
    square = angle * angle
    series = np.ones_like(square)
    for k in (17, 15, 13, 11, 9, 7, 5):
        series = 1.0 - square * series / (k * (k - 1))
    is_small = square < 1.0
    return np.where(is_small, angle * series / 6.0, (1.0 - sinc(angle)) / np.where(is_small, 1.0, angle))
