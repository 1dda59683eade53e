"""Updates of a pose and its covariance by a measurement: extended, iterated, unscented, information form.

The state is a pose T with a disturbance on the right, T exp ξ, ξ normal with covariance P in base, so every
update is T ← T exp ξ⁺ with P ← Jr(ξ⁺) P⁺ Jr(ξ⁺)ᵀ. Sources: Thrun, Burgard & Fox 2005, chapter 3; Barfoot
2017, section 8.2; Bell & Cathey 1993 (the iterated filter is Gauss–Newton).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.localization.filters.measurements import Measurement
from cspace.localization.filters.rows import move_pose
from cspace.math.wrapping import wrap_angle
from cspace.spatial.planar_twists import left_jacobian

ITERATIONS: Final = 10
"""Most iterations of the iterated filter; three to five reach the last digit."""

SPREAD: Final = 0.5
"""α of the unscented filter: how far its sigma points lie out, in √3 standard deviations."""
PRIOR: Final = 2.0
"""β of the unscented filter: best for normal distributions."""


@dataclass(frozen=True, eq=False)
class Innovation:
    """A measurement less its prediction, ν (d,), and the covariance S (d, d) of that."""

    value: Array
    covariance: Array

    @property
    def nis(self) -> float:
        """νᵀ S⁻¹ ν, χ² with d degrees of freedom for a consistent filter."""
        return float(self.value @ np.linalg.solve(self.covariance, self.value))


Update = Callable[[Array, Array, Measurement], tuple[Array, Array]]


def measure_innovation(pose: Array, P: Array, measurement: Measurement) -> Innovation:
    """ν and S = H P Hᵀ + R at a pose (3,) with covariance P (3, 3). Raises InputError where S is singular."""
    H, R = measurement.linearize(pose)
    S = H @ P @ H.T + R
    if not np.linalg.det(S) > 0:
        raise InputError("the covariance of an innovation is singular; give the sensor deviations above zero")
    return Innovation(subtract_values(measurement, measurement.value, measurement.predict(pose)), S)


def subtract_values(measurement: Measurement, a: Array, b: Array) -> Array:
    """a − b (..., d), with angles wrapped after the subtraction."""
    return np.where(measurement.angular, wrap_angle(a - b), a - b)


def update_extended(pose: Array, P: Array, measurement: Measurement) -> tuple[Array, Array]:
    """The extended Kalman filter: one linearisation, Joseph form."""
    return iterate_update(pose, P, measurement, 1)


def update_iterated(pose: Array, P: Array, measurement: Measurement) -> tuple[Array, Array]:
    """The iterated extended Kalman filter: Gauss–Newton on prior and measurement, the prior kept."""
    return iterate_update(pose, P, measurement, ITERATIONS)


def iterate_update(pose: Array, P: Array, measurement: Measurement, most: int) -> tuple[Array, Array]:
    """ξ ← K (ν(ξ) + H ξ) with H linearised anew at T exp ξ in each iteration."""
    xi = np.zeros(3)
    for _ in range(most):
        at = move_pose(pose, xi)
        H, R = measurement.linearize(at)
        H = H @ right_jacobian(xi)
        K = np.linalg.solve(H @ P @ H.T + R, H @ P).T
        before = xi
        xi = K @ (subtract_values(measurement, measurement.value, measurement.predict(at)) + H @ xi)
        if np.abs(xi - before).max() < tolerances.ITERATED_STEP:
            break
    A = np.eye(3) - K @ H
    return finish_update(pose, A @ P @ A.T + K @ R @ K.T, xi)


def update_information(pose: Array, P: Array, measurement: Measurement) -> tuple[Array, Array]:
    """The information form: Y ← Y + Hᵀ R⁻¹ H, ξ = Y⁻¹ Hᵀ R⁻¹ ν. Raises InputError where P has no inverse."""
    H, R = measurement.linearize(pose)
    known = np.linalg.eigvalsh(P)
    if known[0] <= tolerances.KNOWN_EXACTLY * known[-1]:
        raise InputError(
            "the information form has no finite information for a pose known exactly; give start_covariance"
            " above zero, or use filter='ekf'"
        )
    Y = np.linalg.inv(P)
    weighted = np.linalg.solve(R, H).T
    after: Array = np.asarray(np.linalg.inv(Y + weighted @ H), dtype=np.float64)
    residual = subtract_values(measurement, measurement.value, measurement.predict(pose))
    return finish_update(pose, after, after @ weighted @ residual)


def update_unscented(pose: Array, P: Array, measurement: Measurement) -> tuple[Array, Array]:
    """The unscented Kalman filter: sigma points T exp χ, averaged about the central one.

    Angles are averaged as offsets from the central point: a mean of sines and cosines would flip by π, as the
    central weight is below zero for small α. Source: Julier & Uhlmann 1997; Wan & van der Merwe 2000.
    """
    n = len(P)
    spread = SPREAD**2 * n
    root = spread**0.5 * factor_covariance(P)
    chi = np.concatenate([np.zeros((1, n)), root.T, -root.T])
    weights = np.full(2 * n + 1, 0.5 / spread)
    weights[0] = 1.0 - n / spread
    seen = measurement.predict(move_pose(pose, chi))
    offsets = subtract_values(measurement, seen, seen[0])
    mean = weights @ offsets
    spread_weights = weights.copy()
    spread_weights[0] += 1.0 - SPREAD**2 + PRIOR
    around = offsets - mean
    S = (around * spread_weights[:, None]).T @ around + measurement.linearize(pose)[1]
    K = np.linalg.solve(S, (around * spread_weights[:, None]).T @ chi).T
    residual = subtract_values(measurement, subtract_values(measurement, measurement.value, seen[0]), mean)
    return finish_update(pose, P - K @ S @ K.T, K @ residual)


def finish_update(pose: Array, P: Array, xi: Array) -> tuple[Array, Array]:
    """The pose moved by ξ, and its covariance carried to the new pose and symmetrised."""
    J = right_jacobian(xi)
    P = J @ P @ J.T
    return move_pose(pose, xi), 0.5 * (P + P.T)


def right_jacobian(xi: Array) -> Array:
    """Jr(ξ) (3, 3), without checks."""
    return left_jacobian(-xi)


def factor_covariance(P: Array) -> Array:
    """L with L Lᵀ = P, of a P that may be singular."""
    values, vectors = np.linalg.eigh(P)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


UPDATES: Final[dict[str, Update]] = {
    "ekf": update_extended,
    "iekf": update_iterated,
    "information": update_information,
    "ukf": update_unscented,
}
"""The filters by name."""
