"""TimedPath: a motion along a path whose squared speed is quadratic between the places of a grid."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace._core import sum_times
from cspace.arrays import Array, as_floats, whole_number
from cspace.errors import InputError
from cspace.model.values import freeze_array
from cspace.tables import count_things, one_line, shown, tabulate
from cspace.tolerances import FEED_HELD, FEED_LOST
from cspace.trajectory.limit_check import BindingLimit
from cspace.trajectory.path import HIGHEST_ORDER, Path, _powers_to_bernstein, restrict_pieces
from cspace.trajectory.piece_roots import find_piece_roots
from cspace.trajectory.square_law import (
    add_polynomials,
    derive_polynomials,
    move_within,
    multiply_polynomials,
    seconds_between,
)
from cspace.trajectory.trajectory import Trajectory, read_factor

MOST_PARTS: Final = 8
"""Of an interval that is divided at once."""

NEAR_LIMIT: Final = 0.99
"""Share of a limit from which on it binds: an interval attains its limit at one place and keeps below it
elsewhere, by as much as its acceleration changes."""


BLOCK: Final = 4096
"""Intervals whose turning times are found at once."""


FEED: Final = "feed"
"""The name of the speed that a frame is to have."""


@tabulate()
class SlowStretch(NamedTuple):
    """A stretch of time on which a frame is slower than its feed.

    begin, end [s]. slowest [m/s]: its least speed, at three places of each interval. joint, limit: what
    slows it down, of which most is used.
    """

    begin: float
    end: float
    slowest: float
    joint: str
    limit: str


class Grid(NamedTuple):
    """Intervals of a path in order: the piece (k,) of each, and where in it, in 0 … 1, its ends are."""

    piece: npt.NDArray[np.int32]
    begin: Array
    end: Array

    def lengths(self, path: Path) -> Array:
        """The lengths (k,) of the parameter."""
        lengths: Array = self.end - self.begin
        lengths *= path.lengths[self.piece]
        return lengths

    def divided(self, parts: npt.NDArray[np.intp]) -> Grid:
        """The grid with each interval divided into so many equal parts (k,)."""
        number = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        count, begin, end = (np.repeat(row, parts) for row in (parts, self.begin, self.end))
        size = (end - begin) / count
        begins = begin + number * size
        ends = np.where(number + 1 == count, end, np.append(begins[1:], end[-1:]))
        return Grid(np.repeat(self.piece, parts), begins, ends)


class Places(NamedTuple):
    """Where a motion is: pieces (m,) of the path, places in them, and the derivatives of the parameter."""

    piece: npt.NDArray[np.int64]
    local: Array
    speed: Array
    acceleration: Array
    jerk: Array | None = None


Ratios = Callable[[Path, Places], list[tuple[str, str, Array]]]
"""The limits of a motion at places (m,): of each its joint or frame, its name, and its share (m,) in use."""


@tabulate("path", "duration", "proved", "reason")
class TimedPath(Trajectory):
    """A motion along a path within limits; falsy where there is none.

    path: the Path. squared_speed (k + 1,): the squared speed ṡ² of its parameter on the grid. rises (k,): of
    the middle Bernstein coefficient of ṡ² between two places above their mean; without a rise ṡ² is linear.
    grid (k + 1,): the parameters of the places. proved: no limit is exceeded anywhere, not only at samples.
    converged: halving the intervals would not change the duration by more than the tolerance.
    reason, place: why there is no motion and at which parameter (nan where it is no single place).
    speed_range: if the speed at the start or the end is at fault, the least and the largest possible one.
    """

    def __init__(
        self,
        path: Path,
        intervals: Grid,
        squared_speed: Array,
        rises: Array | None = None,
        *,
        ratios: Ratios | None = None,
        proved: bool = True,
        converged: bool = True,
        reason: str = "",
        place: float = np.nan,
        speed_range: tuple[float, float] | None = None,
        joint_names: Sequence[str] | None = None,
    ) -> None:
        self.path = path
        self.intervals = intervals
        is_kept = squared_speed.flags.c_contiguous and not squared_speed.flags.writeable
        self.squared_speed = squared_speed if is_kept else freeze_array(np.array(squared_speed))
        self.rises = freeze_array(np.zeros(len(intervals.piece)) if rises is None else rises)
        self.proved, self.converged = proved, converged
        self.place, self.speed_range = place, speed_range
        self._ratios = ratios
        self._lengths = intervals.lengths(path)
        moves = len(squared_speed) > 0
        self._times = sum_times(self._lengths, self.squared_speed, self.rises) if moves else np.zeros(1)
        super().__init__(path.dof, float(self._times[-1]), joint_names, reason)

    @property
    def knots(self) -> Array:
        """The times (k + 1,) [s] of the places of the grid."""
        return self._times

    def _squares(self, i: Any) -> Array:
        """Bernstein coefficients (m, 3) of the squared speed on intervals i (m,)."""
        x, y = self.squared_speed[:-1][i], self.squared_speed[1:][i]
        return np.stack([x, 0.5 * (x + y) + self.rises[i], y], axis=-1)

    @property
    def _no_motion(self) -> str:
        return "" if len(self.squared_speed) else self.reason

    @cached_property
    def grid(self) -> Array:
        """The parameters (k + 1,) of the places of the grid."""
        at = self.path.breaks[self.intervals.piece] + self.intervals.begin * self._piece_lengths
        return freeze_array(np.append(at, self.path.length)) if len(at) else np.zeros(1)

    @property
    def _piece_lengths(self) -> Array:
        return self.path.lengths[self.intervals.piece]

    def _place_times(self, times: Array, before: bool) -> Places:
        """Where the motion is at times (m,), from the nearer end of an interval."""
        side = "left" if before else "right"
        i = np.searchsorted(self._times[1:-1], times, side=side)  # type: ignore[call-overload]
        since, until = times - self._times[i], self._times[i + 1] - times
        early = self._is_early(i, since, until)
        squares = self._squares(i)
        squares = np.where(early[:, None], squares, squares[:, ::-1])
        ahead, speed, u, w = self._move(i, squares, np.where(early, since, until))
        share = np.where(early, ahead, 1.0 - ahead)
        begin, end = self.intervals.begin[i], self.intervals.end[i]
        local = np.clip(begin + (end - begin) * share, begin, end)
        return Places(self.intervals.piece[i].astype(np.int64), local, speed, np.where(early, u, -u), w)

    def _is_early(self, i: Any, since: Array, until: Array) -> Any:
        """Whether the begin of intervals i is nearer than their end."""
        return since <= until

    def _move(self, i: Any, squares: Array, t: Array) -> tuple[Array, Array, Array, Array]:
        """Share of an interval, speed, acceleration and jerk, a time t (m,) after its begin."""
        return move_within(squares, self._lengths[i], t)

    def _evaluate(self, times: Array, order: int, before: bool = False) -> Array:
        if len(self._times) == 1:
            return np.zeros((len(times), self.dof)) + (self.path.start if order == 0 else 0.0)
        return move_along(self.path, self._place_times(times, before), order)

    def _evaluate_joint(self, joint: int, times: Array, order: int, before: bool) -> Array:
        return self._evaluate(times, order, before)[:, joint]

    def parameter(self, t: Any, order: int = 0) -> Array:
        """The parameter s of the path, ṡ or s̈ (...) at times t (...) [s]; order: 0, 1 or 2.

        Raises InputError for a time outside of 0 … duration, and for another order.
        """
        order = whole_number(order, "order", 0, 2)
        times = self._check_times(as_floats(t, "t"))
        if len(self._times) == 1:
            return np.zeros_like(times)
        at = self._place_times(times.ravel(), False)
        s = self.path.breaks[at.piece] + at.local * self.path.lengths[at.piece]
        return np.asarray((s, at.speed, at.acceleration)[order].reshape(times.shape))

    def _turning_times(self, order: int) -> list[Array]:
        """The knots, and where the next derivative of q(s(t)) is zero."""
        if len(self._times) == 1:
            return [self._times] * self.dof
        found = [[self._times] for _ in range(self.dof)]
        for begin in range(0, len(self.intervals.piece), BLOCK):
            rows = np.arange(begin, min(begin + BLOCK, len(self.intervals.piece)))
            for j, times in enumerate(self._turns_within(rows, order)):
                found[j].append(times)
        return [np.unique(np.clip(np.concatenate(each), 0.0, self.duration)) for each in found]

    def _turns_within(self, rows: Any, order: int) -> list[Array]:
        """Of every joint, when the next derivative is zero within intervals rows (m,)."""
        at, joint, roots = _find_turns(self._place_polynomials(rows, order))
        begin = np.zeros(len(at))
        since = seconds_between(self._squares(rows[at]), self._lengths[rows[at]], begin, roots)
        times = self._times[rows[at]] + since
        return [times[joint == j] for j in range(self.dof)]

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
        x = self._squares(rows) @ np.array([[1.0, -2.0, 1.0], [0.0, 2.0, -2.0], [0.0, 0.0, 1.0]])
        if order == 0:
            return derive_polynomials(q)
        slope, bend = derive_polynomials(q), derive_polynomials(derive_polynomials(q))
        acceleration = add_polynomials(
            multiply_polynomials(bend, x), 0.5 * multiply_polynomials(slope, derive_polynomials(x))
        )
        if order == 1:
            return acceleration
        jerk = derive_polynomials(acceleration)  # over the path speed
        if order == 2:
            return jerk
        return add_polynomials(
            multiply_polynomials(derive_polynomials(jerk), x),
            0.5 * multiply_polynomials(jerk, derive_polynomials(x)),
        )

    def binding(self, limits: Any = None) -> tuple[BindingLimit, ...]:
        """Which limit determines the speed, when: on each interval the one of which most is used.

        Without limits those that the path was timed with; their names are "velocity", "acceleration",
        "jerk", "torque", "speed" or "feed", and "turn_rate", the last ones of a frame. Intervals that use
        no limit fully are left out. With limits (Limits or a robot) as of Trajectory.binding. Returns
        BindingLimits.
        """
        if limits is not None or self._ratios is None:
            return super().binding(limits)
        if len(self._times) == 1:
            return ()
        used, shares = self._use_limits()
        most = _find_binding(shares.max(axis=1))
        return tuple(
            BindingLimit(used[most[a]][0], used[most[a]][1], float(self._times[a]), float(self._times[b]))
            for a, b in _find_runs(most)
            if most[a] >= 0
        )

    def below_feed(self) -> tuple[SlowStretch, ...]:
        """When the frame is slower than the feed that the motion was timed with, and which limit slows it.

        Returns SlowStretches in order; the first and the last are those from and to rest.
        Raises InputError without a feed.
        """
        if (found := self._compare_to_feed()) is None:
            raise InputError("the motion was timed without a feed; pass feed= to time_parametrize")
        used, row, held, others = found
        most = np.where(held < NEAR_LIMIT, _name_all(_find_binding(others), others, held < NEAR_LIMIT), row)
        feed = self._ratios.frame.speed  # type: ignore[union-attr]
        return tuple(
            SlowStretch(
                float(self._times[a]),
                float(self._times[b]),
                feed * float(held[a:b].min()),
                *used[most[a]][:2],
            )
            for a, b in _find_runs(most)
            if most[a] != row
        )

    def _compare_to_feed(self) -> tuple[list[tuple[str, str, Array]], int, Array, Array] | None:
        """The limits, which is the feed, the least share (k,) of it, and most (limits, k) of the others."""
        if self._ratios is None or len(self._times) == 1:
            return None
        used, shares = self._use_limits()
        row = next((k for k, each in enumerate(used) if each[1] == FEED), None)
        if row is None:
            return None
        others = shares.max(axis=1)
        others[row] = 0.0
        return used, row, shares[row].min(axis=0), others

    def _divide_for_feed(self) -> npt.NDArray[np.intp]:
        """Into how many parts (k,) to divide intervals that are below the feed though no limit slows them.

        What a law of the squared speed loses falls by the square of the length.
        """
        if (found := self._compare_to_feed()) is None:
            return np.ones(len(self.intervals.piece), dtype=np.intp)
        _, _, held, others = found
        parts = np.clip(np.ceil(np.sqrt((1.0 - held) / FEED_HELD)), 2, MOST_PARTS)
        lost = (1.0 - held) * np.diff(self._times) > FEED_LOST * self.duration
        loose = lost & (held < 1.0 - FEED_HELD) & (others.max(axis=0) < NEAR_LIMIT)
        return np.where(loose, parts, 1).astype(np.intp)

    def _use_limits(self) -> tuple[list[tuple[str, str, Array]], Array]:
        """The limits, and their shares (limits, 3, k) in use at three places of every interval."""
        assert self._ratios is not None
        used = self._ratios(self.path, self._look_at((0.0, 0.5, 1.0)))
        return used, np.array([ratio.reshape(3, -1) for _, _, ratio in used])

    def _look_at(self, shares: Sequence[float]) -> Places:
        """Places at shares of the length of every interval, share by share."""
        grid, x = self.intervals, self.squared_speed
        t = np.array(shares)[:, None]
        local = grid.begin + t * (grid.end - grid.begin)
        rise = 2.0 * self.rises * (1.0 - t)
        speed = np.sqrt(np.maximum(x[:-1] + t * (np.diff(x) + rise), 0.0))
        u = (np.diff(x) + 2.0 * self.rises * (1.0 - 2.0 * t)) / (2.0 * self._lengths)
        w = -2.0 * self.rises / self._lengths**2 * speed
        piece = np.broadcast_to(grid.piece, local.shape).ravel().astype(np.int64)
        return Places(piece, local.ravel(), speed.ravel(), u.ravel(), w.ravel())

    def scaled(self, factor: float) -> TimedPath:
        """The same path, slower by a factor: its duration is multiplied by it.

        Raises InputError for a factor that is not above zero.
        """
        factor = read_factor(factor)
        proved = self.proved and factor >= 1.0
        return self._remade(self.path, self.intervals, factor**-2, proved)

    def reversed(self) -> TimedPath:
        """The same motion backwards in time."""
        last = len(self.path) - 1
        grid = Grid(
            (last - self.intervals.piece[::-1]).astype(np.int32),
            1.0 - self.intervals.end[::-1],
            1.0 - self.intervals.begin[::-1],
        )
        return self._remade(self.path.reversed(), grid, 1.0, self.proved)

    def _remade(self, path: Path, grid: Grid, factor: float, proved: bool) -> TimedPath:
        """The motion with squared speeds times a factor, backwards if the path is another one."""
        turn = slice(None) if path is self.path else slice(None, None, -1)
        return TimedPath(
            path,
            grid,
            factor * self.squared_speed[turn],
            factor * self.rises[turn],
            ratios=self._ratios,
            proved=proved,
            converged=self.converged,
            reason=self.reason,
            joint_names=self.joint_names,
        )

    def __repr__(self) -> str:
        if self.reason:
            return one_line(type(self).__name__, self.reason)
        text = f"of {count_things(self.dof, 'joint')}, {shown(self.duration)} s,"
        text += f" {count_things(len(self.intervals.piece), 'interval')}"
        return one_line(
            type(self).__name__, text + (", limits proved" if self.proved else ", limits checked")
        )


def _find_binding(shares: Array) -> npt.NDArray[np.intp]:
    """The limit (k,) of which most is used on each interval, of shares (limits, k); −1 where none binds."""
    most: npt.NDArray[np.intp] = shares.argmax(axis=0)
    most[shares.max(axis=0) < NEAR_LIMIT] = -1
    return most


def _name_all(
    binding: npt.NDArray[np.intp], shares: Array, asked: npt.NDArray[np.bool_]
) -> npt.NDArray[np.intp]:
    """The limit of each interval; where none binds that of the one before or after, if that is asked for.

    Between two limits there are intervals that use neither fully.
    """
    made = binding.copy()
    for order in (range(1, len(made)), range(len(made) - 2, -1, -1)):
        before = -1 if order.step > 0 else 1
        for i in order:
            if made[i] < 0 and asked[i] and asked[i + before]:
                made[i] = made[i + before]
    return np.where(made < 0, shares.argmax(axis=0), made)


def _find_runs(values: npt.NDArray[np.intp]) -> list[tuple[int, int]]:
    """Begins and ends of the runs of equal values (k,)."""
    begins = np.flatnonzero(np.append(True, np.diff(values) != 0))
    return list(zip(begins.tolist(), np.append(begins[1:], len(values)).tolist(), strict=True))


def _find_turns(c: Array) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], Array]:
    """The roots within 0 … 1 of polynomials (k, dof, n): their intervals, joints and places, (m,) each."""
    count, dof, n = c.shape
    flat = c.reshape(count * dof, n)
    control = flat @ _powers_to_bernstein(n - 1).T
    turns = np.flatnonzero((control.min(axis=1) < 0.0) & (control.max(axis=1) > 0.0))  # others have none
    roots = find_piece_roots(flat[turns], np.zeros(len(turns)), np.ones(len(turns)))
    at, k = np.nonzero(np.isfinite(roots))
    return turns[at] // dof, turns[at] % dof, roots[at, k]


def move_along(path: Path, at: Places, order: int) -> Array:
    """A derivative by time (m, dof) of a motion along a path, by the chain rule."""
    if order == 0:
        return path.evaluate_pieces(at.piece, at.local, 0)
    slope = path.evaluate_pieces(at.piece, at.local, 1)
    v, u = at.speed[:, None], at.acceleration[:, None]
    if order == 1:
        return slope * v
    bend = path.evaluate_pieces(at.piece, at.local, 2)
    if order == 2:
        return bend * (v * v) + slope * u
    twist = path.evaluate_pieces(at.piece, at.local, HIGHEST_ORDER)
    own = 0.0 if at.jerk is None else slope * at.jerk[:, None]
    return twist * v**3 + bend * (3.0 * v * u) + own


def move_along_path(path: Path, at: Places) -> tuple[Array, Array, Array]:
    """Positions, velocities and accelerations (m, dof) of a motion along a path."""
    q, slope, bend = path.evaluate_motion(at.piece, at.local)
    v, u = at.speed[:, None], at.acceleration[:, None]
    return q, slope * v, bend * (v * v) + slope * u
