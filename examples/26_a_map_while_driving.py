"""A robot drives through a building that it does not know: scan matching and loops make the map."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace.localization import LaserScanner, LaserSlam, simulate


def main(folder: Path) -> None:
    # A ring of corridors with niches at irregular places, cells of 10 cm.
    blocked = np.ones((200, 200), dtype=bool)
    blocked[20:180, 20:180] = False
    blocked[55:145, 55:145] = True
    for k, deep in zip(range(30, 170, 22), (8, 16, 5, 11, 14, 7, 10), strict=True):
        blocked[20 - deep : 20, k : k + 12] = blocked[k : k + 9, 180 : 180 + deep] = False
        blocked[180 : 180 + deep, k + 5 : k + 12] = blocked[k : k + 15, 20 - deep : 20] = False
    grid = cs.OccupancyGrid(blocked, 0.1)

    # The log: odometry that drifts, and scans.
    way = [(3.7, 3.7), (16.3, 3.7), (16.3, 16.3), (3.7, 16.3), (3.7, 3.7), (9, 3.7)]
    run = cs.navigation.follow(way, vehicle=cs.Unicycle())
    log = simulate(run, grid, LaserScanner(most_range=12.0), period=0.4, rng=7)
    assert log.truth is not None
    assert log.scans is not None

    # One scan against another: where it was taken, with a covariance.
    match = cs.match_scan(log.scans[1], log.scans[0])
    print(match)

    # The whole log.
    found = cs.slam(log)
    assert isinstance(found, LaserSlam)
    assert found
    print(found)
    for name, stage in found.stages.items():
        print(f"{name:10} {cs.ate(stage, log.truth, align='se2').rmse:.3f} m")
    print(f"{found.stats.accepted} loops accepted, {found.stats.rejected} rejected")

    # The map serves planning and localisation.
    print(found.map, found.map.to_grid())
    axes = cs.plot.world(found.map)[0].axes
    axes.plot(*found.poses[:, :2].T)
    axes.figure.savefig(folder / "building.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
