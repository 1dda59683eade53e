"""From the solver of an arm of up to six joints to its explanation."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.ik.conditions import arm_length, common_point, explain_missing_form
from cspace.ik.explain.few_joints import few_joint_steps, orientation_steps, placed_wrist_steps
from cspace.ik.explain.findings import Step
from cspace.ik.explain.form import Form
from cspace.ik.explain.general import Loop
from cspace.ik.explain.parallel import first_parallel_steps, middle_parallel_steps, three_parallel_steps
from cspace.ik.explain.plan import IkPlan
from cspace.ik.explain.screws import Screws, goal_values, joint_values
from cspace.ik.explain.survey import invariant_directions, invariant_points, measure_relations
from cspace.ik.explain.wrist import wrist_constants, wrist_steps
from cspace.ik.geometry import PIEPER_CASES
from cspace.ik.solver import Solver
from cspace.kinematics import KinematicModel
from cspace.model import Chain
from cspace.tolerances import FORM_DEVIATION

SPHERICAL_WRIST, THREE_PARALLEL, MIDDLE_PARALLEL, FIRST_PARALLEL = 1, 2, 3, 4
"""The families of the core."""
SUMMARIES = {
    SPHERICAL_WRIST: "the last three axes meet in a point, the wrist: three joints place it, three turn "
    "about it",
    THREE_PARALLEL: "axes 2, 3 and 4 are parallel and axes 5 and 6 meet: the plane across the parallel axes "
    "separates the equations",
    MIDDLE_PARALLEL: "axes 2, 3 and 4 are parallel: two equations without them fix two other joints",
    FIRST_PARALLEL: "axes 1, 2 and 3 are parallel: two equations without them fix two other joints",
}


def survey_of(robot: KinematicModel) -> IkPlan:
    """What an explanation says of every arm: its joints, its length, what its axes share. No steps yet."""
    chain = robot.chain
    measurable = chain.dof == len(chain.joint_types) and len(chain.joint_types) > 0
    length = arm_length(robot) if measurable else 1.0
    if isinstance(robot, _core.SolverBase):
        length = _core._ik_geometry(robot)["length"]
    return IkPlan(
        robot.name,
        tuple(chain.joint_names),
        length=length,
        relations=measure_relations(chain, length),
        invariant_points=invariant_points(chain, length),
        invariant_directions=invariant_directions(chain, length),
    )


def settled_plan(solver: Solver, survey: IkPlan, numbers: tuple[int, ...] | None = None) -> IkPlan:
    """An arm of up to six joints. numbers: by which (from 1) the user knows them, 1, 2, … unless given."""
    if solver.is_redundant:
        return refused_plan(survey, explain_missing_form(solver))
    chain = solver.chain
    seen = _core._ik_geometry(solver)
    kind, plan = _core._ik_numbers(solver)
    survey = replace(survey, length=seen["length"])
    if kind == "closed" and seen["family"] in SUMMARIES:
        return form_plan(Form.of(plan), seen, survey, numbers)
    if kind == "general":
        return general_plan(Loop.of(plan), survey)
    return few_joint_plan(chain, survey)


def refused_plan(survey: IkPlan, reason: str) -> IkPlan:
    """An arm that nothing solves: what its axes share."""
    return replace(survey, summary="`robot.ik` does not solve this arm.", reason=reason)


ONE_CALL = (
    "`robot.ik(T)` lists every solution of the steps above; `near=` picks the nearest of them.",
    "`robot.track(poses)` begins a branch at each solution of the first pose and follows it by the joints' "
    "velocity and acceleration along the path, $J q' = t$, and Newton's method, until a joint meets its "
    "limit or two branches meet and vanish.",
)
"""What is asked of an arm whose solutions are finite in number."""
COMPLETED = " of the completed arm; the arm's own are those with its virtual joints at zero"
"""Whose solutions are counted, where virtual joints complete an arm."""


def form_plan(
    form: Form, seen: dict[str, Any], survey: IkPlan, numbers: tuple[int, ...] | None = None
) -> IkPlan:
    """An arm with a closed form."""
    family = seen["family"]
    constants = form.constants()
    summary = SUMMARIES[family]
    if family == SPHERICAL_WRIST:
        kind = seen["pieper_case"]
        constants |= wrist_constants(form)
        steps = wrist_steps(form, kind)
        summary += f"; of the first three, {PIEPER_CASES[kind]}"
    else:
        steps = {
            THREE_PARALLEL: three_parallel_steps,
            MIDDLE_PARALLEL: middle_parallel_steps,
            FIRST_PARALLEL: first_parallel_steps,
        }[family](form)
    name = "spherical wrist" if family == SPHERICAL_WRIST else "three parallel axes"
    if form.reversed:
        summary = f"read from the tip, {summary}"
    return replace(
        survey,
        family=name,
        summary=f"{name}. {summary[0].upper()}{summary[1:]}.",
        branches=count_ways(steps),
        counted=COMPLETED if seen["virtual_joints"] else "",
        notes=notes_of(form, seen),
        tables={"Denavit–Hartenberg form of the solver": form.table(survey.joints, numbers)},
        matrices={"B": form.base, "C": form.tool},
        constants=constants,
        steps=tuple(steps),
        _values=form.values,
    )


def notes_of(form: Form, seen: dict[str, Any]) -> tuple[str, ...]:
    """What has to be known to read the equations."""
    goal = "T^{-1}" if form.reversed else "T"
    notes = []
    if form.reversed:
        notes.append(
            "The arm is read from the tip to the base: joint 1 of the solver is the last joint of the "
            "arm, and the goal is the inverse of the pose."
        )
    if seen["virtual_joints"]:
        virtual = [str(i + 1) for i, joint in enumerate(form.joint) if joint < 0]
        notes.append(
            f"Virtual joints ({', '.join(virtual)} of the six below) complete the arm to six, in a place "
            "where a closed form appears. A pose that the arm reaches is one that the completed arm "
            "reaches with its virtual joints at zero; solutions with other values are dropped."
        )
    notes.append(
        f"$P = B^{{-1}} {goal} C^{{-1}}$ is the goal from the frame of axis 1 to that of axis 6; $p$ is "
        "its origin, $r_{ij}$ are the entries of its rotation. $c_1$, $s_{23}$ are cosine and sine "
        "of $t_1$, $t_2 + t_3$; $c_{\\alpha_1}$, $s_{\\alpha_1}$ those of a twist."
    )
    if seen["deviation"] > FORM_DEVIATION:
        corrected = "; Newton steps on the true axes correct it" if seen["polish"] else ""
        notes.append(
            "The form takes axes as parallel or meeting that are so within rounding; poses differ by up "
            f"to {seen['deviation']:.1g} of the arm's length ({seen['length']:.3g} m){corrected}."
        )
    return tuple(notes)


def general_plan(loop: Loop, survey: IkPlan) -> IkPlan:
    """Up to six joints, revolute or prismatic, without a closed form on lanes."""
    n = len(survey.joints)
    notes: tuple[str, ...] = ()
    if n < 6:
        notes = (
            f"Virtual joints ({', '.join(str(i + 1) for i in range(n, 6))}) behind the last complete the "
            "arm to six. A pose that the arm reaches is one that the completed arm reaches with its "
            "virtual joints at zero.",
        )
        survey = replace(survey, counted=COMPLETED)
    if loop.wrist is not None:
        return wrist_plan(loop, replace(survey, notes=notes))
    notes += (
        f"Lengths are over the arm's ({loop.length:.4g} m). $L_1, \\ldots, L_5$ lead from the frame on "
        "one axis to that on the next, $F$ from the base to the first, $H$ from the last to the tip; "
        "$L_6 = H T^{-1} F$ closes the loop.",
    )
    matrices, values = loop.matrices(), loop.values
    survey = replace(survey, length=1.0, family="general", notes=notes, matrices=matrices, _values=values)
    if loop.slides == 3:
        return slides_plan(loop, survey)
    if loop.perturbed_arms or not loop.order:
        return perturbed_plan(loop, survey)
    steps, count = loop.steps(), len(loop.order)
    asked = (
        f"{count} of the twelve formulations {'is' if count == 1 else 'are'} regular for this arm; they "
        "are asked in this order until one certifies that nothing is missing."
    )
    return replace(
        survey,
        summary="joints in general position. No closed form: all but one angle are eliminated from the "
        "loop that arm and goal close.",
        branches=count_ways(steps),
        notes=(*survey.notes, asked),
        tables={"Formulations": loop.formulations(survey.joints)},
        steps=tuple(steps),
    )


def perturbed_plan(loop: Loop, survey: IkPlan) -> IkPlan:
    """An arm that is solved through arms beside it."""
    most = 8 if loop.slides == 2 else 16
    step = Step(
        "The loop",
        "Every solution of a neighbour leads to one of the arm by Newton's method; what one neighbour "
        "loses beside a fold the other one keeps.",
        (loop.chain_equation(),),
        method="perturbed_arms",
        ways=most,
    )
    return replace(
        survey,
        summary="joints in general position, with axes parallel, square or meeting in such a way that "
        "every polynomial in a hidden angle vanishes or has double roots only. Two neighbours of the arm, "
        "its axes disturbed a little to either side, have neither fault; they are solved by elimination "
        "to one hidden angle.",
        branches=most,
        steps=(step,),
    )


def slides_plan(loop: Loop, survey: IkPlan) -> IkPlan:
    """Three prismatic joints: the orientation first."""
    steps = orientation_steps(loop.six, loop.chain_equation())
    return replace(
        survey,
        family="orientation first",
        summary="three revolute joints determine the orientation, three prismatic joints the position.",
        branches=count_ways(steps),
        steps=tuple(steps),
    )


def wrist_plan(loop: Loop, survey: IkPlan) -> IkPlan:
    """A wrist behind three joints of any kind."""
    notes = list(survey.notes)
    arm, names = loop.six, (*survey.joints, *("",) * (6 - len(survey.joints)))  # virtual joints have none
    if loop.wrist:
        arm, names = arm.reversed(), names[::-1]
        notes.append(
            "The arm is read from the tip to the base: joint 1 below is the last joint, and the goal is "
            "the inverse of the pose."
        )
    centre = common_point(arm.axes[3:], arm.points[3:])[0]
    notes.append(
        "$t_i$ is the angle of a revolute joint, $q_i$ that of a prismatic one; $p$ and $r_{ij}$ are "
        "position "
        "and rotation of the goal, $w$ is where the wrist's centre has to be."
    )

    def values(q: Array, T: Array) -> dict[str, Any]:
        whole = np.concatenate([q, np.zeros((*q.shape[:-1], 6 - q.shape[-1]))], axis=-1)
        goal = np.asarray(np.linalg.inv(T), dtype=np.float64) if loop.wrist else T
        return joint_values(arm.joint_types, whole[..., ::-1] if loop.wrist else whole) | goal_values(goal)

    steps = placed_wrist_steps(arm, centre)
    return replace(
        survey,
        family="wrist behind three joints",
        tables={"Joints at zero": arm.table(names)},
        summary="three axes meet in a point, the wrist: the three joints before it, some of which slide, "
        "place it, and the wrist makes the orientation.",
        branches=count_ways(steps),
        notes=tuple(notes),
        steps=tuple(steps),
        _values=values,
    )


def few_joint_plan(chain: Chain, survey: IkPlan) -> IkPlan:
    """Arms of up to three joints."""
    steps = few_joint_steps(chain)
    turning = chain.joint_types.count("R")
    notes = [
        "$p$ is where the tip has to be, in the base; $t_i$ is the angle of a revolute joint, $q_i$ the "
        "position of a prismatic joint."
    ]
    if turning > 1:
        end = "last" if chain.joint_types[-1] == "R" else "first"
        notes.append(
            f"A pose is reached by the same equations: the {end} joint leaves the points of its own axis "
            "alone, so the other joints bring two of them to their places, and the orientation that "
            "remains is its angle."
        )
    elif turning == 1:
        notes.append(
            "For a pose the revolute joint takes the angle of its rotation, and the prismatic joints "
            "follow linearly."
        )

    def values(q: Array, T: Array) -> dict[str, Any]:
        return joint_values(chain.joint_types, q) | goal_values(T)

    return replace(
        survey,
        family="fewer than six joints",
        tables={"Joints at zero": Screws.of(chain).table(survey.joints)},
        summary=f"an arm of {len(chain.joint_types)} joint{'s' if len(chain.joint_types) > 1 else ''} "
        f"({chain.joint_types}), solved directly.",
        branches=count_ways(steps),
        notes=tuple(notes),
        steps=tuple(steps),
        _values=values,
    )


def count_ways(steps: list[Step]) -> int:
    """How many answers the steps have together."""
    return int(np.prod([step.ways for step in steps]))
