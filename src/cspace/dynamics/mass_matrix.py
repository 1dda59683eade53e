"""The mass matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.rows import dynamic_rows, run_rows
from cspace.kinematics.batch import check_output, refuse_infinite
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
    M = check_output(out, (*batch.shape, robot.dof, robot.dof))
    if not run_rows(robot, "mass_matrix", batch, None, M, np.zeros(3), False):
        refuse_infinite(batch)
    return M
