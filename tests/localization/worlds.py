"""A robot on a closed path among landmarks, and logs of it."""

from __future__ import annotations

import numpy as np

import cspace as cs
from cspace.localization import Landmarks, RangeBearing, simulate
from cspace.mobile import Odometry, RandomWalk

NOISE = RandomWalk(distance=1e-3, side=2e-4, turn=2e-3, drift=1e-3, rest=1e-6, rest_turn=1e-6)
SENSOR = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=6.0)


def landmarks(rng):
    points = np.random.default_rng(rng).uniform(-8, 8, size=(25, 2))
    return Landmarks(np.arange(25), points)


def drive(seconds=40.0, dt=0.1):
    """The true poses: an eight."""
    times = np.arange(0.0, seconds, dt)
    turn = 0.5 * np.cos(2 * np.pi * times / seconds)
    twists = np.stack([np.full_like(times, 0.8), np.zeros_like(times), turn], axis=-1)
    return Odometry.from_twists(times, twists).dead_reckoning()


def log_of(seed, seconds=40.0, period=0.5, sensor=SENSOR, noise=NOISE):
    return simulate(drive(seconds), landmarks(7), sensor=sensor, noise=noise, period=period, rng=seed)


def disturbed_start(log, P, seed):
    """A start whose error has the covariance P."""
    xi = np.random.default_rng(seed).multivariate_normal(np.zeros(3), P)
    return cs.to_xytheta(cs.pose_2d(xytheta=log.truth.poses[0]) @ cs.exp_se2(-xi))


def rmse(run, log):
    error = run.at(log.truth.times) - log.truth.poses
    return float(np.sqrt((error[:, :2] ** 2).sum(axis=1).mean()))
