"""The feasible intervals of a redundant joint, for a pose or for parts of one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import RENAMED, InputError, InputTypeError
from cspace.ik.goals.partial import KEYWORDS, PartialGoal
from cspace.ik.goals.parts import check_one_goal, partial_goal
from cspace.ik.locked_joints import joint_number, locked_values, value_in_words
from cspace.ik.redundancy.arm_angle import swivel_intervals
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.solver import HasSolver, Solver, as_solver
from cspace.spatial.checks import one_pose
from cspace.tolerances import MOVING_JOINT


def redundancy(
    robot: HasSolver,
    goal: Any = None,
    parameter: str | int | None = None,
    *,
    locked: Mapping[Any, float] | None = None,
    tool_axis: Any = "z",
    **parts: Any,
) -> Redundancy:
    """For which values of a redundant joint a goal can be reached within all limits, branch by branch.

    The ends are where another joint reaches a limit (it is locked there, and the others are solved) and where
    branches fold: the determinant of the others' Jacobian vanishes. goal (4, 4): T_base_tip; or parts of it
    by keyword, one goal, as `robot.ik` takes them: position, rotation, direction, look_at, ray, angle_to,
    tool_axis. parameter: the joint, by name or number, one of those that a partial goal adds, or "swivel" of
    an arm with two spherical joints; the solver's own choice unless given (`ik(goal).freedom` names it).
    locked: values of other joints [rad, m], so that one redundant joint is left.

    Returns a `Redundancy`, falsy where no value will do. Raises InputError for arms without a redundant
    joint or with more than one, and for a joint that the goal settles. For arms with two spherical joints:
    M. Shimizu et al. 2008; here for any arm.
    """
    solver = as_solver(robot)
    given = {name: value for name, value in parts.items() if value is not None}
    unknown = sorted(given.keys() - set(KEYWORDS))
    if unknown:
        if unknown[0] in RENAMED:
            raise InputTypeError(f"unknown keyword {unknown[0]!r}: use {RENAMED[unknown[0]]}=")
        raise InputTypeError(
            f"redundancy() has no keyword {unknown[0]!r}; the parts of a goal are {list(KEYWORDS)}"
        )
    check_one_goal("redundancy", goal, given, tool_axis)
    if given:
        return redundancy_of_parts(solver, partial_goal(given, tool_axis), parameter, locked)
    T = one_pose(goal, "goal")
    if isinstance(parameter, str) and parameter == "swivel" and "swivel" not in solver.joint_names:
        if locked is not None:
            raise InputTypeError(
                "locked= cannot be combined with the swivel, the only free dimension of seven joints"
            )
        return swivel_intervals(solver, T)
    return redundancy_of_pose(solver, T, parameter, locked)


def redundancy_of_parts(solver: Solver, goal: PartialGoal, parameter: Any, locked: Any) -> Redundancy:
    """That of the arm with the virtual joints of the goal."""
    if goal.T.ndim != 2:
        raise InputError(f"the goal has shape {goal.T.shape[:-2]}, expected one goal; call it in a loop")
    named = parameter is None or isinstance(parameter, str)
    joint = parameter if named else solver.joint_names[joint_number(solver, parameter, "parameter")]
    found = redundancy_of_pose(solver.extend(goal), goal.T, joint, locked, solver)
    return found._of_arm(solver, goal.own_joints)


END_NOTHING, END_FOLD = -1, -2


def redundancy_of_pose(
    solver: Solver, T: Array, parameter: Any, locked: Any, own: Solver | None = None
) -> Redundancy:
    """The feasible intervals for a pose of the solver's arm. own: as of locked_values."""
    values = locked_values(solver, locked, own)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError("locked= takes one value per joint here")
    others = solver.lock({joint: float(value) for joint, value in values.items()})
    degree = others.redundancy_degree()
    if degree != 1:
        raise InputError(
            f"{solver.name} has {degree} redundant joints here, expected one: "
            + ("lock the others with locked=" if degree > 1 else "the goal determines all of them")
        )
    usual = others.redundant_joints[0]
    if parameter is None:
        joint = usual
    else:
        number = joint_number(solver, parameter, "parameter")
        if number in values:
            name = solver.joint_names[number]
            raise InputError(f"parameter {name!r} is locked by locked=; choose another joint")
        joint = others.joint_names.index(solver.joint_names[number])
    found = intervals_of(others, T, joint)
    if not found and joint != usual:
        check_moves(others, T, joint)
    if values:

        def with_locked(q: Array) -> Array:
            row = np.array([float(values.get(k, np.nan)) for k in range(solver.dof)])
            row[np.isnan(row)] = q
            return row

        found = found._of_arm(solver, with_locked)
    return found if is_bounded(others, joint) else replace(found, complete=False)


def is_bounded(solver: Solver, joint: int) -> bool:
    """Whether the parameter has limits or is an angle; else the search covers the length of the arm."""
    bounds = solver.limits.lower[joint], solver.limits.upper[joint]
    return solver.joint_types[joint] == "R" or bool(np.isfinite(bounds).all())


def check_moves(solver: Solver, T: Array, joint: int) -> None:
    """Raise InputError for a joint that rests during the self-motion: the goal determines it."""
    usual = solver.redundant_joints[0]
    seen = intervals_of(solver, T, usual)
    if not seen:
        return
    J = solver.jacobian(np.array([interval.q for interval in seen]))
    if np.abs(np.linalg.svd(J)[2][:, -1, joint]).max() > MOVING_JOINT:
        return
    at = ", ".join(sorted({value_in_words(solver, joint, interval.q[joint]) for interval in seen}))
    raise InputError(
        f"parameter {solver.joint_names[joint]!r} is determined by the goal, at {at}, and is not free; "
        f"take another joint, such as {solver.joint_names[usual]!r}"
    )


def intervals_of(solver: Solver, T: Array, joint: int) -> Redundancy:
    rows, inside, complete = _core._ik_intervals(solver, joint, T)
    names, slides = solver.joint_names, solver.joint_types[joint] == "P"

    def end(what: int, side: int) -> str:
        if what == END_FOLD:
            return "fold"
        return "nothing" if what == END_NOTHING else f"{names[what]} at {'upper' if side else 'lower'} limit"

    made = [
        Interval(low, high, branch + 1, (end(a, sa), end(b, sb)), q, slides)
        for (low, high, branch, a, sa, b, sb), q in zip(rows, inside, strict=True)
    ]
    made.sort(key=lambda interval: (interval.branch, interval.lower))
    return Redundancy(solver, T, names[joint], tuple(made), complete, slides)
