"""Inverse dynamics: the torques behind a motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from cspace.arrays import Array
from cspace.dynamics.float_rows import is_single, output_in, pushes_in, refuse_overflow, refuse_unfit, rows_in
from cspace.dynamics.rows import EARTH, Wrenches, check_gravity, dynamic_rows, fill_rows, push_rows, run_rows
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def inverse_dynamics(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
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
    """The joint torques and forces behind a motion; see Robot.inverse_dynamics.

    q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,) [m/s²], wrenches: frame → (..., 6), expressed_in:
    their axes, "base" or "tip" (those of the frame). T_world_base (..., 4, 4), out (..., dof). dtype:
    float64, or float32 to compute in single precision.
    Returns tau (..., dof) [N·m or N].
    Raises InputError for a wrong shape or NaN and where no link has a mass, UnknownNameError for an unknown
    frame.
    """
    single = is_single(dtype)
    batch = rows_in(single, robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    batch, pushes = push_rows(robot, batch, wrenches, expressed_in)
    tau = output_in(single, out, (*batch.shape, robot.dof))
    down, applied = check_gravity(gravity), pushes_in(single, pushes)
    if not run_rows(robot, "inverse_dynamics", batch, batch.qdd, tau, down, friction, applied):
        refuse_unfit(batch)
    refuse_overflow(tau)
    return tau


def gravity_torques(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The torques and forces that hold the weight of the robot at rest; see Robot.gravity_torques.

    q (..., n) [rad or m], gravity (3,) [m/s²], T_world_base (..., 4, 4), out (..., dof).
    Returns g (..., dof) [N·m or N].
    Raises InputError for a wrong shape or NaN and where no link has a mass.
    """
    batch = dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads)
    down = check_gravity(gravity)
    return fill_rows(robot, "inverse_dynamics", batch, None, (robot.dof,), down, False, out)
