"""Centroidal momentum and the energies."""

from __future__ import annotations

from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.rows import EARTH, NO_GRAVITY, check_gravity, dynamic_rows, fill_rows
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike


def centroidal_momentum(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The momentum of the whole robot: linear, and angular about its centre of mass.

    Without external forces it does not change, apart from the weight, which changes the linear part alone.

    q (..., n) [rad or m], qd (..., dof) [rad/s or m/s]; of a floating base [v; ω] comes first. T_world_base
    (..., 4, 4): where the base is. out (..., 6). threads: as in fk.

    Returns [l; k] (..., 6) [kg·m/s, kg·m²/s] in the axes of the base, of the world where the base is placed.
    Raises InputError for a wrong shape or NaN and where no link has a mass.

    Orin, Goswami and Lee 2013.
    """
    batch = dynamic_rows(robot, q, qd=qd, T_world_base=T_world_base, threads=threads)
    return fill_rows(robot, "momentum", batch, None, (6,), NO_GRAVITY, False, out)


def centroidal_momentum_matrix(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The matrix A with [l; k] = A(q) q̇; see centroidal_momentum.

    q (..., n) [rad or m], T_world_base (..., 4, 4), out (..., 6, dof). Returns A (..., 6, dof).
    Raises InputError for a wrong shape or NaN and where no link has a mass.
    """
    batch = dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads)
    return fill_rows(robot, "momentum_matrix", batch, None, (6, robot.dof), NO_GRAVITY, False, out)


def kinetic_energy(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The kinetic energy ½ q̇ᵀ M(q) q̇, that of rotors (armature) included.

    q (..., n) [rad or m], qd (..., dof) [rad/s or m/s], T_world_base (..., 4, 4), out (...). Returns
    (...) [J].
    Raises InputError for a wrong shape or NaN and where no link has a mass.
    """
    batch = dynamic_rows(robot, q, qd=qd, T_world_base=T_world_base, threads=threads)
    return fill_rows(robot, "kinetic_energy", batch, None, (), NO_GRAVITY, False, out)


def potential_energy(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The energy −m g · c of the weight, zero with the centre of mass at the origin.

    q (..., n) [rad or m], gravity (3,) [m/s²], T_world_base (..., 4, 4), out (...). Returns
    (...) [J].
    Raises InputError for a wrong shape or NaN and where no link has a mass.
    """
    batch = dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads)
    return fill_rows(robot, "potential_energy", batch, None, (), check_gravity(gravity), False, out)
