"""The Coriolis matrix."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.rows import NO_GRAVITY, dynamic_rows, fill_rows
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def coriolis_matrix(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The Coriolis matrix C(q, q̇): C q̇ are the forces of velocities, and Ṁ = C + Cᵀ.

    Of all matrices with these forces it is the one of Christoffel's symbols, so that Ṁ − 2 C is
    antisymmetric, as control laws assume.

    q (..., n) [rad or m], qd (..., dof) [rad/s or m/s]; of a floating base [v; ω] comes first. T_world_base
    (..., 4, 4): where the base is. out (..., dof, dof). threads: as in fk.

    Returns C (..., dof, dof).
    Raises InputError for a wrong shape or NaN and where no link has a mass.

    Echeandia and Wensing 2021, algorithm 1.
    """
    batch = dynamic_rows(robot, q, qd=qd, T_world_base=T_world_base, threads=threads)
    return fill_rows(robot, "coriolis_matrix", batch, None, (robot.dof, robot.dof), NO_GRAVITY, False, out)
