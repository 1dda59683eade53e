"""Planar poses with times: reference trajectories, results, and how they are interpolated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, one_array
from cspace.errors import InputError, shown
from cspace.math.wrapping import wrap_angle
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import MOST_MARKS


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class TimedPoses:
    """Planar poses at times, such as the ground truth of a log.

    times (n,) [s], increasing. poses (n, 3): x, y [m], θ [rad]. covariances (n, 3, 3) of the disturbance ξ
    of T exp ξ in base, or None. Raises InputError for times that run backwards, NaN, or shapes that differ.
    """

    times: Array
    poses: Array
    covariances: Array | None = None

    def __post_init__(self) -> None:
        times = read_times(self.times)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "poses", read_rows(self.poses, "poses", times, (3,)))
        if self.covariances is not None:
            object.__setattr__(self, "covariances", read_rows(self.covariances, "covariances", times, (3, 3)))

    def __len__(self) -> int:
        """How many poses there are."""
        return len(self.times)

    def __repr__(self) -> str:
        span = f" over {np.ptp(self.times):.6g} s" if len(self.times) else ""
        return one_line("TimedPoses", f"{count_things(len(self), 'pose')}{span}")

    def at(self, times: npt.ArrayLike, *, max_gap: float = np.inf) -> Array:
        """The poses at times, linear between neighbours with the short way of θ: (...) [s] → (..., 3).

        NaN outside of the times, and inside of gaps longer than max_gap [s].
        """
        when = as_floats(times, "times")
        longest = read_limit(max_gap, "max_gap")
        if not len(self.times):
            return np.full((*when.shape, 3), np.nan)
        columns = [self.poses[:, 0], self.poses[:, 1], np.unwrap(self.poses[:, 2])]
        found = np.stack([np.interp(when, self.times, column) for column in columns], axis=-1)
        found[..., 2] = wrap_angle(found[..., 2])
        found[self._is_unknown(when, longest)] = np.nan
        return found

    def between(self, first: float, last: float) -> TimedPoses:
        """The poses (n, 3) with times from first to last [s]."""
        keep = find_between(self.times, first, last)
        covariances = None if self.covariances is None else self.covariances[keep]
        return TimedPoses(self.times[keep], self.poses[keep], covariances)

    def _is_unknown(self, when: Array, max_gap: float) -> npt.NDArray[np.bool_]:
        outside = (when < self.times[0]) | (when > self.times[-1])
        after = np.clip(np.searchsorted(self.times, when, side="left"), 0, len(self.times) - 1)
        before = np.clip(np.searchsorted(self.times, when, side="right") - 1, 0, None)
        return np.asarray(outside | (self.times[after] - self.times[before] > max_gap))


NO_REFERENCE: Final = "give TimedPoses, such as log.truth; a log without reference poses has none"
"""What is wrong where reference poses are needed."""


def read_times(times: npt.ArrayLike, subject: str = "times") -> Array:
    """Times (n,) that never run backwards; InputError names the first that does."""
    numbers = one_array(times, subject, (None,), "a number of seconds per row")
    back = np.flatnonzero(np.diff(numbers) < 0)
    if len(back):
        k = int(back[0]) + 1
        raise InputError(
            f"{subject} runs backwards at row {k}, from {numbers[k - 1]:.9g} to {numbers[k]:.9g} s; sort the"
            " rows by time, or mend the clock"
        )
    return numbers


def read_limit(value: Any, subject: str) -> float:
    """One number, infinite ones too; InputError for others, and NaN."""
    number = as_floats(value, subject, finite=False)
    if number.ndim or np.isnan(number):
        raise InputError(f"{subject} is {shown(value)}; it must be one number")
    return float(number)


def find_between(times: Array, first: Any, last: Any) -> npt.NDArray[np.bool_]:
    """Which times (n,) lie from first to last."""
    return (times >= read_limit(first, "first")) & (times <= read_limit(last, "last"))


def mark_times(first: float, end: float, step: float, subject: str) -> Array:
    """Times from first at equal distances [s] up to before end; InputError for too many of them."""
    if not (end - first) / step <= MOST_MARKS:
        raise InputError(
            f"{subject} is {step:g} s, and the log {end - first:g} s long; give at least"
            f" {(end - first) / MOST_MARKS:g} s"
        )
    return np.arange(first, end, step)


def read_rows(values: npt.ArrayLike, subject: str, times: npt.NDArray[Any], last: tuple[int, ...]) -> Array:
    """An array (n, *last) with a row per time; InputError where the numbers of rows differ."""
    rows = one_array(values, subject, (None, *last))
    if len(rows) != len(times):
        raise InputError(
            f"{subject} has {len(rows)} rows and there are {len(times)} times; give one per time"
        )
    return rows
