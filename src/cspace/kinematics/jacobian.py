"""The geometric Jacobian of a frame or a point, and its time derivative."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.errors import InputTypeError
from cspace.kinematics.batch import check_choice, check_output, frame_number, rows_of
from cspace.kinematics.forward import compute_chain
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike

AXES = ("base", "tip")
"""The axes in which a Jacobian can be expressed."""


def jacobian(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The geometric Jacobian of a frame, or of a point fixed to it; see Robot.jacobian.

    q (..., n) [rad or m], point (..., 3) [m] in the frame, T_world_base (..., 4, 4), out (..., 6, dof).
    Returns J (..., 6, dof), rows [v; ω]; rows of NaN in q as in fk.
    Raises InputError for a wrong shape or any other NaN, UnknownNameError for an unknown frame or axes.
    """
    number, in_tip = frame_number(robot, frame), check_choice(expressed_in, "expressed_in", AXES) == "tip"
    batch = rows_of(robot, q, point=point, T_world_base=T_world_base, threads=threads)
    J = check_output(out, (*batch.shape, 6, robot.dof))
    compute_chain(robot, number, batch, J=J, in_tip=in_tip)
    return J


def fk_jacobian(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    out: tuple[Array, Array] | None = None,
    threads: int | None = None,
) -> tuple[Array, Array]:
    """The pose and the Jacobian of a frame in one pass; see Robot.fk_jacobian, which is this function.

    q (..., n) [rad or m], point (..., 3) [m] in the frame, T_world_base (..., 4, 4), out: the pair (..., 4,
    4) and (..., 6, dof). Returns T (..., 4, 4) and J (..., 6, dof), rows [v; ω]; T is that of the frame,
    whatever the point. Raises InputError for a wrong shape or NaN, UnknownNameError for an unknown frame or
    axes.
    """
    number, in_tip = frame_number(robot, frame), check_choice(expressed_in, "expressed_in", AXES) == "tip"
    if out is not None and not (isinstance(out, tuple | list) and len(out) == 2):
        raise InputTypeError("out must be the pair of arrays (T, J) to write into")
    batch = rows_of(robot, q, point=point, T_world_base=T_world_base, threads=threads)
    T = check_output(out and out[0], (*batch.shape, 4, 4), "out[0]")
    J = check_output(out and out[1], (*batch.shape, 6, robot.dof), "out[1]")
    compute_chain(robot, number, batch, T=T, J=J, in_tip=in_tip)
    return T, J


def jacobian_dot(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    frame: str | None = None,
    *,
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The time derivative of the Jacobian at the velocities qd.

    d/dt J(q(t)) = Σᵢ ∂J/∂qᵢ q̇ᵢ, so that the acceleration of the point is [v̇; ω̇] = J q̈ + J̇ q̇ (in base
    axes).

    q (..., n) [rad or m]. qd (..., dof) [rad/s or m/s]; of a floating base [v; ω; joints], the twist of the
    base at its origin in world axes. frame, point (..., 3), expressed_in, T_world_base (..., 4, 4),
    threads: as in jacobian; out (..., 6, dof): array to write into. In "tip" it is the derivative of the
    matrix that jacobian gives in "tip".

    Returns J̇ (..., 6, dof).
    Raises InputError for a wrong shape or NaN, UnknownNameError for an unknown frame or axes.

    Siciliano et al. 2009, section 3.8 (without the detour over angles).
    """
    if qd is None:
        raise InputTypeError("qd is None; the derivative needs the velocities (..., dof)")
    number, in_tip = frame_number(robot, frame), check_choice(expressed_in, "expressed_in", AXES) == "tip"
    batch = rows_of(robot, q, qd=qd, point=point, T_world_base=T_world_base, threads=threads)
    J_rate = check_output(out, (*batch.shape, 6, robot.dof))
    compute_chain(robot, number, batch, J_rate=J_rate, in_tip=in_tip)
    return J_rate
