"""The centre of mass of a robot and its Jacobian."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.kinematics.batch import Batch, check_output, refuse_infinite, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def center_of_mass(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The centre of mass of everything the robot carries.

    c(q) = Σ mₖ cₖ(q) / Σ mₖ over all links with a mass, those fixed to the base included.

    q (..., n) [rad or m]. T_world_base (..., 4, 4): where the base is. out (..., 3). threads: as in fk.

    Returns c (..., 3) [m] in the base.
    Raises InputError for a wrong shape or NaN, and where no link has a mass.
    """
    batch = rows_of(robot, q, T_world_base=T_world_base, threads=threads)
    center = check_output(out, (*batch.shape, 3))
    _compute(robot, batch, center, None)
    return center


def center_of_mass_jacobian(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The Jacobian of the centre of mass.

    ċ = J_c(q) q̇; the column of a joint that turns about d through o is d × (s − m o) / M, with the mass m
    and first moment s = Σ mₖ cₖ of all that it carries and the total mass M.

    q (..., n) [rad or m]. T_world_base (..., 4, 4): where the base is. out (..., 3, dof). threads: as in fk.

    Returns J_c (..., 3, dof); the columns of a floating base come first.
    Raises InputError for a wrong shape or NaN, and where no link has a mass.

    Sugihara, Nakamura and Inoue 2002, section 2.
    """
    batch = rows_of(robot, q, T_world_base=T_world_base, threads=threads)
    J = check_output(out, (*batch.shape, 3, robot.dof))
    _compute(robot, batch, None, J)
    return J


def _compute(robot: KinematicModel, batch: Batch, center: Array | None, columns: Array | None) -> None:
    if robot.mass == 0.0:
        raise InputError(f"no link of {robot.name} has a mass; add inertial data to its description")
    if not _core._tree_rows(robot, batch.q, batch.T_world_base, None, center, columns, batch.threads):
        refuse_infinite(batch)
