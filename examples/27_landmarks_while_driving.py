"""A robot drives around a block without a map: it finds the landmarks while they tell it where it is."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace.localization import Landmarks, RangeBearing, run_ekf_slam, run_fast_slam, simulate


def main(folder: Path) -> None:
    # The true drive, and what the robot measured of it: noisy steps, ranges and bearings of what it passes.
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1)], vehicle=cs.Unicycle())
    points = [(3, -1.5), (6, -1.5), (10.5, 1), (10.5, 5), (7, 7.5), (3, 7.5), (-1.5, 5), (-1.5, 1), (4.5, 3)]
    sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=4.0)
    log = simulate(run, Landmarks(np.arange(9), np.array(points)), sensor=sensor, rng=3)
    truth = log.truth
    assert truth is not None
    start = truth.poses[0]

    def rmse(poses: np.ndarray) -> float:
        return float(np.sqrt(np.mean(np.sum((poses - truth.poses)[:, :2] ** 2, axis=1))))

    odometry = rmse(log.odometry.dead_reckoning(start).poses)
    print(f"odometry   : {odometry:.3f} m")
    answers = {
        "invariant": run_ekf_slam(log, sensor=sensor, start=start),
        "plain": run_ekf_slam(log, sensor=sensor, start=start, linearization="plain"),
        "particles": run_fast_slam(log, sensor=sensor, start=start, rng=7),
    }
    for name, found in answers.items():
        assert found.status == "localised"
        error = found.landmarks.points - np.array(points)[found.landmarks.names]
        print(
            f"{name:11s}: {rmse(found.at(truth.times)):.3f} m, {len(found.landmarks)} landmarks within"
            f" {np.hypot(*error.T).max():.3f} m, NIS per dof {found.stats.mean_nis:.2f}"
        )
        assert rmse(found.at(truth.times)) < odometry

    best = answers["invariant"]
    rows = np.column_stack([best.times, best.poses])
    np.savetxt(folder / "drive.csv", rows, fmt="%.4f", delimiter=",", header="time,x,y,theta")
    assert best.landmarks.covariances is not None
    ellipses = np.sqrt(np.linalg.eigvalsh(best.landmarks.covariances))
    print(f"landmarks are known to {ellipses.min():.3f} to {ellipses.max():.3f} m")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
