"""Arms with joints to spare: which are held, and how a goal is then answered."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import InputError, InputTypeError
from cspace.ik.about import About
from cspace.ik.goals import one_configuration
from cspace.ik.held import Held, by_name, fixed_values, hold, joint_number, leads_ahead
from cspace.ik.partial import KEYWORDS, PartialGoal, check_tool_axis, partial_goal
from cspace.ik.prepare import prepare
from cspace.ik.redundancy import MOST_SAMPLES, Interval, Redundancy
from cspace.ik.solutions import EXACT, INCOMPLETE, POSE_ASKS, UNREACHABLE, Solutions, how_many
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solve_partial import own_columns, whole_arm
from cspace.ik.windings import into_limits
from cspace.spare import spare_array
from cspace.spatial.checks import one_pose
from cspace.tolerances import FARTHEST

__all__ = ["redundancy", "redundant_answer"]

SAMPLES = 16
END_NOTHING, END_FOLD = -1, -2
STILL = 1e-6
"""Part of the self-motion's direction below which a joint stands still in it: files round axes."""


def redundant_answer(
    robot: Any,
    T: Array,
    *,
    fixed: Any,
    samples: Any,
    near: Any,
    threads: int,
) -> Solutions | SolutionsBatch:
    """The answer of an arm with joints to spare, or with joints held: see inverse_kinematics."""
    values = fixed_values(robot, {} if fixed is None else fixed)
    spare = to_spare(robot, values)
    if samples is not None and near is not None:
        raise InputTypeError("samples= and near= do not go together: near= answers with one configuration")
    if samples is not None and spare != 1:
        raise InputTypeError(
            f"samples= goes with one free dimension, but {robot.name} has {max(spare, 0)} here: "
            + ("leave samples= out" if spare < 1 else "hold joints with fixed=")
        )
    if spare <= 0:
        return solve_held(robot, T, values, near, threads)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError(
            "fixed= takes one value per joint while dimensions stay free; hold all of them, or ask in a loop"
        )
    held = hold(robot, {joint: float(value) for joint, value in values.items()})
    if T.ndim == 2 and _core._ik_is_beyond(robot, np.ascontiguousarray(T)):
        return unreachable(held, T, proven=True)
    if near is not None:
        if not values:
            held.solver.serve_near(robot, About(freedom=held.freedom))
        return nearest(held, T, near, threads)
    if held.solver.spare != 1:
        return nearest(held, T, start_of_search(robot, T), threads)
    count = sample_count(samples)
    if T.ndim == 2:
        return sampled(held, T, count, threads)
    return sampled_batch(held, T, count, threads)


def redundancy(
    robot: Any,
    goal: Any = None,
    parameter: str | int | None = None,
    *,
    fixed: Mapping[Any, float] | None = None,
    tool_axis: Any = "z",
    **parts: Any,
) -> Redundancy:
    """For which values of a joint to spare a goal can be reached within all limits, branch by branch.

    The ends are where another joint reaches a limit (it is locked there, and the others are solved) and where
    branches fold: the determinant of the others' Jacobian vanishes. goal (4, 4): T_base_tip; or parts of it
    by keyword, one goal, as `robot.ik` takes them: position, rotation, direction, look_at, ray, angle_to,
    tool_axis. parameter: the joint, by name or number, one of those that a partial goal adds, or "swivel" of
    an arm with two spherical joints; the solver's own choice unless given (`ik(goal).freedom` names it).
    fixed: values of other joints [rad, m], so that one is left to spare.

    Returns a `Redundancy`, falsy where no value will do. Raises InputError for arms without a joint to spare
    or with more than one, and for a joint that the goal settles.
    For arms with two spherical joints: M. Shimizu et al. 2008; here for any arm.
    """
    given = {name: value for name, value in parts.items() if value is not None}
    unknown = sorted(given.keys() - set(KEYWORDS))
    if unknown:
        raise InputTypeError(f"redundancy has no keyword {unknown[0]!r}; of a goal it takes {list(KEYWORDS)}")
    check_tool_axis(tool_axis, given)
    if (goal is None) == (not given):
        raise InputTypeError("redundancy needs one goal: a pose, or parts of it by name, such as position=p")
    if given:
        return redundancy_of_parts(robot, partial_goal(given, tool_axis), parameter, fixed)
    prepare(robot)
    T = one_pose(goal, "goal")
    if isinstance(parameter, str) and parameter == "swivel" and "swivel" not in robot.joint_names:
        from cspace.ik.swivel_intervals import swivel_intervals

        if fixed is not None:
            raise InputTypeError("the swivel is what seven joints leave free: fixed= does not go with it")
        return swivel_intervals(robot, T)
    return redundancy_of_pose(robot, T, parameter, fixed)


def redundancy_of_parts(robot: Any, goal: PartialGoal, parameter: Any, fixed: Any) -> Redundancy:
    """That of the arm with the joints which stand for what the goal leaves open."""
    if goal.T.ndim != 2:
        raise InputError(f"the goal has shape {goal.T.shape[:-2]}, expected one goal: ask in a loop")
    whole, own = whole_arm(robot, goal), own_columns(robot, goal)
    prepare(whole)
    named = parameter is None or isinstance(parameter, str)
    joint = parameter if named else robot.joint_names[joint_number(robot, parameter, "parameter")]
    values = by_name(robot, fixed) if isinstance(fixed, Mapping) else fixed
    found = redundancy_of_pose(whole, goal.T, joint, values)
    rows = tuple(replace(interval, q=interval.q[own]) for interval in found)
    return replace(found, robot=robot, intervals=rows)


def redundancy_of_pose(robot: Any, T: Array, parameter: Any, fixed: Any) -> Redundancy:
    values = fixed_values(robot, {} if fixed is None else fixed)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError("fixed= takes one value per joint here")
    held = hold(robot, {joint: float(value) for joint, value in values.items()})
    spare = held.solver.spare
    if spare != 1:
        raise InputError(
            f"{robot.name} has {spare} joints to spare here, expected one: "
            + ("hold the others with fixed=" if spare > 1 else "the goal settles all of them")
        )
    joint = (
        held.solver.held[0] if parameter is None else held.free.index(free_joint(robot, parameter, values))
    )
    found = intervals_of(held, T, joint)
    if not found and joint != held.solver.held[0]:
        check_moves(held, found.goal, joint)
    return found if is_bounded(held, joint) else replace(found, complete=False)


def is_bounded(held: Held, joint: int) -> bool:
    """Whether the parameter runs between limits or round a circle: along a slide without limits the search
    looks as far as the arm is long.
    """
    limits, k = held.robot.limits, held.free[joint]
    return held.robot.joint_types[k] == "R" or bool(np.isfinite([limits.lower[k], limits.upper[k]]).all())


def check_moves(held: Held, T: Array, joint: int) -> None:
    """Raise InputError for a joint that stands still while the tip does: the goal settles it."""
    own = held.solver.held[0]
    seen = intervals_of(held, T, own)
    if not seen:
        return
    J = held.robot.jacobian(np.array([interval.q for interval in seen]))[..., list(held.free)]
    if np.abs(np.linalg.svd(J)[2][:, -1, joint]).max() > STILL:
        return
    names = [held.robot.joint_names[k] for k in held.free]
    at = ", ".join(sorted({f"{interval.q[held.free[joint]]:.6g}" for interval in seen}))
    raise InputError(
        f"parameter {names[joint]!r} is settled by the goal, at {at}, and does not move with what is free; "
        f"take another joint, such as {names[own]!r}"
    )


def to_spare(robot: Any, fixed: Mapping[int, Any]) -> int:
    """How many dimensions a pose leaves free with some joints held, at values without a pattern."""
    return hold(robot, {}).solver.spare_with(list(fixed))


def free_joint(robot: Any, parameter: Any, fixed: Mapping[int, Any]) -> int:
    joint = joint_number(robot, parameter, "parameter")
    if joint in fixed:
        raise InputError(f"parameter {robot.joint_names[joint]!r} is held by fixed=: it is not free")
    return joint


def intervals_of(held: Held, T: Array, joint: int) -> Redundancy:
    rows, complete = held.solver.intervals(joint, T)
    names = [held.robot.joint_names[k] for k in held.free]
    slides = held.robot.joint_types[held.free[joint]] == "P"

    def end(what: int, side: int) -> str:
        if what == END_FOLD:
            return "fold"
        return "nothing" if what == END_NOTHING else f"{names[what]} at {'upper' if side else 'lower'} limit"

    robot = held.robot
    bounds = robot.joint_types, robot.limits.lower, robot.limits.upper
    made = [
        Interval(
            low,
            high,
            branch + 1,
            (end(a, sa), end(b, sb)),
            into_limits(held.whole(np.array(q)), *bounds)[0],
            slides,
        )
        for low, high, branch, a, sa, b, sb, q in rows
    ]
    made.sort(key=lambda interval: (interval.branch, interval.lower))
    return Redundancy(held.robot, T, names[joint], tuple(made), complete, slides)


# --- answers ----------------------------------------------------------------------------------------------
def solve_held(
    robot: Any, T: Array, values: dict[int, Any], near: Any, threads: int
) -> Solutions | SolutionsBatch:
    """All joints to spare are held: every solution of the others."""
    solver = hold(robot, {}).solver
    joints = list(values)
    given = {f"fixed[{robot.joint_names[joint]!r}]": np.shape(v) for joint, v in values.items()}
    shape = leading_axes(goal=T.shape[:-2], **given)
    goals = np.ascontiguousarray(np.broadcast_to(T, (*shape, 4, 4)))
    n, N = robot.dof, int(np.prod(shape))
    at = np.zeros((N, n))
    for joint, value in values.items():
        at[:, joint] = np.broadcast_to(value, shape).reshape(-1)
    seed = np.empty(0) if near is None else one_configuration(robot, near, "near")
    room = solver.room(joints)
    q = spare_array((N, room, n))
    branch, family = np.zeros((N, room), dtype=np.int8), np.zeros((N, room), dtype=bool)
    count, status = np.empty(N, dtype=np.int64), np.empty(N, dtype=np.uint8)
    solver.solve(joints, at, goals.reshape(-1, 4, 4), seed, q, branch, family, count, status, threads)
    if shape:
        if near is not None:
            raise InputTypeError("near= with fixed= is for one goal; a batch has .nearest(q)")
        return SolutionsBatch(
            robot, goals, q.reshape(*shape, room, n), count.reshape(shape), status.reshape(shape)
        )
    if near is None:
        solver.serve_held(robot, joints, About())
    k = int(count[0])
    note = None
    if k == 0:
        held = ", ".join(f"{robot.joint_names[j]} = {float(v):.6g}" for j, v in values.items())
        note = f"nothing reaches the goal with {held}"
    made = make(robot, goals, int(status[0]), q[0, :k], branch[0, :k], family[0, :k], note, ())
    return made if near is None else made.nearest(near)


def nearest(held: Held, T: Array, near: Any, threads: int) -> Solutions | SolutionsBatch:
    robot = held.robot
    seeds = as_floats(near, "near", last=(robot.dof,), largest=FARTHEST)
    shape = T.shape[:-2]
    if seeds.ndim > 1 and seeds.shape[:-1] != shape:
        raise InputError(
            f"near has shape {seeds.shape}, expected ({robot.dof},) for all goals or"
            f" {(*shape, robot.dof)}, one for each"
        )
    goals = T.reshape(-1, 4, 4)
    rows = np.ascontiguousarray(seeds.reshape(-1, robot.dof)[:, list(held.free)])
    q, found = np.empty((len(goals), len(held.free))), np.empty(len(goals), dtype=bool)
    held.solver.nearest(goals, rows, q, found, threads)
    whole = held.whole(q)
    if shape:
        status = np.where(found, EXACT, UNREACHABLE).astype(np.uint8)
        for k in np.flatnonzero(~found):
            if not _core._ik_is_beyond(robot, np.ascontiguousarray(goals[k])):
                status[k] += INCOMPLETE
        count = found.astype(np.int64).reshape(shape)
        batch = SolutionsBatch(
            robot, T, whole.reshape(*shape, 1, robot.dof), count, status.reshape(shape), None, held.freedom
        )
        return batch
    if not found[0]:
        return unreachable(held, T, proven=False)
    made = make(robot, T, EXACT, whole, np.full(1, -1), np.zeros(1, dtype=bool), None, held.freedom)
    return made.nearest(seeds)


def unreachable(held: Held, T: Array, *, proven: bool) -> Solutions:
    """Nothing found; a search among infinitely many configurations does not prove that there is nothing."""
    nothing = np.empty((0, held.robot.dof))
    note = None
    if held.fixed:
        at = ", ".join(f"{held.robot.joint_names[j]} = {v:.6g}" for j, v in held.fixed.items())
        note = f"nothing reaches the goal with {at}"
    empty = np.empty(0, dtype=np.int8)
    verdict = UNREACHABLE + (0 if proven else INCOMPLETE)
    return make(held.robot, T, verdict, nothing, empty, empty.astype(bool), note, held.freedom)


def sampled(held: Held, T: Array, count: int, threads: int) -> Solutions:
    """All branches at values spread over the feasible intervals; over all that exist if none is feasible."""
    robot, joint = held.robot, held.solver.held[0]
    T = np.ascontiguousarray(T)
    found = intervals_of(held, T, joint)
    where = "its feasible intervals"
    if not found:
        free = hold(robot, held.fixed, limited=False)
        found = intervals_of(free, T, joint)
        where = "the values that reach it, none of them within limits"
    values = found.spread(count)
    if not len(values):
        found_beside = cast(Solutions, nearest(held, T, start_of_search(robot, T), threads))
        # Where joints share their work but for a little, single values may reach what no interval does.
        proven = found.complete and len(held.free) > POSE_ASKS
        return found_beside if found_beside else unreachable(held, T, proven=proven)
    q, branch, counts, complete = sweep(held, T, joint, values)
    real = np.arange(q.shape[1]) < counts[:, None]
    rows = held.whole(q[real])
    note = (
        f"{how_many(len(rows))} the goal, at {len(values)} value{'s' if len(values) > 1 else ''} of "
        f"{held.parameters[0]} spread over {where}"
    )
    verdict = EXACT + (0 if complete and found.complete else INCOMPLETE)
    family = np.zeros(len(rows), dtype=bool)
    return make(robot, T, verdict, rows, branch[real], family, note, held.freedom)


def sampled_batch(held: Held, T: Array, count: int, threads: int) -> SolutionsBatch:
    shape = T.shape[:-2]
    answers = [sampled(held, goal, count, threads) for goal in T.reshape(-1, 4, 4)]
    room = max((len(answer) for answer in answers), default=1) or 1
    q = np.full((len(answers), room, held.robot.dof), np.nan)
    for row, answer in zip(q, answers, strict=True):
        row[: len(answer)] = answer.q
    counts = np.array([len(answer) for answer in answers], dtype=np.int64)
    verdicts = np.array([answer._verdict for answer in answers], dtype=np.uint8)
    return SolutionsBatch(
        held.robot,
        T,
        q.reshape(*shape, room, held.robot.dof),
        counts.reshape(shape),
        verdicts.reshape(shape),
        None,
        held.freedom,
    )


def sweep(
    held: Held, T: Array, joint: int, values: Array
) -> tuple[Array, npt.NDArray[np.int8], npt.NDArray[np.int64], bool]:
    """Every solution at many values of one joint: q (m, 16, n), branch (m, 16), count (m,)."""
    m, n = len(values), len(held.free)
    q = np.empty((m, 16, n))
    branch, count = np.zeros((m, 16), dtype=np.int8), np.empty(m, dtype=np.int64)
    complete = held.solver.sweep(joint, T, np.zeros(n), np.ascontiguousarray(values), q, branch, count)
    return q, branch, count, complete


def make(
    robot: Any,
    T: Array,
    verdict: int,
    q: Array,
    branch: Any,
    family: Any,
    note: str | None,
    freedom: tuple[str, ...],
) -> Solutions:
    made = _core._ik_make(
        robot,
        np.ascontiguousarray(T),
        verdict,
        np.ascontiguousarray(q),
        tuple(int(b) for b in branch),
        tuple(bool(f) for f in family),
        note,
        About(freedom=freedom),
    )
    return cast(Solutions, made)


def start_of_search(robot: Any, T: Array) -> Array:
    """The middle of the limits, 0 for joints that have none; for poses (..., 4, 4) one configuration each
    where a goal's slide that only leads ahead begins as far out as the goal is.
    """
    lower, upper = robot.limits.lower, robot.limits.upper
    bounded = np.isfinite(lower) & np.isfinite(upper)
    middle = np.where(bounded, 0.5 * (np.where(bounded, lower, 0) + np.where(bounded, upper, 0)), 0.0)
    ahead = leads_ahead(robot)
    if not ahead.any():
        return middle
    return np.where(ahead, np.linalg.norm(T[..., :3, 3], axis=-1)[..., None], middle)


def sample_count(samples: Any) -> int:
    if samples is None:
        return SAMPLES
    if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)):
        raise InputTypeError(f"samples is a {type(samples).__name__}, expected a number of values")
    if not 1 <= samples <= MOST_SAMPLES:
        raise InputError(f"samples is {samples}, expected 1 to {MOST_SAMPLES}")
    return int(samples)
