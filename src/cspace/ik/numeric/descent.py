"""Numeric inverse kinematics: descents on the pose error, for every arm, from one start or from many."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, as_generator, whole_number
from cspace.errors import InputError
from cspace.ik.goals.given import rows_for_goals
from cspace.ik.numeric.problem import further_starts, middle_configuration, pose_problem
from cspace.ik.numeric.solution import REACHED, NumericSolution, SampledSolutions
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_choice, thread_count
from cspace.tolerances import FARTHEST, NUMERIC_TOLERANCE

METHODS = ("levenberg_marquardt", "newton")
"""The methods of descent."""

MOST_STARTS = 1_000_000
MOST_ITERATIONS = 100_000
NO_MORE = np.empty(0)


def ik_numeric(
    robot: KinematicModel,
    goal: Any = None,
    start: Any = None,
    *,
    position: Any = None,
    frame: str | None = None,
    method: str = "levenberg_marquardt",
    limits: Any = True,
    starts: int = 64,
    rest: Any = None,
    rest_weights: Any = None,
    weights: Any = None,
    tolerance: float = NUMERIC_TOLERANCE,
    max_iterations: int = 60,
    rng: int | np.random.Generator | None = None,
    threads: int | None = None,
) -> NumericSolution:
    """One configuration that reaches a goal, found by descent from a start: for any robot and any frame.

    Levenberg–Marquardt minimises ½ |W e(q)|², e = [Δp / length; rotation vector] in the axes of the goal, by
    steps (JᵀJ + λ I) Δq = Jᵀ e with λ in proportion to |e|²; "newton" leaves λ out. Where the first start
    ends in a local minimum, further ones are tried, several at once.

    goal (..., 4, 4): the frame in the base; or position (..., 3) [m], its origin alone. start (dof,) or
    (..., dof): where to begin; the middle of the limits, or rest, unless given. Joints that do not move the
    frame keep its values. limits: True keeps q inside the robot's, False ignores them, or other Limits.
    starts: how many to try at most, the first included. rest (dof,): where the goal leaves freedom, move to
    the posture nearest to it, ½ Σ rest_weights (q − rest)², without moving the frame. weights (6,): of e; a
    zero leaves that direction of the goal free. tolerance: largest position error [m] and rotation error
    [rad] that count as reached. max_iterations: per start. rng: draws the further starts; None spreads them
    evenly. threads: of a batch, every processor unless given; the answer does not depend on it.

    Returns NumericSolution: q (..., dof), success, residual, iterations, reason; falsy unless every goal is
    reached. Raises InputError for a goal that is not a pose, a start of the wrong shape, NaN, a floating
    base or more than 16 joints on the way; InputTypeError for no goal or two; UnknownNameError for another
    method or an unknown frame.

    Levenberg 1944; Sugihara 2011 (damping in proportion to the error); Bertsekas 1982 (limits).
    """
    question = pose_problem(robot, goal, position, frame, weights, limits, tolerance)
    newton = check_choice(method, "method", METHODS) == "newton"
    number = whole_number(starts, "starts", 1, MOST_STARTS)
    steps = whole_number(max_iterations, "max_iterations", 0, MOST_ITERATIONS)
    lead, n = question.goals.shape[:-2], len(robot.joint_names)
    if rng is not None:
        rng = as_generator(rng)
    posture = _posture(robot, rest, rest_weights)
    if start is None:
        first = middle_configuration(robot, question.limits)[None] if rest is None else posture[:1]
    else:
        rows = rows_for_goals(start, "start", n, lead)
        first = np.ascontiguousarray(rows.reshape(math.prod(rows.shape[:-1]), n))
    goals = np.ascontiguousarray(question.goals.reshape(-1, 4, 4))
    workers = thread_count(threads, lead)
    q, info = np.empty((len(goals), n)), np.empty((len(goals), 5))
    settings = (posture, question.weights, question.limits, question.tolerance, steps, newton, workers)

    def descend(first: Array, more: Array) -> None:
        _core._ik_descend(robot, question.frame, goals, first, more, *settings, q, info)

    if lead:
        descend(first, further_starts(robot, question.limits, goals, number - 1, rng))
    else:
        descend(first, NO_MORE.reshape(0, n))
        if number > 1 and info[0, 4] != REACHED:
            descend(first, further_starts(robot, question.limits, goals, number - 1, rng))
    found = q.reshape(*lead, n), info.reshape(*lead, 5)
    return NumericSolution.of(robot, question.goals, *found, number, question.limits)


def ik_many_starts(
    robot: KinematicModel,
    goal: Any = None,
    starts: Any = 64,
    *,
    position: Any = None,
    frame: str | None = None,
    limits: Any = True,
    weights: Any = None,
    tolerance: float = NUMERIC_TOLERANCE,
    max_iterations: int = 60,
    rng: int | np.random.Generator | None = None,
    threads: int | None = None,
) -> SampledSolutions:
    """The different solutions of one goal that descents from many starts find: a sample, never a proof.

    goal (4, 4), or position (3,) [m]. starts: how many, or the starts themselves (k, dof). frame, limits,
    weights, tolerance [m, rad], max_iterations, rng, threads: as in ik_numeric.

    Returns SampledSolutions: q (k, dof) in the order found, hits (k,), unseen, reason; falsy if nothing was
    found. Ends that differ by less than 1e-6 [rad, lengths of the arm] are one solution.
    Raises as ik_numeric does.
    """
    question = pose_problem(robot, goal, position, frame, weights, limits, tolerance)
    if question.goals.ndim != 2:
        raise InputError(f"goal has shape {question.goals.shape}; ik_many_starts takes one goal")
    steps = whole_number(max_iterations, "max_iterations", 0, MOST_ITERATIONS)
    n = len(robot.joint_names)
    if isinstance(starts, (list, tuple)) or np.ndim(starts) > 0:
        begin = np.ascontiguousarray(as_floats(starts, "starts", last=(n,), largest=FARTHEST).reshape(-1, n))
    else:
        number = whole_number(starts, "starts", 1, MOST_STARTS)
        begin = further_starts(robot, question.limits, question.goals, number, rng)
    goal_pose = np.ascontiguousarray(question.goals)
    q, residual = np.empty((len(begin), n)), np.empty(len(begin))
    hits = np.empty(len(begin), dtype=np.int64)
    settings = (question.weights, question.limits, question.tolerance, steps, thread_count(threads, ()))
    count = _core._ik_sample(
        robot, question.frame, goal_pose, begin, np.zeros((1, n)), *settings, q, residual, hits
    )
    found = q[:count].copy(), hits[:count].copy(), residual[:count].copy()
    return SampledSolutions(robot, question.goals, *found, len(begin))


def _posture(robot: KinematicModel, rest: Any, rest_weights: Any) -> Array:
    """Rows rest and its weights (2, n), or (0, n)."""
    n = len(robot.joint_names)
    if rest is None:
        if rest_weights is not None:
            raise InputError("rest_weights= can only be combined with rest=, which is missing")
        return np.empty((0, n))
    wanted = as_floats(rest, "rest", last=(n,), largest=FARTHEST)
    weights = np.ones(n) if rest_weights is None else as_floats(rest_weights, "rest_weights", last=(n,))
    if wanted.ndim != 1 or weights.ndim != 1 or not ((weights > 0) & (weights < 1e12)).all():
        raise InputError(f"rest and rest_weights are ({n},) each, one per joint, the weights positive")
    return np.array([wanted, weights])
