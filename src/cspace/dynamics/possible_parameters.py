"""Dynamic parameters that bodies can have: a least squares fit in logarithmic Cholesky coordinates."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.dynamics.base_parameters import BaseParameters
from cspace.dynamics.regressor import BODY, TENSOR, moving_bodies, parameters
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.tolerances import CONVERGED_FIT

LOG_SPREAD: Final = 1.0
"""Prior standard deviation of logarithms of masses, radii of gyration and resistances: a factor of e."""

LENGTH_SPREAD: Final = 0.1
"""Prior standard deviation of centres of mass and of shears [m]: the size of a link."""

UNKNOWN_MASS: Final = 1.0
"""Prior mass of a body without one [kg]."""

UNKNOWN_GYRATION: Final = 0.1
"""Prior radius of gyration of a body without mass [m]."""

LEAST_EXTENT: Final = 0.002
"""Prior extent of a body along a direction without one [m], such as that of a point: its logarithm is
finite."""

UNKNOWN_RESISTANCE: Final = 0.01
"""Prior armature, damping and dry friction where there are none, in their SI units: their logarithm is
finite."""

LARGEST_WEIGHT: Final = 1e10
"""Largest entry of the equations: those of exact data would hide the prior in their rounding."""

MOST_STEPS: Final = 200
"""Of the Gauss–Newton method; ten to thirty are usual."""

SHEARS: Final = ((0, 1), (1, 2), (0, 2))
"""Entries of the upper triangular factor beside its diagonal and last column."""

SLOWER, FASTER = 10.0, 0.3
"""What the damping of the Gauss–Newton method is multiplied by after a step that failed or succeeded."""


def fit_possible(robot: KinematicModel, base: BaseParameters, R: Array, friction: bool) -> Array:
    """Parameters π (p,) of bodies that can exist, with the base parameters as the data have them.

    Minimises |R₁ B π(θ) − R₂|² + |(θ − θ₀) / spread|² over θ, where the pseudo-inertia of each body is
    positive definite for every θ, and θ₀ are the parameters of the robot. R = [R₁ R₂] (b + 1, b + 1): the
    weighted equations of the base parameters.

    Rucker and Wensing 2022; Levenberg 1944, Marquardt 1963.
    """
    b, bodies = len(base), len(moving_bodies(robot._assembly))
    start = to_coordinates(parameters(robot, friction=friction), bodies)
    spread = np.full(len(start), LOG_SPREAD)
    for k in range(bodies):
        spread[10 * k + 4 : 10 * k + 10] = LENGTH_SPREAD
    A, c = R[:b, :b] @ base.matrix, R[:b, b]
    weight = min(1.0, LARGEST_WEIGHT / max(1.0, float(np.abs(A).max(initial=0.0))))
    A, c = weight * A, weight * c

    def residual(theta: Array) -> Array:
        return np.concatenate([A @ to_parameters(theta, bodies) - c, (theta - start) / spread])

    theta, left, damping = start, residual(start), 1.0
    for _ in range(MOST_STEPS):
        J = np.concatenate([A @ parameter_slopes(theta, bodies), np.diag(1.0 / spread)])
        Q, triangle = np.linalg.qr(np.concatenate([J, np.diag(np.sqrt(damping) / spread)]))
        step = np.linalg.solve(triangle, -left @ Q[: len(left)])
        step /= max(1.0, float(np.abs(step / spread).max(initial=0.0)))  # no factor beyond e at once
        ahead = residual(theta + step)
        gain = left @ left - ahead @ ahead
        if gain > 0.0:
            theta, left, damping = theta + step, ahead, FASTER * damping
            if gain <= CONVERGED_FIT * (ahead @ ahead):
                break
        else:
            damping *= SLOWER
            if np.abs(step / spread).max(initial=0.0) <= CONVERGED_FIT:
                break
    return to_parameters(theta, bodies)


def to_coordinates(pi: Array, bodies: int) -> Array:
    """θ (p,) of parameters; those that no body can have are moved to the nearest border first."""
    width = len(BODY) * bodies
    logs = np.log(np.where(pi[width:] > 0.0, pi[width:], UNKNOWN_RESISTANCE))
    return np.concatenate([*(body_coordinates(row) for row in pi[:width].reshape(-1, len(BODY))), logs])


def body_coordinates(row: Array) -> Array:
    """(α, d₁, d₂, d₃, s₁₂, s₂₃, s₁₃, t₁, t₂, t₃) of one body, with the pseudo-inertia U Uᵀ and
    U = e^α [[e^d₁, s₁₂, s₁₃, t₁], [0, e^d₂, s₂₃, t₂], [0, 0, e^d₃, t₃], [0, 0, 0, 1]]."""
    m = row[0] if row[0] > 0.0 else UNKNOWN_MASS
    center = row[1:4] / m if row[0] > 0.0 else np.zeros(3)
    about_origin = row[4:][TENSOR] if row[0] > 0.0 else 2.0 * m * UNKNOWN_GYRATION**2 * np.eye(3)
    spread = 0.5 * np.trace(about_origin) * np.eye(3) - about_origin - m * np.outer(center, center)
    moments, axes = np.linalg.eigh(spread)
    spread = axes @ np.diag(np.maximum(moments, m * LEAST_EXTENT**2)) @ axes.T
    U = np.linalg.cholesky(spread[::-1, ::-1])[::-1, ::-1] / np.sqrt(m)  # upper triangular
    shears = [U[i, j] for i, j in SHEARS]
    return np.array([0.5 * np.log(m), *np.log(np.diag(U)), *shears, *center])


def body_factors(theta: Array) -> Array:
    """The factors U (bodies, 4, 4) of coordinates (bodies, 10)."""
    U = np.zeros((len(theta), 4, 4))
    for i in range(3):
        U[:, i, i], U[:, i, 3] = np.exp(theta[:, 1 + i]), theta[:, 7 + i]
    for k, (i, j) in enumerate(SHEARS):
        U[:, i, j] = theta[:, 4 + k]
    U[:, 3, 3] = 1.0
    return np.exp(theta[:, 0])[:, None, None] * U


def to_parameters(theta: Array, bodies: int) -> Array:
    """The parameters π (p,) of coordinates θ (p,)."""
    width = len(BODY) * bodies
    U = body_factors(theta[:width].reshape(bodies, -1))
    return np.concatenate([read_pseudo_inertia(U @ np.swapaxes(U, -1, -2)).ravel(), np.exp(theta[width:])])


def parameter_slopes(theta: Array, bodies: int) -> Array:
    """∂π/∂θ (p, p)."""
    width = len(BODY) * bodies
    rows = theta[:width].reshape(bodies, -1)
    U, size = body_factors(rows), np.exp(rows[:, 0])
    slopes = np.zeros((len(BODY), bodies, 4, 4))
    slopes[0] = U
    for i in range(3):
        slopes[1 + i, :, i, i], slopes[7 + i, :, i, 3] = size * np.exp(rows[:, 1 + i]), size
    for k, (i, j) in enumerate(SHEARS):
        slopes[4 + k, :, i, j] = size
    half = slopes @ np.swapaxes(U, -1, -2)
    by_coordinate = read_pseudo_inertia(half + np.swapaxes(half, -1, -2))  # (10, bodies, 10)
    result = np.diag(np.concatenate([np.zeros(width), np.exp(theta[width:])]))
    for k in range(bodies):
        part = slice(10 * k, 10 * k + 10)
        result[part, part] = by_coordinate[:, k].T
    return result


def read_pseudo_inertia(J: Array) -> Array:
    """The ten parameters (..., 10) of pseudo-inertias [[½ tr(I) 1 − I, h], [hᵀ, m]] (..., 4, 4)."""
    second = J[..., :3, :3]
    inertia = np.trace(second, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - second
    upper = inertia[..., (0, 0, 0, 1, 1, 2), (0, 1, 2, 1, 2, 2)]
    return np.concatenate([J[..., 3, 3, None], J[..., :3, 3], upper], axis=-1)
