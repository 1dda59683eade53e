"""The feasible intervals of a redundant joint, as the core computes them for a pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError
from cspace.ik.locked_joints import LockedArm, joint_number, lock_joints, locked_values, value_in_words
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.wrapping import into_limits

__all__ = ["intervals_of", "redundancy_of_pose"]

END_NOTHING, END_FOLD = -1, -2
STILL = 1e-6
"""Part of the self-motion's direction below which a joint stands still in it: files round axes."""


def redundancy_of_pose(robot: Any, T: Array, parameter: Any, locked: Any) -> Redundancy:
    values = locked_values(robot, {} if locked is None else locked)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError("locked= takes one value per joint here")
    locked_arm = lock_joints(robot, {joint: float(value) for joint, value in values.items()})
    redundancy_degree = locked_arm.solver.redundancy_degree
    if redundancy_degree != 1:
        raise InputError(
            f"{robot.name} has {redundancy_degree} joints to spare here, expected one: "
            + ("lock the others with locked=" if redundancy_degree > 1 else "the goal settles all of them")
        )
    joint = (
        locked_arm.solver.locked[0]
        if parameter is None
        else locked_arm.free.index(free_joint(robot, parameter, values))
    )
    found = intervals_of(locked_arm, T, joint)
    if not found and joint != locked_arm.solver.locked[0]:
        check_moves(locked_arm, found.goal, joint)
    return found if is_bounded(locked_arm, joint) else replace(found, complete=False)


def is_bounded(locked_arm: LockedArm, joint: int) -> bool:
    """Whether the parameter runs between limits or round a circle: along a prismatic joint without limits
    the search looks as far as the arm is long."""
    limits, k = locked_arm.robot.limits, locked_arm.free[joint]
    return locked_arm.robot.joint_types[k] == "R" or bool(
        np.isfinite([limits.lower[k], limits.upper[k]]).all()
    )


def check_moves(locked_arm: LockedArm, T: Array, joint: int) -> None:
    """Raise InputError for a joint that stands still while the tip does: the goal settles it."""
    own = locked_arm.solver.locked[0]
    seen = intervals_of(locked_arm, T, own)
    if not seen:
        return
    J = locked_arm.robot.jacobian(np.array([interval.q for interval in seen]))[..., list(locked_arm.free)]
    if np.abs(np.linalg.svd(J)[2][:, -1, joint]).max() > STILL:
        return
    names = [locked_arm.robot.joint_names[k] for k in locked_arm.free]
    k = locked_arm.free[joint]
    at = ", ".join(sorted({value_in_words(locked_arm.robot, k, interval.q[k]) for interval in seen}))
    raise InputError(
        f"parameter {names[joint]!r} is settled by the goal, at {at}, and does not move with what is free; "
        f"take another joint, such as {names[own]!r}"
    )


def free_joint(robot: Any, parameter: Any, locked: Mapping[int, Any]) -> int:
    joint = joint_number(robot, parameter, "parameter")
    if joint in locked:
        raise InputError(f"parameter {robot.joint_names[joint]!r} is locked by locked=: it is not free")
    return joint


def intervals_of(locked_arm: LockedArm, T: Array, joint: int) -> Redundancy:
    rows, complete = locked_arm.solver.intervals(joint, T)
    names = [locked_arm.robot.joint_names[k] for k in locked_arm.free]
    slides = locked_arm.robot.joint_types[locked_arm.free[joint]] == "P"

    def end(what: int, side: int) -> str:
        if what == END_FOLD:
            return "fold"
        return "nothing" if what == END_NOTHING else f"{names[what]} at {'upper' if side else 'lower'} limit"

    robot = locked_arm.robot
    bounds = robot.joint_types, robot.limits.lower, robot.limits.upper
    made = [
        Interval(
            low,
            high,
            branch + 1,
            (end(a, sa), end(b, sb)),
            into_limits(locked_arm.whole(np.array(q)), *bounds)[0],
            slides,
        )
        for low, high, branch, a, sa, b, sb, q in rows
    ]
    made.sort(key=lambda interval: (interval.branch, interval.lower))
    return Redundancy(locked_arm.robot, T, names[joint], tuple(made), complete, slides)
