"""Odometry: the motion of a vehicle as it measured it itself, as steps along arcs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, any_array, as_floats, one_array, one_number, positive_number, whole_number
from cspace.errors import InputError, name_type
from cspace.math.wrapping import wrap_angle
from cspace.mobile.arcs import chain_increments
from cspace.mobile.timed_poses import TimedPoses, find_between, read_rows, read_times
from cspace.mobile.wheels import WheelBase
from cspace.spatial import exp_se2, inverse_pose_2d, log_se2, pose_2d, to_xytheta
from cspace.tables import count_things, one_line, tabulate

MOST_BITS = 64
"""The widest counters of ticks."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Odometry:
    """Steps between times, each along the arc of a constant twist.

    times (n,) [s], not decreasing. steps (n − 1, 3): the twist of the step times its duration,
    ξ = [vx, vy, ω] dt [m, rad], so that T_map_next = T_map_base exp ξ. Made from what a robot reports by
    from_increments, from_twists, from_poses and from_ticks. Raises InputError for times that run backwards.
    """

    times: Array
    steps: Array

    def __post_init__(self) -> None:
        times = read_times(self.times)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "steps", read_steps(self.steps, "steps", times))

    @classmethod
    def from_increments(cls, times: npt.ArrayLike, increments: npt.ArrayLike) -> Odometry:
        """Odometry from poses of the next base in the last one.

        times (n,) [s]. increments (n − 1, 3): x, y [m], θ [rad]. An increment is taken as the arc of less
        than half a turn that leads there.
        """
        checked = read_times(times)
        rows = read_steps(increments, "increments", checked)
        return cls(checked, log_se2(pose_2d(xytheta=rows)))

    @classmethod
    def from_twists(cls, times: npt.ArrayLike, twists: npt.ArrayLike) -> Odometry:
        """Odometry from body twists, each valid from its time to the next.

        times (n,) [s]. twists [vx, vy, ω] (n, 3), of which the last has no duration, or (n − 1, 3) [m/s,
        rad/s].
        """
        checked = read_times(times)
        rows = one_array(twists, "twists", (None, 3), "vx, vy [m/s], ω [rad/s]")
        if len(rows) == len(checked):
            rows = rows[:-1]
        return cls(checked, read_steps(rows, "twists", checked) * np.diff(checked)[:, None])

    @classmethod
    def from_poses(cls, times: npt.ArrayLike, poses: npt.ArrayLike) -> Odometry:
        """Odometry from the poses that a robot reports, such as those of its own dead reckoning.

        times (n,) [s]. poses (n, 3): x, y [m], θ [rad].
        """
        checked = read_times(times)
        T = pose_2d(xytheta=read_rows(poses, "poses", checked, (3,)))
        return cls(checked, log_se2(inverse_pose_2d(T[:-1]) @ T[1:]))

    @classmethod
    def from_ticks(
        cls,
        times: npt.ArrayLike,
        ticks: npt.ArrayLike,
        vehicle: WheelBase,
        *,
        per_turn: float,
        bits: int | None = None,
    ) -> Odometry:
        """Odometry from counters of wheel ticks: the twist of each step by the wheel matrix of the vehicle.

        times (n,) [s]. ticks (n, k), a counter per wheel. per_turn: ticks of one turn of a wheel. bits:
        width of counters that wrap, such as 16 or 32; between two rows a wheel must move less than half of
        their range. Raises InputError for a vehicle without a wheel matrix.
        """
        checked = read_times(times)
        angles = wheel_angles(ticks, per_turn=per_turn, bits=bits)
        if not isinstance(vehicle, WheelBase):
            raise InputError(
                f"vehicle is {name_type(vehicle)}; ticks need one with wheels, such as"
                " DifferentialDrive(wheel_radius, track)"
            )
        return cls(checked, vehicle.twist(angles))

    def __len__(self) -> int:
        """How many steps there are."""
        return len(self.steps)

    def __repr__(self) -> str:
        text = f"{count_things(len(self), 'step')}, {self.distances.sum():.4g} m"
        return one_line("Odometry", f"{text} in {np.ptp(self.times) if len(self.times) else 0:.6g} s")

    @property
    def durations(self) -> Array:
        """Seconds of each step, (n − 1,)."""
        return np.diff(self.times)

    @property
    def twists(self) -> Array:
        """The body twist [vx, vy, ω] of each step (n − 1, 3) [m/s, rad/s]; zero for steps of no duration."""
        dt = self.durations[:, None]
        return np.where(dt > 0, self.steps / np.where(dt > 0, dt, 1.0), 0.0)

    @property
    def increments(self) -> Array:
        """The pose of each next base in the last one, x, y, θ (n − 1, 3) [m, rad]."""
        return to_xytheta(exp_se2(self.steps))

    @property
    def distances(self) -> Array:
        """The length of the arc of each step (n − 1,) [m]."""
        return np.hypot(self.steps[:, 0], self.steps[:, 1])

    def dead_reckoning(self, start: npt.ArrayLike = (0.0, 0.0, 0.0)) -> TimedPoses:
        """The poses that the steps lead to from a start x, y, θ (3,) [m, rad], without any correction."""
        increments = to_xytheta(exp_se2(self.steps))
        increments[:, 2] = self.steps[:, 2]
        poses = chain_increments(one_array(start, "start", (3,)), increments)
        poses[:, 2] = wrap_angle(poses[:, 2])
        return TimedPoses(self.times, poses[: len(self.times)])

    def split(self, times: npt.ArrayLike) -> Odometry:
        """The same motion with more times (k,) [s] in it: steps are cut in proportion to their duration.

        Times before the first and after the last step, and those already there, are left out. A step of no
        duration stays whole.
        """
        extra = as_floats(times, "times").ravel()
        if not len(self.times):
            return self
        inside = extra[(extra > self.times[0]) & (extra < self.times[-1])]
        fresh = np.setdiff1d(inside, self.times)
        merged = np.sort(np.concatenate([self.times, fresh]), kind="stable")
        middle = 0.5 * (merged[1:] + merged[:-1])
        dt = np.diff(merged)
        step = np.clip(np.searchsorted(self.times, middle, side="right") - 1, 0, len(self.steps) - 1)
        pieces = self.twists[step] * dt[:, None]
        whole = np.flatnonzero(self.durations == 0)
        pieces[dt == 0] = self.steps[whole]
        return Odometry(merged, pieces)

    def between(self, first: float, last: float) -> Odometry:
        """The steps that begin at or after first and end at or before last [s]."""
        keep = np.flatnonzero(find_between(self.times, first, last))
        if not len(keep):
            return Odometry(np.empty(0), np.empty((0, 3)))
        return Odometry(self.times[keep], self.steps[keep[0] : keep[-1]])

    def corrected(self, *, distance: float = 1.0, turn: float = 1.0, drift: float = 0.0) -> Odometry:
        """The odometry with systematic errors taken out: vx and vy times `distance`, ω times `turn`, plus
        `drift` [rad/m] for each metre forwards, as cspace.mobile.calibrate finds them."""
        k_d, k_r, k_m = (
            one_number(value, name)
            for value, name in ((distance, "distance"), (turn, "turn"), (drift, "drift"))
        )
        steps = self.steps * np.array([k_d, k_d, k_r])
        steps[:, 2] += k_m * self.steps[:, 0]
        return Odometry(self.times, steps)


def wheel_angles(ticks: npt.ArrayLike, *, per_turn: float, bits: int | None = None) -> Array:
    """The turns of wheels between rows of their tick counters, (n, k) → (n − 1, k) [rad].

    per_turn: ticks of one turn. bits: width of counters that wrap; differences are then taken in
    [−2^(bits − 1), 2^(bits − 1)). Raises InputError for counters that are no whole numbers or beyond the
    width.
    """
    scale = 2.0 * np.pi / positive_number(per_turn, "per_turn")
    counts = any_array(ticks, "ticks")
    if counts.ndim != 2:
        raise InputError(
            f"ticks has shape {counts.shape}; give a row per time and a counter per wheel, (n, k)"
        )
    if not np.issubdtype(counts.dtype, np.integer):
        numbers = one_array(ticks, "ticks", (None, None))
        if (numbers != np.round(numbers)).any():
            raise InputError("ticks must be whole numbers; round them, or use from_twists")
        counts = numbers.astype(np.int64)
    return scale * _count_differences(counts, bits)


def read_steps(values: Any, subject: str, times: Array) -> Array:
    """Rows (n − 1, 3) between n times; InputError where the numbers do not fit."""
    rows = one_array(values, subject, (None, 3))
    if len(rows) != max(len(times) - 1, 0):
        raise InputError(
            f"{subject} has {len(rows)} rows and there are {len(times)} times; give one row between two times"
        )
    return rows


def _count_differences(counts: Any, bits: int | None) -> Array:
    if bits is None:
        return np.asarray(np.diff(counts.astype(np.float64), axis=0))
    width = whole_number(bits, "bits", 2, MOST_BITS)
    steps = np.diff(counts.astype(np.int64).astype(np.uint64), axis=0)
    spare = np.uint64(MOST_BITS - width)
    return np.asarray((steps << spare).astype(np.int64) >> np.int64(spare), dtype=np.float64)
