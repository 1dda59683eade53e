"""How the exponential changes with its argument: left and right Jacobians of SO(3) and SE(3).

With the left Jacobian J, exp(x + δ) = exp(J δ) exp(x) to first order in δ, with the right one
exp(x + δ) = exp(x) exp(J δ). The right Jacobian at x is the left one at −x.
Source: Barfoot 2017, State Estimation for Robotics, sections 7.1.5 and 7.3.4.
"""

from __future__ import annotations

from math import factorial

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial.rotations import checked_angle_and_axis, skew
from cspace.spatial.twists import sinc, stack_blocks


def left_jacobian_so3(rotvec: npt.ArrayLike) -> Array:
    """J with exp(w + δ) = exp(J δ) exp(w) to first order.

    J = I + (1 − cos θ)/θ [u] + (1 − sin θ/θ) [u]².

    rotvec: w (..., 3) [rad] → (..., 3, 3).
    """
    w = as_floats(rotvec, "rotation vector", last=(3,))
    angle, axis = checked_angle_and_axis(w, "rotation vector")
    half = 0.5 * angle
    return _polynomial(axis, np.sin(half) * sinc(half), 1.0 - sinc(angle))


def right_jacobian_so3(rotvec: npt.ArrayLike) -> Array:
    """J with exp(w + δ) = exp(w) exp(J δ) to first order; ω_body = J dw/dt.

    rotvec: w (..., 3) [rad] → (..., 3, 3).
    """
    return left_jacobian_so3(-as_floats(rotvec, "rotation vector", last=(3,)))


def left_jacobian_inv_so3(rotvec: npt.ArrayLike) -> Array:
    """The inverse of left_jacobian_so3: I − θ/2 [u] + (1 − θ/2 cot θ/2) [u]².

    rotvec: w (..., 3) [rad] → (..., 3, 3). Raises InputError at 2π, 4π, …, where J is singular.
    """
    w = as_floats(rotvec, "rotation vector", last=(3,))
    angle, axis = checked_angle_and_axis(w, "rotation vector")
    half = 0.5 * angle
    ratio = sinc(half)
    if (np.abs(ratio) <= tolerances.WHOLE_TURN).any():
        raise InputError("the Jacobian has no inverse at multiples of 2π other than zero (|w| = 2π, 4π, …)")
    return _polynomial(axis, -half, 1.0 - np.cos(half) / ratio)


def right_jacobian_inv_so3(rotvec: npt.ArrayLike) -> Array:
    """The inverse of right_jacobian_so3; the derivative of log(R exp(δ)) with respect to δ.

    rotvec: w (..., 3) [rad] → (..., 3, 3). Raises InputError at 2π, 4π, …, where J is singular.
    """
    return left_jacobian_inv_so3(-as_floats(rotvec, "rotation vector", last=(3,)))


def left_jacobian_se3(twist: npt.ArrayLike) -> Array:
    """J with exp(ξ + δ) = exp(J δ) exp(ξ) to first order, [[J_so3, Q], [0, J_so3]] in the order [v; ω].

    twist: ξ (..., 6) [m, rad] → (..., 6, 6).
    """
    xi = as_floats(twist, "twist", last=(6,))
    return stack_blocks(left_jacobian_so3(xi[..., 3:]), _coupling(xi))


def right_jacobian_se3(twist: npt.ArrayLike) -> Array:
    """J with exp(ξ + δ) = exp(ξ) exp(J δ) to first order, in the order [v; ω].

    twist: ξ (..., 6) [m, rad] → (..., 6, 6).
    """
    return left_jacobian_se3(-as_floats(twist, "twist", last=(6,)))


def left_jacobian_inv_se3(twist: npt.ArrayLike) -> Array:
    """The inverse of left_jacobian_se3, [[J⁻¹, −J⁻¹ Q J⁻¹], [0, J⁻¹]].

    twist: ξ (..., 6) [m, rad] → (..., 6, 6). Raises InputError at multiples of 2π other than zero.
    """
    xi = as_floats(twist, "twist", last=(6,))
    J = left_jacobian_inv_so3(xi[..., 3:])
    return stack_blocks(J, -J @ _coupling(xi) @ J)


def right_jacobian_inv_se3(twist: npt.ArrayLike) -> Array:
    """The inverse of right_jacobian_se3; the derivative of log(T exp(δ)) with respect to δ.

    twist: ξ (..., 6) [m, rad] → (..., 6, 6). Raises InputError at multiples of 2π other than zero.
    """
    return left_jacobian_inv_se3(-as_floats(twist, "twist", last=(6,)))


def _polynomial(axis: Array, first: Array, second: Array) -> Array:
    """I + first [u] + second [u]²; the rounding stays below that of the two coefficients."""
    U = skew(axis)
    return np.asarray(np.eye(3) + first[..., None, None] * U + second[..., None, None] * (U @ U))


def _coupling(xi: Array) -> Array:
    """Q(ξ) of Barfoot 2017, eq. 7.86, with the powers of θ moved from the matrices into the coefficients."""
    angle, axis = checked_angle_and_axis(xi[..., 3:], "the rotation of the twist")
    V, U = skew(xi[..., :3]), skew(axis)
    UV, VU = U @ V, V @ U
    UVU = UV @ U
    second, third, fourth = (x[..., None, None] for x in _coupling_coefficients(angle))
    return np.asarray(
        0.5 * V
        + second * (UV + VU + angle[..., None, None] * UVU)
        + third * (U @ UV + VU @ U - 3.0 * UVU)
        + fourth * (UVU @ U + U @ UVU)
    )


def _coupling_coefficients(angle: Array) -> tuple[Array, Array, Array]:
    """(θ − sin θ)/θ², (θ² + 2 cos θ − 2)/(2 θ²) and (2 θ − 3 sin θ + θ cos θ)/(2 θ²).

    The first and the last cancel: below one radian their power series are summed.
    """
    small, large = np.minimum(angle, 1.0), np.maximum(angle, 1.0)
    middle = 0.5 * (1.0 - sinc(0.5 * angle) ** 2)
    first_series = small * _alternating(small, [1.0 / factorial(2 * m + 3) for m in range(8)])
    last_series = small**3 * _alternating(small, [(m + 1.0) / factorial(2 * m + 5) for m in range(8)])
    first = np.where(angle < 1.0, first_series, (1.0 - sinc(large)) / large)
    last = np.where(angle < 1.0, last_series, (2.0 - 3.0 * sinc(large) + np.cos(large)) / (2.0 * large))
    return first, middle, last


def _alternating(x: Array, coefficients: list[float]) -> Array:
    """Σ cₘ (−x²)ᵐ, by Horner's rule."""
    total = np.zeros_like(x)
    for c in reversed(coefficients):
        total = c - x * x * total
    return total
