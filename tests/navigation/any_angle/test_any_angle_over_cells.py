"""The shortest path over grids of many corners: through runs of cells, read where it comes to them."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from data import shared_data
from oracles.segments import enters

any_angle = cs.navigation.AnyAngle()

NOISE = (500, 400)
"""A grid of random cells with so many corners that no polygons are made of it."""


def noise(rng, shape=NOISE, share=0.35, **frame):
    return cs.OccupancyGrid(rng.random(shape) < share, **frame)


def corners_of(blocked):
    """Points between four cells where not all are alike in pairs; beyond the border all is blocked."""
    wide = np.pad(blocked, 1, constant_values=True)
    a, b, c, d = wide[:-1, :-1], wide[:-1, 1:], wide[1:, :-1], wide[1:, 1:]
    return int((((a != b) | (c != d)) & ((a != c) | (b != d))).sum())


def test_corners_are_counted():
    rng = np.random.default_rng(1)
    for shape in ((1, 1), (3, 61), (3, 62), (3, 63), (3, 64), (65, 130), (20, 7)):
        blocked = rng.random(shape) < 0.4
        assert cs.OccupancyGrid(blocked).corners == corners_of(blocked)


@pytest.mark.slow
@pytest.mark.data
@pytest.mark.parametrize("name", ["arena", "brc202d", "AcrosstheCape"])
def test_every_line_of_the_grids(name):
    folder = shared_data() / "navigation"
    grid = cs.OccupancyGrid.from_movingai(folder / f"grid/{name}.map")
    lines = (folder / f"grid/{name}.map.scen").read_text().splitlines()[1:]
    ends = np.array([line.split()[4:8] for line in lines if line.strip()], float)
    truth = np.loadtxt(folder / f"mesh/anyangle_{name}.txt")
    found = np.array([any_angle.plan(grid, row[:2], row[2:]).length for row in ends])
    digits = np.where(truth < 1000, 6e-10, 6e-9)  # as many as the file has
    assert np.all(np.abs(found - truth) <= digits)


def test_grids_of_many_corners_are_searched_as_they_are_and_agree_with_their_polygons():
    rng = np.random.default_rng(2)
    grid = noise(rng, resolution=0.05, origin=(-3.0, 0.7))
    assert any_angle.takes_grid(grid)
    polygons = cs.PolygonWorld.from_grid(grid)
    verdicts = set()
    for cells in rng.integers(0, NOISE, (60, 2, 2)):
        start, goal = grid.center_of(cells) + rng.uniform(-0.02, 0.02, 2)
        if not (grid.is_free(start) and grid.is_free(goal)):
            continue
        route, other = cs.navigate(grid, start, goal), cs.navigate(polygons, start, goal)
        assert route.world is grid
        assert route.status == other.status
        assert route.reason
        verdicts.add(route.status)
        if route:
            assert route.length == pytest.approx(other.length, rel=1e-12)
            np.testing.assert_array_equal(route.path[[0, -1]], [start, goal])
    assert verdicts == {"found", "unreachable"}


def test_paths_keep_out_of_blocked_cells():
    rng = np.random.default_rng(3)
    grid = noise(rng, (24, 20), 0.3)
    polygons = cs.PolygonWorld.from_grid(grid)
    found = 0
    for cells in rng.integers(0, (24, 20), (40, 2, 2)):
        start, goal = grid.center_of(cells)
        if grid.is_free(start) and grid.is_free(goal) and (route := any_angle.plan(grid, start, goal)):
            assert enters(route.path, polygons.obstacles, polygons.bounds) is None
            found += 1
    assert found > 5


def test_the_search_can_be_seen_again():
    grid = noise(np.random.default_rng(4))
    start, goal = (grid.center_of(np.argwhere(~grid.blocked)[k]) for k in (0, 700))
    route = cs.navigate(grid, start, goal)
    events = route.trace.only("see")
    assert len(events) > 0
    xmin, ymin, xmax, ymax = grid.bounds
    assert np.all((events.end >= (xmin, ymin)) & (events.end <= (xmax, ymax)))
    assert np.all(np.diff(events.value) >= -1e-9)


def test_ends_on_the_sides_of_cells():
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 0, 0]], resolution=0.1)
    for x in (0.1, 0.1 + 1e-11, 0.1 - 1e-17):
        assert any_angle.plan(grid, (x, 0.05), (0.2, 0.05)).length == pytest.approx(0.2, abs=1e-10)
    with pytest.raises(ValueError, match="start"):
        any_angle.plan(grid, (0.15, 0.05), (0.25, 0.05))
    with pytest.raises(ValueError, match="goal"):
        any_angle.plan(grid, (0.05, 0.05), (0.35, 0.05))


def test_a_goal_that_is_shut_in_is_told_without_a_flood():
    blocked = np.zeros((400, 500), bool)
    blocked[100:150, 100] = blocked[100:150, 149] = blocked[100, 100:150] = blocked[149, 100:150] = True
    grid = cs.OccupancyGrid(blocked)
    ends = (5.5, 5.5), (120.5, 120.5)
    for planner in ("a_star", "dijkstra", "jump_point_search", "theta_star", "wavefront", "focal_search"):
        cs.navigate(grid, *ends, planner)  # the first of them comes to know the parts
        for start, goal in (ends, ends[::-1]):
            route = cs.navigate(grid, start, goal, planner)
            assert route.status == "unreachable"
            assert route.stats.nodes == 0
            assert route.evidence == {"parts": 2}
            assert "another of the 2 connected parts" in route.reason
            assert len(route.trace) == 0
        assert cs.navigate(grid, ends[0], (490.5, 390.5), planner)
    assert any_angle.plan(grid, *ends).status == "unreachable"
    assert any_angle.plan(grid, *ends).stats.nodes == 0
    assert any_angle.plan(grid, ends[0], (490.5, 390.5))
    assert grid.nbytes < 0.6 * blocked.size  # of bytes


@pytest.mark.parametrize("share", [0.1, 0.4])
def test_large_maps_take_half_a_byte_per_cell(share):
    rng = np.random.default_rng(5)
    grid = noise(rng, (2000, 2000), share)
    assert grid.nbytes < 0.3 * grid.rows * grid.columns
    start, goal = (grid.center_of(np.argwhere(~grid.blocked[:60, :60])[k]) for k in (0, 60))
    for planner in ("any_angle", "jump_point_search"):
        assert cs.navigate(grid, start, goal, planner).stats.nodes < 1e5
    assert "polygons" not in vars(grid).get("_derived", {})
