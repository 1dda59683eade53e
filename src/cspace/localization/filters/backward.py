"""Smoothers: what was known later about where the robot was earlier."""

from __future__ import annotations

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.localization.filters.forward import Passed
from cspace.localization.filters.timeline import Timeline
from cspace.localization.filters.updates import finish_update, move_pose
from cspace.math.wrapping import wrap_angle
from cspace.spatial.planar_twists import left_jacobian, logarithm_se2
from cspace.spatial import pose_2d


def smooth_interval(line: Timeline, passed: Passed) -> tuple[Array, Array]:
    """Poses (n, 3) and covariances (n, 3, 3) given all measurements (Rauch, Tung & Striebel 1965).

    With C = P Aᵀ (P⁻)⁻¹ and ζ = log(T⁻⁻¹ Tˢ) at the next node: Tˢ = T exp(C ζ), Pˢ = P + C (Jr⁻¹ Pˢ Jr⁻ᵀ − P⁻) Cᵀ.
    """
    poses, covariances = passed.poses.copy(), passed.covariances.copy()
    gains = make_gains(line, passed)
    for k in range(len(poses) - 2, -1, -1):
        zeta = relative_twist(passed.poses_before[k + 1], poses[k + 1])
        inside = carry_back(covariances[k + 1], zeta) - passed.covariances_before[k + 1]
        P = passed.covariances[k] + gains[k] @ inside @ gains[k].T
        poses[k], covariances[k] = finish_update(passed.poses[k], P, gains[k] @ zeta)
    return poses, covariances


def smooth_lag(line: Timeline, passed: Passed, lag: float) -> tuple[Array, Array]:
    """Poses and covariances given the measurements up to a lag [s] after each: (n, 3) and (n, 3, 3).

    All nodes go back at once, each from the last node within its lag.
    """
    n = len(line.times)
    last = np.searchsorted(line.times, line.times + lag, side="right") - 1
    last = np.maximum(last, np.arange(n))
    poses, covariances = passed.poses[last], passed.covariances[last]
    gains = make_gains(line, passed)
    at = last.copy()
    going = np.flatnonzero(at > np.arange(n))
    while len(going):
        k = at[going] - 1
        zeta = relative_twist(passed.poses_before[k + 1], poses[going])
        inside = carry_back(covariances[going], zeta) - passed.covariances_before[k + 1]
        P = passed.covariances[k] + gains[k] @ inside @ np.swapaxes(gains[k], -1, -2)
        xi = np.einsum("nij,nj->ni", gains[k], zeta)
        J = left_jacobian(-xi)
        P = J @ P @ np.swapaxes(J, -1, -2)
        poses[going] = move_pose(passed.poses[k], xi)
        covariances[going] = 0.5 * (P + np.swapaxes(P, -1, -2))
        at[going] = k
        going = going[k > going]
    return poses, covariances


def make_gains(line: Timeline, passed: Passed) -> Array:
    """C = P Aᵀ (P⁻)⁻¹ of each step (n − 1, 3, 3); directions that P⁻ knows exactly get none."""
    P, A = passed.covariances[:-1], line.A
    before = passed.covariances_before[1:]
    inverse = np.linalg.pinv(before, rcond=tolerances.KNOWN_EXACTLY, hermitian=True)
    return np.asarray(P @ np.swapaxes(A, -1, -2) @ inverse)


def relative_twist(poses: Array, others: Array) -> Array:
    """log(T⁻¹ T') of rows x, y, θ: (..., 3) and (..., 3) → (..., 3)."""
    c, s = np.cos(poses[..., 2]), np.sin(poses[..., 2])
    dx, dy = others[..., 0] - poses[..., 0], others[..., 1] - poses[..., 1]
    turn = wrap_angle(others[..., 2] - poses[..., 2])
    return logarithm_se2(pose_2d(xytheta=np.stack([c * dx + s * dy, c * dy - s * dx, turn], axis=-1)))


def carry_back(P: Array, zeta: Array) -> Array:
    """A covariance at T exp ζ as one of the disturbance at T: Jr⁻¹ P Jr⁻ᵀ."""
    J = np.linalg.inv(left_jacobian(-zeta))
    return np.asarray(J @ P @ np.swapaxes(J, -1, -2))
