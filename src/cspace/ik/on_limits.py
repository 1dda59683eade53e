"""Double solutions at a joint limit.

Where two solutions meet, a solver finds them to the square root of the rounding, some 1e-8 rad; a joint that
stands on its limit there may come out beyond it. The configuration on the limit then reaches the same pose,
since the error lies along a direction in which the tip does not move to first order.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.ik.solver import Solver
from cspace.ik.wrapping import into_limits, measure_violations
from cspace.model import Limits
from cspace.tolerances import DOUBLE_DIRECTION, DOUBLE_SOLUTION, SAME_TIP

STEPS = 4
"""Corrections of a configuration: each squares an error of 1e-7 or less, and any may add a joint."""


def keep_within(
    solver: Solver, q: Array, limits: Limits, rows: slice, order: npt.NDArray[np.int64] | None = None
) -> tuple[Array, npt.NDArray[np.int64]]:
    """Of the rows q (..., k, dof) those inside limits, moved by multiples of 2π, NaN behind them, and their
    number (...,). order (..., k): receives the numbers of the rows kept, and of the others behind them.
    rows: of the Jacobian that the goals count, as of settle_on_limits.
    """
    counts, room = q.shape[:-2], q.shape[-2]
    given = np.ascontiguousarray(q, dtype=float).reshape(-1, room, solver.dof)
    kept, count = np.empty(given.shape), np.empty(len(given), dtype=np.int64)
    bounds = np.ascontiguousarray(limits.lower), np.ascontiguousarray(limits.upper)

    def keep(configurations: Array) -> npt.NDArray[np.int64]:
        arrays = configurations, *bounds, kept, count, order
        return np.asarray(_core._ik_keep_within(solver, *arrays, SAME_TIP, DOUBLE_SOLUTION))

    close = keep(given)
    if len(close) and solver.dof <= rows.stop:
        given = given.copy()
        flat = given.reshape(-1, solver.dof)
        for row in close:
            flat[row] = settle_row(solver, flat[row], limits, rows)
        keep(given)
    return kept.reshape(q.shape), count.reshape(counts)


def settle_on_limits(solver: Solver, q: Array, limits: Limits, rows: slice) -> Array:
    """Configurations (..., dof), those beyond a limit by DOUBLE_SOLUTION or less replaced by the one on the
    limit if it reaches the same goal. rows: of the Jacobian that the goal counts.

    An arm with more joints than rows could be brought onto a limit anywhere, locked joints among them: its
    configurations stay as they are.
    """
    bounds = solver.joint_types, limits.lower, limits.upper
    if solver.dof > rows.stop:
        return q
    outside = np.nonzero(~into_limits(q, *bounds, SAME_TIP)[1])
    excess = measure_violations(q[outside], *bounds, SAME_TIP)
    close = (excess <= DOUBLE_SOLUTION).all(axis=-1) & (excess > 0).any(axis=-1)
    if not close.any():
        return q
    settled = q.copy()
    for index in zip(*(axis[close] for axis in outside), strict=True):
        settled[index] = settle_row(solver, q[index], limits, rows)
    return settled


def settle_row(solver: Solver, q: Array, limits: Limits, rows: slice) -> Array:
    """The configuration (dof,) on the limits that q breaks, or q where it does not reach the same goal.

    Newton's method in the joints that are not on a limit.
    """
    bounds = solver.joint_types, limits.lower, limits.upper
    T, x, locked = solver.fk(q), q, np.zeros(len(q), dtype=bool)
    for _ in range(STEPS):
        x, _ = into_limits(x, *bounds, DOUBLE_SOLUTION)  # joints slightly beyond a limit are set to it
        locked = locked | (x == limits.lower) | (x == limits.upper)
        J = solver.jacobian(x)[rows]
        miss = measure_displacement(solver.fk(x), T)[rows]
        size = max(1.0, float(np.abs(J).max()))
        if np.abs(miss).max() <= SAME_TIP * size and into_limits(x, *bounds, SAME_TIP)[1]:
            return x
        x = x.copy()
        x[~locked] += np.linalg.lstsq(J[:, ~locked], miss, rcond=DOUBLE_DIRECTION)[0]
    return q


def measure_displacement(T_from: Array, T_to: Array) -> Array:
    """The small motion [v; ω] (6,) that takes a pose to another one, to first order."""
    turn = T_to[:3, :3] @ T_from[:3, :3].T
    w = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return np.concatenate([T_to[:3, 3] - T_from[:3, 3], w])
