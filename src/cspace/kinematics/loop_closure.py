"""Configurations of closed loops for given values of some coordinates: one, all that are found, or a
motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace.arrays import Array, as_floats, as_generator, leading_axes, positive_number, whole_number
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.kinematics.assembly import Numbers
from cspace.kinematics.loop_constraints import LoopConstraints
from cspace.kinematics.loop_freedom import find_rank_tolerance, find_scaled_jacobian
from cspace.kinematics.loop_newton import close_rows, polish_rows, select_columns, solve_least
from cspace.kinematics.workspace import random_configurations
from cspace.math.wrapping import wrap_near
from cspace.tables import count_things, join_words, one_line, shown, tabulate
from cspace.tolerances import FARTHEST, LOOP_CLOSED, LOOP_SINGULAR, SAME_MODE, SHORTEST_PART

Flags = NDArray[np.bool_]
Driven = Mapping[str, ArrayLike]
"""Names of coordinates and their values."""

MOST_STARTS: Final = 100_000
"""Of a search: more would take gigabytes at once."""

PROBE: Final = 0.01
"""How far driven coordinates are moved [rad, sizes of the mechanism] to see whether others move with them."""

RETURNED: Final = 0.1
"""Share of this move within which a probe came back to where it was."""

LONGEST_STRIDE: Final = 0.1
"""Of a predictor [rad, sizes of the mechanism]."""

MOST_CORRECTION: Final = 0.3
"""A correction that is larger than this share of the predictor's step means that the step was too long."""

LONGER: Final = 2.0
"""Factor of the stride after a success; a failure halves it."""


@tabulate()
@dataclass(frozen=True, eq=False)
class LoopClosure:
    """Configurations with closed loops; falsy if one could not be closed.

    q (..., n) [rad or m]: the nearest found where a loop stays open. closed (...), singular (...): whether
    all loops are closed; whether the driven coordinates do not determine the velocities of the others there,
    as at a dead point. gap (...) [m]: how far the loops stay open, angles in the unit of lengths. reason:
    "closed", "singular: …" or "impossible: …", of the first configuration that is not closed, or singular.
    """

    q: Array
    closed: Flags
    singular: Flags
    gap: Array
    reason: str

    def __bool__(self) -> bool:
        return bool(self.closed.all())

    def __repr__(self) -> str:
        return one_line("LoopClosure", f"{count_things(self.closed.size, 'configuration')}, {self.reason}")


@tabulate()
@dataclass(frozen=True, eq=False)
class AssemblyModes:
    """The configurations of a mechanism for given driven coordinates; falsy if there is none.

    q (k, n) [rad or m]. complete: whether no others exist, which a closed form knows and a search does not.
    gap [m]: what is missing, zero if there is any. reason: "found", or what is impossible.
    """

    q: Array
    complete: bool
    gap: float
    reason: str

    def __bool__(self) -> bool:
        return len(self.q) > 0

    def __len__(self) -> int:
        return len(self.q)

    def __repr__(self) -> str:
        known = "all of them" if self.complete else "perhaps not all"
        text = f"{count_things(len(self), 'configuration')}, {known}" if self else self.reason
        return one_line("AssemblyModes", text)


@tabulate()
@dataclass(frozen=True, eq=False)
class LoopMotion:
    """The motion of a mechanism along values of its driven coordinates; falsy if it stops before the last.

    q (k, n) [rad or m]: a configuration for each value reached. stop (n,): where the motion stopped, the last
    configuration if it did not. reason: "complete", "time limit", or "dead point: …" with the driven
    coordinates.
    """

    q: Array
    stop: Array
    reason: str

    def __bool__(self) -> bool:
        return self.reason == "complete"

    def __len__(self) -> int:
        return len(self.q)

    def __repr__(self) -> str:
        return one_line("LoopMotion", f"{count_things(len(self), 'configuration')}, {self.reason}")


def close_loops(
    constraints: LoopConstraints,
    driven: Driven | None = None,
    *,
    near: ArrayLike | None = None,
    starts: int = 30,
    rng: int | np.random.Generator | None = 0,
) -> LoopClosure:
    """Configurations whose loops are closed, with the driven coordinates at given values.

    Newton's method, damped, from `near`. Where it ends at open loops it goes on from random configurations
    and takes the closed one nearest to `near`. Limits of joints do not count, except for these draws.

    driven: coordinate → values (...) [rad or m]; without any the loops are closed near `near`. near (..., n):
    seeds, zero if None. starts: how many random ones. rng: as everywhere.

    Returns a LoopClosure, whose gap is the smallest that was found where no configuration is closed: a search
    does not prove that there is none.
    Raises InputError for a wrong shape, NaN, or leading axes that do not fit; UnknownNameError for an unknown
    coordinate.
    """
    numbers, values, lead = check_driven(constraints, driven or {}, near)
    draws, generator = whole_number(starts, "starts", 0, MOST_STARTS), as_generator(rng)
    n = len(constraints.robot.joint_names)
    seed = np.broadcast_to(np.zeros(n) if near is None else np.asarray(near, dtype=np.float64), (*lead, n))
    q = seed.reshape(-1, n).copy()
    q[:, numbers] = values
    passive = np.setdiff1d(np.arange(n), numbers)
    wish = q.copy()
    q, gap = close_rows(constraints, q, passive)
    limit = LOOP_CLOSED * constraints.length
    for row in np.flatnonzero(gap > limit):
        many = draw_starts(constraints, wish[row], passive, draws, generator)
        found, gaps = close_rows(constraints, many, passive)
        near_by = wrap_revolute(constraints, found, wish[row], passive)
        away = np.where(gaps <= limit, np.linalg.norm(near_by - wish[row], axis=-1), np.inf)
        if away.min(initial=np.inf) < np.inf:
            q[row], gap[row] = near_by[away.argmin()], gaps[away.argmin()]
        elif gaps.min(initial=np.inf) < gap[row]:
            q[row], gap[row] = near_by[gaps.argmin()], gaps[gaps.argmin()]
    closed = gap <= limit
    singular = closed.copy()
    for row in np.flatnonzero(closed):
        singular[row] = is_stuck(constraints, q[row], numbers, passive)
    reason = name_reason(constraints, q, closed, singular, gap, lead)
    return LoopClosure(
        q.reshape((*lead, n)), closed.reshape(lead), singular.reshape(lead), gap.reshape(lead), reason
    )


def find_assembly_modes(
    constraints: LoopConstraints,
    driven: Driven,
    *,
    starts: int = 200,
    rng: int | np.random.Generator | None = 0,
) -> AssemblyModes:
    """The configurations of a mechanism that Newton's method finds from many random ones; never called
    complete.

    driven: coordinate → value [rad or m]. starts: how many are drawn between the limits, prismatic joints
    without limits within the size of the mechanism. Configurations that differ by multiples of 2π are one;
    they are sorted by their coordinates.

    Raises as close_loops.
    """
    numbers, values, lead = check_driven(constraints, driven, None)
    if lead:
        raise InputError(
            f"driven values have shape {lead}, expected one number each; assembly modes are of one position"
        )
    count, generator = whole_number(starts, "starts", 1, MOST_STARTS), as_generator(rng)
    n = len(constraints.robot.joint_names)
    seed = np.zeros(n)
    seed[numbers] = values
    passive = np.setdiff1d(np.arange(n), numbers)
    q, gap = close_rows(constraints, draw_starts(constraints, seed, passive, count, generator), passive)
    closed = gap <= LOOP_CLOSED * constraints.length
    if not closed.any():
        best = int(gap.argmin())
        return AssemblyModes(
            np.empty((0, n)), False, float(gap[best]), name_gap(constraints, q[best], gap[best])
        )
    return AssemblyModes(pick_modes(constraints, q[closed], passive), False, 0.0, "found")


def follow_loops(
    constraints: LoopConstraints, driven: Driven, start: ArrayLike, *, time_limit: float | None = None
) -> LoopMotion:
    """The motion of a mechanism while its driven coordinates go through given values.

    A predictor along the tangent and Newton's corrector, with strides as long as the correction stays small,
    so the motion stays on its branch. At a dead point, where the driven coordinates can go no further, it
    stops.

    driven: coordinate → values (k,) [rad or m], passed one after the other in straight lines. start (n,): a
    configuration near the first values, which is closed there. time_limit [s]: of the computation.

    Returns a LoopMotion. Raises InputError for a start that cannot be closed, a wrong shape or NaN;
    UnknownNameError for an unknown coordinate.
    """
    numbers, values, lead = check_driven(constraints, driven, None)
    if len(lead) != 1 or lead[0] == 0 or numbers.size == 0:
        raise InputError(
            f"driven values have shape {lead}, expected (k,): one value per configuration of the motion"
        )
    limit = math.inf if time_limit is None else positive_number(time_limit, "time_limit")
    deadline = perf_counter() + limit
    n = len(constraints.robot.joint_names)
    first = close_loops(
        constraints,
        {name: np.asarray(v)[0] if np.ndim(v) else v for name, v in driven.items()},
        near=as_floats(start, "start", last=(n,)),
        starts=0,
    )
    if not first:
        raise InputError(
            f"start cannot be closed at the first values of the driven coordinates: {first.reason}"
        )
    passive = np.setdiff1d(np.arange(n), numbers)
    q, rows, stride = first.q, [first.q], 1.0
    for goal in values[1:]:
        q, arrived, stride = step_towards(constraints, q, numbers, passive, goal, stride, deadline)
        if not arrived:
            is_late = perf_counter() > deadline
            reason = "time limit" if is_late else name_dead_point(constraints, q, numbers)
            return LoopMotion(np.array(rows), q, reason)
        rows.append(q)
    return LoopMotion(np.array(rows), q, "complete")


def step_towards(
    constraints: LoopConstraints,
    q: Array,
    numbers: Numbers,
    passive: Numbers,
    goal: Array,
    stride: float,
    deadline: float,
) -> tuple[Array, bool, float]:
    """Follow the loops until the driven coordinates are at their goal: where, whether it was reached, the
    stride.

    stride: the share of the way that the first step tries. It stops where shorter steps do not help, and
    after the deadline.
    """
    begin, done = q[numbers].copy(), 0.0
    share = min(stride, 1.0)
    unit = constraints.unit[constraints.robot.dof - len(constraints.robot.joint_names) :]
    way = max(1.0, np.abs((goal - begin) / unit[numbers]).max(initial=0.0))
    while done < 1.0:
        if perf_counter() > deadline:
            return q, False, share
        part = min(share, 1.0 - done)
        target = goal if done + part >= 1.0 else begin + (done + part) * (goal - begin)
        moved = try_step(constraints, q, numbers, passive, target, unit)
        if moved is None:
            share = 0.5 * part
            if share * way < SHORTEST_PART:
                return q, False, share
            continue
        q, done = moved, done + part
        share = part * LONGER
    return q, True, share


def try_step(
    constraints: LoopConstraints, q: Array, numbers: Numbers, passive: Numbers, target: Array, unit: Array
) -> Array | None:
    """The configuration with driven coordinates at a target, or None if it is too far for one step."""
    at = constraints.place(q[None])
    J, _ = select_columns(constraints, at, passive)
    driven, _ = select_columns(constraints, at, numbers)
    change = (target - q[numbers]) / unit[numbers]
    tangent = -solve_least(J, driven @ change, find_rank_tolerance(constraints, at))[0]
    size = max(np.abs(tangent).max(initial=0.0), np.abs(change).max(initial=0.0))
    if size > LONGEST_STRIDE:
        return None
    ahead = q.copy()
    ahead[numbers] = target
    ahead[passive] += tangent * unit[passive]
    found = polish_rows(constraints, ahead[None], passive)[0]
    if not constraints.find_miss(constraints.place(found[None]))[0] <= LOOP_CLOSED * constraints.length:
        return None
    correction = np.abs((found - ahead) / unit).max()
    return found if correction <= MOST_CORRECTION * size + LOOP_CLOSED else None


def list_modes(constraints: LoopConstraints, driven: Iterable[str], found: Array) -> AssemblyModes:
    """All configurations (k, n) that a closed form gives, complete unless one is part of a continuum."""
    numbers = number_coordinates(constraints, list(driven))
    passive = np.setdiff1d(np.arange(found.shape[1]), numbers)
    if any(is_in_continuum(constraints, q, passive) for q in found):
        return AssemblyModes(
            found, False, 0.0, "singular: infinitely many configurations, of which one is given"
        )
    return AssemblyModes(found, True, 0.0, "found")


def is_in_continuum(constraints: LoopConstraints, q: Array, passive: Numbers) -> bool:
    """Whether passive coordinates can leave a configuration (n,) while the others stand still."""
    if count_left(constraints, q, passive) == 0:
        return False
    J, unit = select_columns(constraints, constraints.place(q[None]), passive)
    along = np.linalg.svd(J[0])[2][-1] * unit
    probes = np.repeat(q[None], 2, axis=0)
    probes[:, passive] += PROBE * np.array([along, -along])
    probes, gaps = close_rows(constraints, probes, passive)
    away = np.abs((probes - q)[:, passive] / unit).max(axis=1)
    return bool(((gaps <= LOOP_CLOSED * constraints.length) & (away > RETURNED * PROBE)).any())


def check_driven(
    constraints: LoopConstraints, driven: Any, near: ArrayLike | None
) -> tuple[Numbers, Array, tuple[int, ...]]:
    """The numbers of driven coordinates (k,), their values (rows, k), and the leading axes of the rows.

    near (..., n): configurations whose axes count too. Raises as close_loops.
    """
    robot = constraints.robot
    if not isinstance(driven, Mapping):
        raise InputTypeError(
            f"driven is {name_type(driven)}, expected a dict of coordinate → value, such as"
            f' {{"{robot.joint_names[0]}": 0.5}}'
        )
    numbers = number_coordinates(constraints, list(driven))
    largest = FARTHEST / len(robot.joint_names)  # of a sum that fits a double
    given = {name: as_floats(value, f"driven {name!r}", largest=largest) for name, value in driven.items()}
    shapes = {name: value.shape for name, value in given.items()}
    if near is not None:
        shapes["near"] = as_floats(near, "near", last=(len(robot.joint_names),), largest=largest).shape[:-1]
    lead = leading_axes(**shapes)
    rows = [np.broadcast_to(value, lead).ravel() for value in given.values()]
    count = int(np.prod(lead))
    return numbers, np.array(rows).T.reshape(count, len(rows)), lead


def number_coordinates(constraints: LoopConstraints, names: Sequence[str]) -> Numbers:
    """The numbers of coordinates by name. Raises UnknownNameError for an unknown one, InputError if one is
    named twice."""
    robot = constraints.robot
    for name in names:
        if name not in robot.joint_names:
            raise suggest("joint", name, robot.joint_names, owner=robot.name)
    if len(set(names)) < len(names):
        raise InputError(f"driven joints {join_words([repr(name) for name in names])} contain one twice")
    return np.array([robot.joint_names.index(name) for name in names], dtype=np.intp)


def draw_starts(
    constraints: LoopConstraints, seed: Array, passive: Numbers, count: int, rng: np.random.Generator
) -> Array:
    """Random configurations (count, n) whose coordinates are those of the seed (n,), except for passive
    ones."""
    robot = constraints.robot
    drawn = random_configurations(
        robot.limits, robot.joint_types, count, rng=rng, reach=2.0 * constraints.length
    )
    q = np.tile(seed, (count, 1))
    q[:, passive] = drawn[:, passive]
    return q


def wrap_revolute(constraints: LoopConstraints, q: Array, seed: Array, passive: Numbers) -> Array:
    """Configurations (m, n) whose passive revolute joints are moved by multiples of 2π towards a seed
    (n,)."""
    types = constraints.robot.joint_types
    turns = np.array([i for i in passive if types[i] == "R"], dtype=np.intp)
    q = q.copy()
    q[:, turns] = wrap_near(q[:, turns], seed[turns])
    return q


def is_stuck(constraints: LoopConstraints, q: Array, numbers: Numbers, passive: Numbers) -> bool:
    """Whether passive coordinates have more freedom at a configuration than beside it."""
    left = count_left(constraints, q, passive)
    if left == 0:
        return False
    probes = np.repeat(q[None], 2 * max(numbers.size, 1), axis=0)
    unit = constraints.unit[constraints.robot.dof - q.size :]
    if numbers.size:
        for i, number in enumerate(numbers):
            probes[2 * i, number] += PROBE * unit[number]
            probes[2 * i + 1, number] -= PROBE * unit[number]
    moved = probes[:, passive]
    moved += PROBE * unit[passive] * np.random.default_rng(0).normal(size=moved.shape)
    probes[:, passive] = moved
    probes, gaps = close_rows(constraints, probes, passive)
    away = np.abs((probes - q) / unit).max(axis=1)  # nowhere: the configuration is an isolated point
    counts = (gaps <= LOOP_CLOSED * constraints.length) & (away > RETURNED * PROBE)
    beside = [count_left(constraints, each, passive) for each in probes[counts]]
    return min(beside, default=0) < left


def count_left(constraints: LoopConstraints, q: Array, passive: Numbers) -> int:
    """How many independent velocities the passive coordinates have while the others stand still."""
    if passive.size == 0:
        return 0
    at = constraints.place(q[None])
    J, _ = select_columns(constraints, at, passive)
    largest = np.linalg.norm(find_scaled_jacobian(constraints, at)[0], 2)
    sigma = np.linalg.svd(J[0], compute_uv=False)
    return int(passive.size - np.sum(sigma > LOOP_SINGULAR * largest))


def pick_modes(constraints: LoopConstraints, q: Array, passive: Numbers) -> Array:
    """Different configurations among those given (m, n), with angles in (−π, π], sorted."""
    q = wrap_revolute(constraints, q, np.zeros(q.shape[1]), passive)
    unit = constraints.unit[constraints.robot.dof - q.shape[1] :]
    turns = np.array([kind == "R" for kind in constraints.robot.joint_types])
    kept: list[Array] = []
    for row in q[np.lexsort(np.round(q / unit, 6).T[::-1])]:
        apart = [np.where(turns, wrap_near(row - each, 0.0), row - each) / unit for each in kept]
        if all(np.abs(each).max() > SAME_MODE for each in apart):
            kept.append(row)
    return np.array(kept)


def name_gap(constraints: LoopConstraints, q: Array, gap: float) -> str:
    """The sentence about loops that cannot be closed."""
    loop = constraints.name_open_loop(q)
    if not np.isfinite(gap):
        return f"impossible: loop {loop!r} closes only upside down"
    return f"impossible: loop {loop!r} stays open, {shown(float(gap))} m are missing"


def name_dead_point(constraints: LoopConstraints, q: Array, numbers: Numbers) -> str:
    """The sentence about a motion that stopped."""
    names = [f"{constraints.robot.joint_names[i]} = {q[i]:.6g}" for i in numbers]
    return f"dead point: the motion cannot go on beyond {join_words(names)}"


def name_reason(
    constraints: LoopConstraints, q: Array, closed: Flags, singular: Flags, gap: Array, lead: tuple[int, ...]
) -> str:
    """Why the first configuration is not closed, or that it is singular."""
    for rows in (np.flatnonzero(~closed), np.flatnonzero(singular)):
        if rows.size:
            row = int(rows[0])
            where = f", in row {row}" if lead else ""
            if not closed[row]:
                return name_gap(constraints, q[row], gap[row]) + where
            return "singular: the driven coordinates do not determine the motion of the others" + where
    return "closed"
