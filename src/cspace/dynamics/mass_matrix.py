"""The mass matrix."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.rows import NO_GRAVITY, dynamic_rows, fill_rows
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def mass_matrix(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The mass matrix M of the kinetic energy ½ q̇ᵀ M(q) q̇; see Robot.mass_matrix.

    q (..., n) [rad or m], T_world_base (..., 4, 4), out (..., dof, dof).
    Returns M (..., dof, dof), symmetric.
    Raises InputError for a wrong shape or NaN and where no link has a mass.
    """
    batch = dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads)
    return fill_rows(robot, "mass_matrix", batch, None, (robot.dof, robot.dof), NO_GRAVITY, False, out)
