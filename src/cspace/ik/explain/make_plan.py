"""From a robot, and what will be asked of it, to the explanation."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from cspace.errors import InputTypeError, name_new_keywords
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.explain.describe import refused_plan, settled_plan, survey_of
from cspace.ik.explain.goal_parts import goal_of_parts, plan_of_parts
from cspace.ik.explain.locked_joints import locked_plan
from cspace.ik.explain.plan import IkPlan
from cspace.ik.goals.parts import POINTED, check_tool_axis
from cspace.ik.locked_joints import locked_values
from cspace.ik.solver import HasSolver, Solver, as_solver
from cspace.kinematics import KinematicModel


@name_new_keywords
def ik_plan(robot: HasSolver, *, goal_parts: Any = None, locked: Any = None, tool_axis: Any = "z") -> IkPlan:
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
    if not isinstance(robot, KinematicModel):
        as_solver(robot)  # raises
    try:
        solver = as_solver(robot)
    except NoClosedFormError as error:
        check_tool_axis(tool_axis, () if goal_parts is None else POINTED)
        return refused_plan(survey_of(cast(KinematicModel, robot)), str(error))
    if goal_parts is not None:
        if locked is not None:
            raise InputTypeError("locked= can only be combined with a full pose; leave goal_parts= out")
        return plan_of_parts(solver, goal_of_parts(goal_parts, tool_axis), plan_of_poses)
    check_tool_axis(tool_axis, ())
    return plan_of_poses(solver, locked)


def plan_of_poses(solver: Solver, locked: Any = None) -> IkPlan:
    """How full poses are answered."""
    given = locked_values(solver, {} if locked is None else locked)
    if any(np.ndim(value) for value in given.values()):
        raise InputTypeError("locked= takes one value per joint here, because a plan describes one arm")
    values = {joint: float(value) for joint, value in given.items()}
    if values or solver.is_redundant:
        return locked_plan(solver, values, survey_of(solver))
    return settled_plan(solver, survey_of(solver))
