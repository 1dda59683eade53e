"""Draws the figure of the page on Monte Carlo localisation: `python docs/figures/monte_carlo.py`."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs
from cspace.localization import LaserScanner, simulate

HERE = Path(__file__).parent
DPI = 80


def make_offices() -> cs.OccupancyGrid:
    """A corridor with four offices that look alike at first."""
    blocked = np.zeros((90, 200), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    blocked[50:52] = True
    for k in range(4):
        blocked[50:, 50 * k : 50 * k + 2] = True
        blocked[50:52, 50 * k + 20 : 50 * k + 30] = False
        blocked[75:83, 50 * k + 8 : 50 * k + 16] = True
    blocked[20:28, 60:64] = blocked[8:14, 150:162] = True
    return cs.OccupancyGrid(blocked, 0.1)


def draw_particles() -> None:
    """Before the first scan, after the search of the map, and when the robot has left its office."""
    grid, scanner = make_offices(), LaserScanner(most_range=8.0)
    way = [(7.5, 7.2), (7.5, 3.0), (13.0, 3.0)]
    run = cs.navigation.follow(way, vehicle=cs.Unicycle(), world=grid)
    log = simulate(run, grid, scanner, rng=5)
    pf = cs.ParticleFilter(grid, sensor=scanner, n=1500, rng=3)
    figure, axes = plt.subplots(3, 1, figsize=(7.5, 10.5))
    times = log.scans.times
    draw_panel(axes[0], pf, log.truth.at(times[0]), "before the first scan")
    for k in range(len(times)):
        pf.update(log.scans[k])
        if k == 0:
            draw_panel(axes[1], pf, log.truth.at(times[k]), "after the first scan")
        if k + 1 < len(times):
            pf.predict(log.odometry.between(times[k], times[k + 1]).dead_reckoning().poses[-1])
    draw_panel(axes[2], pf, log.truth.at(times[-1]), "at the end")
    figure.tight_layout()
    figure.savefig(HERE / "monte_carlo.png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def draw_panel(ax, pf, truth, when: str) -> None:
    """The particles, and the true pose as a black triangle."""
    cs.plot.particles(pf, ax=ax)
    ax.plot(
        *truth[:2],
        marker=(3, 0, np.degrees(truth[2]) - 90),
        ms=9,
        mfc="white",
        mec="black",
        mew=1.4,
        zorder=8,
    )
    ax.set_title(f"{when}: {pf.status}, {pf.reason}", fontsize=9, loc="left")


if __name__ == "__main__":
    draw_particles()
