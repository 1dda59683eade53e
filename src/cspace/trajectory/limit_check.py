"""Checks of a motion against limits, between monotone stretches: no sample can miss a peak."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final, NamedTuple, Protocol

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.model import Limits
from cspace.tables import count_things, html_table, one_line, shown, tabulate
from cspace.tolerances import LIMIT_BINDS, LIMIT_ROUNDING

ORDERS: Final = {"position": 0, "velocity": 1, "acceleration": 2, "jerk": 3}
"""The limits of a motion and the derivatives that they bound."""

HALVINGS: Final = 64
"""Of an interval of time: more than the digits of a double."""


class Motion(Protocol):
    """What a check needs to know of a motion."""

    @property
    def dof(self) -> int: ...
    @property
    def labels(self) -> tuple[str, ...]: ...
    def _evaluate_joint(self, joint: int, times: Array, order: int, before: bool) -> Array: ...
    def _turning_times(self, order: int) -> list[Array]: ...


@tabulate()
@dataclass(frozen=True)
class Violation:
    """A limit of a joint that a motion exceeds.

    joint: its name. limit: "lower", "upper", "velocity", "acceleration" or "jerk". time [s]: when it is
    first exceeded. excess: the most by which it is, in the unit of the limit, at worst_time [s].
    """

    joint: str
    limit: str
    time: float
    excess: float
    worst_time: float

    def __str__(self) -> str:
        return (
            f"{self.joint} exceeds its {self.limit} limit from {shown(self.time)} s on,"
            f" by up to {self.excess:.3g} at {shown(self.worst_time)} s"
        )


@dataclass(frozen=True)
class TrajectoryCheck:
    """The answer of a check: truthy if no limit is exceeded, else with the violations, earliest first.

    no_motion: why there is no motion to check, which is falsy too; empty if there is one.
    """

    violations: tuple[Violation, ...]
    no_motion: str = ""

    def __bool__(self) -> bool:
        return not self.reason

    @property
    def reason(self) -> str:
        """The earliest violation in words, or why there is no motion; empty within all limits."""
        return str(self.violations[0]) if self.violations else self.no_motion

    def __repr__(self) -> str:
        more = len(self.violations) - 1
        also = f", and {count_things(more, 'more violation')}" if more > 0 else ""
        return one_line("TrajectoryCheck", (self.reason or "within all limits") + also)

    def _repr_html_(self) -> str:
        titles = ["joint", "limit", "from [s]", "excess", "worst at [s]"]
        rows = [
            [v.joint, v.limit, shown(v.time), f"{v.excess:.3g}", shown(v.worst_time)] for v in self.violations
        ]
        return html_table("Limits exceeded" if rows else self.reason or "Within all limits", titles, rows)


@tabulate()
@dataclass(frozen=True)
class BindingLimit:
    """A stretch of time on which a joint is at one of its limits.

    joint: its name. limit: as in Violation. begin, end [s].
    """

    joint: str
    limit: str
    begin: float
    end: float


class Bound(NamedTuple):
    """A limit of one joint: sign · (derivative of that order) ≤ level. size: what rounding is relative to."""

    joint: int
    limit: str
    order: int
    sign: float
    level: float
    size: float


def read_limits(limits: Any, dof: int) -> Limits:
    """The limits given, or those of a robot; InputError if they are of another number of joints."""
    own = getattr(limits, "limits", limits)
    if not isinstance(own, Limits):
        raise InputTypeError(f"limits is {name_type(limits)}; give Limits or a robot")
    if len(own) != dof:
        raise InputError(f"limits is of {len(own)} joints, the trajectory of {dof}; give limits for each")
    return own


def list_bounds(limits: Limits) -> Iterator[Bound]:
    """Every limit that is finite, derivative by derivative."""
    for name, order in ORDERS.items():
        for j in range(len(limits)):
            high = limits.upper[j] if order == 0 else getattr(limits, name)[j]
            low = limits.lower[j] if order == 0 else -high
            for sign, level, side in ((1.0, high, "upper"), (-1.0, -low, "lower")):
                if np.isfinite(level):
                    size = max(1.0, abs(level)) if order == 0 else abs(level)
                    yield Bound(j, side if order == 0 else name, order, sign, float(level), float(size))


class Stretches(NamedTuple):
    """The monotone stretches of one derivative of one joint: their ends (k,) [s] and the values there."""

    begin: Array
    end: Array
    first: Array
    last: Array


def monotone_stretches(motion: Motion, joint: int, order: int, times: Array) -> Stretches:
    """The stretches of a motion on which a derivative of a joint rises or falls throughout.

    times (k,) [s]: where it turns, of motion._turning_times.
    """
    begin, end = (times[:-1], times[1:]) if len(times) > 1 else (times, times)
    first = motion._evaluate_joint(joint, begin, order, False)
    last = motion._evaluate_joint(joint, end, order, True)
    return Stretches(begin, end, first, last)


def find_crossings(
    motion: Motion, bound: Bound, level: float, begin: Array, end: Array, rising: Array
) -> Array:
    """When the derivative of a bound crosses a level, once within each stretch (k,) given."""
    low, high = begin.copy(), end.copy()
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        value = bound.sign * motion._evaluate_joint(bound.joint, middle, bound.order, False)
        later = (value < level) == rising
        low, high = np.where(later, middle, low), np.where(later, high, middle)
    return np.where(rising, low, high)


def stretches_above(motion: Motion, bound: Bound, level: float, parts: Stretches) -> tuple[Array, Array]:
    """The ends (k,) [s] of the stretches on which sign · derivative is at least a level."""
    first, last = bound.sign * parts.first, bound.sign * parts.last
    above = (first >= level) | (last >= level)
    begin, end = parts.begin[above].copy(), parts.end[above].copy()
    first, last = first[above], last[above]
    crosses = (first < level) != (last < level)
    rising = last > first
    at = find_crossings(motion, bound, level, begin[crosses], end[crosses], rising[crosses])
    begin[crosses] = np.where(rising[crosses], at, begin[crosses])
    end[crosses] = np.where(rising[crosses], end[crosses], at)
    return begin, end


def find_violation(motion: Motion, bound: Bound, parts: Stretches) -> Violation | None:
    """How a motion exceeds a limit beyond rounding, if it does."""
    first, last = bound.sign * parts.first, bound.sign * parts.last
    highest = np.maximum(first, last)
    allowed = bound.level + LIMIT_ROUNDING * bound.size
    exceeded = np.flatnonzero(highest > allowed)
    if not exceeded.size:
        return None
    one = Stretches(*(row[exceeded[:1]] for row in parts))
    begin, _ = stretches_above(motion, bound, allowed, one)
    worst = int(np.argmax(highest))
    when = parts.begin[worst] if first[worst] >= last[worst] else parts.end[worst]
    excess = float(highest[worst] - bound.level)
    return Violation(motion.labels[bound.joint], bound.limit, float(begin[0]), excess, float(when))


def check_limits(motion: Motion, limits: Limits) -> TrajectoryCheck:
    """Every limit that a motion exceeds, once for each joint and limit."""
    found: dict[tuple[int, str], Violation] = {}
    for bound, parts in bounds_with_stretches(motion, limits):
        violation = find_violation(motion, bound, parts)
        if violation is None:
            continue
        key, other = (bound.joint, bound.limit), found.get((bound.joint, bound.limit))
        found[key] = violation if other is None else merge_violations(violation, other)
    return TrajectoryCheck(tuple(sorted(found.values(), key=lambda violation: violation.time)))


def merge_violations(a: Violation, b: Violation) -> Violation:
    """Those of the two signs of a limit as one."""
    worse = a if a.excess > b.excess else b
    return Violation(a.joint, a.limit, min(a.time, b.time), worse.excess, worse.worst_time)


def bounds_with_stretches(motion: Motion, limits: Limits) -> Iterator[tuple[Bound, Stretches]]:
    """Every finite limit with the monotone stretches of what it bounds."""
    times: dict[int, list[Array]] = {}
    known: dict[tuple[int, int], Stretches] = {}
    for bound in list_bounds(limits):
        key = bound.joint, bound.order
        if bound.order not in times:
            times = {bound.order: motion._turning_times(bound.order)}
        if key not in known:
            known = {key: monotone_stretches(motion, *key, times[bound.order][bound.joint])}
        yield bound, known[key]


def find_binding(motion: Motion, limits: Limits) -> tuple[BindingLimit, ...]:
    """The stretches of time on which a joint is at a limit, earliest first."""
    found = []
    for bound, parts in bounds_with_stretches(motion, limits):
        level = bound.level - LIMIT_BINDS * bound.size
        begins, ends = stretches_above(motion, bound, level, parts)
        for begin, end in merge_intervals(begins, ends):
            found.append(BindingLimit(motion.labels[bound.joint], bound.limit, begin, end))
    return tuple(sorted(found, key=lambda binding: (binding.begin, binding.end)))


def merge_intervals(begins: Array, ends: Array) -> list[tuple[float, float]]:
    """Intervals in order, those that touch as one."""
    merged: list[tuple[float, float]] = []
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        if merged and begin <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((begin, end))
    return merged
