"""JerkTimedPath: a motion along a path whose acceleration is continuous."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.model.values import freeze_array
from cspace.trajectory.path import Path, _powers_to_bernstein, restrict_pieces
from cspace.trajectory.piece_roots import find_piece_roots
from cspace.trajectory.timed_path import Grid, Places, Ratios, TimedPath
from cspace.trajectory.trajectory import Trajectory

QUADRATIC, LAUNCH, LANDING = 0, 1, 2
"""The laws of an interval: a squared speed quadratic by place, or constant path jerk from or to rest."""

SERIES: Final = 0.01
"""Argument below which a series of six terms stands for a quotient: its error is a rounding."""


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
        self.proved, self.converged = proved, False
        self.place, self.speed_range, self._ratios = np.nan, None, ratios
        self._lengths = intervals.lengths(path)
        seconds = _seconds_between(squares, self._lengths, np.zeros(len(squares)), np.ones(len(squares)))
        launched = law != QUADRATIC
        seconds[launched] = np.cbrt(6.0 * self._lengths[launched] / launch_jerk[launched])
        self._times = np.concatenate([[0.0], np.cumsum(seconds)])
        Trajectory.__init__(self, path.dof, float(self._times[-1]), joint_names)

    def _place_times(self, times: Array, before: bool) -> Places:
        side = "left" if before else "right"
        i = np.searchsorted(self._times[1:-1], times, side=side)  # type: ignore[call-overload]
        since, until = times - self._times[i], self._times[i + 1] - times
        early = (since <= until) & (self.law[i] != LANDING) | (self.law[i] == LAUNCH)
        squares = np.where(early[:, None], self.squares[i], self.squares[i, ::-1])
        ahead, speed, u, w = self._move(i, squares, np.where(early, since, until))
        share = np.where(early, ahead, 1.0 - ahead)
        span = self.intervals.end[i] - self.intervals.begin[i]
        begin = self.intervals.begin[i]
        local = np.clip(begin + span * share, begin, self.intervals.end[i])
        return Places(self.intervals.piece[i].astype(np.int64), local, speed, np.where(early, u, -u), w)

    def _move(self, i: Any, squares: Array, t: Array) -> tuple[Array, Array, Array, Array]:
        """Share of an interval, speed, acceleration and jerk, a time t (m,) after its begin."""
        length = self._lengths[i]
        first, second = 2.0 * (squares[:, 1] - squares[:, 0]), squares @ [1.0, -2.0, 1.0]
        begin = np.sqrt(squares[:, 0])
        # With t in units of the length, σ'' = second σ + first / 2.
        tau = t / length
        sine, versed = _sine_and_versed(second, tau)
        share = begin * sine + 0.5 * first * versed
        speed = np.maximum(0.0, begin * (1.0 + second * versed) + 0.5 * first * sine)
        u, w = (0.5 * first + second * share) / length, second * speed / length**2
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

    def _turning_times(self, order: int) -> list[Array]:
        """The knots, and where the next derivative is zero: the root of a polynomial of the place."""
        quadratic = self.law == QUADRATIC
        found = [[self._times] for _ in range(self.dof)]
        for rows, of_place in ((np.flatnonzero(quadratic), True), (np.flatnonzero(~quadratic), False)):
            if not rows.size:
                continue
            c = self._place_polynomials(rows, order) if of_place else self._time_polynomials(rows, order)
            flat = c.reshape(-1, c.shape[-1])
            control = flat @ _powers_to_bernstein(flat.shape[1] - 1).T
            turns = np.flatnonzero((control.min(axis=1) < 0.0) & (control.max(axis=1) > 0.0))
            roots = find_piece_roots(flat[turns], np.zeros(len(turns)), np.ones(len(turns)))
            at, k = np.nonzero(np.isfinite(roots))
            interval, joint = rows[turns[at] // self.dof], turns[at] % self.dof
            times = self._root_times(interval, roots[at, k], of_place)
            for j in range(self.dof):
                found[j].append(times[joint == j])
        return [np.unique(np.clip(np.concatenate(each), 0.0, self.duration)) for each in found]

    def _root_times(self, i: Any, root: Array, of_place: bool) -> Array:
        if not of_place:
            seconds = self._times[i + 1] - self._times[i]
            return np.asarray(self._times[i] + seconds * np.where(self.law[i] == LAUNCH, root, 1.0 - root))
        since = _seconds_between(self.squares[i], self._lengths[i], np.zeros(len(i)), root)
        return np.asarray(self._times[i] + since)

    def _powers(self, rows: Any) -> Array:
        """Coefficients (k, dof, degree + 1) of q by the share of an interval."""
        grid = self.intervals
        control = restrict_pieces(
            self.path.control_points[grid.piece[rows]], grid.begin[rows], grid.end[rows]
        )
        return np.asarray(
            np.einsum("ij,kjn->kni", np.linalg.inv(_powers_to_bernstein(self.path.degree)), control)
        )

    def _place_polynomials(self, rows: Any, order: int) -> Array:
        """What has the sign of the derivative of that order by place: of q', q̈, its slope, or the jerk's."""
        q = self._powers(rows)
        x = self.squares[rows] @ np.array([[1.0, -2.0, 1.0], [0.0, 2.0, -2.0], [0.0, 0.0, 1.0]])
        if order == 0:
            return _derive(q)
        slope, bend = _derive(q), _derive(_derive(q))
        acceleration = _add(_multiply(bend, x), 0.5 * _multiply(slope, _derive(x)))
        if order == 1:
            return acceleration
        jerk = _derive(acceleration)  # over the path speed
        if order == 2:
            return jerk
        return _add(_multiply(_derive(jerk), x), 0.5 * _multiply(jerk, _derive(x)))

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
            made = _derive(made)
        return made

    def _remade(self, path: Path, grid: Grid, squared_speed: Array, proved: bool) -> JerkTimedPath:
        # Slower by the root of the ratio of the squared speeds; reversed if the path is.
        turned = path is not self.path
        law = self.law[::-1] if turned else self.law
        if turned:
            law = np.where(law == QUADRATIC, QUADRATIC, LAUNCH + LANDING - law)
        squares = self.squares[::-1, ::-1] if turned else self.squares
        peak = int(np.argmax(self.squared_speed))
        at = len(squared_speed) - 1 - peak if turned else peak
        ratio = float(squared_speed[at] / self.squared_speed[peak])
        jerk = self.launch_jerk[::-1] if turned else self.launch_jerk
        return JerkTimedPath(
            path,
            grid,
            np.array(squares) * ratio,
            np.array(law),
            np.array(jerk) * ratio**1.5,
            ratios=self._ratios,
            joint_names=self.joint_names,
            proved=proved,
        )


def _sides(shares: Sequence[float]) -> list[bool]:
    """Whether a share of an interval is its end, which the next one must not answer."""
    return [share == 1.0 for share in shares]


def _seconds_between(squares: Array, length: Array, begin: Array, end: Array) -> Array:
    """The time from one share of an interval to another: length ∫ dσ / √x."""
    second = squares @ np.array([1.0, -2.0, 1.0])

    def speed(t: Array) -> Array:
        s = 1.0 - t
        x = s * s * squares[:, 0] + 2.0 * s * t * squares[:, 1] + t * t * squares[:, 2]
        return np.sqrt(np.maximum(x, 0.0))

    total = speed(begin) + speed(end)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (end - begin) / total
        z = second * ratio * ratio
    return np.asarray(2.0 * length * ratio * _inverse_tangent(z))


def _inverse_tangent(z: Array) -> Array:
    """artanh(√z) / √z, which is arctan(√−z) / √−z for negative z."""
    root = np.sqrt(np.abs(z))
    with np.errstate(divide="ignore", invalid="ignore"):
        exact = np.where(z > 0.0, np.arctanh(root), np.arctan(root)) / root
    series = 1.0 + z * (1 / 3 + z * (1 / 5 + z * (1 / 7 + z * (1 / 9 + z * (1 / 11 + z / 13)))))
    return np.where(np.abs(z) < SERIES, series, exact)


def _sine_and_versed(a: Array, t: Array) -> tuple[Array, Array]:
    """sinh(√a t) / √a and (cosh(√a t) − 1) / a; sine and cosine for negative a."""
    z = a * t * t
    root = np.sqrt(np.abs(z))
    with np.errstate(divide="ignore", invalid="ignore"):
        sine = np.where(z > 0.0, np.sinh(root), np.sin(root)) / root
        half = np.where(z > 0.0, np.sinh(0.5 * root), np.sin(0.5 * root)) / (0.5 * root)
    near = np.abs(z) < SERIES
    quarter = 0.25 * z
    sine = np.where(near, _sine_series(z), sine)
    half = np.where(near, _sine_series(quarter), half)
    return t * sine, 0.5 * t * t * half * half


def _sine_series(z: Array) -> Array:
    """sinh(√z) / √z near zero."""
    return 1.0 + z / 6.0 * (1.0 + z / 20.0 * (1.0 + z / 42.0 * (1.0 + z / 72.0 * (1.0 + z / 110.0))))


def _derive(c: Array) -> Array:
    """The derivative of polynomials (..., n), lowest power first; one coefficient at least."""
    return c[..., 1:] * np.arange(1.0, c.shape[-1]) if c.shape[-1] > 1 else np.zeros_like(c)


def _multiply(p: Array, x: Array) -> Array:
    """The products of polynomials (k, dof, m) with those of the intervals (k, n)."""
    made = np.zeros((*p.shape[:2], p.shape[2] + x.shape[1] - 1))
    for i in range(x.shape[1]):
        made[..., i : i + p.shape[2]] += x[:, None, i : i + 1] * p
    return made


def _add(a: Array, b: Array) -> Array:
    n = max(a.shape[-1], b.shape[-1])
    first, second = (np.pad(each, ((0, 0), (0, 0), (0, n - each.shape[-1]))) for each in (a, b))
    return np.asarray(first + second)


def _reversal(degree: int) -> Array:
    """The matrix from coefficients of powers of t to those of powers of 1 − t."""
    flip = np.eye(degree + 1)[::-1]
    basis = _powers_to_bernstein(degree)
    return np.asarray(np.linalg.inv(basis) @ flip @ basis)
