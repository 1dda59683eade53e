"""Exact arcs: where a constant body twist leads, sideways motion included, and how that changes with it."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, leading_axes
from cspace.spatial import adjoint_2d, as_pose_2d, exp_se2, right_jacobian_se2
from cspace.tolerances import FARTHEST_POINT


def drive(T_map_base: Any, twist: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
    """The pose of a vehicle after it moved with a constant twist for a time: T exp(ξ dt).

    T_map_base: planar poses (..., 3, 3). twist: ξ = [vx, vy, ω] in base (..., 3) [m/s, rad/s]. dt: (...) [s],
    below zero to go back in time. Leading axes broadcast. Returns (..., 3, 3). Exact: an arc about the pole
    of the twist, or a line.
    """
    T = as_pose_2d(T_map_base, "T_map_base")
    xi, time = _steps(twist, dt)
    leading_axes(T_map_base=T.shape[:-2], twist=xi.shape[:-1], dt=time.shape)
    return np.asarray(T @ exp_se2(xi * time[..., None]))


def arc_jacobians(twist: npt.ArrayLike, dt: npt.ArrayLike) -> tuple[Array, Array]:
    """How the end of an arc changes with its start, F, and with its twist, G, both as twists in base.

    T exp(δ) exp((ξ + η) dt) = T exp(ξ dt) exp(F δ + G η) to first order: F = Ad(exp(−ξ dt)), G = dt Jr(ξ dt).

    twist: [vx, vy, ω] (..., 3) [m/s, rad/s]. dt: (...) [s]. Returns F and G (..., 3, 3).
    """
    xi, time = _steps(twist, dt)
    step = xi * time[..., None]
    return adjoint_2d(exp_se2(-step)), time[..., None, None] * right_jacobian_se2(step)


def compose_increments(poses: Array, increments: Array) -> Array:
    """The rows x, y, θ of poses followed by increments in them: (..., 3) and (..., 3) → (..., 3)."""
    c, s = np.cos(poses[..., 2]), np.sin(poses[..., 2])
    x, y = increments[..., 0], increments[..., 1]
    moved = [poses[..., 0] + c * x - s * y, poses[..., 1] + s * x + c * y, poses[..., 2] + increments[..., 2]]
    return np.stack(moved, axis=-1)


def chain_increments(start: Array, increments: Array) -> Array:
    """The poses (n + 1, 3) that increments (n, 3) lead to one after the other from a start (3,); θ is not
    wrapped."""
    theta = start[2] + np.concatenate([[0.0], np.cumsum(increments[:, 2])])
    c, s = np.cos(theta[:-1]), np.sin(theta[:-1])
    x, y = increments[:, 0], increments[:, 1]
    poses = np.empty((len(increments) + 1, 3))
    poses[0, :2], poses[:, 2] = start[:2], theta
    poses[1:, 0] = start[0] + np.cumsum(c * x - s * y)
    poses[1:, 1] = start[1] + np.cumsum(s * x + c * y)
    return poses


def _steps(twist: npt.ArrayLike, dt: npt.ArrayLike) -> tuple[Array, Array]:
    xi = as_floats(twist, "twist", last=(3,), largest=FARTHEST_POINT)
    time = as_floats(dt, "dt", largest=FARTHEST_POINT)
    leading_axes(twist=xi.shape[:-1], dt=time.shape)
    return xi, time
