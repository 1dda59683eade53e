"""What numeric inverse kinematics is asked, checked and laid out for the compiled loops."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, as_generator, positive_number
from cspace.errors import InputError, InputTypeError
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_robot, frame_number, limits_of
from cspace.spatial import as_pose
from cspace.spatial.poses import assemble
from cspace.tolerances import FARTHEST, LEAST_SLIDE

MOST_PATH = 16
EVERYTHING = np.ones(6)
POSITION_ALONE = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
EVERYTHING.flags.writeable = POSITION_ALONE.flags.writeable = False


@dataclass
class Question:
    """One frame and the goals (..., 4, 4) it is to reach; weights (6,) of the error; limits (2, dof), or
    (2, 0) without any; tolerance [m, rad].
    """

    frame: int
    goals: Array
    weights: Array
    limits: Array
    tolerance: float


def largest_speeds(robot: KinematicModel, velocity: Any) -> Array:
    """The largest speeds of the joints (n,), or (0,) for none."""
    if velocity is False:
        return np.empty(0)
    n = len(robot.joint_names)
    given = robot.limits.velocity if velocity is True else velocity
    speeds = as_floats(given, "velocity", last=(n,), finite=False)
    if speeds.ndim != 1 or not (speeds >= 0).all():
        raise InputError(f"velocity must be ({n},) speeds, 0 or more, one per joint of {robot.name}")
    return np.ascontiguousarray(speeds)


def pose_problem(
    robot: KinematicModel,
    goal: Any,
    position: Any,
    frame: str | None,
    weights: Any,
    limits: Any,
    tolerance: Any,
) -> Question:
    """The arguments that all descents share.

    Raises InputError for a goal that is not a pose, weights that are negative or all zero, limits upside
    down, a tolerance that is not positive, a floating base, or a frame that more than 16 joints move;
    InputTypeError unless there is one goal; UnknownNameError for a frame that is not there.
    """
    check_robot(robot)
    number = frame_number(robot, frame)
    if robot.floating:
        raise InputError(
            f"the base of {robot.name} is floating, and the pose of a frame does not determine it;"
            " robot.ik_tasks(tasks) moves base and joints together"
        )
    moving = _core._ik_moving(robot, number)
    if moving > MOST_PATH:
        raise InputError(
            f"{moving} joints of {robot.name} move the frame; this function accepts up to {MOST_PATH},"
            " robot.ik_tasks any number"
        )
    if (goal is None) == (position is None):
        raise InputTypeError("give one goal: a pose T (..., 4, 4) of the frame, or position= (..., 3)")
    if position is None:
        goals, counted = as_pose(goal, "goal"), EVERYTHING if weights is None else _weights(weights)
    else:
        if weights is not None:
            raise InputTypeError("weights= can only be used with a pose; leave them out for position=")
        goals = assemble(np.eye(3), as_floats(position, "position", last=(3,)))  # the rotation does not count
        counted = POSITION_ALONE
    far = np.abs(goals[..., :3, 3]).max(initial=0.0)
    if far > FARTHEST / 3:
        raise InputError(f"a goal is {far:g} m away; the maximum is {FARTHEST:g} m")
    return Question(number, goals, counted, bounds_of(robot, limits), positive_number(tolerance, "tolerance"))


def _weights(value: Any) -> Array:
    weights = as_floats(value, "weights", last=(6,), largest=1e6)
    if weights.ndim != 1 or (weights < 0).any() or not weights.any():
        raise InputError(f"weights is {weights.tolist()}; expected six numbers, 0 or more, not all of them 0")
    return np.ascontiguousarray(weights)


def bounds_of(robot: KinematicModel, limits: Any) -> Array:
    """The limits of the joints as rows lower and upper (2, n), or (2, 0) for False; errors of limits_of."""
    return np.empty((2, 0)) if limits is False else limits_of(robot.limits, limits, robot.name).range


def middle_configuration(robot: KinematicModel, bounds: Array) -> Array:
    """The middle between the limits (n,); zero, or the limit nearest to it, where one is missing."""
    if not bounds.size:
        return np.zeros(len(robot.joint_names))
    lower, upper = bounds
    both = np.isfinite(lower) & np.isfinite(upper)
    with np.errstate(invalid="ignore"):
        halfway = 0.5 * (lower + upper)
    return np.asarray(np.where(both, halfway, np.clip(0.0, lower, upper)))


def further_starts(robot: KinematicModel, bounds: Array, goals: Array, count: int, rng: Any) -> Array:
    """Configurations (count, n) all over the limits, to start from.

    Angles without limits lie in (−π, π]; prismatic joints without limits reach as far as the goals and the
    tip at zero. rng: seed or generator of random ones; None spreads them evenly, the same in every call.
    """
    n = len(robot.joint_names)
    share = spread_points(count, n) if rng is None else as_generator(rng).random((count, n))
    reach = 1.0
    if "P" in robot.joint_types:
        reach = LEAST_SLIDE + float(np.abs(goals[..., :3, 3]).max(initial=0.0))
    span = np.where([kind == "P" for kind in robot.joint_types], reach, np.pi)
    low, high = bounds if bounds.size else (np.full(n, -np.inf), np.full(n, np.inf))
    open_low, open_high = ~np.isfinite(low), ~np.isfinite(high)
    lower = np.where(open_low, np.where(open_high, -span, high - 2 * span), low)
    upper = np.where(open_high, np.where(open_low, span, low + 2 * span), high)
    return np.ascontiguousarray(upper - share * (upper - lower))


@lru_cache(maxsize=32)
def spread_points(count: int, n: int) -> Array:
    """Points (count, n) of the unit cube, evenly spread: multiples of the powers of 1/φ, where φ is the
    positive root of xⁿ⁺¹ = x + 1 (the additive recurrence of Roberts 2018).
    """
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (n + 1))
    powers = root ** -np.arange(1.0, n + 1)
    points = np.mod(0.5 + np.arange(1, count + 1)[:, None] * powers, 1.0)
    points.flags.writeable = False
    return points
