"""A robot maps a room with its laser, and finds itself on the map without knowing where it is."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace.localization import Scans, search_pose


def main(folder: Path) -> None:
    # A room with a pillar and a niche, and a drive through it.
    blocked = np.zeros((120, 160), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = blocked[50:70, 60:75] = blocked[:40, 110:115] = True
    room = cs.OccupancyGrid(blocked, resolution=0.05)
    run = cs.navigation.follow([(1, 1), (5, 1), (5, 5), (1, 5), (1, 2)], vehicle=cs.Unicycle())

    # Scans of 181 beams from every tenth pose, with noise.
    rng = np.random.default_rng(3)
    times, poses = run.times[::10], run.poses[::10]
    angles = np.linspace(-np.pi / 2, np.pi / 2, 181)
    ranges = cs.maps.cast_rays(room, poses[:, None, :2], poses[:, 2:] + angles)
    scans = Scans(times, ranges + rng.normal(0.02, 0.01, ranges.shape), angles)

    # The map of all scans but one, and that one on the map.
    held_out = len(scans) // 2
    others = np.arange(len(scans)) != held_out
    evidence = cs.maps.EvidenceGrid.from_scans(scans.subset(others), poses[others], resolution=0.05)
    modes = search_pose(scans.points(held_out), evidence.likelihood_field(), free=~evidence.to_grid().blocked)
    print(evidence)
    print(modes, modes.poses[0].round(2), "true", poses[held_out].round(2))
    assert np.hypot(*(modes.poses[0] - poses[held_out])[:2]) < 0.1

    route = cs.navigate(evidence.to_grid(), poses[0, :2], (7.0, 5.0), planner="a_star", radius=0.2)
    print(route)
    assert route
    axes = cs.plot.world(evidence)[0].axes
    axes.plot(*route.path.T)
    axes.figure.savefig(folder / "room.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
