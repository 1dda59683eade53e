"""How well a robot moves: singular values, manipulability and its ellipsoid, distance to singularity."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, suggest
from cspace.kinematics.batch import check_choice, frame_number, rows_of
from cspace.kinematics.forward import compute_chain
from cspace.kinematics.jacobian import AXES, jacobian
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike

ROWS = ("vx", "vy", "vz", "wx", "wy", "wz")
"""The rows of a Jacobian by name."""

GROUPS = {"all": ROWS, "linear": ROWS[:3], "angular": ROWS[3:]}


class Ellipsoid(NamedTuple):
    """The twists that joint velocities of norm one reach.

    directions (..., m, m): unit axes as columns, over the m rows asked for; radii (..., m): their half
    lengths, largest first, 0 along a lost direction.
    """

    directions: Array
    radii: Array


def row_numbers(rows: str | Iterable[str]) -> list[int]:
    """The numbers of rows given by name: "all", "linear", "angular", or names out of ROWS.

    Raises UnknownNameError for other names, InputError for none or one twice.
    """
    if isinstance(rows, str) and rows in GROUPS:
        return [ROWS.index(row) for row in GROUPS[rows]]
    try:
        names = [rows] if isinstance(rows, str) else list(rows)
    except TypeError:
        raise InputTypeError(f"rows must be names, got {type(rows).__name__}") from None
    for name in names:
        if not isinstance(name, str) or name not in ROWS:
            raise suggest("row", name, (*ROWS, *GROUPS), owner="the Jacobian")
    if not names or len(set(names)) < len(names):
        raise InputError(f"rows are {names}; name at least one, and each only once")
    return [ROWS.index(name) for name in names]


def singular_values(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    rows: str | Iterable[str] = "all",
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    threads: int | None = None,
) -> Array:
    """The singular values of the Jacobian.

    J = U Σ Vᵀ; σᵢ is the speed along uᵢ per unit of joint velocity along vᵢ. Rows in m/s and rad/s are
    weighted equally, so with "all" a metre counts as a radian: scale lengths first if this is not intended.

    q (..., n) [rad or m]. rows: "all", "linear", "angular" or names out of vx, vy, vz, wx, wy, wz, in the
    axes of expressed_in. frame, point (..., 3), T_world_base (..., 4, 4), threads: as in jacobian. The base
    of a floating robot is held.

    Returns σ (..., k), largest first; k = min(rows, n).
    Raises InputError for a wrong shape or NaN, UnknownNameError for an unknown frame, row or axes.

    Golub and Van Loan 2013, section 2.4; computed by one-sided Jacobi rotations, which keep small ones
    accurate.
    """
    number, chosen = frame_number(robot, frame), row_numbers(rows)
    in_tip = check_choice(expressed_in, "expressed_in", AXES) == "tip"
    batch = rows_of(robot, q, point=point, T_world_base=T_world_base, threads=threads)
    sigma = np.empty((*batch.shape, min(len(chosen), len(robot.joint_names))))
    compute_chain(robot, number, batch, sigma=sigma, chosen=sum(1 << r for r in chosen), in_tip=in_tip)
    return sigma


def manipulability(robot: KinematicModel, q: ArrayLike, frame: str | None = None, **options: Any) -> Array:
    """The manipulability: the volume of the ellipsoid of reachable twists, up to a constant.

    w = √det(J Jᵀ) = σ₁ σ₂ … σₖ, k = min(rows, n): with fewer joints than rows it is the volume within what
    the joints span, √det(Jᵀ J). It is 0 exactly at singular configurations.

    q (..., n) [rad or m]. options: rows, point, expressed_in, T_world_base, threads, as in singular_values,
    which also names the errors.

    Returns w (...).

    Yoshikawa 1985.
    """
    sigma = singular_values(robot, q, frame, **options)
    return np.asarray(np.prod(sigma, axis=-1))[()]


def distance_to_singularity(
    robot: KinematicModel, q: ArrayLike, frame: str | None = None, **options: Any
) -> Array:
    """The distance to singularity: the smallest singular value of the Jacobian.

    σ_min = min ‖J − S‖₂ over all S of lower rank, so it is the distance of the matrix to the nearest
    singular one, and the speed left in the worst direction per unit of joint velocity.

    q (..., n) [rad or m]. options: rows, point, expressed_in, T_world_base, threads, as in singular_values,
    which also names the errors.

    Returns σ_min (...), inf for a robot without joints.

    Eckart and Young 1936; Klein and Blaho 1987.
    """
    sigma = singular_values(robot, q, frame, **options)
    return np.asarray(sigma[..., -1] if sigma.shape[-1] else np.full(sigma.shape[:-1], np.inf))[()]


def manipulability_ellipsoid(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    rows: str | Iterable[str] = "linear",
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
) -> Ellipsoid:
    """The ellipsoid of the twists that joint velocities of norm one reach.

    {J q̇ : ‖q̇‖ ≤ 1}, with the axes uᵢ and half lengths σᵢ of J = U Σ Vᵀ.

    q (..., n) and the other arguments: as in singular_values; rows are the linear ones unless said
    otherwise, since an ellipsoid of metres and radians has no size.

    Returns directions (..., m, m) as columns and radii (..., m), largest first.

    Yoshikawa 1985.
    """
    chosen = row_numbers(rows)
    J = jacobian(robot, q, frame, point=point, expressed_in=expressed_in, T_world_base=T_world_base)
    J = J[..., chosen, robot.dof - len(robot.joint_names) :]
    directions, sigma, _ = np.linalg.svd(J, full_matrices=True)
    radii = np.zeros(J.shape[:-1])
    radii[..., : sigma.shape[-1]] = sigma
    return Ellipsoid(directions, radii)
