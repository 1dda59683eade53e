"""Limits along a path that are no polynomials: torques of the joints, speed and turn rate of a frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from cspace.arrays import Array
from cspace.dynamics import inverse_dynamics
from cspace.dynamics.mechanics import find_resistances
from cspace.kinematics import jacobian
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.tolerances import LIMIT_ROUNDING, STANDING_SPEED, TIGHTENED_LEAST
from cspace.trajectory.path import Path
from cspace.trajectory.timed_path import FEED, Grid, Places, TimedPath, move_along, move_along_path

CHECKED_PLACES: Final = 10
"""Of each interval: the error between its ends and its middle is a smooth bump, which they cannot miss, and
whose peak between them a parabola has but for a rounding."""

MOST_ROUNDS: Final = 8
"""Of checking and tightening."""

TIGHTENED: Final = 1.5
"""Multiple of what exceeds a limit by which it is tightened: the motion changes with it."""


@dataclass
class TorqueLimits:
    """Torques of joints that are linear in the acceleration and the squared speed of a path.

    robot: with masses. limit (dof,) [N·m or N]. gravity (3,) [m/s²]. damping (dof,) [N·m·s/rad or N·s/m] and
    dry friction dry (dof,) [N·m or N] of the joints. is_dry: whether any has dry friction. resists: whether
    any has dry friction or damping.
    """

    robot: KinematicModel
    limit: Array
    gravity: Array

    def __post_init__(self) -> None:
        self.damping, self.dry = find_resistances(self.robot)
        self.is_dry = bool(self.dry.any())
        self.resists = self.is_dry or bool(self.damping.any())

    def torques(self, q: Array, qd: Array, qdd: Array, friction: bool = True) -> Array:
        """The torques (m, dof) of a motion (m, dof)."""
        return inverse_dynamics(self.robot, q, qd, qdd, gravity=self.gravity, friction=friction)

    def find_reversals(self, path: Path, grid: Grid) -> Any:
        """In which intervals which joints may reverse (k, dof), so that their dry friction jumps."""
        if not self.is_dry:
            return np.zeros((len(grid.piece), path.dof), dtype=bool)
        slopes = path.slope_controls(grid.piece, grid.begin, grid.end)
        return (slopes.min(axis=1) <= 0.0) & (slopes.max(axis=1) >= 0.0) & (self.dry > 0.0)

    def bound_sizes(self, tau: Array, signs: Array, reverses: Any) -> Array:
        """Sizes (m, k, dof) of torques, continuous along intervals; of samples (m, k, dof) of intervals.

        signs: of the velocities. Where a motion stands the dry friction is that beside it, and where a joint
        may reverse (k, dof) it acts both ways.
        """
        if not self.is_dry:
            return np.abs(tau)
        beside = signs.copy()
        beside[0], beside[-1] = signs[1], signs[-2]
        smooth = tau - self.dry * signs
        both: Array = np.abs(smooth) + self.dry
        return np.where(reverses, both, np.abs(smooth + self.dry * beside))

    def find_spread(self, path: Path, grid: Grid, reverses: Any) -> Array:
        """By which share of it dry friction may be more or less (k, dof) than what `terms` counts.

        It acts both ways where joints may reverse (k, dof), and not at all at the instant at which a motion
        stands: in intervals beside the ends and the stops half of it is counted.
        """
        stands = np.array(path.stop_flags, dtype=bool)
        stands[[0, -1]] = True
        beside = ((grid.begin == 0.0) & stands[grid.piece]) | ((grid.end == 1.0) & stands[grid.piece + 1])
        spread: Array = np.where(reverses, 1.0, np.where(beside[:, None] & (self.dry > 0.0), 0.5, 0.0))
        return spread

    def terms(
        self, q: Array, slope: Array, bend: Array, squared_speed: Array, spread: Array
    ) -> tuple[Array, ...]:
        """τ = along s̈ + across ṡ² + offset: the three terms, each (m, dof).

        Of dry friction the part that is certain is counted: 1 − spread (m, dof) of it. Damping is
        proportional to ṡ, the root of ṡ². Its tangent at the squared speeds given stands for it.
        """
        rest = np.zeros_like(q)
        rates = np.stack([rest, rest, slope]), np.stack([rest, slope, bend])
        weight, along, across = self.torques(q, *rates, friction=False)
        along -= weight
        across -= weight
        if not self.resists:
            return along, across, weight
        damping, dry = self.damping * slope, (1.0 - spread) * self.dry * np.sign(slope)
        x = squared_speed[:, None]
        root = np.sqrt(np.maximum(x, STANDING_SPEED * squared_speed.max(initial=1.0)))
        return along, across + 0.5 * damping / root, weight + dry + 0.5 * damping * root


@dataclass
class FrameLimits:
    """Largest speed [m/s] and turn rate [rad/s] of a frame of a robot; inf where there is none.

    is_feed: whether the speed is one that the frame is to have.
    """

    robot: KinematicModel
    frame: str | None
    speed: float
    turn_rate: float
    is_feed: bool = False

    def rates(self, q: Array, qd: Array) -> tuple[Array, Array]:
        """The speed and the turn rate (m,) at configurations and velocities (m, dof)."""
        twist = np.einsum("kij,kj->ki", jacobian(self.robot, q, self.frame), qd)
        return np.linalg.norm(twist[:, :3], axis=1), np.linalg.norm(twist[:, 3:], axis=1)

    def shares(self, q: Array, qd: Array) -> Array:
        """The larger of the two shares (m,) that are used of the limits."""
        speed, turn = self.rates(q, qd)
        shares: Array = np.maximum(speed / self.speed, turn / self.turn_rate)
        return shares


@dataclass
class SampledLimits:
    """What time_path samples on a grid; margins tighten the limits where a check finds them exceeded.

    expected: parameters and squared speeds near which the motion will be.
    """

    path: Path
    torque: TorqueLimits | None
    frame: FrameLimits | None
    expected: tuple[Array, Array] | None = None
    margin: Array | None = None
    slower: Array | None = None
    _last: tuple[tuple[Any, ...], tuple[Array | None, ...]] | None = None

    @property
    def exist(self) -> bool:
        """Whether there are any."""
        return self.torque is not None or self.frame is not None

    def __call__(self, piece: Any, begin: Array, end: Array) -> Samples:
        """The samples at the begin, the middle and the end of each interval, as the core wants them."""
        along, across, offset, reversal, inverse = self._sample(piece, begin, end)
        limit = None if self.torque is None else self.torque.limit
        if inverse is not None and self.slower is not None:
            inverse = inverse * self.slower[:, None]
        margin = self.margin if reversal is None or self.margin is None else self.margin + reversal
        return along, across, offset, reversal if margin is None else margin, limit, inverse

    def _sample(self, piece: Any, begin: Array, end: Array) -> tuple[Array | None, ...]:
        """Along, across and offset of torques, what of dry friction is not certain (k, dof), inverse squares.

        They are kept for the grid of the last call. Of damping they depend on the motion that is expected.
        """
        grid = (piece, begin, end)
        if self._last is not None and all(map(np.array_equal, grid, self._last[0])):
            return self._last[1]
        places = np.stack([begin, 0.5 * (begin + end), end], axis=1).ravel()
        pieces = np.repeat(piece, 3)
        q, slope, bend = self.path.evaluate_motion(pieces, places)
        along = across = offset = reversal = inverse = None
        if self.torque is not None:
            spread = np.zeros((len(piece), self.path.dof))
            if self.torque.resists:
                own = Grid(piece, begin, end)
                spread = self.torque.find_spread(self.path, own, self.torque.find_reversals(self.path, own))
                reversal = np.ascontiguousarray(spread * self.torque.dry) if spread.any() else None
            along, across, offset = self.torque.terms(
                q, slope, bend, self._expected_at(pieces, places), np.repeat(spread, 3, axis=0)
            )
        if self.frame is not None:
            inverse = _inverse_squares(self.frame.shares(q, slope).reshape(-1, 3))
        made = along, across, offset, reversal, inverse
        if self.torque is None or not self.torque.resists:
            self._last = grid, made
        return made

    def _expected_at(self, pieces: Array, places: Array) -> Array:
        if self.expected is None:
            return np.zeros(len(pieces))
        s = self.path.breaks[pieces] + places * self.path.lengths[pieces]
        return np.asarray(np.interp(s, *self.expected))

    def tighten(self, timed: TimedPath) -> bool:
        """Whether no limit is exceeded at samples of each interval; else the limits there are tightened."""
        if self.torque is not None:
            self.expected = timed.grid, timed.squared_speed
        return self.tighten_by(self.measure(timed))

    def renewed(self, expected: tuple[Array, Array] | None) -> SampledLimits:
        """The same limits, not tightened, for another grid."""
        return SampledLimits(self.path, self.torque, self.frame, expected)

    def measure(self, timed: TimedPath) -> Excess:
        """How far limits are exceeded at samples of each interval, and by parabolas between them."""
        shares = np.arange(CHECKED_PLACES + 1.0) / CHECKED_PLACES
        at = timed._look_at(tuple(shares))
        q, qd, qdd = move_along_path(self.path, at)
        over = used = None
        if self.torque is not None:
            shape = (len(shares), -1, self.path.dof)
            tau = self.torque.torques(q, qd, qdd).reshape(shape)
            reverses = self.torque.find_reversals(self.path, timed.intervals)
            over = _peaks(self.torque.bound_sizes(tau, np.sign(qd).reshape(shape), reverses))
            over = np.maximum(over, np.abs(tau).max(axis=0)) - self.torque.limit
        if self.frame is not None:
            used = _peaks(self.frame.shares(q, qd).reshape(len(shares), -1))
        return Excess(over, used)

    def tighten_by(self, excess: Excess) -> bool:
        """Whether no limit is exceeded; else they are tightened where they are exceeded or nearly attained.

        Tightening one interval lets the motion be faster in those beside it.
        """
        kept, (over, used) = True, excess
        slack = 0.0 if self.torque is None else LIMIT_ROUNDING * np.maximum(self.torque.limit, 1.0)
        if over is not None and self.torque is not None and (over > slack).any():
            kept = False
            own = np.zeros_like(over) if self.margin is None else self.margin
            least = TIGHTENED_LEAST * self.torque.limit
            more = np.where(over > -least, TIGHTENED * np.maximum(over, 0.0) + TIGHTENED * least, 0.0)
            self.margin = np.ascontiguousarray(own + more)
        if used is not None and (used > 1.0 + LIMIT_ROUNDING).any():
            kept = False
            own = np.ones_like(used) if self.slower is None else self.slower
            more = (np.maximum(used, 1.0) + TIGHTENED_LEAST) ** (2.0 * TIGHTENED)
            self.slower = own * np.where(used > 1.0 - TIGHTENED_LEAST, more, 1.0)
        return kept


Samples: TypeAlias = tuple[Array | None, Array | None, Array | None, Array | None, Array | None, Array | None]
"""Along, across, offset, margin and limit of torques, and the inverse of the squared speed of a frame."""


class Excess(NamedTuple):
    """By interval: how far torques are beyond their limits (k, dof), and what is used of a frame's (k,)."""

    torque: Array | None
    frame: Array | None

    def of_section(self, begin: int, end: int) -> Excess:
        """That of intervals begin … end − 1, the first and the last counted with their neighbours inside."""

        def inside(rows: Array | None) -> Array | None:
            if rows is None:
                return None
            own = rows[begin + 1 : end - 1].copy()
            own[0], own[-1] = np.maximum(own[0], rows[begin]), np.maximum(own[-1], rows[end - 1])
            return own

        return Excess(inside(self.torque), inside(self.frame))


def _peaks(values: Array) -> Array:
    """The largest values (...) of the parabolas through three samples in a row, of samples (m, ...)."""
    before, middle, after = values[:-2], values[1:-1], values[2:]
    slope, bend = 0.5 * (after - before), after - 2.0 * middle + before
    inside = np.abs(slope) < -bend
    rise = np.where(inside, slope * slope, 0.0) / np.where(inside, -2.0 * bend, 1.0)
    peaks: Array = np.maximum(values.max(axis=0), (middle + rise).max(axis=0))
    return peaks


def _inverse_squares(shares: Array) -> Array:
    """Bernstein coefficients (k, 3) of the inverse of the squared speed at which a share is one.

    shares (k, 3): what unit speed uses of a limit at the begin, the middle and the end of each interval. The
    quadratic polynomial through their squares stands for what is between.
    """
    first, middle, last = (shares * shares).T
    control = np.maximum(2.0 * middle - 0.5 * (first + last), np.minimum(first, last))
    return np.stack([first, control, last], axis=1)


@dataclass(frozen=True)
class LimitShares:
    """How much a motion uses of its limits: what TimedPath.binding compares."""

    labels: tuple[str, ...]
    velocity: Array
    acceleration: Array
    jerk: Array | None
    torque: TorqueLimits | None
    frame: FrameLimits | None

    def __call__(self, path: Path, at: Places) -> list[tuple[str, str, Array]]:
        """Joint or frame, name and share (m,) of every limit."""
        rows: list[tuple[str, str, Array]] = []
        q, qd, qdd = move_along_path(path, at)
        rows += self._joint_rows("velocity", qd, self.velocity)
        rows += self._joint_rows("acceleration", qdd, self.acceleration)
        if self.jerk is not None:
            rows += self._joint_rows("jerk", move_along(path, at, 3), self.jerk)
        if self.torque is not None:
            rows += self._joint_rows("torque", self.torque.torques(q, qd, qdd), self.torque.limit)
        if self.frame is not None:
            speed, turn = self.frame.rates(q, qd)
            frame = self.frame.frame or "tip"
            rows.append((frame, FEED if self.frame.is_feed else "speed", speed / self.frame.speed))
            rows.append((frame, "turn_rate", turn / self.frame.turn_rate))
        return rows

    def _joint_rows(self, name: str, values: Array, limit: Array) -> list[tuple[str, str, Array]]:
        with np.errstate(divide="ignore", invalid="ignore"):
            shares: Any = np.where(limit > 0.0, np.abs(values) / limit, 0.0)
        return [(label, name, shares[:, j]) for j, label in enumerate(self.labels)]
