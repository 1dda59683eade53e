"""Limits of motion that a computation cannot do without: those given, else those of the robot."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, suggest
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.model.joint import LIMIT_FIELDS
from cspace.tables import join_words

MAGNITUDES = LIMIT_FIELDS[2:]
"""The limits that are largest magnitudes."""


def require_limits(robot: KinematicModel, kind: str, given: ArrayLike | None = None) -> Array:
    """The largest velocities, accelerations, jerks or efforts of all joints, none of them absent.

    kind: "velocity" [rad/s or m/s], "acceleration", "jerk" or "effort" [N·m or N]. given: one number for all
    joints or one per joint (n,), in place of the robot's own; infinity is an answer here.

    Returns the limits (n,).
    Raises UnknownNameError for another kind, InputError for joints without such a limit, by name, and for
    given limits of another length, NaN, or not above zero.
    """
    if kind not in MAGNITUDES:
        raise suggest("limit", kind, MAGNITUDES)
    n = len(robot.joint_names)
    if given is None:
        own: Array = getattr(robot.limits, kind)
        absent = [name for name, limit in zip(robot.joint_names, own, strict=True) if np.isinf(limit)]
        if absent:
            which = "" if len(absent) == n else f" of {join_words(absent)}"
            raise InputError(f"{robot.name} has no {kind} limits{which}; pass {kind}=")
        return own
    row = as_floats(given, kind, finite=False)
    if row.shape not in ((), (n,)):
        raise InputError(f"{kind} has shape {row.shape}, expected () or ({n},), one per joint")
    if not (row > 0.0).all():
        raise InputError(f"{kind} contains {float(row[~(row > 0.0)].flat[0]):g}; it must be above zero")
    return np.array(np.broadcast_to(row, (n,)))
