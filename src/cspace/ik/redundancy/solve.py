"""Goals that leave freedom: which joints are locked, and how the core answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array, leading_axes, whole_number
from cspace.buffer_pool import pooled_array
from cspace.errors import InputTypeError
from cspace.ik.context import About, Options
from cspace.ik.goals.given import one_configuration, rows_for_goals
from cspace.ik.goals.partial import PartialGoal
from cspace.ik.locked_joints import locked_values
from cspace.ik.redundancy.result import MOST_SAMPLES
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solver import Solver

SAMPLES = 16


def solve_freedom(
    solver: Solver, goal: PartialGoal | None, T: Array, options: Options
) -> Solutions | SolutionsBatch:
    """The answer to goals T (..., 4, 4) that leave freedom, or have joints locked.

    goal: the partial goal that T stands for; its virtual joints are then part of the arm.
    """
    arm = solver.limited(options.limits)
    whole = arm if goal is None else arm.extend(goal)
    values = locked_values(whole, options.locked, None if goal is None else solver)
    leaves_joints = bool(values) or whole.is_redundant
    degree = whole.redundancy_degree(tuple(values)) if leaves_joints else 0
    check_samples(solver, options, degree)
    if leaves_joints and degree <= 0:
        return choose_nearest(solve_locked(solver, whole, goal, T, values, options), options)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError(
            "locked= takes one value per joint while dimensions stay free; lock all redundant joints,"
            " or call it in a loop"
        )
    asked = whole.lock({joint: float(value) for joint, value in values.items()})
    freedom = tuple(asked.joint_names[k] for k in asked.redundant_joints) if degree > 0 else ()
    about = About(goal, None if goal is None else whole, freedom, values)
    seeds = None
    if options.near is not None and degree > 0:
        near = rows_for_goals(options.near, "near", solver.dof, T.shape[:-2])
        seeds = np.ascontiguousarray(near.reshape(-1, solver.dof))
    if goal is None and not values and degree > 0:
        _core._ik_enable_near(solver, About(freedom=freedom))
    samples = SAMPLES
    if options.samples is not None:
        samples = whole_number(options.samples, "samples", 1, MOST_SAMPLES)
    found = ask_core(solver, asked, T, about, options.threads, seeds=seeds, samples=samples)
    return choose_nearest(found, options) if seeds is None else found._chosen_within(options.limits)


def choose_nearest(found: Solutions | SolutionsBatch, options: Options) -> Solutions | SolutionsBatch:
    """Of all solutions the nearest to a seed within limits, or all without a seed."""
    return found if options.near is None else found._nearest_within(options.near, options.limits)


def ask_core(
    solver: Solver,
    asked: Solver,
    T: Array,
    about: About,
    threads: int,
    *,
    seeds: Array | None = None,
    samples: int = SAMPLES,
    at: Array | None = None,
) -> Solutions | SolutionsBatch:
    """The core's answer to T (..., 4, 4) by a solver that lacks the locked joints, or has them and takes rows
    of their values, `at`. seeds: rows of the arm's joints. samples: values of one redundant joint.
    """
    shape, goal, whole = T.shape[:-2], about.goal, about.extended or solver
    goals = np.ascontiguousarray(T.reshape(-1, 4, 4))
    columns, values = columns_of(whole, about.locked if at is None else {})
    first = 0 if goal is None else len(goal.before)
    locked = None if at is None else list(about.locked)
    request = (columns, values, first, goal is not None, seeds, samples, locked, at)
    made = _core._ik_answer(solver, asked, goals, *request, threads, not shape, about)
    if not shape:
        return cast(Solutions, made)
    q, rows, count, verdict, self_motion = made
    return SolutionsBatch.of(solver, T, q, count, verdict, replace(about, q=rows), self_motion)


def columns_of(whole: Solver, locked: Mapping[int, Any]) -> tuple[list[int], Array]:
    """Which joint of the others each joint of the whole arm is, −1 for locked ones, and their values."""
    moving = [k for k in range(whole.dof) if k not in locked]
    columns = [moving.index(k) if k not in locked else -1 for k in range(whole.dof)]
    return columns, np.array([float(locked.get(k, 0.0)) for k in range(whole.dof)])


def check_samples(solver: Solver, options: Options, degree: int) -> None:
    """Raise InputTypeError for samples= where it has no meaning."""
    if options.samples is None:
        return
    if options.near is not None:
        raise InputTypeError("samples= cannot be combined with near=, which answers with one configuration")
    if degree != 1:
        raise InputTypeError(
            f"samples= needs one free dimension, but {solver.name} has {max(degree, 0)} here: "
            + ("leave samples= out" if degree < 1 else "lock joints with locked=")
        )


# --- all redundant joints are locked ----------------------------------------------------------------------
def locked_rows(solver: Solver, T: Array, values: Mapping[int, Any]) -> tuple[tuple[int, ...], Array, Array]:
    """Leading axes of goals and values together, the goals (..., 4, 4) and rows of values (N, dof)."""
    given = {f"locked[{solver.joint_names[joint]!r}]": np.shape(v) for joint, v in values.items()}
    shape = leading_axes(goal=T.shape[:-2], **given)
    at = np.zeros((int(np.prod(shape)), solver.dof))
    for joint, value in values.items():
        at[:, joint] = np.broadcast_to(value, shape).reshape(-1)
    return shape, np.ascontiguousarray(np.broadcast_to(T, (*shape, 4, 4))), at


def solve_locked(
    solver: Solver,
    whole: Solver,
    goal: PartialGoal | None,
    T: Array,
    values: dict[int, Any],
    options: Options,
) -> Solutions | SolutionsBatch:
    """Every solution of the other joints."""
    joints = list(values)
    shape, goals, at = locked_rows(whole, T, values)
    if goal is not None:
        about = About(goal.spread(shape), whole, (), values)
        return ask_core(solver, whole, goals, about, options.threads, at=at)
    n, N = solver.dof, len(at)
    seed = np.empty(0)
    if options.near is not None and not shape:
        seed = one_configuration(solver, options.near, "near")
    room = _core._ik_locked_room(solver, joints)
    q = pooled_array((N, room, n))
    branch, self_motion = np.zeros((N, room), dtype=np.int8), np.zeros((N, room), dtype=bool)
    count, status = np.empty(N, dtype=np.int64), np.empty(N, dtype=np.uint8)
    rows = (q, branch, self_motion, count, status)
    _core._ik_locked_rows(solver, joints, at, goals.reshape(-1, 4, 4), seed, *rows, options.threads)
    if shape:
        return SolutionsBatch.of(solver, goals, q, count, status, About(locked=values), self_motion)
    if options.near is None:
        _core._ik_enable_locked(solver, joints, About())
    k = int(count[0])
    return Solutions.of(
        solver, goals, int(status[0]), q[0, :k], branch[0, :k], self_motion[0, :k], None, About(locked=values)
    )
