"""A robot drives through doors by its own estimate: odometry at each step, a scan every half second."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import cspace as cs


class OwnEstimate:
    """Where the robot takes itself to be: the pose of its particle filter, fed by simulated sensors."""

    def __init__(self, grid: cs.OccupancyGrid, start: tuple[float, float, float]) -> None:
        self.grid, self.scanner = grid, cs.LaserScanner(most_range=12.0)
        self.filter = cs.ParticleFilter(grid, sensor=self.scanner, start=start, rng=7)
        self.rng = np.random.default_rng(3)
        self.times, self.poses = [0.0], [np.array(start)]

    def __call__(self, t: float, pose: np.ndarray) -> np.ndarray:
        if t > 0:
            self.times, self.poses = [*self.times, t], [*self.poses, pose]
            step = SimpleNamespace(times=np.array(self.times[-2:]), poses=np.array(self.poses[-2:]))
            log = cs.localization.simulate(step, self.grid, self.scanner, rng=self.rng)
            assert log.odometry is not None
            assert log.scans is not None
            self.filter.predict(log.odometry.dead_reckoning().poses[-1], t - self.times[-2])
            if len(self.times) % 10 == 0:
                self.filter.update(log.scans[len(log.scans) - 1])
        return self.filter.pose


def main(folder: Path) -> None:
    blocked = np.zeros((80, 160), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    blocked[:, 55:57] = blocked[:, 105:107] = True
    blocked[24:42, 55:57] = blocked[40:58, 105:107] = False
    grid = cs.OccupancyGrid(blocked, 0.1)
    way = [(2, 3.3), (8, 3.3), (8, 4.9), (13, 4.9), (13, 2.0)]

    believed = OwnEstimate(grid, (2.0, 3.3, 0.0))
    run = cs.navigation.follow(way, vehicle=cs.Unicycle(), world=grid, tolerance=0.1, estimate=believed)
    off = np.hypot(*(run.believed - run.poses)[:, :2].T)
    print(f"{run.reason}; the estimate was up to {off.max():.2f} m off")
    assert run.status in ("arrived", "missed")
    assert np.hypot(*(run.poses[-1, :2] - way[-1])) < 0.2

    cs.plot.save(cs.plot.particles(believed.filter), folder / "estimate.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
