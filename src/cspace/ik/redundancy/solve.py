"""Arms with redundant joints: which are locked, and how a goal is then answered."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.buffer_pool import pooled_array
from cspace.errors import InputError, InputTypeError
from cspace.ik.context import About
from cspace.ik.goals.given import one_configuration
from cspace.ik.locked_joints import LockedArm, leads_ahead, lock_joints, locked_in_words, locked_values
from cspace.ik.redundancy.feasible_intervals import intervals_of
from cspace.ik.redundancy.result import MOST_SAMPLES
from cspace.ik.solutions import EXACT, INCOMPLETE, POSE_ASKS, UNREACHABLE, Solutions, how_many
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.tolerances import FARTHEST

__all__ = ["redundant_answer"]

SAMPLES = 16


def redundant_answer(
    robot: Any,
    T: Array,
    *,
    locked: Any,
    samples: Any,
    near: Any,
    threads: int,
) -> Solutions | SolutionsBatch:
    """The answer of an arm with redundant joints, or with locked joints: see inverse_kinematics."""
    values = locked_values(robot, {} if locked is None else locked)
    redundancy_degree = count_redundancy(robot, values)
    if samples is not None and near is not None:
        raise InputTypeError("samples= and near= do not go together: near= answers with one configuration")
    if samples is not None and redundancy_degree != 1:
        raise InputTypeError(
            f"samples= goes with one free dimension, but {robot.name} has {max(redundancy_degree, 0)} here: "
            + ("leave samples= out" if redundancy_degree < 1 else "lock joints with locked=")
        )
    if redundancy_degree <= 0:
        return solve_locked(robot, T, values, near, threads)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError(
            "locked= takes one value per joint while dimensions stay free; hold all of them, or ask in a loop"
        )
    locked_arm = lock_joints(robot, {joint: float(value) for joint, value in values.items()})
    if T.ndim == 2 and exceeds_reach(robot, T):
        return unreachable(locked_arm, T, proven=True)
    if near is not None:
        if not values:
            locked_arm.solver.serve_near(robot, About(freedom=locked_arm.freedom))
        return nearest(locked_arm, T, near, threads)
    if locked_arm.solver.redundancy_degree != 1:
        return nearest(locked_arm, T, start_of_search(locked_arm, T, threads), threads)
    count = sample_count(samples)
    if T.ndim == 2:
        return sampled(locked_arm, T, count, threads)
    return sampled_batch(locked_arm, T, count, threads)


def count_redundancy(robot: Any, locked: Mapping[int, Any]) -> int:
    """How many dimensions a pose leaves free with some joints locked, at values without a pattern."""
    return lock_joints(robot, {}).solver.redundancy_degree_with(list(locked))


# --- answers ----------------------------------------------------------------------------------------------
def solve_locked(
    robot: Any, T: Array, values: dict[int, Any], near: Any, threads: int
) -> Solutions | SolutionsBatch:
    """All redundant joints are locked: every solution of the others."""
    solver = lock_joints(robot, {}).solver
    joints = list(values)
    given = {f"locked[{robot.joint_names[joint]!r}]": np.shape(v) for joint, v in values.items()}
    shape = leading_axes(goal=T.shape[:-2], **given)
    goals = np.ascontiguousarray(np.broadcast_to(T, (*shape, 4, 4)))
    n, N = robot.dof, int(np.prod(shape))
    at = np.zeros((N, n))
    for joint, value in values.items():
        at[:, joint] = np.broadcast_to(value, shape).reshape(-1)
    seed = np.empty(0) if near is None else one_configuration(robot, near, "near")
    room = solver.room(joints)
    q = pooled_array((N, room, n))
    branch, self_motion = np.zeros((N, room), dtype=np.int8), np.zeros((N, room), dtype=bool)
    count, status = np.empty(N, dtype=np.int64), np.empty(N, dtype=np.uint8)
    solver.solve(joints, at, goals.reshape(-1, 4, 4), seed, q, branch, self_motion, count, status, threads)
    if shape:
        if near is not None:
            raise InputTypeError("near= with locked= is for one goal; a batch has .nearest(q)")
        return SolutionsBatch(
            robot, goals, q.reshape(*shape, room, n), count.reshape(shape), status.reshape(shape)
        )
    if near is None:
        solver.serve_locked(robot, joints, About())
    k = int(count[0])
    note = None if k else f"nothing reaches the goal with {locked_in_words(robot, values)}"
    made = make(robot, goals, int(status[0]), q[0, :k], branch[0, :k], self_motion[0, :k], note, ())
    return made if near is None else made.nearest(near)


def nearest(locked_arm: LockedArm, T: Array, near: Any, threads: int) -> Solutions | SolutionsBatch:
    robot = locked_arm.robot
    seeds = as_floats(near, "near", last=(robot.dof,), largest=FARTHEST)
    shape = T.shape[:-2]
    if seeds.ndim > 1 and seeds.shape[:-1] != shape:
        raise InputError(
            f"near has shape {seeds.shape}, expected ({robot.dof},) for all goals or"
            f" {(*shape, robot.dof)}, one for each"
        )
    goals = T.reshape(-1, 4, 4)
    rows = np.ascontiguousarray(seeds.reshape(-1, robot.dof)[:, list(locked_arm.free)])
    q, found = np.empty((len(goals), len(locked_arm.free))), np.empty(len(goals), dtype=bool)
    locked_arm.solver.nearest(goals, rows, q, found, threads)
    whole = locked_arm.whole(q)
    if shape:
        status = np.where(found, EXACT, UNREACHABLE).astype(np.uint8)
        for k in np.flatnonzero(~found):
            if not exceeds_reach(robot, goals[k]):
                status[k] += INCOMPLETE
        count = found.astype(np.int64).reshape(shape)
        batch = SolutionsBatch(
            robot,
            T,
            whole.reshape(*shape, 1, robot.dof),
            count,
            status.reshape(shape),
            None,
            locked_arm.freedom,
        )
        return batch
    if not found[0]:
        return unreachable(locked_arm, T, proven=False)
    made = make(robot, T, EXACT, whole, np.full(1, -1), np.zeros(1, dtype=bool), None, locked_arm.freedom)
    return made.nearest(seeds)


def exceeds_reach(robot: Any, T: Array) -> bool:
    """Whether the lengths and axes of an arm alone rule a pose out."""
    far = float(np.linalg.norm(T[:3, 3])) > robot._ik_reach
    return far or bool(_core._ik_exceeds_reach(robot, np.ascontiguousarray(T)))


def unreachable(locked_arm: LockedArm, T: Array, *, proven: bool) -> Solutions:
    """Nothing found; a search among infinitely many configurations does not prove that there is nothing."""
    nothing = np.empty((0, locked_arm.robot.dof))
    at = locked_in_words(locked_arm.robot, locked_arm.locked)
    note = f"nothing reaches the goal with {at}" if at else None
    empty = np.empty(0, dtype=np.int8)
    verdict = UNREACHABLE + (0 if proven else INCOMPLETE)
    return make(locked_arm.robot, T, verdict, nothing, empty, empty.astype(bool), note, locked_arm.freedom)


def sampled(locked_arm: LockedArm, T: Array, count: int, threads: int) -> Solutions:
    """All branches at values spread over the feasible intervals; over all that exist if none is feasible."""
    robot, joint = locked_arm.robot, locked_arm.solver.locked[0]
    T = np.ascontiguousarray(T)
    found = intervals_of(locked_arm, T, joint)
    where = "its feasible intervals"
    if not found:
        free = lock_joints(robot, locked_arm.locked, limited=False)
        found = intervals_of(free, T, joint)
        where = "the values that reach it, none of them within limits"
    values = found.spread(count)
    q, branch, counts, complete = sweep(locked_arm, T, joint, values)
    if not counts.any():
        found_nearby = cast(
            Solutions, nearest(locked_arm, T, start_of_search(locked_arm, T, threads), threads)
        )
        # Where joints share their work but for a little, single values may reach what no interval does.
        proven = not found and found.complete and len(locked_arm.free) > POSE_ASKS
        return found_nearby if found_nearby else unreachable(locked_arm, T, proven=proven)
    real = np.arange(q.shape[1]) < counts[:, None]
    rows = locked_arm.whole(q[real])
    note = (
        f"{how_many(len(rows))} the goal, at {len(values)} value{'s' if len(values) > 1 else ''} of "
        f"{locked_arm.parameters[0]} spread over {where}"
    )
    verdict = EXACT + (0 if complete and found.complete else INCOMPLETE)
    self_motion = np.zeros(len(rows), dtype=bool)
    return make(robot, T, verdict, rows, branch[real], self_motion, note, locked_arm.freedom)


def sampled_batch(locked_arm: LockedArm, T: Array, count: int, threads: int) -> SolutionsBatch:
    shape = T.shape[:-2]
    answers = [
        unreachable(locked_arm, goal, proven=True)
        if exceeds_reach(locked_arm.robot, goal)
        else sampled(locked_arm, goal, count, threads)
        for goal in T.reshape(-1, 4, 4)
    ]
    room = max((len(answer) for answer in answers), default=1) or 1
    q = np.full((len(answers), room, locked_arm.robot.dof), np.nan)
    for row, answer in zip(q, answers, strict=True):
        row[: len(answer)] = answer.q
    counts = np.array([len(answer) for answer in answers], dtype=np.int64)
    verdicts = np.array([answer._verdict for answer in answers], dtype=np.uint8)
    return SolutionsBatch(
        locked_arm.robot,
        T,
        q.reshape(*shape, room, locked_arm.robot.dof),
        counts.reshape(shape),
        verdicts.reshape(shape),
        None,
        locked_arm.freedom,
    )


def sweep(
    locked_arm: LockedArm, T: Array, joint: int, values: Array
) -> tuple[Array, npt.NDArray[np.int8], npt.NDArray[np.int64], bool]:
    """Every solution at many values of one joint: q (m, 16, n), branch (m, 16), count (m,)."""
    m, n = len(values), len(locked_arm.free)
    q = np.empty((m, 16, n))
    branch, count = np.zeros((m, 16), dtype=np.int8), np.empty(m, dtype=np.int64)
    complete = locked_arm.solver.sweep(joint, T, np.zeros(n), np.ascontiguousarray(values), q, branch, count)
    return q, branch, count, complete


def make(
    robot: Any,
    T: Array,
    verdict: int,
    q: Array,
    branch: Any,
    self_motion: Any,
    note: str | None,
    freedom: tuple[str, ...],
) -> Solutions:
    made = _core._ik_make(
        robot,
        np.ascontiguousarray(T),
        verdict,
        np.ascontiguousarray(q),
        tuple(int(b) for b in branch),
        tuple(bool(f) for f in self_motion),
        note,
        About(freedom=freedom),
    )
    return cast(Solutions, made)


def start_of_search(locked_arm: LockedArm, T: Array, threads: int) -> Array:
    """The middle of the limits, 0 for joints that have none; for poses (..., 4, 4) one configuration each
    where a goal's slide only leads ahead. It begins as far out as the goal is, and the others where they look
    at a point in the same direction that is not so far.
    """
    robot, steps, near_by = locked_arm.robot, 100.0, 300.0
    lower, upper = robot.limits.lower, robot.limits.upper
    bounded = np.isfinite(lower) & np.isfinite(upper)
    middle = np.where(bounded, 0.5 * (np.where(bounded, lower, 0) + np.where(bounded, upper, 0)), 0.0)
    ahead = leads_ahead(robot)
    if not ahead.any():
        return middle
    away = np.linalg.norm(T[..., :3, 3], axis=-1)
    if T.ndim == 2 and away > near_by:
        closer = T.copy()
        closer[:3, 3] /= min(steps, away / near_by * 2)
        found = nearest(locked_arm, closer, start_of_search(locked_arm, closer, threads), threads)
        middle = found.q[0] if found else middle
    return np.where(ahead, away[..., None], middle)


def sample_count(samples: Any) -> int:
    if samples is None:
        return SAMPLES
    if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)):
        raise InputTypeError(f"samples is a {type(samples).__name__}, expected a number of values")
    if not 1 <= samples <= MOST_SAMPLES:
        raise InputError(f"samples is {samples}, expected 1 to {MOST_SAMPLES}")
    return int(samples)
