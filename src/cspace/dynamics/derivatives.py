"""The first derivatives of inverse and of forward dynamics."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.forward import forward_dynamics, singular_error
from cspace.dynamics.rows import EARTH, check_gravity, dynamic_rows, fill_rows, refuse_rows, run_rows
from cspace.kinematics.batch import check_output
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def inverse_dynamics_derivatives(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> tuple[Array, Array, Array]:
    """∂tau/∂q, ∂tau/∂q̇ and ∂tau/∂q̈ = M of inverse dynamics.

    The position of a floating base is varied by a displacement [v; ω] in the axes of the world, its
    velocities and accelerations in these axes kept. Dry friction counts as constant.

    q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,), friction, T_world_base (..., 4, 4), threads: as
    in inverse_dynamics. out (..., 3, dof, dof): float64 array to write into; the answers are parts of it.

    Returns dq, dqd and M, each (..., dof, dof): row i holds the derivatives of tau[i].
    Raises InputError for a wrong shape or NaN and where no link has a mass.

    Carpentier and Mansard 2018; Singh, Russell and Wensing 2022.
    """
    batch = dynamic_rows(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    last, down = (3, robot.dof, robot.dof), check_gravity(gravity)
    slopes = fill_rows(robot, "derivatives", batch, batch.qdd, last, down, friction, out)
    return slopes[..., 0, :, :], slopes[..., 1, :, :], slopes[..., 2, :, :]


def forward_dynamics_derivatives(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    tau: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> tuple[Array, Array, Array]:
    """∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂tau = M⁻¹ of forward dynamics.

    They are −M⁻¹ times those of inverse dynamics at the acceleration that tau causes.

    q (..., n), qd, tau (..., dof), gravity, friction, T_world_base, threads: as in forward_dynamics. out
    (..., 3, dof, dof): as in inverse_dynamics_derivatives.

    Returns dq, dqd and M⁻¹, each (..., dof, dof).
    Raises InputError for a wrong shape or NaN, and where a joint moves no inertia.
    """
    qdd = forward_dynamics(
        robot, q, qd, tau, gravity=gravity, friction=friction, T_world_base=T_world_base, threads=threads
    )
    batch = dynamic_rows(robot, q, qd=qd, qdd=qdd, T_world_base=T_world_base, threads=threads)
    last, down = (3, robot.dof, robot.dof), check_gravity(gravity)
    slopes = check_output(out, (*batch.shape, *last))
    if not run_rows(robot, "responses", batch, batch.qdd, slopes, down, friction):
        refuse_rows(batch)
        raise singular_error(robot, batch)
    return slopes[..., 0, :, :], slopes[..., 1, :, :], slopes[..., 2, :, :]
