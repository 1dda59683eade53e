"""The configurations of a goal, whatever its kind."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from cspace.arrays import Array, shape_of
from cspace.collision.checks import explain_contacts
from cspace.errors import InputError, InputTypeError, name_type
from cspace.plan_motion.goals import GoalLike, Goals
from cspace.plan_motion.parts import solve_parts
from cspace.plan_motion.poses import solve_any_pose, solve_pose
from cspace.plan_motion.regions import sample_region
from cspace.planning import ArmSpace, Region
from cspace.planning.space import are_names
from cspace.spatial import as_pose
from cspace.spatial.checks import PoseLike, one_pose

if TYPE_CHECKING:
    from cspace.robot import Robot

POSE_ROWS: Final = 4
"""Rows of a pose: as many configurations of four joints have its shape."""

POSITION_SIZE: Final = 3
"""Values of a position, which is often given where a configuration is expected."""


def find_goals(robot: Robot, space: ArmSpace, starts: Array, goal: GoalLike) -> Goals:
    """The configurations (g, dof) of a goal as `plan` takes it.

    Those of poses, partial goals and regions are sorted by their distance from the first of the starts
    (s, dof), each revolute joint at the multiple of 2π that is nearest to it. Raises as `plan`.
    """
    if space.dof != POSE_ROWS and (plain := space.plain_rows(goal)) is not None:
        return Goals(plain, is_given=True)
    if are_names(goal):
        return Goals(space.as_rows(goal, "goal"), is_given=True)
    if isinstance(goal, Region):
        if not goal.is_exact:
            return sample_region(robot, space, starts[0], goal)
        goal = goal.goal
    if isinstance(goal, Mapping):
        return solve_parts(robot, space, starts[0], goal)
    shape = shape_of(goal, "goal")
    if shape == (4, 4) and (space.dof != POSE_ROWS or is_pose(goal)):
        return solve_pose(robot, space, starts[0], goal)
    if shape[1:] == (4, 4) and shape[0]:
        return solve_any_pose(robot, space, starts[0], as_pose(goal, "goal"))
    if not shape and is_pose(goal):  # an object that holds a pose, such as scipy's RigidTransform
        return solve_pose(robot, space, starts[0], one_pose(goal, "goal"))
    check_kind(goal, shape, space.dof)
    return Goals(space.as_rows(goal, "goal"), is_given=True)


def check_kind(goal: object, shape: tuple[int, ...], dof: int) -> None:
    """Raises InputTypeError or InputError for a value that is not a goal; names the kind that it is like."""
    if len(shape) not in (1, 2):
        said = f"has shape {shape}" if shape else f"is {name_type(goal)}"
        raise InputTypeError(
            f"goal {said}; it must be configurations (dof,) or (g, dof), poses (4, 4) or (g, 4, 4), a named"
            " pose, a dict of keywords of robot.ik, or a cs.planning.Region"
        )
    if shape == (POSITION_SIZE,) and dof != POSITION_SIZE:
        raise InputError(
            f"goal has shape {shape}; a configuration has {dof} values, and a position of the tip is"
            ' {"position": goal}'
        )


def is_pose(goal: PoseLike) -> bool:
    """Whether a goal is a pose: not four configurations of four joints, which are (4, 4) numbers too."""
    try:
        as_pose(goal)
    except (InputError, InputTypeError):
        return False
    return True


def explain_goals(space: ArmSpace, goals: Goals) -> tuple[str, str]:
    """The status where no IK solution is free, and what they touch: a proof if they are all there are."""
    named = explain_contacts(space.geometry, goals.rows, space.scene, space.margin)
    if goals.is_whole:
        return "unreachable", f"all {len(goals.rows)} IK solutions within limits touch something: {named}"
    text = f"all {len(goals.rows)} sampled IK solutions touch something, though others exist: {named}"
    return "undetermined", text
