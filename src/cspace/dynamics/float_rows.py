"""Batches in single precision: twice as many rows in a register, half as many digits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final, cast

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.buffer_pool import pooled_array
from cspace.dynamics.rows import Push, dynamic_rows, refuse_missing, refuse_rows
from cspace.errors import InputError, InputTypeError
from cspace.kinematics.batch import Batch, broadcast_rows, check_output, check_robot, thread_count
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial import as_pose

LARGEST_ANGLE: Final = 1e4
"""Values of joints that are computed in floats are below this [rad or m]; see float_trig.hpp."""


def is_single(dtype: npt.DTypeLike) -> bool:
    """Whether a call is to be computed in floats. Raises InputError unless dtype is float64 or float32."""
    try:
        kind = np.dtype(dtype)
    except TypeError:
        kind = None
    if kind not in (np.float64, np.float32):
        raise InputError(f"dtype is {dtype!r}, expected np.float64 or np.float32")
    return kind == np.float32


def rows_in(
    single: bool, robot: KinematicModel, q: Any, *, T_world_base: Any = None, threads: Any = None, **rest: Any
) -> Batch:
    """dynamic_rows, in floats if `single`; arrays of floats are then taken as they are."""
    if not single:
        return dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads, **rest)
    check_robot(robot)
    refuse_missing(**rest)
    arrays = {"q": q, **rest}
    sizes = {name: len(robot.joint_names) if name == "q" else robot.dof for name in arrays}
    is_ready = robot.mass > 0.0
    for name, value in arrays.items():
        is_ready = (
            is_ready
            and isinstance(value, np.ndarray)
            and value.dtype == np.float32
            and value.ndim > 0
            and value.shape[-1] == sizes[name]
            and value.flags.aligned
        )
    if not is_ready:
        batch = dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads, **rest)
        names = ("q", "qd", "qdd", "tau", "T_world_base")
        rows = {name: to_floats(getattr(batch, name)) for name in names}
        return replace(batch, **rows)
    given = {name: (value, 1) for name, value in arrays.items()}
    if T_world_base is not None:
        given["T_world_base"] = (to_floats(as_pose(T_world_base, "T_world_base")), 2)
    shape, rows = broadcast_rows(given, shared=("T_world_base",))
    return Batch(shape=shape, threads=thread_count(threads, shape), **rows)


def pushes_in(single: bool, pushes: Sequence[Push]) -> Sequence[Push]:
    """Wrenches, in floats if `single`."""
    return [replace(push, wrench=to_floats(push.wrench)) for push in pushes] if single else pushes


def to_floats(array: Array | None) -> Any:
    """The array in single precision."""
    with np.errstate(over="ignore"):  # what becomes infinite is refused after the loops
        return None if array is None else array.astype(np.float32)


def output_in(single: bool, out: Any, shape: tuple[int, ...]) -> Array:
    """The array to write into, of floats if `single`: a new one, or the caller's if it fits.

    Raises InputTypeError unless out is a contiguous array of that type, InputError for another shape.
    """
    if not single:
        return check_output(out, shape)
    if out is None:
        size = int(np.prod(shape))
        return cast("Array", pooled_array(((size + 1) // 2,)).view(np.float32)[:size].reshape(shape))
    if not isinstance(out, np.ndarray) or out.dtype != np.float32:
        kind = f"an array of {out.dtype}" if isinstance(out, np.ndarray) else type(out).__name__
        raise InputTypeError(f"out must be a float32 array to write into, got {kind}")
    if out.shape != shape:
        raise InputError(f"out has shape {out.shape}, expected {shape}")
    if not (out.flags.c_contiguous and out.flags.writeable and out.flags.aligned):
        raise InputError(f"out must be C-contiguous and writeable, such as np.empty({shape}, np.float32)")
    return cast("Array", out)


def refuse_unfit(batch: Batch) -> None:
    """Raise the InputError for the first value that is not finite or too large, of a joint in floats too."""
    refuse_rows(batch)
    if batch.q.dtype == np.float32 and (np.abs(batch.q) >= LARGEST_ANGLE).any():
        beyond = float(batch.q[np.abs(batch.q) >= LARGEST_ANGLE][0])
        raise InputError(
            f"q holds {beyond:g}; in float32 the values of joints must be below {LARGEST_ANGLE:g} [rad or m],"
            " so use dtype=np.float64, or turns less than that"
        )


def refuse_overflow(result: Array) -> None:
    """Raise InputError where numbers that fit floats have results that do not."""
    if result.dtype != np.float32:
        return
    with np.errstate(over="ignore", invalid="ignore"):
        total = result.sum()
    if not np.isfinite(total) and not np.isfinite(result).all():
        raise InputError("the numbers given are too large for float32; use dtype=np.float64")
