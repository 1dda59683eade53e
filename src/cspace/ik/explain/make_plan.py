"""From a robot, and what will be asked of it, to the explanation."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.errors import InputTypeError
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.explain.describe import refused_plan, settled_plan, survey_of
from cspace.ik.explain.goal_parts import goal_of_parts, plan_of_parts
from cspace.ik.explain.locked_joints import locked_plan
from cspace.ik.explain.plan import IkPlan
from cspace.ik.goals.partial import check_tool_axis
from cspace.ik.locked_joints import locked_values
from cspace.ik.prepare import check_chain, prepare
from cspace.kinematics.batch import check_robot

__all__ = ["ik_plan"]


def ik_plan(robot: Any, *, goal_parts: Any = None, locked: Any = None, tool_axis: Any = "z") -> IkPlan:
    """How `robot.ik` solves an arm: the geometry found, the steps, the equations with its numbers.

    goal_parts: the parts of a pose that goals will have, by the keywords of `robot.ik`: "position", or
    ("position", "direction"), or a dict with values, {"position": (None, None, 0.1)}, where these change
    the method; a full pose unless given. tool_axis: as in `robot.ik`. locked: joints that will be locked,
    by name or number, with their values, {"joint4": 0.3}; of an arm with redundant joints the solver's own
    choice unless given.

    The answer is built from what the solver itself holds. It prints, has to_markdown() and to_latex(), and
    plan.residuals(q, T) evaluates every equation. An arm that nothing solves gets a plan that is false and
    says why. Raises InputTypeError for a value that is not a robot and for goals that are none, InputError
    for joints that the arm does not have.
    """
    check_robot(robot)
    if goal_parts is not None:
        if locked is not None:
            raise InputTypeError("locked= goes with a full pose: leave goal_parts= out")
        goal = goal_of_parts(goal_parts, tool_axis)
        return plan_of_parts(robot, goal, plan_of_poses) if is_chain(robot) else plan_of_poses(robot)
    check_tool_axis(tool_axis, ())
    return plan_of_poses(robot, locked)


def is_chain(robot: Any) -> bool:
    """Whether the robot is one that robot.ik answers for."""
    try:
        check_chain(robot)
    except NoClosedFormError:
        return False
    return True


def plan_of_poses(robot: Any, locked: Any = None) -> IkPlan:
    """How full poses are answered."""
    try:
        prepare(robot)
    except NoClosedFormError as error:
        return refused_plan(survey_of(robot), str(error))
    given = locked_values(robot, {} if locked is None else locked)
    if any(np.ndim(value) for value in given.values()):
        raise InputTypeError("locked= takes one value per joint here: the plan is that of one arm")
    values = {joint: float(value) for joint, value in given.items()}
    if values or not robot._ik_direct:
        return locked_plan(robot, values, survey_of(robot))
    return settled_plan(robot, survey_of(robot))
