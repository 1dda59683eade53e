"""Draws the figure of the page on SLAM: `python docs/figures/slam.py`."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs
from cspace.localization import LaserScanner, Log, simulate
from cspace.mobile import RandomWalk

HERE = Path(__file__).parent
DPI = 80
INK, BLUE, RED = "#222222", "#1f6fb2", "#c8442f"
TITLES = {"odometry": "odometry", "matched": "matched scans", "closed": "closed loops"}


def make_building() -> cs.OccupancyGrid:
    """A ring of corridors with niches, cells of 10 cm."""
    blocked = np.ones((260, 260), dtype=bool)
    blocked[20:240, 20:240] = False
    blocked[60:200, 60:200] = True
    for k, deep in zip(range(30, 220, 27), (8, 16, 5, 11, 14, 7, 10, 6), strict=True):
        blocked[20 - deep : 20, k : k + 12] = blocked[k : k + 9, 240 : 240 + deep] = False
        blocked[240 : 240 + deep, k + 5 : k + 12] = blocked[k : k + 15, 20 - deep : 20] = False
    return cs.OccupancyGrid(blocked, 0.1)


def draw_stages() -> None:
    """The map at the poses of each stage, with the trajectory."""
    corners = [(4, 4), (22, 4), (22, 22), (4, 22)] * 2 + [(4, 4), (12, 4)]
    run = cs.navigation.follow(corners, vehicle=cs.Unicycle())
    noise = RandomWalk(distance=2e-3, side=5e-4, turn=3e-3, drift=2e-3)
    raw = simulate(run, make_building(), LaserScanner(most_range=15.0), noise=noise, period=0.4, rng=7)
    log = Log(raw.odometry.corrected(distance=1.03, drift=0.01), scans=raw.scans, truth=raw.truth)
    found = cs.slam(log)
    figure, axes = plt.subplots(1, 3, figsize=(11, 4))
    for ax, (stage, title) in zip(axes, TITLES.items(), strict=True):
        built = found.map_at(stage)
        low_x, low_y, high_x, high_y = built.bounds
        ax.imshow(
            built.probability,
            origin="lower",
            extent=(low_x, high_x, low_y, high_y),
            cmap="Greys",
            vmin=0,
            vmax=1,
        )
        poses = found.stages[stage].poses
        ax.plot(poses[:, 0], poses[:, 1], color=BLUE, lw=0.8)
        error = cs.ate(found.stages[stage], log.truth, align="se2").rmse
        ax.set_title(f"{title}: {error:.2f} m", fontsize=10, color=INK)
        ax.set_axis_off()
    for loop in found.loops:
        ends = found.poses[[loop.first, loop.second], :2].T
        axes[2].plot(*ends, color=BLUE if loop.accepted else RED, lw=0.5)
    figure.tight_layout()
    figure.savefig(HERE / "slam.png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)


if __name__ == "__main__":
    draw_stages()
