"""The first derivatives of inverse and of forward dynamics."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.forward import forward_dynamics, singular_error
from cspace.dynamics.rows import (
    EARTH,
    Push,
    Wrenches,
    check_gravity,
    dynamic_rows,
    fill_rows,
    push_rows,
    refuse_rows,
    run_rows,
)
from cspace.kinematics.batch import Batch, check_output
from cspace.kinematics.jacobian import jacobian_dot
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike

ROWS_AT_ONCE: Final = 256
"""How many configurations are differentiated at once: their Jacobians are dof matrices each."""


def inverse_dynamics_derivatives(
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
) -> tuple[Array, Array, Array]:
    """∂tau/∂q, ∂tau/∂q̇ and ∂tau/∂q̈ = M of inverse dynamics.

    The position of a floating base is varied by a displacement [v; ω] in the axes of the world, its
    velocities and accelerations in these axes kept. Dry friction counts as constant. Wrenches keep their
    numbers in the axes that expressed_in names, and move with their frames.

    q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,), wrenches, expressed_in, friction, T_world_base
    (..., 4, 4), threads: as in inverse_dynamics. out (..., 3, dof, dof): float64 array to write into; the
    answers are parts of it.

    Returns dq, dqd and M, each (..., dof, dof): row i holds the derivatives of tau[i].
    Raises InputError for a wrong shape or NaN and where no link has a mass, UnknownNameError for an unknown
    frame.

    Carpentier and Mansard 2018; Singh, Russell and Wensing 2022.
    """
    batch = dynamic_rows(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    batch, pushes = push_rows(robot, batch, wrenches, expressed_in)
    last, down = (3, robot.dof, robot.dof), check_gravity(gravity)
    slopes = fill_rows(robot, "derivatives", batch, batch.qdd, last, down, friction, out)
    if pushes:
        slopes[..., 0, :, :] -= _differentiate_pushes(robot, batch, pushes)
    return slopes[..., 0, :, :], slopes[..., 1, :, :], slopes[..., 2, :, :]


def forward_dynamics_derivatives(
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
) -> tuple[Array, Array, Array]:
    """∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂tau = M⁻¹ of forward dynamics.

    They are −M⁻¹ times those of inverse dynamics at the acceleration that tau causes.

    q (..., n), qd, tau (..., dof), gravity, wrenches, expressed_in, friction, T_world_base, threads: as in
    forward_dynamics. out (..., 3, dof, dof): as in inverse_dynamics_derivatives.

    Returns dq, dqd and M⁻¹, each (..., dof, dof).
    Raises InputError for a wrong shape or NaN, and where a joint moves no inertia, UnknownNameError for an
    unknown frame.
    """
    qdd = forward_dynamics(
        robot,
        q,
        qd,
        tau,
        gravity=gravity,
        wrenches=wrenches,
        expressed_in=expressed_in,
        friction=friction,
        T_world_base=T_world_base,
        threads=threads,
    )
    batch = dynamic_rows(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    batch, pushes = push_rows(robot, batch, wrenches, expressed_in)
    last, down = (3, robot.dof, robot.dof), check_gravity(gravity)
    slopes = check_output(out, (*batch.shape, *last))
    if not run_rows(robot, "responses", batch, batch.qdd, slopes, down, friction):
        refuse_rows(batch)
        raise singular_error(robot, batch)
    if pushes:
        slopes[..., 0, :, :] += slopes[..., 2, :, :] @ _differentiate_pushes(robot, batch, pushes)
    return slopes[..., 0, :, :], slopes[..., 1, :, :], slopes[..., 2, :, :]


def _differentiate_pushes(robot: KinematicModel, batch: Batch, pushes: list[Push]) -> Array:
    """∂(Σ Jᵀ w)/∂q (..., dof, dof), column j along the unit velocity of coordinate j."""
    total = np.zeros((len(batch.q), robot.dof, robot.dof))
    for push in pushes:
        for begin in range(0, len(batch.q), ROWS_AT_ONCE):
            rows = slice(begin, begin + ROWS_AT_ONCE)
            place = batch.T_world_base
            rates = jacobian_dot(
                robot,
                batch.q[rows, None],
                np.eye(robot.dof),
                robot.frames[push.frame],
                expressed_in="tip" if push.in_tip else "base",
                T_world_base=place if place is None or len(place) == 1 else place[rows, None],
                threads=batch.threads,
            )
            wrench = push.wrench if len(push.wrench) == 1 else push.wrench[rows]
            total[rows] += np.einsum("rjki,rk->rij", rates, np.broadcast_to(wrench, (len(rates), 6)))
    return total.reshape(*batch.shape, robot.dof, robot.dof)
