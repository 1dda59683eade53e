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


def fields() -> None:
    """Three fields that robots go down, as surfaces."""
    import matplotlib.pyplot as plt

    sheds = [
        [(2, 2), (5, 2), (5, 5), (2, 5)],
        [(6, 1), (8.5, 1.5), (7, 4)],
        [(1, 6.5), (7, 6), (7, 7), (1.5, 8)],
    ]
    hook = [(3, 3), (7, 3), (7, 8), (3, 8), (3, 7.4), (6.4, 7.4), (6.4, 3.6), (3, 3.6)]
    trap = cs.PolygonWorld([hook], (0, 0, 10, 10))
    yard = cs.PolygonWorld(sheds, (0, 0, 10, 10))
    start, goal = (1.5, 5.7), (8.8, 5.4)
    routes = [
        cs.navigate(trap, start, goal, "potential_field", rho_0=1.0),
        cs.navigate(yard, (1, 1), (8.8, 8.8), "rimon_koditschek"),
        cs.navigate(trap, start, goal, "harmonic", resolution=0.1),
    ]
    figure = plt.figure(figsize=(13.5, 4.6), dpi=120)
    for k, route in enumerate(routes):
        box = (0.005 + 0.333 * k, 0.03, 0.32, 0.91)
        cs.plot.surface(route, ax=figure.add_axes(box, projection="3d"))
    cs.plot.save(figure, HERE / "fields.png", dpi=75)


def noise() -> None:
    """One walk by a sensor without noise, with a little and with much."""
    walks = [
        cs.navigate(yard(), (2, 30), (98, 42), "voronoi_bug", range=20.0, noise=share * 20, rng=1)
        for share in (0, 0.02, 0.1)
    ]
    figure = cs.plot.routes(walks, columns=3)
    for axes, share in zip(figure.axes, ("no noise", "2 % of the range", "10 % of the range"), strict=False):
        axes.set_title(share, loc="left", fontsize="small")
    cs.plot.save(figure, HERE / "noise.png", dpi=75)


def main() -> None:
    fields()
    noise()
    world = yard()
    routes = [cs.navigate(world, (2, 30), (98, 42), planner) for planner in cs.navigation.PLANNERS]
    cs.plot.save(cs.plot.routes(routes, columns=7), HERE / "planners.png", dpi=75)


if __name__ == "__main__":
    main()
