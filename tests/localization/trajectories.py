"""Random trajectories with estimates that drift."""

from __future__ import annotations

import numpy as np

import cspace as cs
from cspace.localization import TimedPoses


def planar_pair(rng, n=300, times=None):
    """A winding drive of about 0.1 m per row, and its noisy estimate in another frame."""
    times = np.cumsum(rng.uniform(0.05, 0.15, n)) if times is None else times
    steps = np.column_stack([rng.uniform(0.02, 0.2, n), rng.normal(0, 0.01, n), rng.normal(0, 0.2, n)])
    return TimedPoses(times, chain(steps)), TimedPoses(times, chain(steps + rng.normal(0, 0.02, (n, 3))))


def chain(steps):
    """Poses (n, 3) of steps of twists."""
    T, rows = np.asarray(cs.pose_2d(xytheta=[3.0, -1.0, 2.0])), []
    for step in cs.exp_se2(np.asarray(steps)):
        T = T @ step
        rows.append(cs.to_xytheta(T))
    return np.array(rows)


class Spatial:
    """Poses of space with times, as an answer has them."""

    def __init__(self, times, poses):
        self.times, self.poses = times, poses


def spatial_pair(rng, n=200):
    """The same in space."""
    times = np.cumsum(rng.uniform(0.05, 0.15, n))
    steps = np.concatenate([rng.uniform(0.02, 0.2, (n, 3)), rng.normal(0, 0.2, (n, 3))], axis=1)
    pair = []
    for noisy in (0.0, 0.02):
        T, rows = np.asarray(cs.random_pose(rng=rng)), []
        for step in cs.exp_se3(steps + noisy * rng.normal(size=steps.shape)):
            T = T @ step
            rows.append(T)
        pair.append(Spatial(times, np.array(rows)))
    return pair
