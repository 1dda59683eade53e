"""Occupancy grids: where cells lie, what is free, what inflation blocks, and what cannot be a grid."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cspace as cs


def random_blocked(rng, largest=90):
    return rng.random(rng.integers(1, largest, 2)) < rng.uniform(0, 0.6)


def test_cells_come_back_as_they_were_given():
    rng = np.random.default_rng(1)
    for _ in range(50):
        blocked = random_blocked(rng, 200)
        grid = cs.OccupancyGrid(blocked)
        assert grid.shape == blocked.shape
        assert np.array_equal(grid.blocked, blocked)
        assert grid.blocked_cells == blocked.sum()
        assert np.array_equal(cs.OccupancyGrid(blocked.astype(int)).blocked, blocked)
        assert np.array_equal(cs.OccupancyGrid(blocked[::-1, ::-1].T).blocked, blocked[::-1, ::-1].T)


def test_rows_go_up_and_columns_go_right():
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 0, 0]], 0.5, (10, 20))
    assert grid.bounds == (10, 20, 11.5, 21)
    assert grid.cell_of((10.6, 20.1)) == (0, 1)
    assert not grid.is_free((10.75, 20.25))
    assert grid.is_free((10.75, 20.75))
    assert np.array_equal(grid.center_of((1, 2)), (11.25, 20.75))
    assert np.array_equal(grid.center_of([[0, 0], [1, 2]]), [(10.25, 20.25), (11.25, 20.75)])
    assert np.array_equal(grid.origin, (10, 20))
    assert grid.resolution == 0.5


def test_many_points_at_once():
    rng = np.random.default_rng(4)
    grid = cs.OccupancyGrid(random_blocked(rng), 0.5, (-1, 2))
    points = rng.uniform(-5, 50, (4, 30, 2))
    free = grid.is_free(points)
    assert free.shape == (4, 30)
    assert free.dtype == bool
    assert [grid.is_free(point) for point in points.reshape(-1, 2)] == free.ravel().tolist()
    assert grid.is_free(np.empty((0, 2))).shape == (0,)


def test_a_point_on_a_border_is_in_the_free_cell():
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 1, 1]], 0.1)
    assert grid.cell_of((0.1, 0.05)) == (0, 0)
    assert grid.cell_of((0.2, 0.05)) == (0, 2)
    assert grid.cell_of((0.25, 0.1)) == (0, 2)
    assert grid.cell_of((0.3, 0.0)) == (0, 2)
    assert grid.cell_of((0.2, 0.15)) in {(1, 1), (1, 2)}
    assert grid.is_free((0.1, 0.2))
    assert not grid.is_free((0.2, 0.15))
    assert not grid.is_free((0.35, 0.1))
    assert cs.OccupancyGrid(np.zeros((2, 2))).cell_of((1, 1)) == (1, 1)


@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
@settings(max_examples=60, deadline=None)
def test_the_centre_of_a_cell_lies_in_it(seed, resolution, x, y):
    rng = np.random.default_rng(seed)
    blocked = random_blocked(rng)
    grid = cs.OccupancyGrid(blocked, resolution, (x, y))
    for cell in rng.integers(0, blocked.shape, (20, 2)):
        centre = grid.center_of(cell)
        assert grid.cell_of(centre) == tuple(cell)
        assert grid.is_free(centre) == (not blocked[tuple(cell)])


def inflated(blocked, limit, from_centers):
    """Blocked cells, cell by cell: gaps in half cells, their squares summed against a limit."""
    walled = np.pad(blocked, 1, constant_values=True)
    walls = np.argwhere(walled) - 1
    grown = blocked.copy()
    for cell in np.argwhere(~blocked):
        gap = np.maximum(2 * np.abs(walls - cell) - (1 if from_centers else 2), 0)
        grown[tuple(cell)] |= ((gap**2).sum(axis=1) < limit).any()
    return grown


@pytest.mark.slow
@pytest.mark.parametrize("clear", ["cells", "centers"])
def test_inflation_equals_going_over_all_pairs(clear):
    rng = np.random.default_rng(2)
    for _ in range(150):
        blocked = rng.random(rng.integers(1, 80, 2)) < rng.choice([0.002, 0.05, 0.3])
        halves = int(rng.integers(0, 200))  # the square of the radius in half cells
        side = float(rng.choice([1.0, 0.05, 0.3]))
        grid = cs.OccupancyGrid(blocked, side, (0.1, -3))
        grown = grid.inflate(side * np.sqrt(halves) / 2, clear=clear)
        assert np.array_equal(grown.blocked, inflated(blocked, halves, clear == "centers"))
        assert grown.resolution == side
        assert np.array_equal(grown.origin, grid.origin)


def test_inflation_by_a_decimal_radius_is_what_it_says():
    blocked = np.zeros((21, 21), bool)
    blocked[10, 10] = True
    grown = cs.OccupancyGrid(blocked, 0.05).inflate(0.15)
    assert grown.blocked[10, 13]
    assert not grown.blocked[10, 14]
    none = cs.OccupancyGrid(blocked, 0.05).inflate(0.0)
    assert np.array_equal(none.blocked, blocked)


def test_a_radius_of_navigate_keeps_away_from_walls():
    blocked = np.zeros((9, 9), bool)
    blocked[3, :6] = True
    grid = cs.OccupancyGrid(blocked)
    route = cs.navigate(grid, (2.5, 1.5), (2.5, 7.5), planner="a_star", radius=0.9)
    assert route
    assert route.path[:, 0].max() >= 7.5
    wide = cs.navigate(grid, (2.5, 1.5), (2.5, 7.5), planner="a_star", radius=1.0)
    assert wide.status == "found"


def test_inflation_of_large_radii_blocks_all():
    grid = cs.OccupancyGrid(np.zeros((30, 40), bool))
    assert grid.inflate(14.0).blocked_cells == 1200 - 2 * 12
    assert grid.inflate(14.1).blocked_cells == 1200
    assert grid.inflate(100.0).blocked_cells == 1200
    assert grid.inflate(1e12).blocked_cells == 1200


def test_copies_and_pickles_are_the_same():
    rng = np.random.default_rng(3)
    grid = cs.OccupancyGrid(random_blocked(rng), 0.25, (1, 2))
    for other in (copy.copy(grid), copy.deepcopy(grid), pickle.loads(pickle.dumps(grid))):
        assert np.array_equal(other.blocked, grid.blocked)
        assert (other.resolution, other.bounds) == (grid.resolution, grid.bounds)
    assert "cells of 0.25 m" in repr(grid)


def test_a_map_of_64_million_cells():
    blocked = np.zeros((8000, 8000), bool)
    blocked[100::200] = True
    blocked[:, 100::200] = True
    blocked[::200] = False
    blocked[:, ::200] = False
    grid = cs.OccupancyGrid(blocked)
    assert grid.nbytes < 0.26 * blocked.size
    for goal, length in (((250.5, 0.5), 250), ((7999.5, 0.5), 7999)):
        route = cs.navigate(grid, (0.5, 0.5), goal, planner="jump_point_search")
        assert route.length == length
    assert cs.navigate(grid, (0.5, 0.5), (350.5, 90.5), planner="a_star").stats.nodes < 1e5


def test_a_grid_takes_a_quarter_of_a_byte_per_cell():
    grid = cs.OccupancyGrid(np.zeros((2000, 3000), bool))
    assert grid.nbytes < 0.26 * 6e6


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (([0, 1],), ValueError, r"blocked has shape \(2,\), expected \(rows, columns\)"),
        ((np.zeros((0, 3)),), ValueError, r"blocked has shape \(0, 3\)"),
        (([[0, 2]],), ValueError, "blocked contains 2; cells must be 0"),
        (([[0, 0.5]],), ValueError, r"blocked contains 0\.5"),
        (([[0, np.nan]],), ValueError, "blocked contains nan"),
        (([["a"]],), TypeError, "blocked must be boolean"),
        ((object(),), TypeError, "blocked must be boolean"),
        (([[0]], 0), ValueError, "resolution is 0; it must be one positive number"),
        (([[0]], -1.0), ValueError, "resolution is -1"),
        (([[0]], np.nan), ValueError, "resolution"),
        (([[0]], [1, 2]), ValueError, r"resolution has shape \(2,\)"),
        (([[0]], 1, (1, 2, 3)), ValueError, r"origin has shape \(3,\)"),
        (([[0]], 1, (1, np.inf)), ValueError, "origin"),
        (([[0]], 1e-9, (1e6, 0)), ValueError, "cells from the farthest cell"),
    ],
)
def test_what_is_no_grid(arguments, error, message):
    with pytest.raises(error, match=message) as caught:
        cs.OccupancyGrid(*arguments)
    assert isinstance(caught.value, cs.CspaceError)


def test_what_cannot_be_asked():
    grid = cs.OccupancyGrid([[0, 1]])
    with pytest.raises(ValueError, match=r"point \(5, 0\) is outside the grid, which spans x 0 … 2, y 0 … 1"):
        grid.cell_of((5, 0))
    with pytest.raises(ValueError, match=r"point has shape \(1, 2\)"):
        grid.cell_of([(0, 0)])
    with pytest.raises(ValueError, match=r"points has shape \(3,\)"):
        grid.is_free((0, 0, 0))
    with pytest.raises(ValueError, match="radius is -1; it must be zero or more"):
        grid.inflate(-1)
    with pytest.raises(KeyError, match="did you mean 'centers'"):
        grid.inflate(1, clear="center")
    with pytest.raises(TypeError, match="cannot be resampled"):
        grid.to_grid(0.5)
    assert grid.to_grid() is grid
    assert grid.to_grid(1.0) is grid
