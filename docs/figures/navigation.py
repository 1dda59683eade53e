"""Draws the figure of the page on navigation: `python docs/figures/navigation.py` writes it here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np

import cspace as cs

HERE = Path(__file__).parent
TRAP = [(30, 2), (34, 2), (34, 60), (70, 60), (70, 20), (74, 20), (74, 64), (30, 64)]


def yard() -> cs.PolygonWorld:
    """Convex sheds, one in each cell of a raster, and a trap among them."""
    rng = np.random.default_rng(5)
    obstacles = [TRAP]
    for k in range(25):
        center = 20.0 * (np.array([k % 5, k // 5]) + 0.5)
        angles = np.sort(rng.uniform(0, 2 * np.pi, 6))
        radius = 20.0 * rng.uniform(0.2, 0.4)
        obstacles.append(center + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    return cs.PolygonWorld(obstacles, bounds=(0, 0, 100, 100))


def main() -> None:
    world = yard()
    routes = [cs.navigate(world, (2, 30), (98, 42), planner) for planner in cs.navigation.PLANNERS]
    cs.plot.save(cs.plot.routes(routes), HERE / "planners.png", dpi=75)


if __name__ == "__main__":
    main()
