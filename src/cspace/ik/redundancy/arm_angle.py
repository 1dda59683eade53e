"""The swivel of an arm with two spherical joints: its elbow about the line from shoulder to wrist."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.ik.answers import EXACT, UNREACHABLE
from cspace.ik.context import About
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solver import HasSolver, Solver, as_solver
from cspace.tolerances import FARTHEST

BRANCHES = 8
JOINTS = 7


def swivel(robot: HasSolver, q: Any) -> Array:
    """The angle of the elbow about the line from shoulder to wrist.

    ψ = atan2(n · (z × e), z · e), n = (W − S)/|W − S|, z = r − (r · n) n.

    robot: a Robot or a Solver. q (..., 7) [rad] → ψ (...) [rad]. S: where axes 1, 2, 3 meet, W: where axes
    5, 6, 7 do, e: from S to the point of axis 4 nearest to S, r: the direction of axis 1. Where W lies on
    axis 1 a fixed direction perpendicular to it stands for r. Raises InputError for an arm that is not built
    so. M. Shimizu et al. 2008, section II.
    """
    solver = as_solver(robot).check_swivel()
    rows = as_floats(q, "q", last=(JOINTS,), largest=FARTHEST)
    out = np.empty(int(np.prod(rows.shape[:-1])))
    _core._ik_swivels(solver, np.ascontiguousarray(rows.reshape(-1, JOINTS)), out)
    return out.reshape(rows.shape[:-1])


def solve_swivel(solver: Solver, T: Array, angle: Any) -> Solutions | SolutionsBatch:
    """Every solution at given swivels; goals and swivels are broadcast against each other."""
    angles = as_floats(angle, "swivel", largest=FARTHEST)
    shape = leading_axes(goal=T.shape[:-2], swivel=angles.shape)
    goals = np.ascontiguousarray(np.broadcast_to(T, (*shape, 4, 4)))
    swivels = np.ascontiguousarray(np.broadcast_to(angles, shape).reshape(-1))
    q = np.empty((len(swivels), BRANCHES, JOINTS))
    _core._ik_swivel_rows(solver.check_swivel(), goals.reshape(-1, 4, 4), swivels, q)
    real = np.isfinite(q[..., 0])
    verdict = np.where(real.any(axis=-1), EXACT, UNREACHABLE).astype(np.uint8)
    if shape:  # the rows of each goal first
        order = np.argsort(~real, axis=-1, kind="stable")
        q, count = np.take_along_axis(q, order[..., None], axis=-2), real.sum(axis=-1)
        return SolutionsBatch.of(solver, goals, q, count, verdict, About(), np.zeros(real.shape, dtype=bool))
    rows, numbers = q[0, real[0]], np.flatnonzero(real[0])
    note = None if len(rows) else "no swivel reaches the goal, because the wrist centre is out of reach"
    return Solutions.of(solver, goals, int(verdict[0]), rows, numbers, (False,) * len(rows), note)
