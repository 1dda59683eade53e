"""Simulated logs: what a robot on a known path would have measured."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array, as_generator, positive_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.localization.checks import suggest_map
from cspace.localization.filters.measurements import see_point
from cspace.localization.filters.rows import follow_rows
from cspace.localization.log import Landmarks, Log, Readings, Scans
from cspace.localization.sensors import LaserScanner, RangeBearing, read_sensor
from cspace.maps import cast_rays
from cspace.math.wrapping import wrap_angle
from cspace.mobile import MotionNoise, Odometry, TimedPoses
from cspace.mobile.noise import read_noise
from cspace.mobile.timed_poses import mark_times
from cspace.spatial import exp_se2, log_se2, pose_2d


def simulate(
    run: Any,
    landmarks: Any,
    sensor: RangeBearing | LaserScanner | None = None,
    *,
    noise: MotionNoise | None = None,
    period: float = 0.5,
    rng: int | np.random.Generator | None = None,
) -> Log:
    """The log of a robot that drove a run: noisy odometry, and what its sensor saw.

    run: anything with times (n,) [s] and poses (n, 3), such as that of navigation.follow. landmarks: those in
    view are read by a RangeBearing; or a grid, which is scanned by a LaserScanner. Measurements come at the
    run's times, every `period` [s], with the biases, deviations and delay of the sensor. The true step is the
    measured one with noise added, as the filters assume. rng: int, Generator or None.
    """
    generator = as_generator(rng)
    if not hasattr(run, "times") or not hasattr(run, "poses"):
        raise InputTypeError(f"run is {name_type(run)}; give what navigation.follow returns")
    truth = TimedPoses(run.times, run.poses)
    if not len(truth):
        raise InputError("the run has no poses; simulate needs one at least")
    odometry = disturb_odometry(Odometry.from_poses(truth.times, truth.poses), read_noise(noise), generator)
    marks = mark_times(truth.times[0], truth.times[-1], positive_number(period, "period"), "period")
    rows = np.unique(np.searchsorted(truth.times, marks))
    times, poses = truth.times[rows], truth.poses[rows]
    if isinstance(landmarks, Landmarks):
        if isinstance(sensor, LaserScanner):
            raise InputTypeError("sensor is a LaserScanner; landmarks are read by a RangeBearing")
        readings = draw_readings(times, poses, landmarks, read_sensor(sensor, RangeBearing), generator)
        return Log(odometry, readings=readings, landmarks=landmarks, truth=truth)
    if not hasattr(landmarks, "to_grid"):
        what = f"landmarks is {name_type(landmarks)}, which is no map"
        raise InputTypeError(f"{what}; {suggest_map(landmarks)}")
    if isinstance(sensor, RangeBearing):
        raise InputTypeError("sensor is a RangeBearing; a grid is scanned by a LaserScanner")
    scans = draw_scans(times, poses, landmarks, read_sensor(sensor, LaserScanner), generator)
    return Log(odometry, scans=scans, truth=truth)


def disturb_odometry(true: Odometry, noise: MotionNoise, rng: np.random.Generator) -> Odometry:
    """Odometry of which the truth is a sample: log(exp(ξ) exp(−w)) with w of the covariance of the step."""
    Q = noise.covariance(true.steps, true.durations)
    values, vectors = np.linalg.eigh(Q)
    scale = np.sqrt(np.maximum(values, 0.0))
    w = np.einsum("nij,nj->ni", vectors, scale * rng.standard_normal(true.steps.shape))
    return Odometry(true.times, log_se2(exp_se2(true.steps) @ exp_se2(-w)))


def draw_readings(
    times: Array, poses: Array, landmarks: Landmarks, sensor: RangeBearing, rng: np.random.Generator
) -> Readings:
    """Readings of all landmarks in view from poses (k, 3) at times (k,)."""
    p = see_point(landmarks.points, poses[:, None], sensor.mount)
    r, b = np.hypot(p[..., 0], p[..., 1]), np.arctan2(p[..., 1], p[..., 0])
    at, which = np.nonzero((r <= sensor.most_range) & (np.abs(b) <= 0.5 * sensor.field_of_view))
    noise = rng.standard_normal((len(at), 2))
    ranges = r[at, which] + sensor.range_bias + sensor.range_sigma * noise[:, 0]
    bearings = b[at, which] + sensor.bearing_bias + sensor.bearing_sigma * noise[:, 1]
    return Readings(times[at] + sensor.delay, landmarks.names[which], np.abs(ranges), wrap_angle(bearings))


def draw_scans(
    times: Array, poses: Array, grid: Any, scanner: LaserScanner, rng: np.random.Generator
) -> Scans:
    """Scans (k, readings) of a grid from poses (k, 3) at times (k,): the beam model, drawn."""
    lasers = follow_rows(poses, np.array(scanner.mount))
    most = scanner.most_range
    walls = cast_rays(grid.to_grid(), lasers[:, None, :2], lasers[:, 2:] + scanner.angles, most)
    none = walls >= most
    ranges = np.where(none, np.inf, np.abs(walls + scanner.range_sigma * rng.standard_normal(walls.shape)))
    kind = rng.choice(4, size=walls.shape, p=scanner.shares)
    # Exponential up to the wall, by the inverse of its distribution.
    share = rng.random(walls.shape)
    before = -np.log1p(share * np.expm1(-scanner.short_rate * walls)) / scanner.short_rate
    ranges = np.select([kind == 1, kind == 2, kind == 3], [before, np.inf, share * most], ranges)
    mount = pose_2d(xytheta=np.array(scanner.mount))
    return Scans(times, ranges.astype(np.float32), scanner.angles, most, mount)
