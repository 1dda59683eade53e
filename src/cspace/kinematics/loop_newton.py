"""Newton's method for closed loops: some coordinates given, the others found, many configurations at once."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.kinematics.assembly import Numbers
from cspace.kinematics.loop_constraints import LoopConstraints, Placement
from cspace.kinematics.loop_freedom import find_rank_tolerance, find_scaled_jacobian
from cspace.tolerances import LOOP_CLOSED

MOST_STEPS: Final = 200
"""Of a damped iteration: a double root gains a factor of four per step, from 1 to 1e-16 in 30 of them."""

MOST_POLISHES: Final = 6
"""Undamped steps at the end: each squares the residual, which is below 1e-3 there."""

LONGEST_STEP: Final = 0.5
"""Of one iteration, in radians and sizes of the mechanism: further away the linear equations mean nothing."""

FIRST_DAMPING, LESS, MORE = 1e-1, 0.3, 4.0
"""Of Levenberg and Marquardt, relative to the square of the residual, and its factors after a success and a
failure."""

MOST_DAMPING: Final = 1e12
"""Beyond it a step no longer changes a double."""


def close_rows(constraints: LoopConstraints, q: Array, passive: Numbers) -> tuple[Array, Array]:
    """Configurations (m, n) near those given whose loops are closed, or nearly; the residuals (m,) [m].

    passive (k,): the numbers of the coordinates that may move. The residual is infinite where a loop is
    closed upside down.
    """
    q = reduce_residuals(constraints, q.copy(), passive)
    q = polish_rows(constraints, q, passive)
    return q, constraints.find_miss(constraints.place(q))


def reduce_residuals(constraints: LoopConstraints, q: Array, passive: Numbers) -> Array:
    """The damped iteration of Levenberg and Marquardt on the rows (m, n) that are not yet closed."""
    if passive.size == 0:
        return q
    active = np.arange(len(q))
    damping = np.full(len(q), FIRST_DAMPING)
    for _ in range(MOST_STEPS):
        at = constraints.place(q[active])
        phi = at.phi * constraints.scale
        size = np.linalg.norm(phi, axis=-1)
        J, unit = select_columns(constraints, at, passive)
        slope = np.einsum("mri,mr->mi", J, phi)
        goes_on = (size > 0.1 * LOOP_CLOSED) & (damping[active] < MOST_DAMPING)
        goes_on &= np.linalg.norm(slope, axis=-1) > LOOP_CLOSED * size
        active, phi, size, J, slope = (each[goes_on] for each in (active, phi, size, J, slope))
        if active.size == 0:
            break
        H = np.einsum("mri,mrj->mij", J, J)
        mu = damping[active] * size * size + np.finfo(float).eps * np.trace(H, axis1=-2, axis2=-1)
        H[:, np.arange(passive.size), np.arange(passive.size)] += mu[:, None]
        step = shorten_steps(-np.linalg.solve(H, slope[..., None])[..., 0])
        tried = q[active]
        tried[:, passive] += step * unit
        after = np.linalg.norm(constraints.place(tried).phi * constraints.scale, axis=-1)
        better = after < size
        q[active[better]] = tried[better]
        damping[active] = np.where(better, damping[active] * LESS, damping[active] * MORE)
    return q


def polish_rows(
    constraints: LoopConstraints, q: Array, passive: Numbers, steps: int = MOST_POLISHES
) -> Array:
    """Undamped steps of least length, while they make the residual smaller."""
    if passive.size == 0 or len(q) == 0:
        return q
    at = constraints.place(q)
    size = np.linalg.norm(at.phi * constraints.scale, axis=-1)
    for _ in range(steps):
        phi = at.phi * constraints.scale
        J, unit = select_columns(constraints, at, passive)
        tried = q.copy()
        tried[:, passive] += shorten_steps(-solve_least(J, phi, find_rank_tolerance(constraints, at))) * unit
        after_at = constraints.place(tried)
        after = np.linalg.norm(after_at.phi * constraints.scale, axis=-1)
        better = after < size
        if not better.any():
            break
        q = np.where(better[:, None], tried, q)
        size = np.where(better, after, size)
        at = after_at if better.all() else constraints.place(q)
    return q


def select_columns(constraints: LoopConstraints, at: Placement, passive: Numbers) -> tuple[Array, Array]:
    """The scaled columns of K (..., r, k) of coordinates, and their units (k,)."""
    columns = passive + constraints.robot.dof - len(constraints.robot.joint_names)
    return find_scaled_jacobian(constraints, at)[..., columns], constraints.unit[columns]


def solve_least(J: Array, b: Array, tolerance: Array) -> Array:
    """x (..., k) of least length that makes J x − b (..., r) least; smaller singular values count as zero."""
    U, s, Vt = np.linalg.svd(J, full_matrices=False)
    keeps = s > tolerance[..., None] * s[..., :1]
    weights = np.einsum("...ri,...r->...i", U, b) / np.where(keeps, s, 1.0) * keeps
    result: Array = np.einsum("...ij,...i->...j", Vt, weights)
    return result


def shorten_steps(step: Array) -> Array:
    """Steps (..., k) of at most LONGEST_STEP."""
    largest = np.abs(step).max(axis=-1, initial=0.0)[..., None]
    result: Array = step * np.minimum(1.0, LONGEST_STEP / np.maximum(largest, LONGEST_STEP))
    return result
