"""Which method answers a goal: the closed form, locked joints, or a search along the self-motion."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.buffer_pool import pooled_array
from cspace.errors import InputTypeError
from cspace.ik.answers import NEAREST, SINGULAR, UNREACHABLE
from cspace.ik.context import Options
from cspace.ik.goals.given import (
    checked_poses,
    goal_array,
    is_far,
    is_open,
    one_configuration,
    open_in_space,
    planar_poses,
    points_in_base,
    too_far,
)
from cspace.ik.goals.partial import KEYWORDS
from cspace.ik.goals.parts import check_one_goal, partial_goal
from cspace.ik.redundancy.arm_angle import solve_swivel
from cspace.ik.redundancy.solve import choose_nearest, solve_freedom
from cspace.ik.solutions import Solutions, nearest_to_goal
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solver import Solver
from cspace.ik.wrapping import wrap_joints
from cspace.kinematics.batch import limits_of, thread_count
from cspace.spatial import as_pose
from cspace.tolerances import SAME_MEMBER

MAX_POSITION_JOINTS = 3
"""A point determines up to so many joints."""
Answer = Solutions | SolutionsBatch


def solve(
    solver: Solver,
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
    limits: Any = None,
    locked: Any = None,
    swivel: Any = None,
    samples: int | None = None,
    least_squares: bool = False,
    threads: int | None = None,
) -> Answer:
    """Every configuration q with fk(q) = goal; see Solver.solve, which documents the keywords."""
    workers = (os.cpu_count() or 1) if threads is None else thread_count(threads, (1,)) or os.cpu_count() or 1
    if not isinstance(least_squares, (bool, np.bool_)):
        raise InputTypeError(f"least_squares must be True or False, got {type(least_squares).__name__}")
    if limits is not None and near is None:
        raise InputTypeError("limits= can only be combined with near=; s.within(limits) filters a list")
    bounds = solver.limits if limits is None else limits_of(solver.limits, limits, solver.name)
    options = Options(near, bounds, locked, swivel, samples, bool(least_squares), workers)
    if angle is not None:
        goal, position = planar_poses(solver, goal, position, angle), None
    position = open_in_space(solver, position)
    named = (position, rotation, direction, look_at, ray, angle_to)
    given = {name: value for name, value in zip(KEYWORDS, named, strict=True) if value is not None}
    check_one_goal("ik", goal, given, tool_axis)
    if goal is not None:
        return answer_poses(solver, goal, options)
    if is_plain_position(solver, given):
        given["position"] = points_in_base(solver, position)
        if not options.sets_freedom and swivel is None:
            return answer_points(solver, given["position"], options)
    if swivel is not None:
        raise InputTypeError("swivel= needs a full pose; lock joints with locked= instead")
    parts = partial_goal(given, tool_axis)
    return approach_unreached(solve_freedom(solver, parts, parts.T, options), options)


def answer_poses(solver: Solver, goal: Any, options: Options) -> Answer:
    T = goal_array(goal)
    if options.swivel is not None:
        return answer_swivel(solver, T, options)
    if options.sets_freedom or solver.is_redundant:
        return approach_unreached(solve_freedom(solver, None, checked_poses(T), options), options)
    if T.ndim > 2:
        return choose_solutions(solve_many(solver, T, _core._ik_many, options.threads), options)
    return choose_solutions(solve_one(solver, T, options), options)


def answer_points(solver: Solver, p: Array, options: Options) -> Answer:
    if p.ndim > 1:
        return choose_solutions(solve_many(solver, p, _core._ik_positions, options.threads), options)
    found = cast(Solutions, _core._ik_position(solver, p))
    if options.near is not None and found.self_motions:
        found = found._with_members(one_configuration(solver, options.near, "near"), options.limits)
    return choose_solutions(found, options)


def choose_solutions(found: Answer, options: Options) -> Answer:
    """Of all solutions those that the options name."""
    chosen = choose_nearest(found, options)
    if options.near is not None and isinstance(chosen, SolutionsBatch):
        chosen = with_nearest_members(cast(SolutionsBatch, found), chosen, options)
    return approach_unreached(chosen, options)


def with_nearest_members(found: SolutionsBatch, chosen: SolutionsBatch, options: Options) -> SolutionsBatch:
    """The same, goals with self-motions answered one by one: of these the nearest members count."""
    singular: Any = np.nonzero(found._status == SINGULAR)
    if not len(singular[0]) or found._about is not None:
        return chosen
    seeds = found._seed(options.near)
    q, count = chosen.q.copy(), chosen.count.copy()
    for index in zip(*singular, strict=True):
        goal, near = np.ascontiguousarray(found.goal[index]), seeds if seeds.ndim == 1 else seeds[index]
        single = answer_points if found._is_point else answer_poses
        one = cast(Solutions, single(found.solver, goal, replace(options, near=near)))
        count[index] = len(one)
        q[(*index, 0)] = one.q[0] if one else np.nan
    return replace(chosen, q=q, count=count)


def approach_unreached(found: Answer, options: Options) -> Answer:
    """With least_squares=, the configurations of least error for goals that nothing reaches."""
    if not options.least_squares:
        return found
    if options.locked:
        raise InputTypeError("least_squares= cannot be combined with locked=, because it moves every joint")
    if isinstance(found, SolutionsBatch):
        return least_squares_batch(found, options.threads)
    return least_squares_answer(found) if found._status == UNREACHABLE else found


def answer_swivel(solver: Solver, T: Array, options: Options) -> Answer:
    if options.sets_freedom or options.least_squares:
        raise InputTypeError(
            "swivel= can only be combined with near=, because it fixes the redundant degree of freedom"
        )
    return choose_solutions(solve_swivel(solver, checked_poses(T), options.swivel), options)


def is_plain_position(solver: Solver, given: dict[str, Any]) -> bool:
    """Whether a goal is a whole point for an arm of up to three joints, which are solved directly."""
    few = len(solver.joint_types) <= MAX_POSITION_JOINTS
    return few and list(given) == ["position"] and not is_open(given["position"])


def solve_one(solver: Solver, T: Array, options: Options) -> Solutions:
    if options.near is None:
        found = _core._ik_single(solver, T)
        if found is None:
            raise too_far("goal", T[:3, 3])
        return cast(Solutions, found)
    seed = one_configuration(solver, options.near, "near")
    if is_far(T[:3, 3]):
        raise too_far("goal", T[:3, 3])
    found = cast(Solutions, _core._ik_near_singular(solver, T, seed))
    return found._with_members(seed, options.limits, SAME_MEMBER) if found.self_motions else found


def solve_many(solver: Solver, goals: Array, fill: Callable[..., int], workers: int) -> SolutionsBatch:
    """The solutions of poses (..., 4, 4) or of points (..., 3). fill: the core's function for one of them."""
    own = (4, 4) if goals.shape[-1] == 4 else (3,)
    leading = goals.shape[: goals.ndim - len(own)]
    n = int(np.prod(leading))
    q = pooled_array((n, solver.max_solutions, solver.dof))
    count, verdict = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.uint8)
    bad = fill(solver, goals.reshape(-1, *own), q, count, verdict, workers)
    if bad < n:
        index = tuple(map(int, np.unravel_index(bad, leading)))
        if own == (3,):
            raise too_far(f"position {index}", goals[index])
        as_pose(goals, "goal")  # raises where the goal is not a pose
        raise too_far(f"goal {index}", goals[index][:3, 3])
    return SolutionsBatch.of(solver, goals, q, count, verdict)


def least_squares_batch(found: SolutionsBatch, threads: int) -> SolutionsBatch:
    """The batch with the configuration of least error for each goal that nothing reaches."""
    bad: Any = np.nonzero(found._status == UNREACHABLE)
    if not len(bad[0]):
        return found
    solver, whole = found._whole
    if found._partial is None and not found._is_point:
        goals = np.ascontiguousarray(found.goal[bad])
        nearest = _core._ik_nearest_poses(solver, goals, 1.0, threads)
    else:
        each = (nearest_to_goal(found[index])[0] for index in zip(*bad, strict=True))
        nearest = np.array(list(each))
    nearest = wrap_joints(nearest, solver.joint_types)
    q, count, verdict, about = found.q.copy(), found.count.copy(), found._verdict.copy(), found._about
    q[(*bad, 0)] = found._wanted.own_joints(nearest)
    count[bad], verdict[bad] = 1, NEAREST
    if about is not None and about.q is not None:
        whole = whole.copy()
        whole[(*bad, 0)] = nearest
        about = replace(about, q=whole)
    return replace(found, q=q, count=count, _verdict=verdict, _about=about)


def least_squares_answer(found: Solutions) -> Solutions:
    """The configuration of least error for one goal that nothing reaches."""
    q = wrap_joints(nearest_to_goal(found)[0], found._whole[0].joint_types)[None]
    about = replace(found._about, q=q) if found._about and found._partial else None
    own = found._wanted.own_joints(q)
    return Solutions.of(found.solver, found.goal, NEAREST, own, (-1,), (False,), None, about)
