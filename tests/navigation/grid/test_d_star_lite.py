"""D* Lite: after every change its way is as long as that of a fresh search."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.navigation import DStarLite
from oracles import grids


def centre(cell):
    return (float(cell[1]) + 0.5, float(cell[0]) + 0.5)


def expected(planner, grid, start, goal, metric, corners):
    """The length that a fresh A* finds; inf where it finds none or an end is blocked."""
    if not (grid.is_free(start) and grid.is_free(goal)):
        return np.inf
    return cs.navigate(grid, start, goal, planner="a_star", metric=metric, corners=corners).length


@pytest.mark.parametrize(
    ("metric", "corners"),
    [("octile", "never"), ("octile", "one"), ("octile", "always"), ("manhattan", "never")],
)
def test_ten_thousand_edits_equal_a_fresh_search(metric, corners):
    rng = np.random.default_rng(1)
    rows, columns = 25, 31
    blocked = rng.random((rows, columns)) < 0.25
    start, goal = (0, 0), (rows - 1, columns - 1)
    blocked[start] = blocked[goal] = False
    planner = DStarLite(
        cs.OccupancyGrid(blocked), centre(start), centre(goal), metric=metric, corners=corners
    )
    found = 0
    for k in range(2500):
        cell = tuple(int(rng.integers(n)) for n in (rows, columns))
        blocked[cell] = not blocked[cell]
        planner.set_blocked(cell, bool(blocked[cell]))
        if k % 7 == 0 and len(planner.route.path) > 2:  # the robot goes on
            planner.move(planner.route.path[1])
        grid = cs.OccupancyGrid(blocked)
        route = planner.route
        best = expected(planner, grid, route.start, centre(goal), metric, corners)
        assert route.length == best or abs(route.length - best) <= 1e-9
        if route:
            found += 1
            cells = [grid.cell_of(point) for point in route.path]
            walked = grids.walked(blocked, cells, corners, metric == "octile")
            assert walked is not None
            assert abs(walked - route.length) <= 1e-9
        if k % 400 == 0:
            assert np.array_equal(planner.grid.blocked, blocked)
            free = np.argwhere(~blocked)
            planner.move(centre(free[rng.integers(len(free))]))
    assert 500 < found < 2500


def test_mending_is_cheaper_than_a_fresh_search():
    rng = np.random.default_rng(2)
    blocked = rng.random((100, 100)) < 0.2
    blocked[0, 0] = blocked[99, 99] = False
    planner = DStarLite(cs.OccupancyGrid(blocked), (0.5, 0.5), (99.5, 99.5))
    first = planner.route.stats.nodes
    mended = []
    for _ in range(100):
        planner.set_blocked(rng.integers((0, 1), (99, 100)), True)
        mended.append(planner.route.stats.nodes)
    assert np.mean(mended) < first / 10


def test_it_is_a_planner_too():
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 1, 0], [0, 0, 0]])
    route = cs.navigate(grid, (0.5, 0.5), (2.5, 0.5), planner="d_star_lite")
    assert route
    assert route.length == 6
    assert len(route.trace) == route.stats.nodes
    shut = cs.navigate(cs.OccupancyGrid([[0, 1, 0]]), (0.5, 0.5), (2.5, 0.5), planner="d_star_lite")
    assert shut.status == "unreachable"
    assert "no path to the goal" in shut.reason


def test_what_cannot_be_used():
    planner = DStarLite(cs.OccupancyGrid(np.zeros((3, 4), bool)), (0.5, 0.5), (3.5, 2.5))
    with pytest.raises(ValueError, match=r"cells holds \(3, 0\); the grid has rows 0 … 2, columns 0 … 3"):
        planner.set_blocked((3, 0))
    with pytest.raises(ValueError, match=r"cells holds \(0.5, 0\)"):
        planner.set_blocked([(1, 1), (0.5, 0)])
    with pytest.raises(TypeError, match="blocked must be True or False"):
        planner.set_blocked((1, 0), 2)
    with pytest.raises(ValueError, match=r"point \(9, 0\) is outside the grid"):
        planner.move((9, 0))
    with pytest.raises(ValueError, match="metric is 'euclidean'"):
        DStarLite(planner.grid, (0.5, 0.5), (3.5, 2.5), metric="euclidean")
    assert planner.route.length == 1 + 2 * 2**0.5
    planner.set_blocked(np.argwhere(np.ones((3, 4), bool)))
    assert planner.route.status == "unreachable"
    assert not planner.grid.is_free((0.5, 0.5))
    planner.set_blocked(np.argwhere(np.ones((3, 4), bool)), False)
    assert planner.route.length == 1 + 2 * 2**0.5


def pickled(planner):
    return pickle.loads(pickle.dumps(planner))


@pytest.mark.parametrize("again", [pickled, copy.copy, copy.deepcopy])
def test_copies_know_the_changes_and_go_their_own_way(again):
    rng = np.random.default_rng(8)
    grid = cs.OccupancyGrid(rng.random((20, 20)) < 0.2)
    start, goal, *others = (centre(c) for c in rng.permutation(np.argwhere(~grid.blocked))[:8])
    planner = DStarLite(grid, start, goal, corners="one")
    for point in others:
        planner.set_blocked(rng.integers(0, 20, (12, 2)), bool(rng.integers(2)))
        planner.move(point)
        same = again(planner)
        np.testing.assert_array_equal(same.grid.blocked, planner.grid.blocked)
        assert same.route.status == planner.route.status
        assert same.route.length == pytest.approx(planner.route.length, rel=1e-12)
        same.set_blocked(np.argwhere(np.ones((20, 20), bool)))
        assert not same.route
        assert planner.route.length == pytest.approx(again(planner).route.length, rel=1e-12)
