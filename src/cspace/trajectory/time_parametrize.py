"""Time parametrisation: the fastest motion along a path within limits."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace._core import divide_path, time_path
from cspace.arrays import (
    Array,
    as_floats,
    bounded_number,
    one_array,
    positive_number,
    truth_value,
    whole_number,
)
from cspace.dynamics.rows import EARTH
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.model import Limits
from cspace.model.values import freeze_array
from cspace.tables import join_words
from cspace.tolerances import FARTHEST, LEAST_LIMIT, LIMIT_ROUNDING, TIMED_WITHIN
from cspace.trajectory.graded_grid import Section
from cspace.trajectory.jerk_timed_path import JerkTimedPath
from cspace.trajectory.jerk_timing import (
    JerkLimits,
    SectionLaw,
    default_intervals,
    divide_for_feed,
    divide_section,
    find_sections,
    join_laws,
    refuse_jumps,
    time_section,
    time_sections,
)
from cspace.trajectory.path import Path
from cspace.trajectory.sampled_limits import (
    MOST_ROUNDS,
    FrameLimits,
    LimitShares,
    SampledLimits,
    TorqueLimits,
)
from cspace.trajectory.timed_path import Grid, TimedPath

MOST_INTERVALS: Final = 10_000_000
"""Of a grid that is given as a number."""

MOST_JERK_GRID: Final = 100_000
"""Of a grid that is given as a number, under jerk limits: a solution takes some eight seconds."""

MOST_JERK_INTERVALS: Final = 3000
"""From which on grids are not halved further under jerk limits: a solution takes half a second."""

FEED_ROUNDS: Final = 4
"""Of dividing intervals on which a feed is not held though no limit slows it."""

ROUGHLY: Final = 0.01
"""Of the duration of a motion without jerk limits, from which the search under them begins."""

EMPTY_GRID: Final = Grid(np.zeros(0, dtype=np.int32), np.zeros(0), np.zeros(0))


def time_parametrize(
    path: Path,
    limits: Limits | KinematicModel | None = None,
    *,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    jerk: ArrayLike | bool | None = None,
    torque: ArrayLike | bool | None = None,
    speed: float | None = None,
    turn_rate: float | None = None,
    feed: float | None = None,
    robot: KinematicModel | None = None,
    frame: str | None = None,
    gravity: ArrayLike | None = None,
    start_speed: float = 0.0,
    end_speed: float = 0.0,
    grid: int | None = None,
    tolerance: float | None = None,
    positions: bool = True,
) -> TimedPath:
    """The fastest motion along a path within limits of velocity, acceleration, torque and tip speed.

    The squared speed of the parameter is quadratic on each interval of a grid, linear if the grid is given.
    Limits of velocity, acceleration and jerk hold everywhere on an interval, which is proved by Bernstein
    coefficients. Limits of torque and of a frame are sampled at three places of an interval, checked at ten
    and tightened where exceeded.

    path: a Path, such as of spline or blend. limits: Limits or a robot. velocity, acceleration: in their
    place, one number or (dof,) [rad/s or m/s, and per s]; inf for none. jerk: likewise, per s², or True for
    those of limits; the acceleration is then continuous, and the motion rests at both ends. torque: one
    number, (dof,) [N·m or N], or True for the efforts of the robot. speed [m/s], turn_rate [rad/s]: largest
    ones of the frame of robot, by default its tip. feed [m/s]: the speed that it is to have, wherever the
    limits allow it; `below_feed` lists where they do not. robot: whose dynamics and kinematics those need, by
    default limits. gravity (3,) [m/s²]: for torque, (0, 0, −9.81) unless given. start_speed, end_speed:
    speeds ds/dt of the parameter at the ends. grid: about so many intervals; with few the motion may be much
    slower. By default they are halved until that changes the duration by less than `tolerance`, relative
    (0.001). Under jerk limits 30 of a piece (fewer of the short pieces of long paths), 150 or more, unless a
    tolerance is given. positions: whether the limits of position of limits count, too.

    Returns a TimedPath; falsy, with reason, place and speed_range, where no speed keeps the limits, the path
    leaves those of position, or the speeds at the ends are impossible. Raises InputError for a wrong shape,
    NaN, negative limits, joints without one of acceleration, and jerk limits where the path's bend jumps.
    Source: Pham and Pham 2018, with bounds over whole intervals; a barrier method under jerk limits.
    """
    own, given = _choose_robot(robot, limits), getattr(limits, "limits", limits)
    if own is not None and own.floating:
        _refuse_floating(own, torque, speed, turn_rate, feed)
    _check_path(path, given)
    labels = _label_joints(path, own)
    v = _read_limit("velocity", velocity, given, labels, required=False)
    a = _read_limit("acceleration", acceleration, given, labels, required=True)
    sampled = SampledLimits(
        path, _read_torque(torque, own, path, gravity), _read_frame(speed, turn_rate, feed, own, frame)
    )
    kept = given if truth_value(positions, "positions") and isinstance(given, Limits) else None
    timer = _Timer(
        path,
        v,
        a,
        sampled if sampled.exist else None,
        bounded_number(start_speed, "start_speed", 0.0, "it must be 0 or more", FARTHEST),
        bounded_number(end_speed, "end_speed", 0.0, "it must be 0 or more", FARTHEST),
        None if tolerance is None else positive_number(tolerance, "tolerance"),
        labels,
        None if own is None else own.joint_names,
        _read_jerk(jerk, given, labels),
    )
    return timer.run(_read_grid(grid, tolerance, timer.jerk), kept)


def _check_path(path: Any, limits: Any) -> None:
    """Raise InputTypeError unless path is a Path, InputError for Limits of another number of joints."""
    if not isinstance(path, Path):
        raise InputTypeError(f"path is {name_type(path)}; make a Path by spline, blend, b_spline or fit_path")
    if isinstance(limits, Limits) and len(limits.lower) != path.dof:
        raise InputError(f"limits is of {len(limits.lower)} joints, the path of {path.dof}")


def _read_grid(grid: Any, tolerance: Any, jerk: Array | None) -> int | None:
    """The number of intervals that is given, if one is."""
    if grid is not None and tolerance is not None:
        raise InputTypeError("grid= and tolerance= exclude each other: a grid that is given is not refined")
    most = MOST_INTERVALS if jerk is None else MOST_JERK_GRID
    return None if grid is None else whole_number(grid, "grid", 1, most)


class _Timer:
    """A path with its limits, to be timed on one grid after another."""

    def __init__(
        self,
        path: Path,
        velocity: Array,
        acceleration: Array,
        sampled: SampledLimits | None,
        start: float,
        end: float,
        tolerance: float | None,
        labels: tuple[str, ...],
        joint_names: tuple[str, ...] | None,
        jerk: Array | None,
    ) -> None:
        self.jerk = jerk
        self.path, self.velocity, self.acceleration = path, velocity, acceleration
        self.sampled, self.ends, self.tolerance = sampled, (start, end), tolerance
        self.labels, self.joint_names = labels, joint_names
        torque, frame = (None, None) if sampled is None else (sampled.torque, sampled.frame)
        self.ratios = LimitShares(labels, velocity, acceleration, jerk, torque, frame)
        self.arrays = path.control_points, path.lengths, path.stop_flags

    def run(self, count: int | None, kept: Limits | None) -> TimedPath:
        """The fastest motion on so many intervals, or on a grid of its own. kept: limits of position."""
        if kept is not None and (left := self.find_position_left(kept)) is not None:
            return left
        if (still := self.find_locked_joint()) is not None:
            return still
        if self.jerk is not None:
            return self.time_with_jerk(count)
        return self.time(None if count is None else Grid(*divide_path(*self.arrays, count)))

    def find_position_left(self, limits: Limits) -> TimedPath | None:
        """The answer where the path leaves the limits of position."""
        low, high = self.path._hull
        if (low >= limits.lower).all() and (high <= limits.upper).all():
            return None
        lower, upper = (
            bound + side * LIMIT_ROUNDING * np.maximum(1.0, np.abs(np.where(np.isinf(bound), 0.0, bound)))
            for side, bound in ((-1.0, limits.lower), (1.0, limits.upper))
        )
        found = self.path.first_beyond(lower, upper)
        if found is None:
            return None
        j, s, value = found
        name, limit = ("upper", limits.upper[j]) if value > upper[j] else ("lower", limits.lower[j])
        return self._refuse(
            f"{self.labels[j]} is {value:.6g} at s = {s:.6g}, beyond its {name} limit {limit:.6g};"
            " positions=False leaves these limits out",
            s,
        )

    def find_locked_joint(self) -> TimedPath | None:
        """The answer where a joint moves whose limit is zero, or nothing limits the motion."""
        moves, always_moves = self.path.moving, self.path.always_moves
        for name, limit in (
            ("velocity", self.velocity),
            ("acceleration", self.acceleration),
            ("jerk", self.jerk),
        ):
            if limit is None or np.count_nonzero(limit) == self.path.dof:
                continue
            locked = np.argwhere(moves & (limit == 0.0))
            if locked.size:
                piece, j = map(int, locked[0])
                s = float(self.path.breaks[piece])
                return self._refuse(f"{self.labels[j]} moves from s = {s:.6g} on; its {name} limit is 0", s)
        if not always_moves and (standing := np.flatnonzero(~moves.any(axis=1))).size:
            s = float(self.path.breaks[standing[0]])
            return self._refuse(f"nothing moves from s = {s:.6g} on; leave such pieces out of the path", s)
        if self.path.turning_places.size:
            s = float(self.path.turning_places[0])
            return self._refuse(
                f"the slope vanishes at s = {s:.6g}, where the second derivative jumps; make the path in"
                " parts that end there",
                s,
            )
        limited = np.isfinite(self.velocity) | np.isfinite(self.acceleration)
        if always_moves and np.count_nonzero(limited) == self.path.dof:
            return None
        free = ~(moves & limited).any(axis=1)
        if self.sampled is None and free.any():
            s = float(self.path.breaks[np.flatnonzero(free)[0]])
            raise InputError(f"no limit applies to the joints that move at s = {s:.6g}; pass acceleration=")
        return None

    def time_once(self, grid: Grid | None, tolerance: float, rises: Array | None = None) -> TimedPath:
        """The fastest motion whose sampled limits are not yet checked; on a grid of its own without one.

        rises: of the squared speeds on a grid that is given.
        """
        if self.sampled is not None and self.sampled.torque is not None and self.sampled.torque.resists:
            plain = self._solve(grid, None, tolerance, rises)
            if plain:
                self.sampled.expected = plain.grid, plain.squared_speed
        return self._solve(grid, self.sampled, tolerance, rises)

    def time(self, grid: Grid | None) -> TimedPath:
        """The fastest motion; on a grid of its own without one, on which a feed is held."""
        timed = self.time_on(grid)
        for _ in range(FEED_ROUNDS if grid is None and self.has_feed else 0):
            parts = timed._divide_for_feed()
            if not timed or (parts == 1).all():
                break
            assert self.sampled is not None
            self.sampled = self.sampled.renewed((timed.grid, timed.squared_speed))
            converged, rises = timed.converged, np.repeat(np.where(parts == 1, timed.rises, 0.0), parts)
            timed = self.time_on(timed.intervals.divided(parts), rises)
            timed.converged = converged
        return timed

    def time_on(self, grid: Grid | None, rises: Array | None = None) -> TimedPath:
        """The fastest motion on a grid, or one of its own."""
        timed = self.time_once(grid, self.within, rises)
        if self.sampled is None:
            return timed
        converged = timed.converged
        for _ in range(MOST_ROUNDS):
            if not timed or self.sampled.tighten(timed):
                timed.converged = converged
                return timed
            timed = self._solve(timed.intervals, self.sampled, self.within, timed.rises)
        if timed and not self.sampled.tighten(timed):
            return self._refuse(f"limits are still exceeded after {MOST_ROUNDS} rounds; pass a finer grid=")
        return timed

    def time_with_jerk(self, count: int | None) -> TimedPath:
        """The fastest motion with limits of jerk too, from rest to rest; finer grids if a tolerance asks."""
        if any(self.ends):
            raise InputError("jerk= is for motions from rest to rest; leave out start_speed= and end_speed=")
        refuse_jumps(self.path)
        plain = self.time_once(None, ROUGHLY)
        if not plain:
            return plain
        number = default_intervals(self.path, len(plain.intervals.piece)) if count is None else count
        sections = find_sections(self.path)
        seconds = time_sections(sections, plain)
        expected = None if self.sampled is None else (plain.grid, plain.squared_speed)
        del plain  # of long paths it takes as much memory as all that follows
        grids = [divide_section(self.path, each, number) for each in sections]
        timed = self.time_with_jerk_on(sections, grids, seconds, expected)
        while timed and count is None and self.tolerance is not None and number < MOST_JERK_INTERVALS:
            number *= 2
            grids = [divide_section(self.path, each, number) for each in sections]
            last, timed = timed.duration, self.time_with_jerk_on(sections, grids, seconds, expected)
            if abs(last - timed.duration) <= self.tolerance * timed.duration:
                timed.converged = True
                break
        for _ in range(FEED_ROUNDS if count is None and self.has_feed else 0):
            parts = timed._divide_for_feed()
            if not timed or (parts == 1).all() or len(parts) > MOST_JERK_INTERVALS:
                break
            ends = np.cumsum([0, *(len(each.piece) + 2 for each in grids)])
            grids = [
                divide_for_feed(each, parts[a + 1 : b - 1])
                for each, (a, b) in zip(grids, pairwise(ends.tolist()), strict=True)
            ]
            divided = self.time_with_jerk_on(sections, grids, seconds, expected)
            if not divided or divided.duration >= timed.duration:  # uneven grids may cost more than they win
                break
            timed = divided
        return timed

    def time_with_jerk_on(
        self,
        sections: list[Section],
        grids: list[Grid],
        seconds: list[float],
        expected: tuple[Array, Array] | None,
    ) -> TimedPath:
        """The same on a grid of each section.

        seconds, expected: of the motion without limits of jerk, as of time_sections and of SampledLimits.
        """
        assert self.jerk is not None
        limits = JerkLimits(self.velocity, self.acceleration, self.jerk)
        sampled = [None if self.sampled is None else self.sampled.renewed(expected) for _ in sections]
        for _ in range(MOST_ROUNDS + 1):
            laws: list[SectionLaw] = []
            for section, grid, own, time in zip(sections, grids, sampled, seconds, strict=True):
                found = time_section(self.path, section, self.arrays, limits, grid, time, own)
                if found is None:
                    s = float(self.path.breaks[section.first])
                    return self._refuse(f"no motion from s = {s:.6g} on keeps the limits", s)
                laws.append(found)
            timed = self._join_sections(laws)
            if self.sampled is None:
                return timed
            excess = self.sampled.measure(timed)
            ends = np.cumsum([0, *(len(each.law) for each in laws)]).tolist()
            kept = True
            for own, (begin, end) in zip(sampled, pairwise(ends), strict=True):
                assert own is not None
                own.expected = timed.grid, timed.squared_speed
                kept &= own.tighten_by(excess.of_section(begin, end))
            if kept:
                return timed
        return self._refuse(f"limits are still exceeded after {MOST_ROUNDS} rounds; pass a finer grid=")

    def _join_sections(self, laws: list[SectionLaw]) -> JerkTimedPath:
        joined = join_laws(laws)
        return JerkTimedPath(
            self.path,
            joined.grid,
            joined.squares,
            joined.law,
            joined.jerk,
            ratios=self.ratios,
            joint_names=self.joint_names,
            proved=self.sampled is None,
        )

    @property
    def has_feed(self) -> bool:
        """Whether the tip is to have a speed."""
        return self.sampled is not None and self.sampled.frame is not None and self.sampled.frame.is_feed

    @property
    def within(self) -> float:
        """By how much less finer grids change the duration, relative."""
        return TIMED_WITHIN if self.tolerance is None else self.tolerance

    def _solve(
        self, grid: Grid | None, sample: SampledLimits | None, tolerance: float, given: Array | None = None
    ) -> TimedPath:
        outcome, where, least, most, own, squared_speed, rises, converged = time_path(
            *self.arrays,
            self.velocity,
            self.acceleration,
            *self.ends,
            tolerance,
            grid,
            sample,
            given,
        )
        used = grid or Grid(*(own or EMPTY_GRID))
        if outcome == "blocked":
            return self._explain_block(used, where, sample)
        if outcome == "stands":
            s = self._parameter(used, where)
            return self._refuse(f"the motion stands at s = {s:.6g}; pass a finer grid=", s)
        if outcome != "timed":
            speed = self.ends[outcome == "end"]
            digits = 6 if f"{speed:.6g}" not in (f"{least:.6g}", f"{most:.6g}") else 15
            shown = (f"{value:.{digits}g}" for value in (speed, least, most))
            reason = "{}_speed is {}; from {} to {} are possible".format(outcome, *shown)
            s = 0.0 if outcome == "start" else self.path.length
            return self._refuse(reason, s, (least, most))
        return TimedPath(
            self.path,
            used,
            freeze_array(squared_speed),
            rises,
            ratios=self.ratios,
            proved=sample is None,
            converged=converged and grid is None,
            joint_names=self.joint_names,
        )

    def _parameter(self, grid: Grid, interval: int) -> float:
        piece = grid.piece[interval]
        return float(self.path.breaks[piece] + grid.begin[interval] * self.path.lengths[piece])

    def _explain_block(self, grid: Grid, where: int, sample: SampledLimits | None) -> TimedPath:
        """Why nothing passes an interval: a torque at rest that exceeds its limit, if there is one."""
        s = self._parameter(grid, where)
        if sample is not None and sample.torque is not None:
            offset = np.asarray(sample(grid.piece[[where]], grid.begin[[where]], grid.end[[where]])[2])
            over = np.abs(offset).max(axis=0) - sample.torque.limit
            if (over > 0.0).any():
                j = int(np.argmax(over))
                needed = float(np.abs(offset[:, j]).max())
                return self._refuse(
                    f"{self.labels[j]} needs {needed:.4g} against gravity and friction at s = {s:.6g},"
                    f" more than its torque limit of {sample.torque.limit[j]:.4g}",
                    s,
                )
        return self._refuse(f"no speed keeps the limits at s = {s:.6g}", s)

    def _refuse(
        self, reason: str, place: float = np.nan, speed_range: tuple[float, float] | None = None
    ) -> TimedPath:
        return TimedPath(
            self.path,
            EMPTY_GRID,
            np.zeros(0),
            ratios=self.ratios,
            proved=False,
            converged=False,
            reason=reason,
            place=place,
            speed_range=speed_range,
            joint_names=self.joint_names,
        )


def _choose_robot(robot: KinematicModel | None, limits: Any) -> KinematicModel | None:
    """The robot whose dynamics and kinematics count, if there is one."""
    if robot is not None and not isinstance(robot, KinematicModel):
        raise InputTypeError(f"robot is {name_type(robot)}; cspace.load_robot(name) returns one")
    if robot is not None:
        return robot
    return limits if isinstance(limits, KinematicModel) else None


def _refuse_floating(robot: KinematicModel, torque: Any, *rates: Any) -> None:
    """InputError for limits that need the pose of the base."""
    if not (torque is None or torque is False) or any(rate is not None for rate in rates):
        raise InputError(
            f"the base of {robot.name} is floating; torque=, speed=, turn_rate= and feed="
            " need one that stands"
        )


def _label_joints(path: Path, robot: KinematicModel | None) -> tuple[str, ...]:
    if robot is None:
        return tuple(f"joint {j}" for j in range(path.dof))
    if len(robot.joint_names) != path.dof:
        raise InputError(f"the path is of {path.dof} joints, {robot.name} of {len(robot.joint_names)}")
    return tuple(robot.joint_names)


def _read_limit(
    name: str, value: Any, limits: Any, labels: tuple[str, ...], *, required: bool, argument: str = ""
) -> Array:
    """The limit given, or that of limits (dof,); inf where there is none and it is not required.

    argument: what gives it, if that is not its name.
    """
    n = len(labels)
    if value is not None:
        row = as_floats(value, name, finite=False)
        if row.shape not in ((), (n,)):
            raise InputError(f"{name} has shape {row.shape}, expected () or ({n},), one per joint")
        if row.ndim and all(LEAST_LIMIT <= limit <= FARTHEST for limit in row.tolist()):
            return np.array(row)
        if not (row >= 0.0).all():
            raise InputError(f"{name} contains {float(row[~(row >= 0.0)].flat[0]):g}; it must be 0 or more")
        if (bad := row[(row > 0.0) & (row < LEAST_LIMIT) | np.isfinite(row) & (row > FARTHEST)]).size:
            raise InputError(
                f"{name} contains {bad.flat[0]:g}; it must be from {LEAST_LIMIT:g} to {FARTHEST:g}, 0 or inf"
            )
        return np.full(n, row)
    if limits is None:
        own = np.full(n, np.inf)
    elif isinstance(limits, Limits):
        own = np.array(getattr(limits, name))
    else:
        raise InputTypeError(f"limits is {name_type(limits)}; give Limits or a robot")
    if required and np.isinf(own).any():
        absent = [label for label, limit in zip(labels, own, strict=True) if np.isinf(limit)]
        which = "" if len(absent) == n else f" of {join_words(absent)}"
        raise InputError(f"there are no {name} limits{which}; pass {argument or name}=, with inf for none")
    return own


def _read_jerk(jerk: Any, limits: Any, labels: tuple[str, ...]) -> Array | None:
    if jerk is None or jerk is False:
        return None
    row = _read_limit("jerk", None if jerk is True else jerk, limits, labels, required=True)
    if np.isinf(row).all():
        raise InputError("jerk is infinite for all joints; leave it out for none")
    return row


def _read_torque(
    torque: Any, robot: KinematicModel | None, path: Path, gravity: ArrayLike | None
) -> TorqueLimits | None:
    if torque is None or torque is False:
        if gravity is not None:
            raise InputTypeError("gravity= counts for limits of torque alone; pass torque=, or leave it out")
        return None
    if robot is None:
        raise InputTypeError("torque= needs the dynamics of a robot; pass robot=")
    labels = tuple(robot.joint_names)
    value = None if torque is True else torque
    limit = _read_limit(
        "torque" if value is not None else "effort",
        value,
        robot.limits,
        labels,
        required=True,
        argument="torque",
    )
    return TorqueLimits(robot, limit, one_array(EARTH if gravity is None else gravity, "gravity", (3,)))


def _read_frame(
    speed: Any, turn_rate: Any, feed: Any, robot: KinematicModel | None, frame: str | None
) -> FrameLimits | None:
    given = {"speed": speed, "turn_rate": turn_rate, "feed": feed}
    if all(value is None for value in given.values()):
        if frame is not None:
            raise InputTypeError("frame= needs a limit of its motion; pass speed=, turn_rate= or feed=")
        return None
    if robot is None:
        raise InputTypeError("speed=, turn_rate= and feed= need the kinematics of a robot; pass robot=")
    rule = "it must be one positive number"
    fastest, turns, held = (
        np.inf if value is None else positive_number(value, name, rule) for name, value in given.items()
    )
    if (least := min(fastest, turns, held)) < LEAST_LIMIT:
        raise InputError(f"speed=, turn_rate= or feed= is {least:g}; they must be {LEAST_LIMIT:g} or more")
    if speed is not None and held < np.inf and held > fastest:
        raise InputError(f"feed is {held:g}, more than speed, which is {fastest:g}; leave one of them out")
    return FrameLimits(robot, frame, min(fastest, held), turns, held < np.inf)
