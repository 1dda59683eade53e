"""TimedPath: a motion along a path whose squared speed is linear between the places of a grid."""

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
from cspace.tables import count_things, one_line, shown
from cspace.tolerances import FEED_HELD, FEED_LOST
from cspace.trajectory.limit_check import BindingLimit
from cspace.trajectory.path import HIGHEST_ORDER, Path, _powers_to_bernstein, restrict_pieces
from cspace.trajectory.piece_roots import find_piece_roots
from cspace.trajectory.trajectory import Trajectory, read_factor

MOST_PARTS: Final = 8
"""Of an interval that is divided at once."""

NEAR_LIMIT: Final = 0.99
"""Share of a limit from which on it binds: an interval attains its limit at one place and keeps below it
elsewhere, by as much as its acceleration changes."""


FEED: Final = "feed"
"""The name of the speed that a frame is to have."""


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


class TimedPath(Trajectory):
    """A motion along a path within limits; falsy where there is none.

    path: the Path. squared_speed (k + 1,): the squared speed ṡ² of its parameter on the grid, linear between.
    grid (k + 1,): the parameters of its places. proved: no limit is exceeded anywhere, and not only at
    samples. converged: halving the intervals would not change the duration by more than the tolerance.
    reason, place: why there is no motion and at which parameter (nan where it is no single place).
    speed_range: if the speed at the start or the end is at fault, the least and the largest possible one.
    """

    def __init__(
        self,
        path: Path,
        intervals: Grid,
        squared_speed: Array,
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
        self.proved, self.converged = proved, converged
        self.place, self.speed_range = place, speed_range
        self._ratios = ratios
        self._lengths = intervals.lengths(path)
        self._times = sum_times(self._lengths, self.squared_speed) if len(squared_speed) else np.zeros(1)
        super().__init__(path.dof, float(self._times[-1]), joint_names, reason)

    @property
    def knots(self) -> Array:
        """The times (k + 1,) [s] of the places of the grid."""
        return self._times

    @cached_property
    def _speeds(self) -> Array:
        """The speeds (k + 1,) of the parameter."""
        return np.sqrt(self.squared_speed)

    @cached_property
    def _accelerations(self) -> Array:
        """The accelerations (k,) of the parameter."""
        return np.asarray(np.diff(self.squared_speed) / (2.0 * self._lengths))

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
        u, length = self._accelerations[i], self._piece_lengths[i]
        early = since <= until
        begin, end = self._speeds[i], self._speeds[i + 1]
        ahead = self.intervals.begin[i] + since * (begin + 0.5 * u * since) / length
        back = self.intervals.end[i] - until * (end - 0.5 * u * until) / length
        local = np.clip(np.where(early, ahead, back), self.intervals.begin[i], self.intervals.end[i])
        speed = np.maximum(0.0, np.where(early, begin + u * since, end - u * until))
        return Places(self.intervals.piece[i].astype(np.int64), local, speed, u)

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
        """The knots, and the roots of the next derivative of q(s(t)), a polynomial on every interval."""
        if len(self._times) == 1:
            return [self._times] * self.dof
        c = self._polynomials
        for _ in range(order + 1):
            c = c[..., 1:] * np.arange(1.0, c.shape[-1]) if c.shape[-1] > 1 else np.zeros_like(c)
        count, n = c.shape[:2]
        flat = c.reshape(count * n, -1)
        control = flat @ _powers_to_bernstein(flat.shape[1] - 1).T
        turns = (control.min(axis=1) < 0.0) & (control.max(axis=1) > 0.0)  # others have no root inside
        found = find_piece_roots(flat[turns], np.zeros(turns.sum()), np.ones(turns.sum()))
        roots = np.full((count * n, found.shape[1]), np.nan)
        roots[turns] = found
        roots = roots.reshape(count, n, -1)
        seconds = np.diff(self._times)
        times = self._times[:-1, None, None] + seconds[:, None, None] * roots
        return [np.unique(np.append(t[np.isfinite(t)], self._times)) for t in times.transpose(1, 0, 2)]

    @cached_property
    def _polynomials(self) -> Array:
        """Coefficients (k, dof, 2 degree + 1) of q by the share of time of each interval."""
        control = self.path.control_points[self.intervals.piece]
        control = restrict_pieces(control, self.intervals.begin, self.intervals.end)
        powers = np.einsum("ij,kjn->kin", np.linalg.inv(_powers_to_bernstein(self.path.degree)), control)
        total = (self._speeds[:-1] + self._speeds[1:])[:, None]
        first = 2.0 * self._speeds[:-1, None] / total  # σ = first t + (1 − first) t²
        made = np.zeros((*powers.shape[::2], 2 * self.path.degree + 1))
        made[..., 0] = powers[:, -1]
        for i in range(self.path.degree - 1, -1, -1):
            shifted = np.zeros_like(made)
            shifted[..., 1:] += first[..., None] * made[..., :-1]
            shifted[..., 2:] += (1.0 - first)[..., None] * made[..., :-2]
            shifted[..., 0] += powers[:, i]
            made = shifted
        return made

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
        speed = np.sqrt(x[:-1] + t * np.diff(x))
        shape = local.shape
        piece = np.broadcast_to(grid.piece, shape).ravel().astype(np.int64)
        u = np.broadcast_to(self._accelerations, shape).ravel()
        return Places(piece, local.ravel(), speed.ravel(), u)

    def scaled(self, factor: float) -> TimedPath:
        """The same path, slower by a factor: its duration is multiplied by it.

        Raises InputError for a factor that is not above zero.
        """
        factor = read_factor(factor)
        proved = self.proved and factor >= 1.0
        return self._remade(self.path, self.intervals, self.squared_speed / factor**2, proved)

    def reversed(self) -> TimedPath:
        """The same motion backwards in time."""
        last = len(self.path) - 1
        grid = Grid(
            (last - self.intervals.piece[::-1]).astype(np.int32),
            1.0 - self.intervals.end[::-1],
            1.0 - self.intervals.begin[::-1],
        )
        return self._remade(self.path.reversed(), grid, self.squared_speed[::-1], self.proved)

    def _remade(self, path: Path, grid: Grid, squared_speed: Array, proved: bool) -> TimedPath:
        return TimedPath(
            path,
            grid,
            squared_speed,
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
