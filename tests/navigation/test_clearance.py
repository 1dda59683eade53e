"""How near a path comes to walls: against every pair of a piece of it and a wall, in plain numpy."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from oracles.clearance import nearest, rings_of

YARD = [
    [(2, 2), (5, 2), (5, 5), (2, 5)],
    [(6, 1), (8.5, 1.5), (7, 4)],
    [(1, 6.5), (7.5, 6), (7.5, 7), (1.5, 8)],
]


def least(path, rings):
    """The least distance between a polyline that crosses no ring and rings: the ends of one piece, or of the
    other, are the nearest."""
    path = np.asarray(path, dtype=float)
    corners = np.concatenate(rings)
    ways = [np.stack([a, b]) for a, b in pairwise(path)]
    there = min(nearest(path, rings)[0])
    back = min((min(nearest(corners, [way])[0]) for way in ways if np.ptp(way, axis=0).any()), default=np.inf)
    return min(there, back)


def squares_of(grid):
    """The outlines of blocked cells, and the border of the grid."""
    corner = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    cells = np.argwhere(grid.blocked)[:, ::-1]
    whole = corner * np.array(grid.shape)[::-1]
    return [grid.origin + grid.resolution * ring for ring in [whole, *(cell + corner for cell in cells)]]


@pytest.mark.parametrize("planner", sorted(cs.navigation.PLANNERS))
def test_clearance_of_every_planner_in_polygons(planner):
    world = cs.PolygonWorld(YARD, bounds=(0, 0, 10, 10))
    route = cs.navigate(world, (1, 1), (9, 9), planner)
    assert route.clearance == pytest.approx(least(route.path, rings_of(world)), abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_clearance_over_cells(seed):
    rng = np.random.default_rng(seed)
    grid = cs.OccupancyGrid(rng.random((40, 90)) < 0.12, resolution=0.25, origin=(-3, 2))
    for planner in ("voronoi", "brushfire", "a_star", "theta_star", "any_angle"):
        cells = np.argwhere(~grid.blocked)
        start, goal = grid.center_of(cells[rng.integers(len(cells), size=2)])
        route = cs.navigate(grid, start, goal, planner)
        if route:
            assert route.clearance == pytest.approx(least(route.path, squares_of(grid)), abs=1e-12)
        else:
            assert np.isnan(route.clearance)


def test_a_grid_and_its_polygons_agree():
    rng = np.random.default_rng(3)
    blocked = np.zeros((300, 500), bool)
    blocked[rng.integers(300, size=40), rng.integers(500, size=40)] = True
    grid = cs.OccupancyGrid(blocked, resolution=0.1, origin=(5, -7))
    world = cs.PolygonWorld.from_grid(grid)
    for path in 5 + np.array((50, 30)) * rng.random((50, 3, 2)) - np.array((0, 12)):
        assert grid.path_clearance(path) == pytest.approx(world.path_clearance(path), abs=1e-10)


def test_paths_that_touch_cross_or_lie_in_walls_have_none():
    world = cs.PolygonWorld(YARD, bounds=(0, 0, 10, 10))
    grid = world.to_grid(0.5)
    for path in ([(1, 3), (9, 3)], [(3, 3), (4, 4)], [(2, 1), (2, 6)], [(-5, 1), (-4, 1)], [(2, 2)]):
        assert world.path_clearance(path) == 0 == grid.path_clearance(path)
    assert np.isnan(world.path_clearance(np.empty((0, 2))))
    with pytest.raises(InputError, match=r"path has shape \(2,\), expected \(n, 2\)"):
        world.path_clearance((1, 2))


def test_clearance_is_that_of_the_world_that_was_asked():
    world = cs.PolygonWorld(YARD, bounds=(0, 0, 10, 10))
    disc = cs.navigate(world, (1, 1), (9, 9), radius=0.3)
    assert disc.clearance == pytest.approx(0.3, abs=1e-9)
    assert disc.world.path_clearance(disc.path) == pytest.approx(0, abs=1e-9)
    over_cells = cs.navigate(world, (1, 1), (9, 9), "a_star", resolution=0.5)
    assert over_cells.clearance >= over_cells.world.path_clearance(over_cells.path)
