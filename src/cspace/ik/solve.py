"""The words around inverse kinematics: what is asked, whether it makes sense, who answers."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.buffer_pool import pooled_array
from cspace.errors import InputTypeError
from cspace.ik.goals.given import (
    checked_poses,
    goal_array,
    is_far,
    one_configuration,
    open_in_space,
    planar_poses,
    points_in_base,
    too_far,
)
from cspace.ik.goals.partial import KEYWORDS, PartialGoal, check_tool_axis, is_open, partial_goal
from cspace.ik.goals.solve_partial import met_by_open_joints, own_columns, solve_partial
from cspace.ik.least_squares import least_squares_answer
from cspace.ik.locked_joints import by_name, locked_values
from cspace.ik.prepare import check_chain, prepare
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.kinematics.batch import check_robot, thread_count
from cspace.spatial import as_pose
from cspace.tolerances import FARTHEST

__all__ = ["inverse_kinematics"]

MAX_POSITION_JOINTS = 3
"""Up to so many joints are settled by the place of the tip alone."""
Counts = npt.NDArray[np.int64]
Verdicts = npt.NDArray[np.uint8]
Answer = Solutions | SolutionsBatch


@dataclass(frozen=True)
class Wish:
    """Which of the solutions: the keywords of `inverse_kinematics` of these names."""

    near: Any
    locked: Any
    swivel: Any
    samples: Any
    least_squares: bool
    threads: int

    @property
    def holds(self) -> bool:
        """Whether something is locked, or sampled at a number of values of one's own."""
        return self.locked is not None or self.samples is not None


def inverse_kinematics(
    robot: Any,
    goal: Any = None,
    *,
    position: Any = None,
    rotation: Any = None,
    direction: Any = None,
    look_at: Any = None,
    ray: Any = None,
    angle_to: Any = None,
    tool_axis: Any = "z",
    angle: Any = None,
    near: Any = None,
    locked: Any = None,
    swivel: Any = None,
    samples: int | None = None,
    least_squares: bool = False,
    threads: int | None = None,
) -> Solutions | SolutionsBatch:
    """Every configuration q with fk(q) = goal.

    goal: T_base_tip, (4, 4) or (..., 4, 4), or anything `as_pose` takes. Instead of it, parts of a pose,
    alone or together: position: of the tip [m], (3,) or (..., 3), None for coordinates that do not matter,
    or (..., 2) for an arm in the plane; rotation (3, 3); direction (3,): where the tool axis points.
    position goes with rotation, direction, angle_to=(axis of the base, angle to it of the tool axis [rad]),
    and in the plane with angle: of the tip [rad]. look_at (3,): a point on the tool axis, ahead of the tip.
    ray=(p, d): the line of the tool axis, through p along d. tool_axis: in the tip, "x", "-z" or any (3,).

    near: (dof,), a configuration; the answer is the one solution nearest to it, and leading joints that a
    singular pose leaves free take its values. Limits choose among a joint's multiples of 2π, not among
    solutions, and with redundant joints count for nothing. locked: locked joints at given values, by name
    or number, {"joint7": 0.3}; arrays of values are solved together with the goals. swivel: of an arm with
    two spherical joints, the angle of its elbow about the line from shoulder to wrist [rad] (see
    `cs.ik.swivel`), or many. samples: of an arm with one redundant joint, at how many of its values
    branches are listed (16 unless given). least_squares: where nothing reaches the goal, the answer is the
    configuration that misses least (a radian weighs like the arm's characteristic length). threads: for a
    batch, all cores unless given; the answer does not depend on it.

    An arm with more than six joints, or some of which do the work of others, leaves freedom, which
    `freedom` of the answer names. With locked= for all redundant joints every solution of the others is
    listed; with near= the nearest of all; else, with one redundant joint, all branches at values of it
    spread over its feasible intervals, and with more the configuration nearest to the middle of the limits.

    Returns `Solutions` for one goal, `SolutionsBatch` for many. An unreachable goal is an answer (falsy,
    with the reason); a goal that is not a pose raises InputError; joints that mimic others, a floating base
    or more than sixteen joints raise NoClosedFormError.
    """
    check_robot(robot)
    workers = thread_count(threads, (1,)) or os.cpu_count() or 1
    if not isinstance(least_squares, (bool, np.bool_)):
        raise InputTypeError(f"least_squares must be True or False, got {type(least_squares).__name__}")
    wish = Wish(near, locked, swivel, samples, bool(least_squares), workers)
    if angle is not None:
        goal, position = planar_poses(robot, goal, position, angle), None
    position = open_in_space(robot, position)
    named = (position, rotation, direction, look_at, ray, angle_to)
    given = {name: value for name, value in zip(KEYWORDS, named, strict=True) if value is not None}
    check_tool_axis(tool_axis, given)
    if (goal is None) == (not given):
        raise InputTypeError(
            "ik needs one goal: robot.ik(T) with the pose of the tip in the base, or parts of it by name,"
            " such as robot.ik(position=p)"
        )
    if goal is not None:
        return answer_poses(robot, goal, wish)
    if is_plain_position(robot, given):
        given["position"] = points_in_base(robot, position)
        if not wish.holds and swivel is None:
            return answer_points(robot, given["position"], wish)
    return answer_partial(robot, partial_goal(given, tool_axis), wish)


def answer_poses(robot: Any, goal: Any, wish: Wish) -> Answer:
    prepare(robot)
    T = goal_array(goal)
    if wish.swivel is not None:
        return at_swivel(robot, T, wish)
    if wish.holds or not robot._ik_direct:
        return redundant(robot, T, wish)
    found = solve_many(robot, T, wish.threads) if T.ndim > 2 else solve_one(robot, T, wish.near)
    return chosen(robot, found, wish)


def answer_points(robot: Any, p: Array, wish: Wish) -> Answer:
    prepare(robot)
    if p.ndim > 1:
        return chosen(robot, solve_positions(robot, p, wish.threads), wish)
    found = cast(Solutions, _core._ik_position(robot, p))
    if wish.near is not None and found.self_motions:
        found = found._along_self_motions(one_configuration(robot, wish.near, "near"))
    return chosen(robot, found, wish)


def answer_partial(robot: Any, goal: PartialGoal, wish: Wish) -> Answer:
    if wish.swivel is not None:
        raise InputTypeError("swivel= goes with a full pose; lock joints with locked=")
    if wish.holds and goal.T.ndim > 2:
        raise InputTypeError("locked= and samples= go with one goal where parts of a pose are asked for")
    if wish.near is not None and goal.T.ndim > 2:
        count = int(np.prod(goal.T.shape[:-2]))
        raise InputTypeError(
            f"near= goes with one goal where parts of a pose are asked for, got {count}; call ik for each"
        )

    def ask(whole: Any, T: Array) -> Answer:
        prepare(whole)
        if wish.holds or not whole._ik_direct:
            return redundant(whole, T, of_whole(robot, goal, whole, wish))
        return solve_many(whole, T, wish.threads) if T.ndim > 2 else solve_one(whole, T, None)

    check_chain(robot)
    return chosen(robot, solve_partial(robot, goal, ask), wish)


def chosen(robot: Any, found: Answer, wish: Wish) -> Answer:
    """Of all solutions those that are wished for."""
    if isinstance(found, SolutionsBatch):
        if wish.near is not None or wish.least_squares:
            raise InputTypeError("near= and least_squares= are for one goal; a batch has .nearest(q)")
        return found
    if wish.least_squares and not found:
        return closest(robot, found, wish)
    return found if wish.near is None else found.nearest(wish.near)


def at_swivel(robot: Any, T: Array, wish: Wish) -> Answer:
    from cspace.ik.redundancy.arm_angle import solve_swivel

    if wish.holds or wish.least_squares:
        raise InputTypeError("swivel= goes with near= alone: it holds what is to spare")
    return solve_swivel(robot, checked_poses(T), wish.swivel, wish.near)


def redundant(robot: Any, T: Array, wish: Wish) -> Answer:
    from cspace.ik.redundancy.solve import redundant_answer

    options = {"locked": wish.locked, "samples": wish.samples, "near": wish.near, "threads": wish.threads}
    found = redundant_answer(robot, checked_poses(T), **options)
    if isinstance(found, SolutionsBatch):
        if wish.least_squares:
            raise InputTypeError("least_squares= is for one goal")
        return found
    return closest(robot, found, wish) if wish.least_squares and not found else found


def closest(robot: Any, found: Solutions, wish: Wish) -> Solutions:
    if wish.locked:
        raise InputTypeError("least_squares= does not go with locked=: it moves every joint")
    return least_squares_answer(robot, found)


def is_plain_position(robot: Any, given: dict[str, Any]) -> bool:
    """Whether a goal is a whole point for an arm of up to three joints, which are solved directly."""
    short = len(robot.chain.joint_types) <= MAX_POSITION_JOINTS
    return short and list(given) == ["position"] and not is_open(given["position"])


def of_whole(robot: Any, goal: PartialGoal, whole: Any, wish: Wish) -> Wish:
    """The wish in terms of the arm with the joints that stand for what the goal leaves open: these begin
    where they bring the seed closest to the goal, and joints are locked by name, for their numbers are
    others."""
    from cspace.ik.redundancy.solve import count_redundancy

    locked, near = wish.locked, None
    if isinstance(locked, Mapping):
        locked = by_name(robot, locked)
    leaves_freedom = locked is None or count_redundancy(whole, locked_values(whole, locked)) > 0
    if wish.near is not None and leaves_freedom:  # else all are listed, and the nearest is picked among them
        seed = as_floats(wish.near, "near", last=(robot.dof,), largest=FARTHEST)
        near = met_by_open_joints(whole, own_columns(robot, goal), seed, goal.T)
    return replace(wish, locked=locked, near=near, least_squares=False)


def solve_one(robot: Any, T: Array, near: Any) -> Solutions:
    if near is None:
        found = _core._ik_single(robot, T)
        if found is None:
            raise too_far("goal", T[:3, 3])
        return cast(Solutions, found)
    seed = one_configuration(robot, near, "near")
    if is_far(T[:3, 3]):
        raise too_far("goal", T[:3, 3])
    bounds = (np.ascontiguousarray(side) for side in (robot.limits.lower, robot.limits.upper))
    _core._ik_serve_near(robot, *bounds)
    found = cast(Solutions, _core._ik_near_singular(robot, T, seed))
    return found._with_member(seed) if found.self_motions else found


def solve_many(robot: Any, T: Array, workers: int) -> SolutionsBatch:
    leading = T.shape[:-2]
    answers = room_for(robot, leading)
    bad = _core._ik_many(robot, T.reshape(-1, 4, 4), *answers, workers)
    if bad < len(answers[0]):
        as_pose(T, "goal")  # finds the words for what is wrong
        index = tuple(map(int, np.unravel_index(bad, leading)))
        raise too_far(f"goal {index}", T[index][:3, 3])
    return shaped(robot, T, leading, answers)


def solve_positions(robot: Any, p: Array, workers: int) -> SolutionsBatch:
    leading = p.shape[:-1]
    answers = room_for(robot, leading)
    bad = _core._ik_positions(robot, p.reshape(-1, 3), *answers, workers)
    if bad < len(answers[0]):
        index = tuple(map(int, np.unravel_index(bad, leading)))
        raise too_far(f"position {index}", p[index])
    return shaped(robot, p, leading, answers)


def room_for(robot: Any, leading: tuple[int, ...]) -> tuple[Array, Counts, Verdicts]:
    """Arrays for the answers to n goals: q (n, k_max, dof), count (n,), verdict (n,)."""
    n = int(np.prod(leading))
    q = pooled_array((n, robot._ik_room, robot.dof))
    return q, np.empty(n, dtype=np.int64), np.empty(n, dtype=np.uint8)


def shaped(
    robot: Any, goal: Array, leading: tuple[int, ...], answers: tuple[Array, Counts, Verdicts]
) -> SolutionsBatch:
    q, count, verdict = answers
    q = q.reshape(*leading, robot._ik_room, robot.dof)
    return SolutionsBatch(robot, goal, q, count.reshape(leading), verdict.reshape(leading))
