"""Smoothers: what was known later about where the robot was earlier.

Between two nodes without a measurement in between, a step of the Rauch–Tung–Striebel smoother spans any
number of steps of odometry, as their transitions are adjoints: C = P Ad(T⁻⁻¹ T)ᵀ (P⁻)⁻¹ with T⁻, P⁻
predicted at the later one. With ζ = log(T⁻⁻¹ Tˢ) there, the earlier one becomes Tˢ = T exp(C ζ) with Pˢ = P
+ C (Jr⁻¹ Pˢ Jr⁻ᵀ − P⁻) Cᵀ.
"""

from __future__ import annotations

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.localization.filters.forward import Passed
from cspace.localization.filters.rows import adjoin_rows, carry_covariance, find_twist, move_pose, relate_rows
from cspace.localization.filters.timeline import Timeline
from cspace.localization.log import Ids
from cspace.spatial.planar_twists import left_jacobian


def smooth_interval(line: Timeline, passed: Passed) -> tuple[Array, Array]:
    """Poses (n, 3) and covariances (n, 3, 3) given all measurements (Rauch, Tung & Striebel 1965).

    From anchor to anchor, then all nodes between at once.
    """
    poses, covariances = passed.poses.copy(), passed.covariances.copy()
    for k in range(len(line.anchors) - 1, 0, -1):
        to, later = line.anchors[k - 1 : k], line.anchors[k : k + 1]
        poses[to], covariances[to] = go_back(passed, to, later, poses[later], covariances[later])
    nodes = np.arange(len(poses))
    later = line.anchors[np.searchsorted(line.anchors, nodes)]
    between = np.flatnonzero(later > nodes)
    later = later[between]
    poses[between], covariances[between] = go_back(passed, between, later, poses[later], covariances[later])
    return poses, covariances


def smooth_lag(line: Timeline, passed: Passed, lag: float) -> tuple[Array, Array]:
    """Poses and covariances given the measurements up to a lag [s] after each: (n, 3) and (n, 3, 3).

    All nodes go back at once, each from the last anchor within its lag.
    """
    nodes = np.arange(len(line.times))
    horizon = np.searchsorted(line.times, line.times + lag, side="right") - 1
    at = np.maximum(line.anchors[np.searchsorted(line.anchors, horizon, side="right") - 1], nodes)
    poses, covariances = passed.poses[at], passed.covariances[at]
    going = np.flatnonzero(at > nodes)
    while len(going):
        later = at[going]
        earlier = line.anchors[np.maximum(np.searchsorted(line.anchors, later) - 1, 0)]
        to = np.maximum(earlier, going)
        poses[going], covariances[going] = go_back(passed, to, later, poses[going], covariances[going])
        at[going] = to
        going = going[to > going]
    return poses, covariances


def go_back(passed: Passed, to: Ids, later: Ids, poses: Array, covariances: Array) -> tuple[Array, Array]:
    """Smoothed poses and covariances at nodes `to`, from those at later nodes: (m, 3) and (m, 3, 3)."""
    before, P_before = passed.poses_before[later], passed.covariances_before[later]
    A = adjoin_rows(relate_rows(before, passed.poses[to]))
    inverse = np.linalg.pinv(P_before, rcond=tolerances.KNOWN_EXACTLY, hermitian=True)
    C = passed.covariances[to] @ np.swapaxes(A, -1, -2) @ inverse
    zeta = find_twist(before, poses)
    to_earlier: Array = np.asarray(np.linalg.inv(left_jacobian(-zeta)), dtype=np.float64)
    inside = carry_covariance(to_earlier, covariances) - P_before
    xi = np.einsum("nij,nj->ni", C, zeta)
    P = carry_covariance(left_jacobian(-xi), passed.covariances[to] + carry_covariance(C, inside))
    return move_pose(passed.poses[to], xi), 0.5 * (P + np.swapaxes(P, -1, -2))
