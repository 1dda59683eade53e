"""How each solution moves with its goal."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array
from cspace.ik.conditions import arm_length
from cspace.ik.solver import Solver
from cspace.tolerances import NO_DERIVATIVE


def solve_derivative(solver: Solver, q: Array, position_only: bool = False) -> Array:
    """dq per twist of the goal: the pseudo-inverse of the Jacobian, (..., dof, 6).

    q: (..., dof) [rad, m], rows of NaN allowed. A goal that moves by the base twist [v; ω] (v the velocity of
    its origin [m/s], ω [rad/s]) moves the solution by derivative @ twist. Where the arm has more joints than
    the goal asks for it is the smallest motion; where fewer, it counts for twists that the arm can follow.
    NaN where the solution is singular. position_only: the goal is a point, and ω makes no difference.
    """
    scale = np.ones(6)
    scale[:3] /= arm_length(solver)
    out = np.full((*q.shape[:-1], solver.dof, 6), np.nan)
    real = np.isfinite(q).all(axis=-1)
    if not real.any():
        return out
    J = scale[:, None] * solver.jacobian(q[real])
    rows = 3 if position_only else 6
    U, sigma, Vt = np.linalg.svd(J[:, :rows], full_matrices=False)
    regular = sigma[:, -1] > NO_DERIVATIVE * sigma[:, 0]
    inverse = np.einsum("kji,kj,klj->kil", Vt, 1 / np.where(regular[:, None], sigma, np.nan), U)
    found = np.zeros((len(J), solver.dof, 6))
    found[..., :rows] = inverse * scale[:rows]
    found[~regular] = np.nan
    out[real] = found
    return out
