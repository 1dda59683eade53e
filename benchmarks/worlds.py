"""Worlds of the plane for the benchmarks of navigation: convex fields, and the maps of N. Sturtevant."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
from chains import Array

DATA = Path(os.environ.get("CSPACE_DATA", "../shared/data")) / "navigation"
FOLDER = DATA / "grid"
SIDE = 100.0


def convex_field(corners: int, rng: np.random.Generator) -> list[Array]:
    """Disjoint convex hexagons (6, 2), counter-clockwise, one in each cell of a raster: `corners` in all."""
    count = corners // 6
    columns = int(np.ceil(np.sqrt(count)))
    cell = SIDE / columns
    obstacles = []
    for k in range(count):
        centre = (np.array([k % columns, k // columns]) + 0.5) * cell
        angles = np.sort(rng.uniform(0, 2 * np.pi, 6))
        radius = rng.uniform(0.25, 0.48) * cell
        obstacles.append(centre + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    return obstacles


def ends_in(world: Any, count: int, rng: np.random.Generator) -> list[tuple[Array, Array]]:
    """Pairs of free points (2,), far enough inside that every contender takes them."""
    grown = world.inflate(0.05)
    points: list[Array] = []
    while len(points) < 2 * count:
        point = rng.uniform(0.5, SIDE - 0.5, 2)
        if grown.is_free(point):
            points.append(point)
    return list(zip(points[::2], points[1::2], strict=True))


def grid(name: str) -> Any:
    """A map of the benchmarks of N. Sturtevant."""
    return cs.OccupancyGrid.from_movingai(FOLDER / f"{name}.map")


def lines(name: str) -> Any:
    """Its scenario lines: cells of start and goal (n, 2) as (column, row), and printed lengths (n,)."""
    return cs.maps.read_scenarios(FOLDER / f"{name}.map.scen")


def centres(of: Any) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Start and goal of each line in the plane of a map with cells of one metre."""
    return [
        (tuple(map(float, a + 0.5)), tuple(map(float, b + 0.5)))
        for a, b in zip(of.start, of.goal, strict=True)
    ]
