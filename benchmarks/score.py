"""Judges answers: residual by the plain forward kinematics, and how many of the true solutions were found."""

from __future__ import annotations

import numpy as np

from chains import Arm, Array, fk, jacobian

VERIFIED = 1e-6
"""Largest residual (max norm of the pose difference, m and unitless) of an answer that counts as a
solution."""

CANDIDATE = 1e-3
"""Largest residual of an answer that is worth polishing into a true solution."""

SOLVED = 1e-12
"""Largest residual of a polished solution: rounding of an arm of a few metres, no more."""


def wrap(angle: Array) -> Array:
    """Angles brought to (−π, π]."""
    return -((-angle + np.pi) % (2 * np.pi) - np.pi)


def residuals(arm: Arm, q: Array, T: Array) -> Array:
    """The max norm of fk(q) − T for q (k, n), one number per row."""
    return np.abs(fk(arm, q) - T).max(axis=(-1, -2)) if len(q) else np.zeros(0)


def same(arm: Arm, a: Array, b: Array, tolerance: float) -> Array:
    """Which rows of a (k, n) are the configuration b (n,), up to turns of the joints that turn."""
    gap = a - b
    return np.abs(np.where(arm.turns, wrap(gap), gap)).max(axis=-1) <= tolerance


def distinct(arm: Arm, q: Array, tolerance: float) -> Array:
    """The rows of q (k, n) without repetitions, up to turns."""
    kept: list[Array] = []
    for row in q:
        if not kept or not same(arm, np.array(kept), row, tolerance).any():
            kept.append(row)
    return np.array(kept).reshape(-1, q.shape[-1])


def polish(arm: Arm, q: Array, T: Array) -> Array:
    """The rows of q (k, n) brought by Newton's method to solutions of fk(q) = T; those that do not converge
    go.

    Near a singularity a configuration can be wrong by far more than its residual shows; a converged Newton
    iteration tells the solutions from their neighbourhood.
    """
    q = q[residuals(arm, q, T) <= CANDIDATE]
    for _ in range(8):
        if len(q) == 0:
            break
        now = fk(arm, q)
        turn = T[:3, :3] @ np.swapaxes(now[:, :3, :3], -1, -2)
        spin = np.stack(
            [turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]]
        )
        twist = np.concatenate([T[:3, 3] - now[:, :3, 3], spin.T / 2], axis=-1)
        J = jacobian(arm, q)
        if arm.dof == 6:
            step = np.linalg.solve(J, twist[..., None])[..., 0]
        else:
            step = (np.linalg.pinv(J) @ twist[..., None])[..., 0]
        q = q + np.clip(step, -1e-2, 1e-2)
    return q[residuals(arm, q, T) <= SOLVED]


def truth(arm: Arm, q_true: Array, T: Array, answers: list[Array], tolerance: float) -> Array:
    """The configurations (k, n) that reach T: the one it was made from and what any contender found,
    polished."""
    pool = np.concatenate([q_true[None], *(a for a in answers if len(a))])
    return distinct(arm, np.concatenate([q_true[None], polish(arm, pool, T)]), tolerance)


def resolution(arm: Arm, q: Array) -> Array:
    """How far q (k, n) may be off when the goal is off by its rounding: four units in the last place over the
    smallest singular value of the Jacobian. Closer configurations are one to anybody who computes in double
    precision."""
    weakest = np.linalg.svd(jacobian(arm, q), compute_uv=False)[:, -1]
    return 4 * np.finfo(float).eps / np.maximum(weakest, 1e-12)


def count_found(arm: Arm, true: Array, answer: Array, tolerance: float) -> int:
    """How many rows of true (k, n) are among the rows of answer, as far as double precision can tell."""
    if len(answer) == 0 or len(true) == 0:
        return 0
    limits = np.maximum(tolerance, resolution(arm, true))
    return sum(bool(same(arm, answer, row, limit).any()) for row, limit in zip(true, limits, strict=True))
