"""Inverse dynamics: the torques behind a motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.rows import EARTH, Wrenches, check_gravity, dynamic_rows, run_rows, torques_of_wrenches
from cspace.kinematics.batch import check_output, refuse_infinite
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
) -> Array:
    """The joint torques and forces behind a motion; see Robot.inverse_dynamics.

    q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,) [m/s²], wrenches: frame → (..., 6), expressed_in:
    their axes, "base" or "tip" (those of the frame). T_world_base (..., 4, 4), out (..., dof).
    Returns tau (..., dof) [N·m or N].
    Raises InputError for a wrong shape or NaN and where no link has a mass, UnknownNameError for an unknown
    frame.
    """
    pull = torques_of_wrenches(robot, q, wrenches, expressed_in, T_world_base)
    batch = dynamic_rows(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    shape = batch.shape if pull is None else np.broadcast_shapes(batch.shape, pull.shape[:-1])
    tau = check_output(out, (*shape, robot.dof))
    own = tau if shape == batch.shape else np.empty((*batch.shape, robot.dof))
    if not run_rows(robot, "inverse_dynamics", batch, batch.qdd, own, check_gravity(gravity), friction):
        refuse_infinite(batch)
    if pull is not None:
        np.subtract(own, pull, out=tau)
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
    tau = check_output(out, (*batch.shape, robot.dof))
    if not run_rows(robot, "inverse_dynamics", batch, None, tau, check_gravity(gravity), False):
        refuse_infinite(batch)
    return tau
