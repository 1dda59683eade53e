"""Configurations of partial goals: all IK solutions, or samples of what the goal leaves free."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from inspect import signature
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.plan_motion.goals import Goals
from cspace.plan_motion.poses import keep_solutions
from cspace.plan_motion.regions import FIRST_POSES, POSE_JOINTS, sample_region, solve_poses
from cspace.planning import ArmSpace, Region

if TYPE_CHECKING:
    from cspace.robot import Robot

GOAL_SAMPLES: Final = 16
"""Configurations that are looked for where a goal that is not a region leaves freedom."""

REGION_PARTS: Final = frozenset({"position", "direction", "rotation", "tool_axis"})
"""The keywords of a partial goal that a region has too."""


def solve_parts(robot: Robot, space: ArmSpace, start: Array, goal: Mapping[str, Any]) -> Goals:
    """The solutions of a goal by keywords of robot.ik, and samples of what it leaves free.

    Raises UnknownNameError for a key that is no keyword of robot.ik.
    """
    known = signature(robot.ik).parameters
    if unknown := [key for key in goal if key not in known]:
        raise suggest("keyword", unknown[0], known, owner="robot.ik, which the goal names")
    solutions = robot.ik(**goal)
    if not solutions.freedom or "near" in goal:
        return keep_solutions(robot, space, start, solutions)
    region = region_of(space, goal)
    if region is None:
        return keep_solutions(robot, space, start, solutions, sample_freedom(robot, goal))
    goals = keep_solutions(robot, space, start, solutions, sample_poses(robot, space, region))
    return replace(goals, find_more=partial(sample_region, robot, space, start, region))


def region_of(space: ArmSpace, goal: Mapping[str, Any]) -> Region | None:
    """The region of size zero that a partial goal is, for an arm that reaches whole poses; else None."""
    given = {name: value for name, value in goal.items() if value is not None}
    point = given.pop("position", None)
    if space.dof < POSE_JOINTS or not REGION_PARTS.issuperset(given) or np.shape(point) not in ((), (3,)):
        return None
    if point is not None and any(value is None for value in point):
        return None
    axis = given.pop("tool_axis", "z")
    pointing = {"axis": axis} if "direction" in given else {}
    return Region(None if point is None else (np.zeros(3), point), **pointing, **given)


def sample_poses(robot: Robot, space: ArmSpace, region: Region) -> list[Array]:
    """The IK solutions of poses of a region."""
    q, count = solve_poses(robot, space, region, 0, FIRST_POSES)
    return [rows[:n] for rows, n in zip(q, count, strict=True) if n]


def sample_freedom(robot: Robot, goal: Mapping[str, Any]) -> list[Array]:
    """Configurations (1, dof) that reach a goal that leaves freedom, each the nearest to a random one."""
    seeds = robot.random_configuration(GOAL_SAMPLES, rng=0, reach=1.0)
    return [solutions.q[:1] for q in seeds if (solutions := robot.ik(**goal, near=q))]
