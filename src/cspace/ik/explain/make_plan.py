"""From a robot, and the goal parts, a pose or parts of one, to the explanation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputTypeError, name_new_keywords, name_type, suggest
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.explain.describe import refused_plan, settled_plan, survey_of
from cspace.ik.explain.locked_joints import locked_plan
from cspace.ik.explain.page import Block, lay_out_table
from cspace.ik.explain.plan import IkPlan
from cspace.ik.explain.screws import vector_text
from cspace.ik.goals.given import is_open
from cspace.ik.goals.partial import KEYWORDS, PartialGoal
from cspace.ik.goals.parts import POINTED, check_tool_axis, partial_goal
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

    The answer is built from the plan of the solver itself. It prints, has to_markdown() and to_latex(), and
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


TYPICAL = MappingProxyType(
    {
        "position": (0.1, 0.2, 0.3),
        "rotation": np.eye(3),
        "direction": (0.0, 0.0, 1.0),
        "look_at": (0.1, 0.2, 0.3),
        "ray": ((0.1, 0.2, 0.3), (0.0, 0.0, 1.0)),
        "angle_to": ("z", 0.5),
    }
)
"""Values where none are given: the method depends on them for angle_to alone, and on open coordinates."""
DIRECT = 3
"""Up to so many joints bring a point to a point without help."""


def goal_of_parts(goal_parts: Any, tool_axis: Any) -> PartialGoal:
    """The goal that stands for all of its kind. Raises InputTypeError for keywords that make none."""
    if isinstance(goal_parts, str):
        goal_parts = [word.strip() for word in goal_parts.replace("+", ",").split(",")]
    if not isinstance(goal_parts, Iterable) or isinstance(goal_parts, np.ndarray):
        raise InputTypeError(
            f"goal_parts is {name_type(goal_parts)}, expected names of parts of a pose, ('position', "
            "'direction'), or a dict with their values"
        )
    names = list(goal_parts)
    for name in names:
        if not isinstance(name, str) or name not in KEYWORDS:
            raise suggest("part", name, KEYWORDS, owner="a pose")
    if not names:
        raise InputTypeError(f"goal_parts is empty, expected some of {', '.join(KEYWORDS)}")
    values = goal_parts if isinstance(goal_parts, Mapping) else {name: TYPICAL[name] for name in names}
    return partial_goal({name: values[name] for name in KEYWORDS if name in values}, tool_axis)


def plan_of_parts(solver: Solver, goal: PartialGoal, plan_of: Callable[[Solver], IkPlan]) -> IkPlan:
    """How goals of this kind are met. plan_of: how poses of an arm are."""
    joints = len(solver.joint_names)
    whole_point = goal.kind == "position" and not is_open(goal.value["position"])
    if not (goal.before or goal.behind) or (whole_point and joints <= DIRECT):
        return plan_of(solver)
    whole = solver.extend(goal)
    plan = plan_of(whole)
    added = len(goal.before) + len(goal.behind)
    notes = [
        f"The goal is {goal.text}; what it leaves open is a motion, made by "
        + ("a joint that does not exist" if added == 1 else f"{added} joints that do not exist")
        + f". With {'it' if added == 1 else 'them'} the goal is a pose of an arm of {len(whole.joint_names)} "
        "joints, to which all below belongs. Solutions that differ in these joints alone count once.",
    ]
    if goal.kind not in ("position", "rotation"):
        notes.append(f"The tool axis is ({vector_text(goal.axis)}) in the tip.")
    if "look_at" in goal.kind:
        notes.append("Solutions that have the point behind the tool, at a negative slide, are dropped.")
    if "angle_to" in goal.kind:
        notes.append(
            "Between the last two joints there is a fixed turn, the angle that is asked for: "
            f"{goal.tilt:.6g} rad here."
        )
    own = slice(len(goal.before), len(goal.before) + solver.dof)
    behind = np.linalg.inv(solver.chain.T_zero) @ whole.chain.T_zero

    def values(q: Array, T: Array) -> dict[str, Any]:
        padded = np.zeros((*q.shape[:-1], whole.dof))  # the joints of the goal at zero
        padded[..., own] = q
        return dict(plan._values(padded, T @ behind)) if plan._values else {}

    return replace(
        plan,
        summary=f"asked for {goal.text}. {plan.summary[0].upper()}{plan.summary[1:]}",
        notes=(*notes, *plan.notes),
        tables={"Joints of the goal": goal_joints(goal), **plan.tables},
        counted=f"{plan.counted}; with the joints of the goal left out there may be fewer",
        calls=calls_of(goal, plan),
        other_ways={},
        _values=values if plan._values else None,
        _other_values=None,
        _dof=solver.dof,
    )


def calls_of(goal: PartialGoal, plan: IkPlan) -> tuple[str, ...]:
    """What the call that asks for the goal does."""
    words = ", ".join(f"{name}=…" for name in goal.kind.split("+"))
    if not plan.locked:
        return (f"`robot.ik({words})` lists every solution of the steps above; `near=` picks the nearest.",)
    if len(plan.locked) > 1:
        rule = "the configuration nearest to the middle of the limits"
    else:
        rule = f"all branches at 16 values of `{plan.locked[0]}`, spread over its feasible intervals"
    near = next(call for call in plan.calls if call.startswith("`near=`"))
    return (f"`robot.ik({words})` answers with {rule}.", near)


def goal_joints(goal: PartialGoal) -> Block:
    """Which motions stand for what the goal leaves open."""
    rows = []
    for i, (kind, axis) in enumerate((*goal.before, *goal.behind)):
        before = i < len(goal.before)
        what = "prismatic" if kind == "P" else "revolute"
        where = "before the base" if before else "behind the tip"
        rows.append((f"`{goal.joint_names[i]}`", where, what, vector_text(axis), "base" if before else "tip"))
    return lay_out_table(("joint", "place", "type", "axis", "seen in"), rows)
