"""From a robot, and what will be asked of it, to the explanation."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.errors import InputTypeError
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.explain.asked import asked_plan, goal_asked
from cspace.ik.explain.describe import refused_plan, settled_plan, survey_of
from cspace.ik.explain.held import held_plan
from cspace.ik.explain.plan import IkPlan
from cspace.ik.held import fixed_values
from cspace.ik.partial import check_tool_axis
from cspace.ik.prepare import check_chain, prepare
from cspace.kinematics.batch import check_robot

__all__ = ["ik_plan"]


def ik_plan(robot: Any, *, asked: Any = None, fixed: Any = None, tool_axis: Any = "z") -> IkPlan:
    """How `robot.ik` solves an arm: the geometry found, the steps, the equations with its numbers.

    asked: the parts of a pose that goals will have, by the keywords of `robot.ik`: "position", or
    ("position", "direction"), or a dict with values, {"position": (None, None, 0.1)}, where these change the
    method; a full pose unless given. tool_axis: as in `robot.ik`. fixed: joints that will be held, by name or
    number, with their values, {"joint4": 0.3}; of an arm with joints to spare the solver's own choice unless
    given.

    The answer is built from what the solver itself holds. It prints, has to_markdown() and to_latex(), and
    plan.residuals(q, T) evaluates every equation. An arm that nothing solves gets a plan that is false and
    says why. Raises InputTypeError for what is no robot and for goals that are none, InputError for joints
    that the arm does not have.
    """
    check_robot(robot)
    if asked is not None:
        if fixed is not None:
            raise InputTypeError("fixed= goes with a full pose: leave asked= out")
        goal = goal_asked(asked, tool_axis)
        return asked_plan(robot, goal, plan_of_poses) if is_chain(robot) else plan_of_poses(robot)
    check_tool_axis(tool_axis, ())
    return plan_of_poses(robot, fixed)


def is_chain(robot: Any) -> bool:
    """Whether the robot is one that robot.ik answers for."""
    try:
        check_chain(robot)
    except NoClosedFormError:
        return False
    return True


def plan_of_poses(robot: Any, fixed: Any = None) -> IkPlan:
    """How full poses are answered."""
    try:
        prepare(robot)
    except NoClosedFormError as error:
        return refused_plan(survey_of(robot), str(error))
    given = fixed_values(robot, {} if fixed is None else fixed)
    if any(np.ndim(value) for value in given.values()):
        raise InputTypeError("fixed= takes one value per joint here: the plan is that of one arm")
    values = {joint: float(value) for joint, value in given.items()}
    if values or not robot._ik_direct:
        return held_plan(robot, values, survey_of(robot))
    return settled_plan(robot, survey_of(robot))
