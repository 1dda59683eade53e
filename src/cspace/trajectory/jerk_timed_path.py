"""JerkTimedPath: a motion along a path whose acceleration is continuous."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace._core import sum_times
from cspace.arrays import Array
from cspace.model.values import freeze_array
from cspace.trajectory.path import Path, _powers_to_bernstein
from cspace.trajectory.square_law import derive_polynomials, move_within
from cspace.trajectory.timed_path import Grid, Places, Ratios, TimedPath, _find_turns
from cspace.trajectory.trajectory import Trajectory

QUADRATIC, LAUNCH, LANDING = 0, 1, 2
"""The laws of an interval: a squared speed quadratic by place, or constant path jerk from or to rest."""


class JerkTimedPath(TimedPath):
    """A motion along a path within limits of velocity, acceleration and jerk.

    The squared speed ṡ² of the parameter is a quadratic spline by place, with Bernstein coefficients squares
    (k, 3) on the intervals. The first and the last interval between two places at which the motion stands
    have a constant path jerk: law (k,) is QUADRATIC, LAUNCH or LANDING, launch_jerk (k,) that of the latter.
    All else as TimedPath.
    """

    def __init__(
        self,
        path: Path,
        intervals: Grid,
        squares: Array,
        law: npt.NDArray[np.int8],
        launch_jerk: Array,
        *,
        ratios: Ratios | None = None,
        joint_names: Sequence[str] | None = None,
        proved: bool = True,
    ) -> None:
        self.path, self.intervals = path, intervals
        self.squares, self.launch_jerk, self.law = freeze_array(squares), freeze_array(launch_jerk), law
        law.setflags(write=False)
        self.squared_speed = freeze_array(np.append(squares[:, 0], squares[-1, 2]))
        self.rises = freeze_array(squares @ [-0.5, 1.0, -0.5])
        self.proved, self.converged = proved, False
        self.place, self.speed_range, self._ratios = np.nan, None, ratios
        self._lengths = intervals.lengths(path)
        seconds = np.diff(sum_times(self._lengths, self.squared_speed, self.rises))
        launched = law != QUADRATIC
        seconds[launched] = np.cbrt(6.0 * self._lengths[launched] / launch_jerk[launched])
        self._times = np.append(0.0, np.cumsum(seconds))
        Trajectory.__init__(self, path.dof, float(self._times[-1]), joint_names)

    def _squares(self, i: Any) -> Array:
        return np.asarray(self.squares[i])

    def _is_early(self, i: Any, since: Array, until: Array) -> Any:
        return (since <= until) & (self.law[i] != LANDING) | (self.law[i] == LAUNCH)

    def _move(self, i: Any, squares: Array, t: Array) -> tuple[Array, Array, Array, Array]:
        length = self._lengths[i]
        share, speed, u, w = move_within(squares, length, t)
        launched = self.law[i] != QUADRATIC
        if launched.any():
            c, own = self.launch_jerk[i[launched]], t[launched]
            share[launched] = c * own**3 / (6.0 * length[launched])
            speed[launched], u[launched], w[launched] = 0.5 * c * own**2, c * own, c
        return share, speed, u, w

    def _look_at(self, shares: Sequence[float]) -> Places:
        times = self._times[:-1] + np.array(shares)[:, None] * np.diff(self._times)
        rows = [self._place_times(row, before) for row, before in zip(times, _sides(shares), strict=True)]
        return Places(*(np.concatenate(each) for each in zip(*rows, strict=True)))

    def _turns_within(self, rows: Any, order: int) -> list[Array]:
        quadratic = self.law[rows] == QUADRATIC
        found = super()._turns_within(rows[quadratic], order)
        rows = rows[~quadratic]
        at, joint, roots = _find_turns(self._time_polynomials(rows, order))
        i = rows[at]
        seconds = self._times[i + 1] - self._times[i]
        times = self._times[i] + seconds * np.where(self.law[i] == LAUNCH, roots, 1.0 - roots)
        return [np.append(each, times[joint == k]) for k, each in enumerate(found)]

    def _time_polynomials(self, rows: Any, order: int) -> Array:
        """The next derivative of q by the share of time of a launch, whose place is its cube."""
        q = self._powers(rows)
        landing = (self.law[rows] == LANDING)[:, None, None]
        # A landing is a launch of the reversed interval.
        shifted = np.einsum("ij,knj->kni", _reversal(self.path.degree), q)
        q = np.where(landing, shifted, q)
        made = np.zeros((*q.shape[:2], 3 * self.path.degree + 1))
        made[..., ::3] = q
        for _ in range(order + 1):
            made = derive_polynomials(made)
        return made

    def _remade(self, path: Path, grid: Grid, factor: float, proved: bool) -> JerkTimedPath:
        turned = path is not self.path
        turn = slice(None, None, -1) if turned else slice(None)
        law = np.array(self.law[turn])
        if turned:
            law[law != QUADRATIC] = LAUNCH + LANDING - law[law != QUADRATIC]
        return JerkTimedPath(
            path,
            grid,
            factor * self.squares[turn, turn],
            law,
            factor**1.5 * self.launch_jerk[turn],
            ratios=self._ratios,
            joint_names=self.joint_names,
            proved=proved,
        )


def _sides(shares: Sequence[float]) -> list[bool]:
    """Whether a share of an interval is its end, which the next one must not answer."""
    return [share == 1.0 for share in shares]


def _reversal(degree: int) -> Array:
    """The matrix from coefficients of powers of t to those of powers of 1 − t."""
    flip = np.eye(degree + 1)[::-1]
    basis = _powers_to_bernstein(degree)
    return np.asarray(np.linalg.inv(basis) @ flip @ basis)
