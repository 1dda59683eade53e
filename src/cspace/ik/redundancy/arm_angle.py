"""The swivel of an arm with two spherical joints: its elbow about the line from shoulder to wrist."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import InputError, InputTypeError
from cspace.ik.solutions import EXACT, UNREACHABLE, Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.kinematics.batch import check_robot
from cspace.tolerances import FARTHEST

__all__ = ["solve_swivel", "swivel"]

BRANCHES = 8
JOINTS = 7


def swivel(robot: Any, q: Any) -> Array:
    """The angle of the elbow about the line from shoulder to wrist.

    ψ = atan2(n · (z × e), z · e), n = (W − S)/|W − S|, z = r − (r · n) n.

    q (..., 7) [rad] → ψ (...) [rad]. S: where axes 1, 2, 3 meet, W: where axes 5, 6, 7 do, e: from S to the
    point of axis 4 nearest to S, r: the direction of axis 1. Where W lies on axis 1 a fixed direction
    perpendicular to it stands for r. Raises InputError for an arm that is not built so. M. Shimizu et al.
    2008, section II.
    """
    check_robot(robot)
    solver = swivel_solver(robot)
    rows = as_floats(q, "q", last=(JOINTS,), largest=FARTHEST)
    out = np.empty(int(np.prod(rows.shape[:-1])))
    solver.swivels(np.ascontiguousarray(rows.reshape(-1, JOINTS)), out)
    return out.reshape(rows.shape[:-1])


def swivel_solver(robot: Any) -> _core.SwivelSolver:
    """The solver of an arm, built once. Raises InputError for an arm without a swivel in closed form."""
    solver = robot.__dict__.get("_swivel")
    if solver is None:
        chain = robot.chain
        if chain.joint_types != "R" * JOINTS or chain.dof != JOINTS:
            raise InputError(f"{robot.name} has no swivel: that takes seven joints that turn")
        solver = _core.SwivelSolver(
            np.ascontiguousarray(chain.axes), np.ascontiguousarray(chain.points), np.array(chain.T_zero)
        )
        if not solver.serves:
            raise InputError(
                f"{robot.name} has no swivel in closed form: axes 1, 2, 3 must meet in a point, axes 5, 6, 7"
                " in another, to rounding; lock a joint with locked= instead"
            )
        robot._swivel = solver
    return cast(_core.SwivelSolver, solver)


def solve_swivel(robot: Any, T: Array, angle: Any, near: Any) -> Solutions | SolutionsBatch:
    """Every solution at given swivels; goals and swivels are broadcast against each other."""
    solver = swivel_solver(robot)
    angles = as_floats(angle, "swivel", largest=FARTHEST)
    shape = leading_axes(goal=T.shape[:-2], swivel=angles.shape)
    goals = np.broadcast_to(T, (*shape, 4, 4)).reshape(-1, 4, 4) if T.ndim > 2 else T[None]
    swivels = np.ascontiguousarray(np.broadcast_to(angles, shape).reshape(-1))
    q = np.empty((len(swivels), BRANCHES, JOINTS))
    solver.solve(np.ascontiguousarray(goals), swivels, q)
    if shape:
        if near is not None:
            raise InputTypeError("near= with swivel= is for one goal; a batch has .nearest(q)")
        return batch_of(robot, np.ascontiguousarray(np.broadcast_to(T, (*shape, 4, 4))), q, shape)
    real = np.isfinite(q[0, :, 0])
    rows = np.ascontiguousarray(q[0, real])
    note = None if len(rows) else "nothing reaches the goal, whatever the swivel: its wrist is out of reach"
    made = _core._ik_make(
        robot,
        np.ascontiguousarray(T),
        EXACT if len(rows) else UNREACHABLE,
        rows,
        tuple(int(b) for b in np.flatnonzero(real)),
        (False,) * len(rows),
        note,
    )
    found = cast(Solutions, made)
    return found if near is None else found.nearest(near)


def batch_of(robot: Any, T: Array, q: Array, shape: tuple[int, ...]) -> SolutionsBatch:
    """The rows of each goal first, NaN behind them."""
    real = np.isfinite(q[..., 0])
    order = np.argsort(~real, axis=-1, kind="stable")
    q = np.take_along_axis(q, order[..., None], axis=-2).reshape(*shape, BRANCHES, JOINTS)
    count = real.sum(axis=-1).reshape(shape)
    verdict = np.where(count, EXACT, UNREACHABLE).astype(np.uint8)
    return SolutionsBatch(robot, T, q, count, verdict)
