"""The feasible intervals of a joint to spare, as the core computes them for a pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError
from cspace.ik.held import Held, fixed_values, hold, joint_number, value_in_words
from cspace.ik.redundancy import Interval, Redundancy
from cspace.ik.windings import into_limits

__all__ = ["intervals_of", "redundancy_of_pose"]

END_NOTHING, END_FOLD = -1, -2
STILL = 1e-6
"""Part of the self-motion's direction below which a joint stands still in it: files round axes."""


def redundancy_of_pose(robot: Any, T: Array, parameter: Any, fixed: Any) -> Redundancy:
    values = fixed_values(robot, {} if fixed is None else fixed)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError("fixed= takes one value per joint here")
    held = hold(robot, {joint: float(value) for joint, value in values.items()})
    spare = held.solver.spare
    if spare != 1:
        raise InputError(
            f"{robot.name} has {spare} joints to spare here, expected one: "
            + ("hold the others with fixed=" if spare > 1 else "the goal settles all of them")
        )
    joint = (
        held.solver.held[0] if parameter is None else held.free.index(free_joint(robot, parameter, values))
    )
    found = intervals_of(held, T, joint)
    if not found and joint != held.solver.held[0]:
        check_moves(held, found.goal, joint)
    return found if is_bounded(held, joint) else replace(found, complete=False)


def is_bounded(held: Held, joint: int) -> bool:
    """Whether the parameter runs between limits or round a circle: along a slide without limits the search
    looks as far as the arm is long.
    """
    limits, k = held.robot.limits, held.free[joint]
    return held.robot.joint_types[k] == "R" or bool(np.isfinite([limits.lower[k], limits.upper[k]]).all())


def check_moves(held: Held, T: Array, joint: int) -> None:
    """Raise InputError for a joint that stands still while the tip does: the goal settles it."""
    own = held.solver.held[0]
    seen = intervals_of(held, T, own)
    if not seen:
        return
    J = held.robot.jacobian(np.array([interval.q for interval in seen]))[..., list(held.free)]
    if np.abs(np.linalg.svd(J)[2][:, -1, joint]).max() > STILL:
        return
    names = [held.robot.joint_names[k] for k in held.free]
    k = held.free[joint]
    at = ", ".join(sorted({value_in_words(held.robot, k, interval.q[k]) for interval in seen}))
    raise InputError(
        f"parameter {names[joint]!r} is settled by the goal, at {at}, and does not move with what is free; "
        f"take another joint, such as {names[own]!r}"
    )


def free_joint(robot: Any, parameter: Any, fixed: Mapping[int, Any]) -> int:
    joint = joint_number(robot, parameter, "parameter")
    if joint in fixed:
        raise InputError(f"parameter {robot.joint_names[joint]!r} is held by fixed=: it is not free")
    return joint


def intervals_of(held: Held, T: Array, joint: int) -> Redundancy:
    rows, complete = held.solver.intervals(joint, T)
    names = [held.robot.joint_names[k] for k in held.free]
    slides = held.robot.joint_types[held.free[joint]] == "P"

    def end(what: int, side: int) -> str:
        if what == END_FOLD:
            return "fold"
        return "nothing" if what == END_NOTHING else f"{names[what]} at {'upper' if side else 'lower'} limit"

    robot = held.robot
    bounds = robot.joint_types, robot.limits.lower, robot.limits.upper
    made = [
        Interval(
            low,
            high,
            branch + 1,
            (end(a, sa), end(b, sb)),
            into_limits(held.whole(np.array(q)), *bounds)[0],
            slides,
        )
        for low, high, branch, a, sa, b, sb, q in rows
    ]
    made.sort(key=lambda interval: (interval.branch, interval.lower))
    return Redundancy(held.robot, T, names[joint], tuple(made), complete, slides)
