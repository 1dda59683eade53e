"""How well a robot moves: singular values, manipulability and its ellipsoid, distance to singularity."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, suggest
from cspace.kinematics.batch import check_choice, frame_number, rows_of
from cspace.kinematics.forward import compute_chain
from cspace.kinematics.jacobian import AXES, jacobian
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tables import one_line, shown, tabulate
from cspace.tolerances import POSSIBLE_MOTION

ROWS = ("vx", "vy", "vz", "wx", "wy", "wz")
"""The rows of a Jacobian by name."""

GROUPS = {"all": ROWS, "linear": ROWS[:3], "angular": ROWS[3:]}

SAMPLES = 8
"""Configurations whose Jacobians give a generic rank: it is lost at all of them only if it is never there."""


@tabulate()
class Ellipsoid(NamedTuple):
    """The twists that joint velocities of norm one reach.

    directions (..., m, m): unit axes as columns, over the m rows asked for; radii (..., m): their half
    lengths, largest first, 0 along a lost direction.
    """

    directions: Array
    radii: Array

    def __repr__(self) -> str:
        if self.radii.ndim > 1:
            return one_line("Ellipsoid", f"batch of shape {self.radii.shape[:-1]}")
        return one_line("Ellipsoid", "with radii " + ", ".join(map(shown, self.radii)))


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


def generic_rank(
    robot: KinematicModel,
    frame: str | None = None,
    rows: str | Iterable[str] = "all",
    point: ArrayLike | None = None,
) -> int:
    """The rank of some rows of the Jacobian at almost every configuration: the dimensions of the motion.

    frame, point (..., 3) [m]: as in jacobian; of many points a few are examined. rows: a group or names.
    Raises UnknownNameError for an unknown frame or row.
    """
    return _rank(_sample_jacobians(robot, frame, point), row_numbers(rows))


def counting_rows(robot: KinematicModel, frame: str | None = None, point: ArrayLike | None = None) -> str:
    """The rows that "auto" means: "linear" where their generic rank equals the number of joints that move
    the frame, so that the arm positions a point; otherwise "all".
    """
    J = _sample_jacobians(robot, frame, point)
    moving = int(np.any(J != 0.0, axis=(0, 1)).sum())
    return "linear" if _rank(J, row_numbers("linear")) == moving else "all"


def select_rows(
    robot: KinematicModel, frame: str | None, rows: str | Iterable[str], point: ArrayLike | None
) -> tuple[list[int], int | None]:
    """The numbers of the rows, and how many singular values count: None for as many as rows and joints."""
    if not (isinstance(rows, str) and rows == "auto"):
        return row_numbers(rows), None
    number, known = frame_number(robot, frame), robot._auto_rows
    if point is None and number in known:
        return known[number]
    group = counting_rows(robot, frame, point)
    found = row_numbers(group), generic_rank(robot, frame, group, point)
    if point is None:
        known[number] = found
    return found


def _sample_jacobians(robot: KinematicModel, frame: str | None, point: ArrayLike | None) -> Array:
    """The columns of the joints (samples, 6, n) of Jacobians at several configurations."""
    number, n = frame_number(robot, frame), len(robot.joint_names)
    q = np.random.default_rng(1).uniform(-1.3, 1.3, size=(SAMPLES, 1, n))
    if point is not None:
        points = as_floats(point, "point", last=(3,)).reshape(-1, 3)
        point = points[np.linspace(0, len(points) - 1, min(SAMPLES, len(points))).astype(np.intp)]
    batch = rows_of(robot, q, point=point, threads=1)
    J = np.empty((*batch.shape, 6, robot.dof))
    compute_chain(robot, number, batch, J=J)
    return J[..., robot.dof - n :].reshape(math.prod(batch.shape), 6, n)  # n may be zero


def _rank(J: Array, chosen: list[int]) -> int:
    """The largest rank of the chosen rows among Jacobians (samples, 6, n)."""
    if J.size == 0:
        return 0
    largest = np.linalg.svd(J, compute_uv=False)[:, :1]
    sigma = np.linalg.svd(J[:, chosen], compute_uv=False)
    return int((sigma > POSSIBLE_MOTION * largest).sum(axis=1).max())


def singular_values(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    rows: str | Iterable[str] = "auto",
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    threads: int | None = None,
) -> Array:
    """The singular values of the Jacobian.

    J = U Σ Vᵀ; σᵢ is the speed along uᵢ per unit of joint velocity along vᵢ. Rows in m/s and rad/s are
    weighted equally, so with all rows a metre counts as a radian: scale lengths first if this is not
    intended.

    q (..., n) [rad or m]. rows: "auto", "all", "linear", "angular" or names out of vx, vy, vz, wx, wy, wz,
    in the axes of expressed_in. "auto" selects what the arm can move: the linear rows if it positions a
    point, that is if their generic rank equals the number of joints that move the frame, and otherwise all
    rows; and of their singular values those that are not zero at every configuration. frame, point (..., 3),
    T_world_base (..., 4, 4), threads: as in jacobian. The base of a floating robot is held.

    Returns σ (..., k), largest first; k = min(rows, n), and with "auto" the generic rank of the rows.
    Raises InputError for a wrong shape or NaN, UnknownNameError for an unknown frame, row or axes.

    Golub and Van Loan 2013, section 2.4; computed by one-sided Jacobi rotations, which keep small ones
    accurate.
    """
    number = frame_number(robot, frame)
    in_tip = check_choice(expressed_in, "expressed_in", AXES) == "tip"
    batch = rows_of(robot, q, point=point, T_world_base=T_world_base, threads=threads)
    chosen, rank = select_rows(robot, frame, rows, point)
    sigma = np.empty((*batch.shape, min(len(chosen), len(robot.joint_names))))
    compute_chain(robot, number, batch, sigma=sigma, chosen=sum(1 << r for r in chosen), in_tip=in_tip)
    return sigma[..., :rank]


def manipulability(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    rows: str | Iterable[str] = "auto",
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    threads: int | None = None,
) -> Array:
    """The manipulability: the volume of the ellipsoid of reachable twists, up to a constant.

    w = √det(J Jᵀ) = σ₁ σ₂ … σₖ: with fewer joints than rows it is the volume within what the joints span,
    √det(Jᵀ J). It is 0 exactly at singular configurations.

    q (..., n) [rad or m]. frame, rows, point, expressed_in, T_world_base, threads: as in singular_values,
    which also names the errors.

    Returns w (...).

    Yoshikawa 1985.
    """
    sigma = singular_values(
        robot,
        q,
        frame,
        rows=rows,
        point=point,
        expressed_in=expressed_in,
        T_world_base=T_world_base,
        threads=threads,
    )
    return np.asarray(np.prod(sigma, axis=-1))[()]


def distance_to_singularity(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    rows: str | Iterable[str] = "auto",
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
    threads: int | None = None,
) -> Array:
    """The distance to singularity: the smallest singular value of the Jacobian.

    σ_min = min ‖J − S‖₂ over all S of lower rank, so it is the distance of the matrix to the nearest
    singular one, and the speed left in the worst direction per unit of joint velocity.

    q (..., n) [rad or m]. frame, rows, point, expressed_in, T_world_base, threads: as in singular_values,
    which also names the errors.

    Returns σ_min (...), inf where no joint moves the frame.

    Eckart and Young 1936; Klein and Blaho 1987.
    """
    sigma = singular_values(
        robot,
        q,
        frame,
        rows=rows,
        point=point,
        expressed_in=expressed_in,
        T_world_base=T_world_base,
        threads=threads,
    )
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
