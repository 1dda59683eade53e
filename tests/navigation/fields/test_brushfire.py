"""Brushfire: distances against all pairs, the diagram against the widest ways there are, hard worlds."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy import ndimage

import cspace as cs
from cspace.navigation import brushfire_diagram
from oracles import grids

SIDES = [[0, 1, 0], [1, 1, 1], [0, 1, 0]]


def random_grid(rng):
    rows, columns = rng.integers(1, 20, 2)
    blocks = rng.random((rows, columns)) < rng.uniform(0, 0.55)
    side = int(rng.integers(1, 4))
    return np.kron(blocks, np.ones((side, side))).astype(bool)[:24, :24]


def gaps(blocked):
    """From the centre of each free cell to the nearest blocked square or the border, by all pairs."""
    walled = np.argwhere(np.pad(blocked, 1, constant_values=True)) - 1
    found = np.zeros(blocked.shape)
    for cell in np.argwhere(~blocked):
        away = np.maximum(np.abs(walled - cell) - 0.5, 0)
        found[tuple(cell)] = np.hypot(*away.T).min()
    return found


def widest(clearance, blocked, start, goal):
    """The greatest clearance at which cells of no less join start and goal along sides; None if none does."""
    levels = np.unique(clearance[~blocked])
    joined = [
        level
        for level in levels
        if (part := ndimage.label(clearance >= level, SIDES)[0])[start] and part[start] == part[goal]
    ]
    return max(joined, default=None)


def test_clearance_is_that_of_all_pairs():
    rng = np.random.default_rng(1)
    for _ in range(60):
        blocked = random_grid(rng)
        made = brushfire_diagram(cs.OccupancyGrid(blocked, 0.25))
        assert np.abs(made.clearance - 0.25 * gaps(blocked)).max() <= 1e-15
        assert ((made.labels < 0) == blocked).all()


def test_the_diagram_has_the_parts_and_the_holes_of_free_space():
    rng = np.random.default_rng(2)
    for _ in range(150):
        blocked = random_grid(rng)
        diagram = brushfire_diagram(cs.OccupancyGrid(blocked)).cells
        assert not (diagram & blocked).any()
        free, count = ndimage.label(~blocked, SIDES)
        parts = ndimage.label(diagram, SIDES)[1]
        assert parts == count
        assert len(np.unique(free[diagram])) == count
        holes = ndimage.label(np.pad(blocked, 1, constant_values=True), np.ones((3, 3)))[1]
        around = ndimage.label(np.pad(~diagram, 1, constant_values=True), np.ones((3, 3)))[1]
        assert around == holes


def test_it_arrives_where_cells_join_and_no_way_is_wider():
    rng = np.random.default_rng(3)
    found = 0
    for _ in range(150):
        blocked = random_grid(rng)
        free = np.argwhere(~blocked)
        if not len(free):
            continue
        grid = cs.OccupancyGrid(blocked, 0.5, (3, -1))
        clearance = brushfire_diagram(grid).clearance
        for _ in range(3):
            start, goal = (tuple(map(int, c)) for c in free[rng.integers(len(free), size=2)])
            ends = grid.center_of(start), grid.center_of(goal)
            best = widest(clearance, blocked, start, goal)
            route = cs.navigate(grid, *ends, planner="brushfire")
            shorter = cs.navigate(grid, *ends, planner="brushfire", prefer="length")
            assert bool(route) == bool(shorter) == (best is not None)
            if not route:
                assert route.status == "unreachable"
                assert "no path to the goal" in route.reason
                continue
            found += 1
            assert route.evidence["least_clearance"] >= best
            cells = [grid.cell_of(point) for point in route.path]
            length = grids.walked(blocked, cells)
            assert length is not None
            assert abs(0.5 * length - route.length) <= 1e-9
    assert found > 100


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5, 8])
def test_corridors_have_one_line_in_the_middle(width):
    grid = cs.OccupancyGrid(np.zeros((width, 50), bool))
    made = brushfire_diagram(grid)
    assert (made.cells[:, width:-width].sum(axis=0) == 1).all()
    assert (made.clearance[made.cells][width:-width] >= (width - 1) / 2).all()
    ends = grid.center_of((0, 0)), grid.center_of((width - 1, 49))
    assert cs.navigate(grid, *ends, planner="brushfire")


def test_a_maze_of_one_connected_wall_has_a_diagram():
    blocked = np.zeros((21, 31), bool)
    blocked[:-5, 5::10] = True
    blocked[5:, 10::10] = True
    made = brushfire_diagram(cs.OccupancyGrid(blocked))
    assert ndimage.label(np.pad(blocked, 1, constant_values=True))[1] == 1
    assert ndimage.label(made.cells, SIDES)[1] == 1
    assert made.cells.any(axis=0)[2:-2].all()


def test_a_single_obstacle_is_walked_around_in_the_middle():
    blocked = np.zeros((31, 31), bool)
    blocked[10:21, 10:21] = True
    grid = cs.OccupancyGrid(blocked)
    made = brushfire_diagram(grid)
    assert ndimage.label(~made.cells)[1] >= 2  # the diagram closes around it
    route = cs.navigate(grid, (0.5, 15.5), (30.5, 15.5), planner="brushfire")
    clearance = [made.clearance[grid.cell_of(p)] for p in route.path[2:-2]]
    assert min(clearance) >= 4


def test_no_way_squeezes_between_cells_that_touch_in_a_corner():
    blocked = ~np.eye(2, dtype=bool)
    route = cs.navigate(cs.OccupancyGrid(blocked), (0.5, 0.5), (1.5, 1.5), planner="brushfire")
    assert route.status == "unreachable"


def test_branches_join_where_they_say():
    blocked = np.zeros((21, 31), bool)
    blocked[8:13, 8:13] = blocked[8:13, 18:23] = True
    made = brushfire_diagram(cs.OccupancyGrid(blocked, 0.5))
    assert len(made.ends) == len(made.lengths) == len(made.widths) > 0
    for ends, width in zip(made.ends, made.widths, strict=True):
        for cell in (tuple(ends[:2]), tuple(ends[2:])):
            assert made.cells[cell]
            assert made.clearance[cell] >= width
    steps = sum(int((made.cells & np.roll(made.cells, 1, axis)).sum()) for axis in (0, 1))
    assert made.lengths.sum() == 0.5 * steps


def test_the_trace_burns_outwards_and_ends_in_the_diagram():
    rng = np.random.default_rng(4)
    blocked = random_grid(rng)
    grid = cs.OccupancyGrid(blocked, 0.5)
    cell = np.argwhere(~blocked)[0]
    trace = cs.navigate(grid, grid.center_of(cell), grid.center_of(cell), planner="brushfire").trace
    burn = trace.only("burn")
    assert len(burn) == (~blocked).sum()
    assert all(a <= b for a, b in pairwise(burn.value))
    assert np.abs(np.hypot(*(burn.end - burn.start).T) - burn.value).max() <= 1e-12
    kept = len(trace.only("meet")) + len(trace.only("keep"))
    assert kept == brushfire_diagram(grid).cells.sum()


def test_what_it_refuses():
    grid = cs.OccupancyGrid([[0, 1, 0]])
    with pytest.raises(KeyError, match="prefer"):
        cs.navigate(grid, (0.5, 0.5), (2.5, 0.5), planner="brushfire", prefer="clear")
    with pytest.raises(ValueError, match="which is blocked"):
        cs.navigate(grid, (1.5, 0.5), (2.5, 0.5), planner="brushfire")
    with pytest.raises(TypeError, match="OccupancyGrid"):
        brushfire_diagram(cs.PolygonWorld([]))
