"""The trajectory: the configuration of joints over time, with its derivatives."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, one_number, positive_number, whole_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.model.values import read_joint_names
from cspace.tables import count_things, one_line, show_fields, shown, tabulate
from cspace.tolerances import CONTINUITY_ROUNDING, LEAST_FACTOR, TIME_ROUNDING
from cspace.trajectory.limit_check import (
    BindingLimit,
    TrajectoryCheck,
    check_limits,
    find_binding,
    monotone_stretches,
    read_limits,
)

HIGHEST_ORDER: Final = 3
"""Of the derivatives of a trajectory: its jerk."""

QUANTITIES: Final = ("position", "velocity", "acceleration", "jerk")
"""The names of the derivatives, by order."""

MOST_SAMPLES: Final = 100_000_000
"""Of one call of sample."""


def read_factor(value: float) -> float:
    """A factor of a duration; InputError for one that is not above zero, too large or too small."""
    factor = positive_number(value, "factor", largest=1.0 / LEAST_FACTOR)
    if factor < LEAST_FACTOR:
        raise InputError(f"factor is {factor:g}; it must be {LEAST_FACTOR:g} or more")
    return factor


@show_fields
class Samples(NamedTuple):
    """A trajectory at times that strictly increase, the last of them its end.

    times (k,) [s]. q [rad or m], qd, qdd (k, dof).
    """

    times: Array
    q: Array
    qd: Array
    qdd: Array


@show_fields
class Extremes(NamedTuple):
    """The lowest and highest value of each joint (dof,), and when it is attained first [s]."""

    lowest: Array
    t_lowest: Array
    highest: Array
    t_highest: Array


def check_trajectory(trajectory: object) -> None:
    """Raise InputTypeError unless it is a Trajectory."""
    if not isinstance(trajectory, Trajectory):
        raise InputTypeError(
            f"trajectory is {name_type(trajectory)}; cspace.time_parametrize or a move returns one"
        )


def check_order(names: Sequence[str] | None, others: Sequence[str] | None, whose: str) -> None:
    """Raise InputError where two lists have the same names of joints in another order."""
    if names is None or others is None or tuple(names) == tuple(others) or set(names) != set(others):
        return
    k = next(k for k, (one, other) in enumerate(zip(names, others, strict=False)) if one != other)
    raise InputError(
        f"joint {k} is {names[k]!r} in the trajectory and {others[k]!r} in {whose};"
        " bring the joints into one order"
    )


@tabulate("dof", "duration", "labels", "reason")
class Trajectory(ABC):
    """A motion of joints in time: positions and derivatives up to the jerk; falsy where reason is not empty.

    dof: number of joints. joint_names: of the joints, or None. duration [s]. reason: why the motion is not
    what was asked for; empty otherwise.
    """

    reason: str = ""

    def __init__(
        self, dof: int, duration: float, joint_names: Sequence[str] | None = None, reason: str = ""
    ) -> None:
        self.dof = dof
        self.duration = duration
        self.joint_names = read_joint_names(joint_names, dof)
        self.reason = reason

    @property
    @abstractmethod
    def knots(self) -> Array:
        """The times (k,) [s] at which pieces of the motion begin and end, 0 and duration among them."""

    @abstractmethod
    def _evaluate_joint(self, joint: int, times: Array, order: int, before: bool) -> Array:
        """A derivative of one joint at times (k,) within the motion; before: at a knot that of the piece
        before it."""

    @abstractmethod
    def _turning_times(self, order: int) -> list[Array]:
        """For each joint times (k,) in order, from 0 to duration, between any two of which the derivative of
        that order is monotone and continuous."""

    def _evaluate(self, times: Array, order: int) -> Array:
        """A derivative of all joints (k, dof) at times (k,)."""
        rows = [self._evaluate_joint(j, times, order, False) for j in range(self.dof)]
        return np.stack(rows, axis=-1) if rows else np.zeros((len(times), 0))

    @property
    def _no_motion(self) -> str:
        """Why there is no motion at all; empty where there is one, even if it is not what was asked for."""
        return ""

    @property
    def labels(self) -> tuple[str, ...]:
        """The names of the joints, or "joint 0", "joint 1", …"""
        return self.joint_names or tuple(f"joint {j}" for j in range(self.dof))

    def __bool__(self) -> bool:
        return not self.reason

    def __call__(self, t: ArrayLike, order: int = 0) -> Array:
        """The positions or a derivative (..., dof) at times t (...) [s].

        order: 0 for q [rad or m], 1 for velocities, 2 for accelerations, 3 for jerks. Where a derivative
        jumps, it is that of the later piece.
        Raises InputError for a time outside of 0 … duration, and for another order.
        """
        order = whole_number(order, "order", 0, HIGHEST_ORDER)
        times = self._check_times(as_floats(t, "t"))
        return self._evaluate(times.ravel(), order).reshape((*times.shape, self.dof))

    def state(self, t: float) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations (dof,) at any time [s], at rest before 0 and after the
        end."""
        time = min(max(one_number(t, "t"), 0.0), self.duration)
        q = self(time)
        if time != t:
            return q, np.zeros_like(q), np.zeros_like(q)
        return q, self(time, 1), self(time, 2)

    def _check_times(self, times: Array) -> Array:
        slack = TIME_ROUNDING * self.duration
        outside = (times < -slack) | (times > self.duration + slack)
        if outside.any():
            bad = float(times[outside].flat[0])
            raise InputError(f"t is {bad:.9g} s; the trajectory is from 0 to {self.duration:.9g} s")
        return np.clip(times, 0.0, self.duration)

    def extremes(self, order: int = 0) -> Extremes:
        """The lowest and highest value of a derivative of each joint, found by the roots of its derivative.

        order: as in a call. Returns Extremes, with arrays (dof,).
        """
        order = whole_number(order, "order", 0, HIGHEST_ORDER)
        rows = np.empty((4, self.dof))
        for j, turns in enumerate(self._turning_times(order) if self.dof else ()):
            parts = monotone_stretches(self, j, order, turns)
            times = np.stack([parts.begin, parts.end], axis=-1).ravel()
            values = np.stack([parts.first, parts.last], axis=-1).ravel()
            low, high = int(np.argmin(values)), int(np.argmax(values))
            rows[:, j] = values[low], times[low], values[high], times[high]
        return Extremes(*rows)

    def sample(self, rate: float) -> Samples:
        """The motion at 0, 1/rate, 2/rate, … and at its end.

        rate [Hz]. Returns Samples, with arrays (k, dof).
        """
        rate = positive_number(rate, "rate")
        count = whole_number(
            int(min(self.duration * rate, 2.0 * MOST_SAMPLES)), "duration · rate", 0, MOST_SAMPLES
        )
        times = np.arange(count + 1) / rate
        times = np.append(times[times < self.duration * (1.0 - TIME_ROUNDING)], self.duration)
        return Samples(times, *(self._evaluate(times, order) for order in range(3)))

    def samples_to_write(self, rate: float) -> Samples:
        """The samples of a motion that is what was asked for.

        rate: as in sample. Raises InputError with the reason for another motion.
        """
        if self.reason:
            raise InputError(f"the motion is not what was asked for, and is not written: {self.reason}")
        return self.sample(rate)

    def check(self, limits: Any) -> TrajectoryCheck:
        """Whether there is a motion that stays within limits, by the roots of its derivatives and not by
        samples.

        limits: Limits or a robot; limits of effort are not looked at. A limit counts as exceeded from one
        part in 10⁹ on. Returns a TrajectoryCheck, falsy with the violations.
        Raises InputError for limits of another number of joints, and for a robot with the same joints in
        another order.
        """
        check_order(self.joint_names, getattr(limits, "joint_names", None), "the robot")
        own = read_limits(limits, self.dof)
        return TrajectoryCheck((), self._no_motion) if self._no_motion else check_limits(self, own)

    def binding(self, limits: Any) -> tuple[BindingLimit, ...]:
        """When which joint is at which limit, within one part in 10⁶; earliest first.

        limits: as in check. Returns BindingLimits.
        """
        return find_binding(self, read_limits(limits, self.dof))

    @property
    def continuity(self) -> int:
        """The highest order up to which no derivative jumps: 0 if velocities do, −1 if positions do."""
        for order in range(HIGHEST_ORDER + 1):
            if self._find_jump(order) is not None:
                return order - 1
        return HIGHEST_ORDER

    def _find_jump(self, order: int) -> tuple[int, float] | None:
        """The joint and time of the first jump of a derivative beyond rounding."""
        inner, most = self.knots[1:-1], self.extremes(order)
        size = max(np.abs(most.lowest).max(initial=0.0), np.abs(most.highest).max(initial=0.0))
        for j in range(self.dof):
            before, after = (self._evaluate_joint(j, inner, order, side) for side in (True, False))
            jumps = np.flatnonzero(np.abs(after - before) > CONTINUITY_ROUNDING * size)
            if jumps.size:
                return j, float(inner[jumps[0]])
        return None

    def then(self, other: Trajectory, order: int = 1) -> Trajectory:
        """This motion and after it another one that begins where this one ends.

        order: up to which derivative the two must agree; `continuity` of the result says up to which they do.
        Raises InputError where they do not, with the joint and the jump, and for the same joints in another
        order.
        """
        order = whole_number(order, "order", 0, HIGHEST_ORDER)
        if not isinstance(other, Trajectory):
            raise InputTypeError(f"other is {name_type(other)}; then joins trajectories")
        if other.dof != self.dof:
            raise InputError(
                f"the other trajectory is of {count_things(other.dof, 'joint')}, this of {self.dof}"
            )
        check_order(self.joint_names, other.joint_names, "the other trajectory")
        for k in range(order + 1):
            self._check_joint_to(other, k)
        return self._join(other)

    def _check_joint_to(self, other: Trajectory, order: int) -> None:
        last, first = self(self.duration, order), other(0.0, order)
        ends = [each.extremes(order) for each in (self, other)]
        size = max(np.abs([each.lowest, each.highest]).max(initial=0.0) for each in ends)
        gap = np.abs(first - last)
        bad = np.flatnonzero(gap > CONTINUITY_ROUNDING * size)
        if bad.size:
            j = int(bad[0])
            raise InputError(
                f"the {QUANTITIES[order]} of {self.labels[j]} jumps from {last[j]:.6g} to {first[j]:.6g};"
                " the second motion must begin as the first one ends"
                + (f", or pass order={order - 1}" if order > 0 else "")
            )

    def _join(self, other: Trajectory) -> Trajectory:
        return JoinedTrajectory([self, other])

    @abstractmethod
    def scaled(self, factor: float) -> Trajectory:
        """The same path, slower by a factor: its duration is multiplied by it."""

    @abstractmethod
    def reversed(self) -> Trajectory:
        """The same motion backwards in time."""

    def __repr__(self) -> str:
        text = f"of {count_things(self.dof, 'joint')}, {shown(self.duration)} s"
        return one_line(type(self).__name__, text + (f": {self.reason}" if self.reason else ""))


class JoinedTrajectory(Trajectory):
    """Motions one after the other.

    parts: the trajectories, of the same joints.
    """

    def __init__(self, parts: Sequence[Trajectory]) -> None:
        self.parts: tuple[Trajectory, ...] = ()
        for part in parts:
            self.parts += part.parts if isinstance(part, JoinedTrajectory) else (part,)
        self.starts = np.cumsum([0.0, *(part.duration for part in self.parts)])
        names = next((part.joint_names for part in self.parts if part.joint_names), None)
        reason = next((part.reason for part in self.parts if part.reason), "")
        super().__init__(self.parts[0].dof, float(self.starts[-1]), names, reason)

    @property
    def knots(self) -> Array:
        return np.unique(np.concatenate([start + part.knots for start, part in self._placed()]))

    @property
    def _no_motion(self) -> str:
        return next((part._no_motion for part in self.parts if part._no_motion), "")

    def _placed(self) -> list[tuple[float, Trajectory]]:
        return list(zip(self.starts[:-1].tolist(), self.parts, strict=True))

    def _evaluate_joint(self, joint: int, times: Array, order: int, before: bool) -> Array:
        which = np.searchsorted(self.starts[1:-1], times, side="left" if before else "right")
        values = np.empty(len(times))
        for k, (start, part) in enumerate(self._placed()):
            here = which == k
            local = np.clip(times[here] - start, 0.0, part.duration)
            values[here] = part._evaluate_joint(joint, local, order, before)
        return values

    def _turning_times(self, order: int) -> list[Array]:
        each = [[start + times for times in part._turning_times(order)] for start, part in self._placed()]
        return [np.unique(np.concatenate(times)) for times in zip(*each, strict=True)]

    def scaled(self, factor: float) -> JoinedTrajectory:
        """The same path, slower by a factor: its duration is multiplied by it."""
        return JoinedTrajectory([part.scaled(factor) for part in self.parts])

    def reversed(self) -> JoinedTrajectory:
        """The same motion backwards in time."""
        return JoinedTrajectory([part.reversed() for part in self.parts[::-1]])
