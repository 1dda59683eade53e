"""Draws the figures of the page on cars: `python docs/figures/cars.py` writes them here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs

HERE = Path(__file__).parent


def car_park() -> cs.OccupancyGrid:
    """Two rows of parked cars with a lane between them, and one free place: 40 × 20 m, cells of 0.2 m."""
    blocked = np.zeros((100, 200), dtype=bool)
    blocked[[0, -1], :] = blocked[:, [0, -1]] = True
    for k in range(13):
        left = 5 + 15 * k
        for low in (3, 70):
            if (k, low) != (8, 70):
                blocked[low : low + 24, left + 2 : left + 12] = True
    return cs.OccupancyGrid(blocked, resolution=0.2)


def rooms() -> cs.OccupancyGrid:
    """Four rooms with doors, a table in one of them: 12 × 8 m, cells of 0.1 m."""
    blocked = np.zeros((80, 120), dtype=bool)
    blocked[[0, -1], :] = blocked[:, [0, -1]] = True
    blocked[:, 58:61] = blocked[40:42, :] = True
    blocked[14:24, 58:61] = blocked[55:66, 58:61] = False
    blocked[40:42, 22:33] = blocked[40:42, 85:97] = False
    blocked[12:26, 80:98] = True
    return cs.OccupancyGrid(blocked, resolution=0.1)


def curves() -> None:
    """The shortest curve of each kind to the same pose."""
    figure, axes = plt.subplots(
        *(1, 2), figsize=(8.6, 3.4), dpi=110, layout="constrained", sharex=True, sharey=True
    )
    start, goal = (0.0, 0.0, 0.0), (0.5, 1.5, np.pi)
    for ax, shortest in zip(axes, (cs.navigation.dubins, cs.navigation.reeds_shepp), strict=True):
        artists = cs.plot.drive(shortest(start, goal, radius=1.0), ax=ax)
        artists[-1].set_text(f"{shortest.__name__}: {artists[-1].get_text()}")
    cs.plot.save(figure, HERE / "curves.png")


def main() -> None:
    curves()
    park = car_park()
    route = cs.navigation.hybrid_a_star(park, (3.0, 10.0, 0.0), (26.6, 17.5, -np.pi / 2), radius=5.0)
    figure, ax = plt.subplots(figsize=(8.6, 4.8), dpi=110, layout="constrained")
    cs.plot.drive(route, ax=ax)
    cs.plot.save(figure, HERE / "parking.png")

    home = rooms()
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 3.7), dpi=110, layout="constrained")
    way = cs.navigate(home, (1, 1), (11, 7), radius=0.3)
    clutter = home.blocked.copy()
    clutter[12:19, 36:42] = clutter[48:56, 90:97] = True
    cluttered = cs.OccupancyGrid(clutter, resolution=0.1)
    run = cs.navigation.follow(way, "dynamic_window", world=cluttered)
    cs.plot.world(cluttered, ax=axes[0])
    axes[0].plot(*way.path.T, "--", color="0.5", linewidth=1.2)
    cs.plot.drive(run, ax=axes[0])
    cs.plot.coverage(cs.navigation.coverage(home, (1, 1), width=0.5), ax=axes[1])
    cs.plot.save(figure, HERE / "rooms.png")


if __name__ == "__main__":
    main()
