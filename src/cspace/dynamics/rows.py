"""What the functions of this room are given besides configurations, and their way into the compiled loops."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes, one_array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics import jacobian
from cspace.kinematics.batch import (
    Batch,
    check_choice,
    check_flag,
    check_output,
    check_robot,
    frame_number,
    rows_of,
)
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.tolerances import FARTHEST

EARTH: Final = (0.0, 0.0, -9.81)
"""Gravity on Earth [m/s²], down along z."""

NO_GRAVITY: Final = np.zeros(3)

Wrenches = Mapping[str, ArrayLike]
"""Frame → (..., 6): force and torque [N, N·m] of the world on the robot at the origin of that frame."""

STATES: Final = {
    "qd": "the velocities (..., dof)",
    "qdd": "the accelerations (..., dof)",
    "tau": "the torques and forces (..., dof)",
}
"""What functions are given besides q, each one number per joint and six for a floating base."""

AXES: Final = ("base", "tip")
"""In which axes wrenches may be."""


@dataclass(frozen=True, eq=False)
class Push:
    """A wrench as the compiled loops take it: the number of its frame, whether it is in the axes of that
    frame, and its numbers (rows or 1, 6)."""

    frame: int
    in_tip: bool
    wrench: Array


def dynamic_rows(robot: KinematicModel, q: ArrayLike, **arguments: Any) -> Batch:
    """The arguments of a call as rows; see kinematics.batch.rows_of.

    Raises InputError also for a robot without mass, InputTypeError for None in place of a state.
    """
    check_robot(robot)
    refuse_missing(**arguments)
    if robot.mass == 0.0:
        raise InputError(f"no link of {robot.name} has a mass; add inertial data to its description")
    return rows_of(robot, q, **arguments)


def refuse_missing(**arguments: Any) -> None:
    """Raise InputTypeError for velocities, accelerations or torques that are None."""
    for name, what in STATES.items():
        if name in arguments and arguments[name] is None:
            raise InputTypeError(f"{name} is None; it must be {what}")


def refuse_rows(batch: Batch) -> None:
    """Raise the InputError that names the value which is not finite or too large for the compiled loops.

    They test the sum of a row, so each value may be as large as FARTHEST divided by the length of the row.
    """
    for name in ("q", *STATES):
        array = getattr(batch, name)
        if array is not None:
            rows = as_floats(array.reshape((*batch.shape, array.shape[1])), name, largest=FARTHEST)
            as_floats(rows, name, largest=FARTHEST / max(1, array.shape[1]))


def check_gravity(gravity: ArrayLike) -> Array:
    """Gravity as (3,) [m/s²]. Raises InputError for another shape, NaN, or numbers whose squares overflow."""
    if gravity is None:
        raise InputTypeError("gravity is None; give three numbers [m/s²], (0, 0, 0) for none")
    return np.ascontiguousarray(one_array(gravity, "gravity", (3,), largest=FARTHEST))


def check_wrench(wrench: ArrayLike, frame: str) -> Array:
    """A wrench (..., 6). Raises InputError for another shape, NaN, or numbers whose squares overflow."""
    return as_floats(wrench, f"wrench at {frame!r}", last=(6,), largest=FARTHEST)


def run_rows(
    robot: KinematicModel,
    what: str,
    batch: Batch,
    force: Array | None,
    result: Array,
    gravity: Array,
    friction: bool,
    pushes: Sequence[Push] = (),
) -> bool:
    """Fill in the result, which may be one of the arguments; see _core._dynamics_rows.

    The numbers are floats where those of the result are.
    """
    friction = check_flag(friction, "friction")
    given = (batch.q, batch.qd, force, batch.T_world_base)
    arrays = [array for array in given if array is not None] + [push.wrench for push in pushes]
    is_shared = any(np.may_share_memory(array, result) for array in arrays)
    to = np.empty_like(result) if is_shared else result
    run = _core._float_dynamics_rows if result.dtype == np.float32 else _core._dynamics_rows
    applied = [(push.frame, push.in_tip, push.wrench) for push in pushes]
    is_done = run(robot, what, *given, gravity, friction, to, batch.threads, applied)
    if is_shared:
        result[...] = to
    return is_done


def fill_rows(
    robot: KinematicModel,
    what: str,
    batch: Batch,
    force: Array | None,
    last: tuple[int, ...],
    gravity: Array,
    friction: bool,
    out: Array | None,
) -> Array:
    """The results (..., *last) of a call whose only fault can be a configuration that is not finite."""
    result = check_output(out, (*batch.shape, *last))
    if not run_rows(robot, what, batch, force, result, gravity, friction):
        refuse_rows(batch)
    return result


def push_rows(
    robot: KinematicModel, batch: Batch, wrenches: Wrenches | None, expressed_in: str
) -> tuple[Batch, list[Push]]:
    """Wrenches as the compiled loops take them, and the batch with as many rows as these have.

    Raises InputTypeError for what is not a mapping, InputError for a wrong shape or NaN, UnknownNameError for
    an unknown frame or axes.
    """
    in_tip = check_choice(expressed_in, "expressed_in", AXES) == "tip"
    check_mapping(wrenches)
    if not wrenches:
        return batch, []
    given = {
        frame: (frame_number(robot, frame), check_wrench(wrench, frame)) for frame, wrench in wrenches.items()
    }
    leads = {f"wrench at {frame!r}": w.shape[:-1] for frame, (_, w) in given.items()}
    shape = leading_axes(q=batch.shape, **leads)
    pushes = []
    for number, w in given.values():
        rows = w if w.ndim == 1 else np.broadcast_to(w, (*shape, 6))
        pushes.append(Push(number, in_tip, np.ascontiguousarray(rows.reshape(-1, 6))))
    return repeat_rows(batch, shape), pushes


def repeat_rows(batch: Batch, shape: tuple[int, ...]) -> Batch:
    """The batch with its leading axes broadcast to a shape."""
    if shape == batch.shape:
        return batch
    rows: dict[str, Array] = {}
    for name in ("q", "qd", "qdd", "tau", "T_world_base"):
        array = getattr(batch, name)
        if array is None or (name == "T_world_base" and len(array) == 1):
            continue
        last = array.shape[1:]
        wide = np.broadcast_to(array.reshape(*batch.shape, *last), (*shape, *last))
        rows[name] = np.ascontiguousarray(wide.reshape(-1, *last))
    return replace(batch, shape=shape, **rows)  # type: ignore[arg-type]


def check_mapping(wrenches: object) -> None:
    """Raise InputTypeError for wrenches that are not a mapping."""
    if wrenches is not None and not isinstance(wrenches, Mapping):
        raise InputTypeError(
            f"wrenches is {name_type(wrenches)}, expected a dict of frame → (..., 6), such as"
            ' {"tool0": [0, 0, -10, 0, 0, 0]}'
        )


def torques_of_wrenches(
    robot: KinematicModel, q: ArrayLike, wrenches: Wrenches | None, expressed_in: str, T_world_base: Any
) -> Array | None:
    """Σ Jᵀ w over the wrenches (..., dof), or None without any.

    Raises InputTypeError for what is not a mapping, InputError for a wrong shape or NaN, UnknownNameError for
    an unknown frame.
    """
    if wrenches is None:
        return None
    check_mapping(wrenches)
    total: Array | None = None
    for frame, wrench in wrenches.items():
        w = check_wrench(wrench, frame)
        J = jacobian(robot, q, frame, expressed_in=expressed_in, T_world_base=T_world_base)
        torques: Array = np.einsum("...ij,...i->...j", J, w)
        total = torques if total is None else total + torques
    return total
