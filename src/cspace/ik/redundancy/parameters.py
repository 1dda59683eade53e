"""Where a redundant joint may be, for a pose or for parts of one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cspace.errors import RENAMED, InputError, InputTypeError
from cspace.ik.goals.partial import KEYWORDS, PartialGoal
from cspace.ik.goals.parts import check_one_goal, partial_goal
from cspace.ik.locked_joints import joint_number
from cspace.ik.redundancy.feasible_intervals import redundancy_of_pose
from cspace.ik.redundancy.result import Redundancy
from cspace.ik.solver import HasSolver, Solver, as_solver
from cspace.spatial.checks import one_pose


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
    locked: values of other joints [rad, m], so that one is left to spare.

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
        from cspace.ik.redundancy.arm_angle_intervals import swivel_intervals

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
