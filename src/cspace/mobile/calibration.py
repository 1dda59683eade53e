"""Systematic errors of odometry, from a log with reference poses: scale of distance and turn, drift,
wheels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, one_array, positive_number
from cspace.errors import InputError, check_kind
from cspace.math.wrapping import wrap_angle, wrap_near
from cspace.mobile.noise import RandomWalk
from cspace.mobile.odometry import Odometry
from cspace.mobile.timed_poses import NO_REFERENCE, TimedPoses, mark_times, read_times
from cspace.mobile.wheels import DifferentialDrive
from cspace.tables import one_line, tabulate

Rows = npt.NDArray[np.intp]

FEWEST_WINDOWS: Final = 8
"""Windows below which the three factors and their standard errors are not determined."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Calibration:
    """Factors of a log's odometry that bring it closest to reference poses, by least squares.

    distance: k_d of vx and vy. turn: k_r of ω. drift: k_m [rad/m], the turn of each metre forwards.
    covariance (3, 3) of these three. odometry: the whole log, corrected. noise: a RandomWalk of what is left.
    held_out: the position error (RMSE [m], after the best turn and shift) of dead reckoning over the part
    that was not used, raw and corrected; NaN where all was used. windows: how many stretches were compared.
    """

    distance: float
    turn: float
    drift: float
    covariance: Array
    odometry: Odometry
    noise: RandomWalk
    held_out: tuple[float, float]
    windows: int

    def __repr__(self) -> str:
        raw, corrected = self.held_out
        factors = f"distance {self.distance:.4f}, turn {self.turn:.4f}, drift {self.drift:.4f} rad/m"
        return one_line("Calibration", f"{factors}, held out {raw:.3g} → {corrected:.3g} m")


def calibrate(
    odometry: Odometry,
    reference: TimedPoses,
    *,
    part: float = 0.5,
    window: float | None = None,
    max_gap: float = 5.0,
) -> Calibration:
    """Scale of distance, scale of turn and drift of odometry, from reference poses such as ground truth.

    Over windows of the log: Δθ = k_r Σω dt + k_m Σvx dt, then Δx = k_d Σ R(θ) v dt with the headings found,
    both linear least squares. part: the share of the log that is used, from its start; the rest tests the
    result. window: length of the stretches [s]; unless given, that of WINDOWS whose result, fitted to the
    first half of that share, drifts least over its second half. max_gap: longest gap of the reference to
    interpolate in [s].
    The covariance is that of ordinary least squares. Raises InputError where the two have too little time in
    common, or the robot neither drove nor turned.
    """
    check_kind("odometry", odometry, Odometry, "give cspace.mobile.Odometry, such as log.odometry")
    check_kind("reference", reference, TimedPoses, NO_REFERENCE)
    share = positive_number(part, "part", "it must be above 0 and at most 1", largest=1.0)
    if window is None:
        window = choose_window(odometry, reference, 0.5 * share, max_gap)
    rows, poses = cut_windows(odometry, reference, positive_number(window, "window"), max_gap)
    used, rest = split_rows(odometry, rows, share)
    if len(used) - 1 < FEWEST_WINDOWS:
        raise InputError(
            f"odometry and reference have {max(len(used) - 1, 0)} windows of {window:g} s in common;"
            f" {FEWEST_WINDOWS} are needed: give a longer log, a larger part, or a shorter window"
        )
    factors, covariance = fit_factors(odometry, used, poses)
    corrected = correct_odometry(odometry, factors)
    return Calibration(
        *factors,
        covariance,
        corrected,
        fit_noise(corrected, reference.between(-np.inf, odometry.times[used[-1]]), max_gap),
        (measure_drift(odometry, rest, poses), measure_drift(corrected, rest, poses)),
        len(used) - 1,
    )


WINDOWS: Final = (5.0, 10.0, 20.0, 40.0)
"""Lengths of stretches [s] that are tried: short ones are many, in long ones stamps that jitter weigh
less."""


def choose_window(odometry: Odometry, reference: TimedPoses, share: float, max_gap: float) -> float:
    """The window of WINDOWS whose factors, fitted to a share of the log, drift least over as much after
    it."""
    best, chosen = np.inf, WINDOWS[0]
    for window in WINDOWS:
        rows, poses = cut_windows(odometry, reference, window, max_gap)
        used, rest = split_rows(odometry, rows, share)
        rest = split_rows(odometry, rest, share / (1.0 - share))[0] if len(rest) > 1 else rest
        if len(used) - 1 < FEWEST_WINDOWS or len(rest) < 2:
            continue
        try:
            factors, _ = fit_factors(odometry, used, poses)
        except InputError:
            continue
        drift = measure_drift(correct_odometry(odometry, factors), rest, poses)
        if drift < best:
            best, chosen = drift, window
    return chosen


def split_rows(odometry: Odometry, rows: Rows, share: float) -> tuple[Rows, Rows]:
    """Rows up to a share of the time between the first and the last, and those from there on."""
    if not len(rows):
        return rows, rows
    times = odometry.times[rows]
    count = int(np.searchsorted(times, times[0] + share * (times[-1] - times[0]), side="right"))
    return rows[:count], rows[max(count - 1, 0) :]


def fit_factors(odometry: Odometry, rows: Rows, poses: Array) -> tuple[tuple[float, float, float], Array]:
    """k_d, k_r and k_m of windows between rows, and their covariance (3, 3)."""
    (turn, drift), turn_covariance = fit_turn(odometry, rows, poses)
    distance, variance = fit_distance(odometry.corrected(turn=turn, drift=drift), rows, poses)
    covariance = np.zeros((3, 3))
    covariance[0, 0], covariance[1:, 1:] = variance, turn_covariance
    return (distance, turn, drift), covariance


def correct_odometry(odometry: Odometry, factors: tuple[float, float, float]) -> Odometry:
    """Odometry with k_d, k_r and k_m."""
    return odometry.corrected(distance=factors[0], turn=factors[1], drift=factors[2])


def cut_windows(
    odometry: Odometry, reference: TimedPoses, window: float, max_gap: float
) -> tuple[Rows, Array]:
    """Rows of odometry about `window` apart where the reference is known, and the reference at all rows (n,
    3)."""
    poses = reference.at(odometry.times, max_gap=max_gap)
    known = np.flatnonzero(np.isfinite(poses[:, 0]))
    if not len(known):
        return known, poses
    begin, end = odometry.times[known[0]], odometry.times[known[-1]]
    marks = mark_times(begin, end + window, window, "window")
    chosen = known[np.minimum(np.searchsorted(odometry.times[known], marks), len(known) - 1)]
    return np.unique(chosen), poses


def fit_turn(odometry: Odometry, rows: Rows, poses: Array) -> tuple[tuple[float, float], Array]:
    """k_r and k_m of windows between rows, and their covariance (2, 2)."""
    sums = sum_windows(odometry.steps[:, [2, 0]], rows)
    turned = wrap_near(np.diff(poses[rows, 2]), sums[:, 0])
    found, covariance = solve_least_squares(sums, turned, "turn and drift")
    return (float(found[0]), float(found[1])), covariance


def fit_distance(odometry: Odometry, rows: Rows, poses: Array) -> tuple[float, float]:
    """k_d of windows between rows, for odometry whose headings are right, and its variance."""
    moved = move_windows(odometry, rows)[:, :2]
    wanted = relative_increments(poses[rows])[:, :2]
    found, covariance = solve_least_squares(moved.reshape(-1, 1), wanted.ravel(), "distance")
    return float(found[0]), float(covariance[0, 0])


def solve_least_squares(A: Array, b: Array, what: str) -> tuple[Array, Array]:
    """x of least |A x − b| and its covariance; InputError where the motion does not determine it."""
    if np.linalg.matrix_rank(A) < A.shape[1]:
        raise InputError(f"the drive does not determine {what}; it must contain both distance and turns")
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    rest = b - A @ x
    spread = float(rest @ rest) / max(len(b) - A.shape[1], 1)
    return np.asarray(x, dtype=np.float64), spread * np.linalg.inv(A.T @ A)


def sum_windows(values: Array, rows: Rows) -> Array:
    """Sums of rows of steps between rows of poses, (k − 1, ...)."""
    sums = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
    return np.asarray(np.diff(sums[rows], axis=0))


def move_windows(odometry: Odometry, rows: Rows) -> Array:
    """The increments (k − 1, 3) of odometry between rows."""
    return relative_increments(odometry.dead_reckoning().poses[rows])


def relative_increments(poses: Array) -> Array:
    """The pose of each next row in the last one, (k, 3) → (k − 1, 3)."""
    c, s = np.cos(poses[:-1, 2]), np.sin(poses[:-1, 2])
    dx, dy, turn = np.diff(poses, axis=0).T
    return np.stack([c * dx + s * dy, c * dy - s * dx, wrap_angle(turn)], axis=-1)


def measure_drift(odometry: Odometry, rows: Rows, poses: Array) -> float:
    """RMSE of positions [m] of dead reckoning at rows, after the best turn and shift of it; NaN for fewer
    than
    two."""
    if len(rows) < 2:
        return float("nan")
    reckoned, wanted = odometry.dead_reckoning().poses[rows, :2], poses[rows, :2]
    moved, fixed = (xy[:, 0] + 1j * xy[:, 1] - complex(*xy.mean(axis=0)) for xy in (reckoned, wanted))
    turn = np.vdot(moved, fixed)
    turn /= abs(turn) or 1.0
    return float(np.sqrt((np.abs(fixed - turn * moved) ** 2).mean()))


NOISE_WINDOW: Final = 2.0
"""Seconds of the windows from whose residuals the noise is estimated: short, so that the error of the heading
has not yet become one of the position."""


def fit_noise(odometry: Odometry, reference: TimedPoses, max_gap: float) -> RandomWalk:
    """A random walk with the variances of the residuals in short windows of corrected odometry.

    Squared residuals of heading, length and side are explained by turn, distance and time, with factors that
    are not below zero; where the reference is noisier than the odometry, the floors per second take it up.
    """
    rows, poses = cut_windows(odometry, reference, NOISE_WINDOW, max_gap)
    if len(rows) < FEWEST_WINDOWS:
        return RandomWalk()
    rest = move_windows(odometry, rows) - relative_increments(poses[rows])
    rest[:, 2] = wrap_angle(rest[:, 2])
    sizes = np.stack([odometry.distances, np.abs(odometry.steps[:, 2]), odometry.durations], axis=-1)
    distance, turn, time = sum_windows(sizes, rows).T
    heading = solve_nonnegative(np.stack([turn, distance, time], axis=-1), rest[:, 2] ** 2)
    along = solve_nonnegative(np.stack([distance, time], axis=-1), rest[:, 0] ** 2)
    side = solve_nonnegative(np.stack([distance, time], axis=-1), rest[:, 1] ** 2)
    return RandomWalk(
        distance=float(along[0]),
        side=float(side[0]),
        turn=float(heading[0]),
        drift=float(heading[1]),
        rest=float(max(along[1], side[1])),
        rest_turn=float(heading[2]),
    )


def solve_nonnegative(A: Array, b: Array) -> Array:
    """x ≥ 0 of least |A x − b|, by trying every set of columns; A has three or fewer."""
    best, found = float(b @ b), np.zeros(A.shape[1])
    for count in range(1, A.shape[1] + 1):
        for columns in combinations(range(A.shape[1]), count):
            x = np.linalg.lstsq(A[:, columns], b, rcond=None)[0]
            error = float(((A[:, columns] @ x - b) ** 2).sum())
            if (x >= 0).all() and error < best:
                best, found = error, np.zeros(A.shape[1])
                found[list(columns)] = x
    return found


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class WheelCalibration:
    """A differential drive fitted to a log: vehicle, the radius of each wheel, their covariance.

    vehicle: a DifferentialDrive with the mean radius and the track. radii: of the left and right wheel [m].
    covariance (3, 3) of left radius, right radius and track [m²]. odometry: of the wheels as calibrated.
    """

    vehicle: DifferentialDrive
    radii: tuple[float, float]
    covariance: Array
    odometry: Odometry

    def __repr__(self) -> str:
        left, right = self.radii
        return one_line(
            "WheelCalibration", f"radii {left:.5g}, {right:.5g} m, track {self.vehicle.track:.5g} m"
        )


def calibrate_wheels(
    times: npt.ArrayLike,
    wheels: npt.ArrayLike,
    reference: TimedPoses,
    *,
    window: float = 10.0,
    max_gap: float = 1.0,
) -> WheelCalibration:
    """Radii of the wheels and track of a differential drive, from turns of its wheels and reference poses.

    times (n,) [s]. wheels (n − 1, 2): turns of the left and the right wheel in each step [rad], such as
    wheel_angles makes from ticks. First Δθ = a Σw_l + b Σw_r, with a = −r_l/track and b = r_r/track, then the
    positions are linear in the track. Raises InputError where the drive does not determine them. Source:
    Censi et al. 2013.
    """
    check_kind("reference", reference, TimedPoses, NO_REFERENCE)
    turns = one_array(wheels, "wheels", (None, 2), "turns of the left and the right wheel [rad]")
    unit = Odometry(read_times(times), np.column_stack([turns, np.zeros(len(turns))]))
    rows, poses = cut_windows(unit, reference, positive_number(window, "window"), max_gap)
    if len(rows) - 1 < FEWEST_WINDOWS:
        raise InputError(
            f"wheels and reference have {max(len(rows) - 1, 0)} windows in common, {FEWEST_WINDOWS} needed"
        )
    sums = sum_windows(turns, rows)
    turned = np.diff(np.unwrap(poses[:, 2][np.isfinite(poses[:, 2])]))
    heading = np.full(len(poses), np.nan)
    heading[np.isfinite(poses[:, 2])] = np.concatenate([[0.0], np.cumsum(turned)])
    found, spread = solve_least_squares(sums, np.diff(heading[rows]), "the ratio of radii and track")
    a, b = map(float, found)
    steps = np.stack(
        [0.5 * (b * turns[:, 1] - a * turns[:, 0]), np.zeros(len(turns)), turns @ found], axis=-1
    )
    track, variance = fit_distance(replace(unit, steps=steps), rows, poses)
    if track <= 0 or a >= 0 or b <= 0:
        raise InputError(
            "the wheels turn against the reference; the columns are left, then right, forwards above zero"
        )
    steps[:, :2] *= track
    J = np.array([[-track, 0.0, -a], [0.0, track, b], [0.0, 0.0, 1.0]])
    inner = np.zeros((3, 3))
    inner[:2, :2], inner[2, 2] = spread, variance
    radii = (-a * track, b * track)
    vehicle = DifferentialDrive(0.5 * sum(radii), track)
    return WheelCalibration(vehicle, radii, J @ inner @ J.T, replace(unit, steps=steps))
