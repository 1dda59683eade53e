"""A robot localises itself on its own map: from anywhere, after it was carried away, and to steer by it."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import cspace as cs


class OwnEstimate:
    """Where the robot takes itself to be: its odometry at each step, a scan every half a second."""

    def __init__(self, grid: cs.OccupancyGrid, scanner: cs.LaserScanner, start: np.ndarray) -> None:
        self.grid, self.scanner = grid, scanner
        self.filter = cs.ParticleFilter(grid, sensor=scanner, start=start, rng=7)
        self.rng = np.random.default_rng(3)
        self.times, self.poses = [0.0], [start]

    def __call__(self, t: float, pose: np.ndarray) -> np.ndarray:
        if t > 0:
            step = SimpleNamespace(
                times=np.array([self.times[-1], t]), poses=np.array([self.poses[-1], pose])
            )
            log = cs.localization.simulate(step, self.grid, self.scanner, rng=self.rng)
            assert log.odometry is not None
            assert log.scans is not None
            self.filter.predict(log.odometry.dead_reckoning().poses[-1], t - self.times[-1])
            if len(self.times) % 10 == 0:
                self.filter.update(log.scans[len(log.scans) - 1])
            self.times.append(t)
            self.poses.append(pose)
        return self.filter.pose


def main(folder: Path) -> None:
    # The map: three rooms with a cupboard and a table, cells of 10 cm.
    blocked = np.zeros((80, 160), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    blocked[:, 55:57] = blocked[:, 105:107] = True
    blocked[24:42, 55:57] = blocked[40:58, 105:107] = False
    blocked[60:75, 20:28] = blocked[10:18, 70:84] = blocked[64:72, 136:150] = True
    grid = cs.OccupancyGrid(blocked, 0.1)

    # The robot drives through the doors; odometry and scans are what it measured on the way.
    way = [(2, 3.3), (8, 3.3), (8, 4.9), (13, 4.9), (13, 2.0)]
    run = cs.navigation.follow(way, vehicle=cs.Unicycle(), world=grid)
    scanner = cs.LaserScanner(most_range=12.0)
    log = cs.localization.simulate(run, grid, scanner, rng=7)
    assert log.truth is not None
    assert log.scans is not None

    # From anywhere: the first scan is searched on the whole map.
    found = cs.localize(log, grid, filter="mcl", sensor=scanner, rng=7)
    error = np.hypot(*(found.at(log.truth.times) - log.truth.poses)[:, :2].T)
    print(found)
    print(f"error: median {np.median(error):.3f} m, at the end {error[-1]:.3f} m")
    assert found
    assert error[-1] < 0.2

    # Carried away: the filter believes in the start, and the scans come from the end.
    pf = cs.ParticleFilter(grid, sensor=scanner, start=log.truth.poses[0], rng=7)
    for _ in range(5):
        pf.update(log.scans[0])
    for k in range(len(log.scans) - 8, len(log.scans)):
        pf.update(log.scans[k])
        at = log.truth.at(log.scans.times[k])
        print(f"scan {k}: {pf.status}, {np.hypot(*(pf.pose - at)[:2]):.2f} m off, {len(pf.modes)} modes")
        if k + 1 < len(log.scans):
            steps = log.odometry.between(log.scans.times[k], log.scans.times[k + 1]).dead_reckoning()
            pf.predict(steps.poses[-1])
    assert pf.status == "localised"
    assert any(event.kind == "search" for event in pf.events)

    # By its own estimate: the robot is steered from where its filter takes it to be.
    own = cs.navigation.follow(
        way,
        vehicle=cs.Unicycle(),
        world=grid,
        tolerance=0.1,
        estimate=OwnEstimate(grid, scanner, run.poses[0]),
    )
    off = np.hypot(*(own.believed - own.poses)[:, :2].T)
    print(f"{own.reason}; the estimate was up to {off.max():.2f} m off")
    assert own.status in ("arrived", "missed")
    assert np.hypot(*(own.poses[-1, :2] - way[-1])) < 0.2

    cs.plot.save(cs.plot.particles(pf), folder / "particles.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
