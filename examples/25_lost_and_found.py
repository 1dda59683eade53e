"""A robot follows a path and localises itself on its own map, from anywhere and after it was carried away."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs


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

    cs.plot.save(cs.plot.particles(pf), folder / "particles.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
