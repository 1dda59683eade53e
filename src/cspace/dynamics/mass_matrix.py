"""The mass matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from cspace.arrays import Array
from cspace.dynamics.float_rows import is_single, output_in, refuse_overflow, refuse_unfit, rows_in
from cspace.dynamics.rows import NO_GRAVITY, run_rows
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def mass_matrix(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
    dtype: DTypeLike = np.float64,
) -> Array:
    """The mass matrix M of the kinetic energy ½ q̇ᵀ M(q) q̇; see Robot.mass_matrix.

    q (..., n) [rad or m], T_world_base (..., 4, 4), out (..., dof, dof). dtype: float64, or
    float32 to compute in single precision.
    Returns M (..., dof, dof), symmetric.
    Raises InputError for a wrong shape or NaN and where no link has a mass.
    """
    single = is_single(dtype)
    batch = rows_in(single, robot, q, T_world_base=T_world_base, threads=threads)
    M = output_in(single, out, (*batch.shape, robot.dof, robot.dof))
    if not run_rows(robot, "mass_matrix", batch, None, M, NO_GRAVITY, False):
        refuse_unfit(batch)
    refuse_overflow(M)
    return M
