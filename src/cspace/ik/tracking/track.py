"""The words around tracking: which path, from where, within what, and what a good branch is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, one_array
from cspace.errors import InputError, InputTypeError
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.goals.partial import plain_goal
from cspace.ik.numeric.descent import ik_numeric
from cspace.ik.numeric.problem import Question, middle_configuration, pose_problem
from cspace.ik.solver import as_solver
from cspace.ik.tracking.result import Branch, Track
from cspace.ik.wrapping import revolute_joints
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_choice, limits_of
from cspace.spatial import interpolate_decoupled, log_so3
from cspace.tolerances import FARTHEST, HALF_TURN, NUMERIC_TOLERANCE, TRACK_BEYOND, TRACK_START

COSTS: Final = ("length", "step", "time")
"""What a branch may cost: Σ ‖Δq‖; the largest Δq of a joint; Σ of the times that the velocity limits ask."""

FATES: Final = ("end", "limit", "singularity", "jump", "unreachable")
MAX_STEP: Final = np.pi / 2
SIX: Final = 6
Cost = str | Callable[[Array], Any]
Starts = tuple[Array, tuple[int, ...], bool, str]
"""Configurations (b, dof), the numbers of their branches, whether they are all, and a note."""


def track(
    robot: KinematicModel,
    poses: Any,
    start: Any = None,
    *,
    limits: Any = True,
    cost: Cost = "length",
    max_step: Any = MAX_STEP,
) -> Track:
    """The branches that follow a path of poses, and where and why each of the others ends.

    Between two poses the tip moves on a straight line and turns about an axis that stands still, both at
    constant speed. A branch is followed by predictor and corrector: with the twist t of the path,
    J q' = t and J q'' = −J' q' say where the joints go, Newton's method corrects, and a step counts only if
    the correction is small beside it. A singular pose is passed where the joints go on smoothly through it.
    Angles are continuous from pose to pose.

    poses (n, 4, 4): T_base_tip. start (dof,): follow one branch alone, from the solution of the first pose
    that is nearest to it, and `reason` says how far away that is; unless given, every solution of the first
    pose begins a branch, each angle with the multiples of 2π that keep it within limits for longest. An arm
    with redundant joints is followed by the least motion of its joints, from start or else from the solution
    nearest the middle of its limits; one of fewer than six joints has to reach the poses alone, and stays as
    near as it can between them.
    limits: True for the robot's, False for none, or Limits. cost: of the best branch: "length" Σ‖Δq‖,
    "step" the largest change of a joint between neighbouring poses, "time" Σ max |Δq| / velocity limit, or
    a function of q (n, dof). max_step: how far a joint may turn from one pose to the next [rad], or (dof,)
    for each joint in its own unit; inf allows any.

    Returns Track: q, branches, ends, reason; falsy where no branch follows every pose. Raises InputError for
    poses that are none, neighbours half a turn apart (the way between is open), a start of the wrong shape,
    or a floating base; NoClosedFormError for an arm whose solutions cannot be listed, if there is no start.

    Allgower and Georg 1990, chapter 6 (predictor and corrector).
    """
    question = pose_problem(robot, poses, None, None, None, limits, NUMERIC_TOLERANCE)
    T = path_of(question.goals)
    cost_function = cost_of(robot, cost)
    chosen = limits_of(robot.limits, limits, robot.name)
    bounds = np.stack([chosen.lower, chosen.upper, check_strides(robot, max_step)])
    starts, numbers, complete, note = starts_of(robot, question, T, start, limits)
    starts_wound = start is None and not is_redundant(robot, question)
    b, n = len(starts), len(robot.joint_names)
    q, last, info = np.empty((b, len(T), n)), np.empty((b, n)), np.empty((b, 5))
    _core._ik_track(robot, question.frame, T, starts, bounds, starts_wound, q, last, info)
    branches = []
    for k, (reached, end, fate, joint, sigma) in enumerate(info.tolist()):
        rows, cause = q[k, : int(reached)], FATES[int(fate)]
        if cause == "singularity" and len(rows) and is_out_of_reach(robot, question, T, end):
            cause = "unreachable"
        who = robot.joint_names[int(joint)] if joint >= 0 else None
        paid = cost_function(rows) if len(rows) else np.inf
        branches.append(Branch(robot, T, rows, end, cause, who, last[k], sigma, paid, numbers[k]))
    return Track(robot, T, tuple(branches), complete, note)


def path_of(poses: Array) -> Array:
    """The poses as (n, 4, 4), C-contiguous, each less than half a turn from the one before."""
    if poses.ndim != 3 or not len(poses):
        raise InputError(f"poses has shape {poses.shape}, expected (n, 4, 4): one path of one pose or more")
    R = poses[:, :3, :3]
    trace = np.einsum("nij,nij->n", R[:-1], R[1:])
    half = np.flatnonzero(trace < HALF_TURN - 1.0)
    if len(half):
        k = int(half[0])
        raise InputError(
            f"poses {k} and {k + 1} are 180° apart, so the direction of rotation between them is not unique;"
            " insert a pose between them"
        )
    return np.ascontiguousarray(poses)


def check_strides(robot: KinematicModel, max_step: Any) -> Array:
    """How far each joint may move between neighbouring poses (n,); one number counts for those that turn."""
    steps = as_floats(max_step, "max_step", finite=False)
    n = len(robot.joint_names)
    if steps.ndim == 0:
        steps = np.where(revolute_joints(robot.joint_types), steps, np.inf)
    if steps.shape != (n,) or not (steps > 0).all():
        raise InputError(
            f"max_step is {max_step!r}; expected one positive angle, or {n} steps, one per joint"
        )
    return np.asarray(steps)


def is_redundant(robot: KinematicModel, question: Question) -> bool:
    """Whether more than six joints move the tip."""
    return bool(_core._ik_moving(robot, question.frame) > SIX)


def starts_of(robot: KinematicModel, question: Question, T: Array, start: Any, limits: Any) -> Starts:
    """Where the branches begin."""
    first, n = T[0], len(robot.joint_names)
    if start is not None:
        seed = one_array(start, "start", (n,), "one configuration", largest=FARTHEST)
        q, numbers, complete, note = nearest_start(robot, question, first, seed, limits)
        return q, numbers, complete, note or describe_start(robot, first, seed, q)
    if is_redundant(robot, question):
        seed = middle_configuration(robot, question.limits)
        q, numbers, complete, note = nearest_start(robot, question, first, seed, limits)
        return q, numbers, complete, note or "; it begins nearest the middle of the limits"
    s: Any = as_solver(robot).solve(first)
    note = "" if s else f"the first pose is not reached: {s.reason}"
    return np.ascontiguousarray(s.q), s._branch_numbers, s.complete and not s.self_motions, note


def nearest_start(
    robot: KinematicModel, question: Question, first: Array, seed: Array, limits: Any
) -> Starts:
    """The solution of the first pose nearest to a configuration: itself, if it is one."""
    if plain_goal(first).residual(robot.fk(seed)) <= NUMERIC_TOLERANCE:
        return np.ascontiguousarray(seed)[None], (-1,), False, ""
    if is_redundant(robot, question):  # a descent also takes another frame than the tip
        d = ik_numeric(robot, first, seed, rest=seed, limits=limits)
        if d:
            return np.ascontiguousarray(d.q)[None], (-1,), False, ""
    try:
        s: Any = as_solver(robot).solve(first, near=seed, limits=limits)
    except NoClosedFormError:
        s = ik_numeric(robot, first, seed, rest=seed, limits=limits)
    if s:
        return np.ascontiguousarray(s.q.reshape(-1, len(seed))[:1]), (-1,), False, ""
    return np.empty((0, len(seed))), (), False, f"the first pose is not reached: {s.reason}"


def describe_start(robot: KinematicModel, first: Array, seed: Array, q: Array) -> str:
    """How far a start is from the first pose and from where the branch begins; empty if it is near."""
    moved = np.abs(q[0] - seed)
    joint = int(moved.argmax())
    if moved[joint] <= TRACK_START:
        return ""
    unit = "rad" if robot.joint_types[joint] == "R" else "m"
    off = robot.fk(seed)[:3, 3] - first[:3, 3]
    turned = np.linalg.norm(log_so3(first[:3, :3].T @ robot.fk(seed)[:3, :3]))
    return (
        f"; start is {np.linalg.norm(off):.3g} m and {turned:.3g} rad from the first pose: the branch begins "
        f"at the solution nearest to it, up to {moved[joint]:.3g} {unit} away ({robot.joint_names[joint]})"
    )


def is_out_of_reach(robot: KinematicModel, question: Question, T: Array, end: float) -> bool:
    """Whether nothing reaches the path just beyond an end."""
    if is_redundant(robot, question):
        return False
    k = min(int(end), len(T) - 2)
    beyond = interpolate_decoupled(T[k], T[k + 1], min(end - k + TRACK_BEYOND, 1.0))
    try:
        found: Any = as_solver(robot).solve(beyond)
    except NoClosedFormError:
        return False
    return not found


def call_cost(cost: Callable[[Array], Any], q: Array) -> float:
    """What a caller's function of the configurations answers, as one number; inf rules a branch out."""
    try:
        value = cost(q)
    except Exception as error:
        raise InputError(
            f"cost= raised {type(error).__name__} for q of shape {q.shape}: {error}; it takes q (n, dof)"
            " and must return one number"
        ) from error
    number = as_floats(value, "the result of cost=", finite=False)
    if number.ndim or np.isnan(number):
        said = f"has shape {number.shape}" if number.ndim else f"is {value!r}"
        raise InputError(f"the result of cost= {said}, expected one number for q (n, dof)")
    return float(number)


def cost_of(robot: KinematicModel, cost: Cost) -> Callable[[Array], float]:
    """The price of a branch q (m, dof)."""
    if callable(cost):
        return lambda q: call_cost(cost, q)
    word = check_choice(cost, "cost", COSTS)
    if word == "length":
        return lambda q: float(np.linalg.norm(np.diff(q, axis=0), axis=1).sum())
    if word == "step":
        return lambda q: float(np.abs(np.diff(q, axis=0)).max(initial=0.0))
    speed = robot.limits.velocity
    if not np.isfinite(speed).any():
        raise InputTypeError(f"{robot.name} has no velocity limits; cost='time' needs them")
    return lambda q: float((np.abs(np.diff(q, axis=0)) / speed).max(axis=1, initial=0.0).sum())
