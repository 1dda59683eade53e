"""Forward dynamics: the accelerations under given torques."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from cspace.arrays import Array
from cspace.dynamics.float_rows import is_single, output_in, pushes_in, refuse_overflow, refuse_unfit, rows_in
from cspace.dynamics.mass_matrix import mass_matrix
from cspace.dynamics.rows import EARTH, Wrenches, check_gravity, push_rows, run_rows
from cspace.errors import InputError
from cspace.kinematics.batch import Batch
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tolerances import INERTIA_ROUNDING


def forward_dynamics(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    tau: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    wrenches: Wrenches | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
    dtype: DTypeLike = np.float64,
) -> Array:
    """The accelerations of the joints under given torques; see Robot.forward_dynamics.

    q (..., n) [rad or m], qd, tau (..., dof), gravity (3,) [m/s²], wrenches: frame → (..., 6), expressed_in:
    their axes, "base" or "tip" (those of the frame). T_world_base (..., 4, 4), out (..., dof). dtype:
    float64, or float32 to compute in single precision.
    Returns qdd (..., dof) [rad/s² or m/s²].
    Raises InputError for a wrong shape or NaN, and where a joint moves no inertia, UnknownNameError for an
    unknown frame.
    """
    single = is_single(dtype)
    batch = rows_in(single, robot, q, qd=qd, tau=tau, T_world_base=T_world_base, threads=threads)
    batch, pushes = push_rows(robot, batch, wrenches, expressed_in)
    qdd = output_in(single, out, (*batch.shape, robot.dof))
    down, applied = check_gravity(gravity), pushes_in(single, pushes)
    if not run_rows(robot, "forward_dynamics", batch, batch.tau, qdd, down, friction, applied):
        refuse_unfit(batch)
        raise singular_error(robot, batch)
    refuse_overflow(qdd)
    return qdd


def singular_error(robot: KinematicModel, batch: Batch) -> InputError:
    """Names the joint that moves least in the first configuration where the mass matrix is singular."""
    row = _first_singular(robot, batch)
    q = batch.q[row]
    M = mass_matrix(robot, q.astype(np.float64))
    size = np.sqrt(np.maximum(np.abs(np.diag(M)), np.finfo(float).tiny))
    values, vectors = np.linalg.eigh(M / np.outer(size, size))
    weakest = vectors[:, 0] / size
    names = [*("vx", "vy", "vz", "ωx", "ωy", "ωz")[: 6 if robot.floating else 0], *robot.joint_names]
    joint = names[int(np.argmax(np.abs(weakest)))]
    where = "" if not batch.shape else f" at row {row}"
    if values[0] < -INERTIA_ROUNDING:
        return InputError(
            f"the mass matrix of {robot.name} is not positive{where}: joint {joint!r} moves a negative"
            " inertia; mend the links that robot.inertia_report() names"
        )
    return InputError(
        f"the mass matrix of {robot.name} is singular{where}: joint {joint!r} moves no inertia;"
        " give its links a mass or the joint an armature (see robot.inertia_report())"
    )


def _first_singular(robot: KinematicModel, batch: Batch) -> int:
    """The number of the first row without an answer."""
    low, high = 0, len(batch.q)
    while high - low > 1:
        middle = (low + high) // 2
        if _is_regular(robot, batch, low, middle):
            low = middle
        else:
            high = middle
    return low


def _is_regular(robot: KinematicModel, batch: Batch, begin: int, end: int) -> bool:
    rest = np.zeros((end - begin, robot.dof), batch.q.dtype)
    base = batch.T_world_base
    part = replace(
        batch,
        q=batch.q[begin:end],
        qd=rest,
        T_world_base=base if base is None or len(base) == 1 else base[begin:end],
    )
    return run_rows(robot, "forward_dynamics", part, rest, rest.copy(), np.zeros(3), False)
