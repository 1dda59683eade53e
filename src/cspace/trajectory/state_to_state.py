"""Motions from state to state in the shortest time, or in any time that is possible."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, guard_memory, leading_axes, whole_number
from cspace.errors import InputError, InputTypeError, check_known
from cspace.model.values import read_joint_names
from cspace.tables import one_line, tabulate
from cspace.tolerances import FARTHEST, LEAST_FACTOR
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.states import (
    AxisLimits,
    check_accelerations,
    check_goal,
    check_length,
    read_duration,
    read_states,
)

SYNCHRONIZE: Final = ("time", "phase", "none")
"""How joints move together: all in the same time, along a straight line, or each alone."""

FOUND, REFUSED_DURATION, NOT_PARALLEL = range(3)
"""What becomes of a problem."""

MOST_THREADS: Final = 1024
"""Of one call."""


@tabulate("shortest", "possible", "reason")
class TrajectoryBatch:
    """Motions of the same joints, one per problem; falsy unless each is what was asked for.

    durations (n,) [s]. shortest (n, dof) [s]: the shortest time of each joint alone. possible (n,): whether
    the duration is one that was asked for, or free. An index gives a PolynomialTrajectory.
    """

    def __init__(
        self,
        states: Array,
        limits: AxisLimits,
        asked: Array,
        synchronize: str,
        joint_names: Sequence[str] | None = None,
    ) -> None:
        rows, dof = states.shape[0], states.shape[-1]
        self._states, self._limits, self._asked = states, limits.rows, asked
        self._mode = SYNCHRONIZE.index(synchronize)
        self.joint_names = None if joint_names is None else tuple(joint_names)
        self.durations, self.shortest = np.empty(rows), np.empty((rows, dof))
        self._verdict = np.empty(rows, np.int32)
        self._motions = np.empty((_core.NUMBERS_OF_MOTION, rows, dof))

    @property
    def possible(self) -> Any:
        """Whether each duration (n,) is one that was asked for, or free."""
        return self._verdict == FOUND

    @property
    def reason(self) -> str:
        """Why the first motion that is not possible is not; empty if all are."""
        bad = np.flatnonzero(self._verdict != FOUND)
        return self._reason_of(int(bad[0])) if bad.size else ""

    def _reason_of(self, i: int) -> str:
        if self._verdict[i] == FOUND:
            return ""
        return (
            f"a duration of {self._asked[i]:.6g} s is not possible within the limits;"
            f" the next one is {self.durations[i]:.6g} s"
        )

    def _solve(self, cycle: float, threads: int) -> None:
        _core.solve_states(
            self._states,
            self._limits,
            self._asked,
            cycle,
            self._mode,
            threads,
            self._verdict,
            self.durations,
            self.shortest,
            self._motions,
        )

    def __bool__(self) -> bool:
        return bool((self._verdict == FOUND).all())

    def __len__(self) -> int:
        return len(self.durations)

    def __getitem__(self, index: int) -> PolynomialTrajectory:
        """The motion of one problem."""
        i = range(len(self))[index]
        duration = float(self.durations[i])
        motions = np.ascontiguousarray(self._motions[:, i])
        pieces = _core.make_pieces(
            self._states[i], self._limits, self.shortest[i], motions, duration, self._mode
        )
        return PolynomialTrajectory._trusted(*pieces, duration, self.joint_names, self._reason_of(i))

    def __iter__(self) -> Iterator[PolynomialTrajectory]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        text = f"of {len(self)} motions of {self.shortest.shape[1]} joints"
        return one_line("TrajectoryBatch", text + (f": {self.reason}" if self.reason else ""))


def state_to_state(
    start: ArrayLike,
    goal: ArrayLike,
    *,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    jerk: ArrayLike | None = None,
    lowest_velocity: ArrayLike | None = None,
    lowest_acceleration: ArrayLike | None = None,
    start_velocity: ArrayLike | None = None,
    start_acceleration: ArrayLike | None = None,
    goal_velocity: ArrayLike | None = None,
    goal_acceleration: ArrayLike | None = None,
    duration: ArrayLike | None = None,
    cycle: float | None = None,
    synchronize: str = "time",
    joint_names: Sequence[str] | None = None,
    threads: int = 0,
) -> PolynomialTrajectory | TrajectoryBatch:
    """The fastest motion of joints between two states under limits of velocity, acceleration and jerk.

    In a given time T the displacements that a joint can attain are an interval whose ends have closed forms.
    The shortest time is where an end passes the goal, and for any other time the jerk is a combination of
    those of both ends, which keeps every limit. A start beyond the limits is brought within them first.

    start, goal (..., dof): positions [rad or m]; with leading axes one motion for each. start_velocity,
    start_acceleration, goal_velocity, goal_acceleration (..., dof): zero unless given. velocity,
    acceleration, jerk () or (dof,): the highest magnitudes; inf or None is no limit. Without a limit of jerk
    of any joint motions have trapezoidal velocities, and the accelerations at both ends are free.
    lowest_velocity, lowest_acceleration () or (dof,): below zero, where they differ. duration () or (...)
    [s]: in place of the shortest. cycle [s]: of which the duration is to be a multiple. synchronize: "time"
    (all joints end together), "phase" (along a straight line, in the shortest time) or "none". joint_names:
    of the joints. threads: of a batch; 0 is one per processor.

    Returns a PolynomialTrajectory, or a TrajectoryBatch. They are falsy where the duration that was asked for
    is not possible; the motion then has the next possible one.
    Raises InputError for wrong shapes, limits that are not above zero, a goal beyond the limits, and with
    "phase" for states that lie on no common line.

    Kröger 2010 states the problem; Berscheid and Kröger 2021 solve it by polynomials of degree six.
    """
    check_known("synchronize", synchronize, SYNCHRONIZE)
    names = read_joint_names(joint_names)
    if synchronize == "time" and duration is cycle is lowest_velocity is lowest_acceleration is None:
        ends = start, start_velocity, start_acceleration, goal, goal_velocity, goal_acceleration
        motion = move_plain_states(ends, (velocity, acceleration, jerk), names)
        if motion is not None:
            return motion[0]
    first = read_states(start, start_velocity, start_acceleration, "start")
    dof = first.shape[-1]
    last = read_states(goal, goal_velocity, goal_acceleration, "goal", dof)
    limits = AxisLimits(velocity, acceleration, jerk, lowest_velocity, lowest_acceleration, dof)
    labels = read_joint_names(names, dof) or tuple(f"joint {j}" for j in range(dof))
    check_accelerations(limits, labels)
    check_goal(last, limits, labels)
    asked = read_durations(duration, cycle, synchronize)
    check_alone(last, synchronize)
    threads = whole_number(threads, "threads", 0, MOST_THREADS)
    shape: tuple[int, ...] = ()
    if first.ndim > 2 or last.ndim > 2 or asked.ndim:
        shape = leading_axes(start=first.shape[:-2], goal=last.shape[:-2], duration=asked.shape)
    batch = solve_batch(
        first, last, limits, asked, shape, read_duration(cycle, "cycle"), synchronize, threads
    )
    batch.joint_names = names
    check_length(float(batch.durations.max(initial=0.0)))
    return batch if shape else batch[0]


def move_plain_states(
    states: tuple[Any, ...],
    limits: tuple[Any, ...],
    joint_names: tuple[str, ...] | None,
    bounds: tuple[Any, ...] = (None, None),
) -> tuple[PolynomialTrajectory, bool] | None:
    """The fastest motion of plain arrays (n,), in one compiled call; None for all that is to be looked at.

    states: start and goal, each with its velocity and acceleration. limits: velocity, acceleration, jerk.
    bounds: lower and upper positions. Returns the motion and whether it keeps within bounds.
    """
    made = _core.move_plain(states, limits, bounds, FARTHEST)
    if made is None or (joint_names is not None and len(joint_names) != len(made[0][0])):
        return None
    pieces, duration, keeps_within = made
    if not duration <= 1.0 / LEAST_FACTOR:
        return None
    return PolynomialTrajectory._trusted(*pieces, duration, joint_names, ""), keeps_within


def read_durations(duration: ArrayLike | None, cycle: float | None, synchronize: str) -> Array:
    """The durations asked for (...), NaN for the shortest."""
    if duration is None:
        if synchronize == "none" and cycle is not None:
            raise InputTypeError("cycle= does not go with synchronize='none'; use 'time'")
        return np.array(np.nan)
    if cycle is not None:
        raise InputTypeError("duration= and cycle= do not go together; give one of them")
    if synchronize == "none":
        raise InputTypeError("duration= does not go with synchronize='none'; use 'time'")
    asked = as_floats(duration, "duration", largest=1.0 / LEAST_FACTOR)
    if (asked < 0.0).any():
        raise InputError(f"duration is {float(asked.min()):g} s; it must not be negative")
    return asked


def check_alone(goal: Array, synchronize: str) -> None:
    """InputError for joints that are to end each alone while moving."""
    if synchronize == "none" and (goal[..., 1:, :] != 0.0).any():
        raise InputError("with synchronize='none' every joint must rest at its goal; use 'time'")


def solve_batch(
    first: Array,
    last: Array,
    limits: AxisLimits,
    asked: Array,
    shape: tuple[int, ...],
    cycle: float | None,
    synchronize: str,
    threads: int,
) -> TrajectoryBatch:
    """The motions between checked states (..., 3, dof), as rows."""
    dof, rows = first.shape[-1], math.prod(shape)
    with guard_memory("start", f"{rows} rows", 200.0 * rows * dof, "solve fewer at once"):
        states = np.empty((*shape, 2, 3, dof))
        states[..., 0, :, :], states[..., 1, :, :] = first, last
        durations = np.empty(shape)
        durations[...] = asked
        batch = TrajectoryBatch(states.reshape(rows, 2, 3, dof), limits, durations.reshape(rows), synchronize)
    batch._solve(cycle or 0.0, threads if rows > 1 else 1)
    check_parallel(batch, bool(shape))
    return batch


def check_parallel(batch: TrajectoryBatch, has_rows: bool) -> None:
    """InputError for boundary states that no straight line connects."""
    bad = np.flatnonzero(batch._verdict == NOT_PARALLEL)
    if bad.size:
        where = f" of row {bad[0]}" if has_rows else ""
        raise InputError(
            f"displacement, velocities and accelerations{where} are not parallel, so no straight line"
            " connects the states; use synchronize='time'"
        )
