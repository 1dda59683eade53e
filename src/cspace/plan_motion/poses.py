"""Configurations of poses and partial goals: all IK solutions, or samples where the arm is redundant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from cspace.arrays import Array
from cspace.ik.goals.given import goal_array
from cspace.ik.near_rows import solve_each_locked_near, solve_locked_near, sort_near
from cspace.plan_motion.goals import Goals
from cspace.planning import ArmSpace
from cspace.search.halton import halton_points
from cspace.spatial.checks import PoseLike

if TYPE_CHECKING:
    from cspace.ik import Solutions
    from cspace.robot import Robot

FEW_VALUES: Final = 9
"""Values of each redundant joint at which a pose is solved: of the poses of 349 Panda problems three in a
hundred have no free solution among them."""

MANY_VALUES: Final = 256
"""The same where none of these solutions is within limits and free: half a millisecond."""

MOST_VALUES: Final = 4096
"""Combinations of values of several redundant joints: ten milliseconds."""

SHOWN_POSES: Final = 3
"""Poses without a solution of which a reason tells."""

STARTS: Final = 256
"""Descents within limits where few values of several redundant joints have no solution: a third of them find
one where 4096 values have none, and they take a millisecond."""


def solve_pose(robot: Robot, space: ArmSpace, start: Array, goal: PoseLike) -> Goals:
    """All IK solutions of a pose; of a redundant arm samples, most at some values of its redundant joints."""
    if not robot.solver.is_redundant:
        return keep_solutions(robot, space, start, robot.ik(goal))
    is_plain = type(goal) is np.ndarray and goal.dtype == np.float64 and goal.flags.carray
    T = goal if is_plain else goal_array(goal)  # the core checks that it is a pose
    rows = solve_redundant(robot, space, start, T, FEW_VALUES)
    if not len(rows) and len(robot.solver.redundant_joints) > 1:  # they may fill a corner of the limits alone
        rows = sort_near(robot.solver, robot.ik_many_starts(T, STARTS, rng=0).q, robot.limits, start)
    return few_samples(robot, space, start, T, rows) or solve_pose_densely(robot, space, start, T)


def solve_any_pose(robot: Robot, space: ArmSpace, start: Array, poses: Array) -> Goals:
    """The solutions of several poses (g, 4, 4), any of which is the goal; the nearest to the start first."""
    return join_goals(robot, start, [solve_pose(robot, space, start, T) for T in poses])


def join_goals(robot: Robot, start: Array, parts: Sequence[Goals]) -> Goals:
    """The configurations of several goals as those of one; its reason is that of each goal."""
    is_whole = all(part.is_whole for part in parts)
    rows = sort_near(robot.solver, np.concatenate([part.rows for part in parts]), robot.limits, start)
    if not len(rows):
        named = "; ".join(f"pose {k}: {part.reason}" for k, part in enumerate(parts[:SHOWN_POSES]))
        others = f"; and {len(parts) - SHOWN_POSES} more" if len(parts) > SHOWN_POSES else ""
        return Goals(rows, named + others, is_whole=is_whole)
    if all(part.find_more is None for part in parts):
        return Goals(rows, is_whole=is_whole)
    more = partial(join_more, robot, start, parts)
    return Goals(rows, is_whole=is_whole, find_more=more)


def join_more(robot: Robot, start: Array, parts: Sequence[Goals]) -> Goals:
    """As join_goals, with further configurations of each goal that has some."""
    return join_goals(
        robot,
        start,
        [replace(part.find_more() if part.find_more else part, find_more=None) for part in parts],
    )


def solve_each_pose(
    robot: Robot, space: ArmSpace, starts: Array, T: Array, threads: int
) -> Sequence[Goals | None]:
    """What solve_pose finds for poses T (n, 4, 4), each with a start of its own (n, dof), on so many threads.

    None for a pose without a solution among many samples, and for arms that are not redundant.
    """
    goals: list[Goals | None] = [None] * len(T)
    if not robot.solver.is_redundant:
        return goals
    few = solve_each_redundant(robot, space, starts, T, FEW_VALUES, threads)
    for k, rows in enumerate(few):
        goals[k] = few_samples(robot, space, starts[k], T[k], rows)
    rest = [k for k, rows in enumerate(few) if not len(rows)]
    many = solve_each_redundant(robot, space, starts[rest], T[rest], MANY_VALUES, threads)
    for k, rows in zip(rest, many, strict=True):
        goals[k] = Goals(rows, is_whole=False) if len(rows) else None
    return goals


def solve_each_redundant(
    robot: Robot, space: ArmSpace, starts: Array, T: Array, each: int, threads: int
) -> list[Array]:
    """As solve_redundant of poses T (n, 4, 4), each with a start of its own (n, dof)."""
    values = keep_values(robot, space, each)
    return solve_each_locked_near(robot.solver, T, values, robot.limits, starts, threads)


def few_samples(robot: Robot, space: ArmSpace, start: Array, T: Array, rows: Array) -> Goals | None:
    """Solutions of a pose T (4, 4) of a redundant arm that are few samples; None if there are none."""
    more = partial(solve_pose_densely, robot, space, start, T)
    return Goals(rows, is_whole=False, find_more=more) if len(rows) else None


def solve_pose_densely(robot: Robot, space: ArmSpace, start: Array, T: Array) -> Goals:
    """The solutions of a pose T (4, 4) of a redundant arm at many values of its redundant joints, or those
    that robot.ik lists."""
    rows = solve_redundant(robot, space, start, T, MANY_VALUES)
    return Goals(rows, is_whole=False) if len(rows) else keep_solutions(robot, space, start, robot.ik(T))


def solve_redundant(robot: Robot, space: ArmSpace, start: Array, T: Array, each: int) -> Array:
    """The solutions of a pose T (4, 4) within limits at so many values of each redundant joint (k, dof), the
    nearest to the start first."""
    return solve_locked_near(robot.solver, T, keep_values(robot, space, each), robot.limits, start)


def keep_values(robot: Robot, space: ArmSpace, each: int) -> Array:
    """Values (n, r) of the redundant joints, so many of each; made once for a robot."""
    kept, name = space.geometry._kept, f"redundant values {each}"
    if name not in kept:
        kept[name] = spread_redundant(robot, space, each)
    values: Array = kept[name]
    return values


def spread_redundant(robot: Robot, space: ArmSpace, each: int) -> Array:
    """Values (n, r) of the redundant joints, spread evenly between their bounds."""
    width = len(robot.solver.redundant_joints)
    if width == 1:
        return scale_redundant(robot, space, (np.arange(each)[:, None] + 0.5) / each)
    return scale_redundant(robot, space, halton_points(0, min(each**width, MOST_VALUES), width))


def scale_redundant(robot: Robot, space: ArmSpace, u: Array) -> Array:
    """Values (n, r) of the redundant joints from points of the unit cube (n, r)."""
    low, high = space.bounds[:, list(robot.solver.redundant_joints)]
    return np.ascontiguousarray(low + (high - low) * u)


def keep_solutions(
    robot: Robot, space: ArmSpace, start: Array, solutions: Solutions, more: Sequence[Array] = ()
) -> Goals:
    """Of solutions and further configurations those within limits, or the reason why there are none."""
    none = np.empty((0, space.dof))
    if not solutions:
        return Goals(none, f"no IK solution: {solutions.reason}", is_whole=bool(solutions.complete))
    is_whole = solutions.status == "exact" and bool(solutions.complete) and not solutions.freedom
    q = np.concatenate([solutions.q, *more]) if more else solutions.q
    rows = sort_near(robot.solver, q, robot.limits, start)
    if not len(rows):
        sampled = "" if is_whole else " among those sampled"
        reason = solutions.within(robot.limits).reason
        return Goals(none, f"no IK solution within limits{sampled}: {reason}", is_whole=is_whole)
    return Goals(rows, is_whole=is_whole)
