"""A robot drives past landmarks: its odometry drifts, a Kalman filter and a smoother bring it back."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace.localization import Landmarks, Localization, RangeBearing, simulate


def main(folder: Path) -> None:
    # The true drive: around a rectangle, by the simulator of path following.
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1)], vehicle=cs.Unicycle())

    # What the robot measured of it: noisy steps, and ranges and bearings of four landmarks.
    landmarks = Landmarks(np.arange(4), np.array([[1.5, -1.0], [10.5, 1.0], [8.0, 7.5], [-1.5, 6.0]]))
    sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=3.0)
    log = simulate(run, landmarks, sensor=sensor, rng=3)

    found = cs.localize(log, landmarks, filter="ekf", sensor=sensor)
    assert isinstance(found, Localization)
    past = found.smoothed()
    assert found.status == "localised"
    print(found)

    truth = log.truth
    assert truth is not None

    def rmse(poses: np.ndarray) -> float:
        return float(np.sqrt(np.mean(np.sum((poses - truth.poses)[:, :2] ** 2, axis=1))))

    start = truth.poses[0]
    print(f"odometry : {rmse(log.odometry.dead_reckoning(start).poses):.3f} m")
    print(f"filter   : {rmse(found.at(truth.times)):.3f} m")
    print(f"smoother : {rmse(past.at(truth.times)):.3f} m")
    assert rmse(past.at(truth.times)) < rmse(log.odometry.dead_reckoning(start).poses)

    rows = np.column_stack([found.times, past.poses])
    np.savetxt(folder / "where.csv", rows, fmt="%.4f", delimiter=",", header="time,x,y,theta")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
