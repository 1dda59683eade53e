"""What the functions of this room are given besides configurations, and their way into the compiled loops."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, one_array
from cspace.errors import InputError, InputTypeError
from cspace.kinematics import jacobian
from cspace.kinematics.batch import Batch, check_output, check_robot, refuse_infinite, rows_of
from cspace.kinematics.kinematic_model import KinematicModel

EARTH: Final = (0.0, 0.0, -9.81)
"""Gravity on Earth [m/s²], down along z."""

NO_GRAVITY: Final = np.zeros(3)

Wrenches = Mapping[str, ArrayLike]
"""Frame → (..., 6): force and torque [N, N·m] of the world on the robot at the origin of that frame."""


def dynamic_rows(robot: KinematicModel, q: ArrayLike, **arguments: Any) -> Batch:
    """The arguments of a call as rows; see kinematics.batch.rows_of.

    Raises InputError also for a robot without mass.
    """
    check_robot(robot)
    if robot.mass == 0.0:
        raise InputError(f"no link of {robot.name} has a mass; add inertial data to its description")
    return rows_of(robot, q, **arguments)


def check_gravity(gravity: ArrayLike) -> Array:
    """Gravity as (3,) [m/s²]. Raises InputError for another shape or NaN."""
    return np.ascontiguousarray(one_array(gravity, "gravity", (3,)))


def run_rows(
    robot: KinematicModel,
    what: str,
    batch: Batch,
    force: Array | None,
    result: Array,
    gravity: Array,
    friction: bool,
) -> bool:
    """Fill in the result, which may be one of the arguments; see _core._dynamics_rows."""
    given = (batch.q, batch.qd, force, batch.T_world_base, gravity)
    is_shared = any(array is not None and np.may_share_memory(array, result) for array in given)
    to = np.empty_like(result) if is_shared else result
    is_done = _core._dynamics_rows(robot, what, *given, friction, to, batch.threads)
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
        refuse_infinite(batch)
    return result


def torques_of_wrenches(
    robot: KinematicModel, q: ArrayLike, wrenches: Wrenches | None, expressed_in: str, T_world_base: Any
) -> Array | None:
    """Σ Jᵀ w over the wrenches (..., dof), or None without any.

    Raises InputTypeError for what is not a mapping, InputError for a wrong shape or NaN, UnknownNameError for
    an unknown frame.
    """
    if wrenches is None:
        return None
    if not isinstance(wrenches, Mapping):
        raise InputTypeError(
            f"wrenches is a {type(wrenches).__name__}, expected a dict of frame → (..., 6), such as"
            ' {"tool0": [0, 0, -10, 0, 0, 0]}'
        )
    total: Array | None = None
    for frame, wrench in wrenches.items():
        w = as_floats(wrench, f"wrench at {frame!r}", last=(6,))
        J = jacobian(robot, q, frame, expressed_in=expressed_in, T_world_base=T_world_base)
        torques: Array = np.einsum("...ij,...i->...j", J, w)
        total = torques if total is None else total + torques
    return total
