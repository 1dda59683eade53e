"""Configurations of poses and partial goals: all IK solutions, or samples where the arm is redundant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.ik.goals.given import goal_array
from cspace.ik.near_rows import solve_locked_near, sort_near
from cspace.plan_goals.goals import Goals
from cspace.planning import ArmSpace
from cspace.search.halton import halton_points

if TYPE_CHECKING:
    from cspace.ik import Solutions
    from cspace.robot import Robot

FEW_VALUES: Final = 9
"""Values of the redundant joints at which a pose is solved: of the poses of 349 Panda problems three in a
hundred have no free solution among them."""

MANY_VALUES: Final = 256
"""The same where none of these solutions is free: half a millisecond."""

GOAL_SAMPLES: Final = 16
"""Configurations that are looked for where a partial goal leaves freedom."""


def solve_pose(robot: Robot, space: ArmSpace, start: Array, goal: Any) -> Goals:
    """All IK solutions of a pose; of a redundant arm those at some values of its redundant joints."""
    if not robot.solver.is_redundant:
        return keep_solutions(robot, space, start, robot.ik(goal))
    T = goal_array(goal)
    rows = solve_redundant(robot, space, start, T, FEW_VALUES)
    if len(rows):
        return Goals(rows, is_whole=False, pose=T)
    return keep_solutions(robot, space, start, robot.ik(T))


def solve_redundant(robot: Robot, space: ArmSpace, start: Array, T: Array, count: int) -> Array:
    """The solutions of a pose T (4, 4) within limits at so many values of the redundant joints (k, dof), the
    nearest to the start first."""
    kept, name = space.geometry._kept, f"redundant values {count}"
    if name not in kept:
        kept[name] = spread_redundant(robot, space, count)
    return solve_locked_near(robot.solver, T, kept[name], robot.limits, start)


def spread_redundant(robot: Robot, space: ArmSpace, count: int) -> Array:
    """Values (count, r) of the redundant joints, spread evenly between their bounds."""
    joints = robot.solver.redundant_joints
    if len(joints) == 1:
        u = (np.arange(count)[:, None] + 0.5) / count
    else:
        u = halton_points(0, count, len(joints))
    return scale_redundant(robot, space, u)


def scale_redundant(robot: Robot, space: ArmSpace, u: Array) -> Array:
    """Values (n, r) of the redundant joints from points of the unit cube (n, r)."""
    low, high = space.bounds[:, list(robot.solver.redundant_joints)]
    return np.ascontiguousarray(low + (high - low) * u)


def solve_parts(robot: Robot, space: ArmSpace, start: Array, goal: Mapping[str, Any]) -> Goals:
    """The solutions of a goal by keywords of robot.ik, and samples of what it leaves free."""
    solutions = robot.ik(**goal)
    more = sample_freedom(robot, goal) if solutions.freedom and "near" not in goal else ()
    return keep_solutions(robot, space, start, solutions, more)


def sample_freedom(robot: Robot, goal: Mapping[str, Any]) -> list[Array]:
    """Configurations that reach a goal that leaves freedom, each the nearest to a random one."""
    seeds = robot.random_configuration(GOAL_SAMPLES, rng=0, reach=1.0)
    found = [robot.ik(**goal, near=q) for q in seeds]
    return [solutions.q[0] for solutions in found if solutions]


def keep_solutions(
    robot: Robot, space: ArmSpace, start: Array, solutions: Solutions, more: Sequence[Array] = ()
) -> Goals:
    """Of solutions and further configurations those within limits, or the reason why there are none."""
    none = np.empty((0, space.dof))
    if not solutions:
        return Goals(none, f"no IK solution: {solutions.reason}", is_whole=bool(solutions.complete))
    is_whole = solutions.status == "exact" and bool(solutions.complete) and not solutions.freedom
    q = np.concatenate([solutions.q, *(row[None] for row in more)]) if more else solutions.q
    rows = sort_near(robot.solver, q, robot.limits, start)
    if not len(rows):
        sampled = "" if is_whole else " among those sampled"
        reason = solutions.within(robot.limits).reason
        return Goals(none, f"no IK solution within limits{sampled}: {reason}", is_whole=is_whole)
    return Goals(rows, is_whole=is_whole)
