"""Forward kinematics: where the frames of a robot are, at a configuration."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.kinematics.batch import Batch, check_output, frame_number, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tolerances import FARTHEST


def forward_kinematics(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The pose of a frame at a configuration; see Robot.fk, which is this function.

    q (..., n) [rad or m], T_world_base (..., 4, 4), out (..., 4, 4). Returns T (..., 4, 4), which maps
    coordinates in the frame to coordinates in the base; in a batch, rows of NaN alone give NaN. Raises
    InputError for a wrong shape or other NaN, UnknownNameError for an unknown frame.
    """
    number = frame_number(robot, frame)
    batch = rows_of(robot, q, T_world_base=T_world_base, threads=threads)
    T = check_output(out, (*batch.shape, 4, 4))
    compute_chain(robot, number, batch, T=T)
    return T


def forward_kinematics_all(
    robot: KinematicModel,
    q: ArrayLike,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> Array:
    """The poses of all frames at a configuration, in one pass through the tree; see Robot.fk_all.

    q (..., n) [rad or m], T_world_base (..., 4, 4), out (..., frames, 4, 4). Returns T (..., frames, 4, 4)
    in the order of robot.frames. Raises InputError for a wrong shape or NaN.
    """
    batch = rows_of(robot, q, T_world_base=T_world_base, threads=threads)
    T = check_output(out, (*batch.shape, len(robot.frames), 4, 4))
    if not _core._tree_rows(robot, batch.q, batch.T_world_base, T, None, None, batch.threads):
        q, absent = split_absent(batch)
        _core._tree_rows(robot, q, batch.T_world_base, T, None, None, batch.threads)
        mark_absent(absent, T)
    return T


def compute_chain(
    robot: KinematicModel,
    frame: int,
    batch: Batch,
    *,
    T: Array | None = None,
    J: Array | None = None,
    J_rate: Array | None = None,
    sigma: Array | None = None,
    chosen: int = 63,
    in_tip: bool = False,
) -> None:
    """Fill the arrays given, for one frame: T (..., 4, 4), J and J_rate (..., 6, dof), sigma (..., k).

    chosen: bit r set where row r of the Jacobian counts for the singular values. Raises InputError for NaN
    in q; in a batch, rows of NaN alone give T and J of NaN, see split_absent.
    """
    outputs = T, J, J_rate, sigma

    def fill(q: Array) -> bool:
        given = q, batch.qd, batch.T_world_base, batch.point
        return bool(_core._chain_rows(robot, frame, *given, *outputs, chosen, in_tip, batch.threads))

    if not fill(batch.q):
        q, absent = split_absent(batch, J_rate, sigma)
        fill(q)
        mark_absent(absent, T, J)


def split_absent(batch: Batch, *others: Array | None) -> tuple[Array, npt.NDArray[np.bool_]]:
    """The configurations (rows, n) of a batch with zeros in place of rows that are NaN alone, as batches of
    solutions have them behind the last, and where these are (...).

    Raises InputError for any other value that is not finite, for a single configuration, and where `others`
    are asked for.
    """
    absent = np.asarray(np.isnan(batch.q).all(axis=1))
    q = np.where(absent[:, None], 0.0, batch.q)
    if not batch.shape or any(other is not None for other in others):
        q = batch.q
    as_floats(q.reshape((*batch.shape, q.shape[1])), "q", largest=FARTHEST)
    return q, absent.reshape(batch.shape)


def mark_absent(absent: npt.NDArray[np.bool_], *outputs: Array | None) -> None:
    """Fill the rows of outputs (..., …) that stand for no configuration with NaN."""
    for output in outputs:
        if output is not None:
            output[absent] = np.nan


def measure_misses(robot: KinematicModel, q: Array, goals: Array) -> Array:
    """How far the tip is from goals (..., 4, 4) or points (..., 3) at configurations (..., k, n), (..., k).

    The larger of the distance [m] and the angle [rad]; NaN for a row of NaN.
    """
    miss = np.empty(q.shape[:-1])
    rows = np.ascontiguousarray(q, dtype=float).reshape(-1, q.shape[-1])
    if miss.size:
        _core._chain_misses(robot, frame_number(robot, None), rows, np.ascontiguousarray(goals), miss, 0)
    return miss
