"""The configurations of a goal that a planner chooses from: within limits, the nearest to a seed first."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.buffer_pool import pooled_array
from cspace.ik.goals.given import checked_poses, too_far
from cspace.ik.on_limits import settle_on_limits
from cspace.ik.solver import Solver
from cspace.model import Limits
from cspace.tolerances import DOUBLE_SOLUTION

POSE_ROWS: Final = slice(6)
"""Of the Jacobian: all that a pose constrains."""

NO_SEED: Final = np.empty(0)
"""Joints that a singular pose leaves free take any value."""


def sort_near(solver: Solver, q: Array, limits: Limits, seed: Array) -> Array:
    """Of solutions q (..., dof) of poses those within limits (k, dof), the nearest to a seed (dof,) first.

    Each revolute joint is moved by the multiple of 2π within its limits that is nearest to the seed. Rows
    of NaN are left out.
    """
    bounds = np.ascontiguousarray(limits.lower), np.ascontiguousarray(limits.upper), seed, DOUBLE_SOLUTION
    rows, is_doubtful = _core._ik_sort_near(solver, q, *bounds)
    if is_doubtful:
        given = q.reshape(-1, solver.dof)
        given = given[np.isfinite(given[:, 0])]
        settled = settle_on_limits(solver, given, limits, POSE_ROWS)
        rows, _ = _core._ik_sort_near(solver, np.ascontiguousarray(settled), *bounds)
    return rows


def solve_locked_near(solver: Solver, T: Array, values: Array, limits: Limits, seed: Array) -> Array:
    """The solutions of a pose T (4, 4) with the redundant joints at values (n, r), sorted as by sort_near.

    Raises InputError for what is not a pose.
    """
    bounds = np.ascontiguousarray(limits.lower), np.ascontiguousarray(limits.upper), seed
    rows = _core._ik_locked_near(solver, T, values, *bounds)
    if rows is None:
        checked_poses(T)
        raise too_far("goal", T[:3, 3])
    return rows


def solve_each_locked_near(
    solver: Solver, T: Array, values: Array, limits: Limits, seeds: Array, threads: int
) -> list[Array]:
    """The same of poses T (n, 4, 4), each with a seed of its own (n, dof), on so many threads.

    What is not a pose has no solutions.
    """
    bounds = np.ascontiguousarray(limits.lower), np.ascontiguousarray(limits.upper), seeds
    rows, counts = _core._ik_each_locked_near(solver, T, values, *bounds, threads)
    sizes = np.maximum(counts, 0)
    ends = np.cumsum(sizes)
    return [rows[a:b] for a, b in zip((ends - sizes).tolist(), ends.tolist(), strict=True)]


def solve_locked_redundant(solver: Solver, T: Array, values: Array) -> tuple[Array, npt.NDArray[np.int64]]:
    """Every solution of poses T (n, 4, 4) with the redundant joints of an arm locked at values (n, r).

    Returns q (n, room, dof) with NaN behind the solutions, and how many each pose has (n,). The poses are
    checked: rotations, none of them too far away.
    """
    joints = list(solver.redundant_joints)
    n, room = len(T), _core._ik_locked_room(solver, joints)
    at = np.zeros((n, solver.dof))
    at[:, joints] = values
    q = pooled_array((n, room, solver.dof))
    count, status = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.uint8)
    branch, self_motion = np.empty((n, room), dtype=np.int8), np.empty((n, room), dtype=bool)
    threads = int(_core._ik_has_closed_form(solver))  # closed forms take less than it takes to begin another
    rows = q, branch, self_motion, count, status, threads
    _core._ik_locked_rows(solver, joints, at, np.ascontiguousarray(T), NO_SEED, *rows)
    return q, count
