"""Time parametrisation by toppra and copp-py, on a given grid of a cubic spline."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from cspace.trajectory import Path

Peer = Callable[[], np.ndarray]
"""A call that returns the squared speeds at the places of the grid."""


def toppra_call(path: Path, velocity: np.ndarray, acceleration: np.ndarray, grid: np.ndarray | None) -> Peer:
    """toppra 0.6 with its own solver, by interpolation; grid: None for its automatic one."""
    import toppra as ta

    ta.setup_logging("ERROR")
    spline = ta.SplineInterpolator(path.breaks, path(path.breaks), bc_type=_ends(path))
    limits = [
        ta.constraint.JointVelocityConstraint(np.stack([-velocity, velocity], axis=1)),
        ta.constraint.JointAccelerationConstraint(
            np.stack([-acceleration, acceleration], axis=1),
            discretization_scheme=ta.constraint.DiscretizationType.Interpolation,
        ),
    ]

    def call() -> np.ndarray:
        options: dict[str, Any] = {"solver_wrapper": "seidel", "parametrizer": "ParametrizeConstAccel"}
        instance = ta.algorithm.TOPPRA(limits, spline, gridpoints=grid, **options)
        instance.compute_trajectory()
        call.grid = instance.gridpoints  # type: ignore[attr-defined]
        return np.asarray(instance.problem_data.sd_vec) ** 2

    return call


def copp_call(path: Path, velocity: np.ndarray, acceleration: np.ndarray, grid: np.ndarray) -> Peer:
    """copp-py 0.2 by reachability analysis; the derivatives of the path on the grid are prepared."""
    import copp_py as copp

    topp = copp.solver.topp2_ra
    derivatives = [path(grid, order) for order in range(3)]

    def call() -> np.ndarray:
        robot = copp.Robot(path.dof, capacity=len(grid))
        robot.append_s(grid)
        robot.set_q(*derivatives, 0)
        robot.add_velocity_limits(velocity, -velocity, start_idx_s=0, length=len(grid))
        robot.add_acceleration_limits(acceleration, -acceleration, start_idx_s=0, length=len(grid))
        return np.asarray(topp.solve(topp.Problem(robot.constraints, (0, len(grid) - 1), (0.0, 0.0))))

    call.grid = grid  # type: ignore[attr-defined]
    return call


def copp_jerk_call(
    path: Path,
    velocity: np.ndarray,
    acceleration: np.ndarray,
    jerk: np.ndarray,
    grid: np.ndarray,
    rounds: int = 1,
) -> Peer:
    """Durations of copp-py under limits of jerk: solved so many times around the last answer, at first that
    without them. The derivatives of the path on the grid are prepared."""
    import copp_py as copp

    topp2, topp3 = copp.solver.topp2_ra, copp.solver.topp3_socp
    derivatives = [path(grid, order) for order in range(4)]
    length = len(grid)

    def call() -> np.ndarray:
        robot = copp.Robot(path.dof, capacity=length)
        robot.append_s(grid)
        robot.set_q(*derivatives[:3], 0, dddq=derivatives[3])
        robot.add_velocity_limits(velocity, -velocity, start_idx_s=0, length=length)
        robot.add_acceleration_limits(acceleration, -acceleration, start_idx_s=0, length=length)
        robot.add_jerk_limits(jerk, -jerk, start_idx_s=0, length=length)
        squares = np.asarray(topp2.solve(topp2.Problem(robot.constraints, (0, length - 1), (0.0, 0.0))))
        for _ in range(rounds):
            profile = topp3.solve(topp3.Problem(robot.constraints, squares))
            squares = np.asarray(profile.a)
        return np.asarray(copp.interpolation.s_to_t_topp3(grid, profile)[1])

    return call


def _ends(path: Path) -> str:
    return "natural" if np.abs(path([0.0, path.length], 2)).max() < 1e-9 else "not-a-knot"


def duration(grid: np.ndarray, squared_speed: np.ndarray) -> float:
    """Seconds along a grid at squared speeds, linear between its places."""
    root = np.sqrt(np.maximum(squared_speed, 0.0))
    return float((2.0 * np.diff(grid) / (root[:-1] + root[1:])).sum())


def excess(
    path: Path,
    grid: np.ndarray,
    x: np.ndarray,
    velocity: np.ndarray,
    acceleration: np.ndarray,
    rises: np.ndarray | float = 0.0,
) -> tuple[float, float]:
    """By which share velocities and accelerations exceed their limits, at ten places of each interval.

    x: squared speeds at the places of the grid, quadratic between them with rises, or linear.
    """
    step = np.diff(grid)
    most = np.zeros(2)
    for share in np.linspace(0.0, 1.0, 11):
        s = np.clip(grid[:-1] + share * step, 0.0, path.length)
        squared = np.maximum(x[:-1] + share * np.diff(x) + 2.0 * share * (1.0 - share) * rises, 0.0)
        u = (np.diff(x) + 2.0 * (1.0 - 2.0 * share) * rises) / (2.0 * step)
        slope, bend = path(s, 1), path(s, 2)
        qd, qdd = slope * np.sqrt(squared)[:, None], bend * squared[:, None] + slope * u[:, None]
        most = np.maximum(most, [(np.abs(qd) / velocity).max(), (np.abs(qdd) / acceleration).max()])
    return float(most[0] - 1.0), float(most[1] - 1.0)
