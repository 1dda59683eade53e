"""Fast marching: times against distances that are known, one minimum, ways that stay in free cells."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy import ndimage

import cspace as cs
from cspace.navigation import arrival_times

SIDES = [[0, 1, 0], [1, 1, 1], [0, 1, 0]]


def random_grid(rng):
    rows, columns = rng.integers(1, 24, 2)
    side = int(rng.integers(1, 4))
    blocks = rng.random((rows, columns)) < rng.uniform(0, 0.5)
    return np.kron(blocks, np.ones((side, side))).astype(bool)[:30, :30]


def go(grid, start, goal, **options):
    ends = grid.center_of(start), grid.center_of(goal)
    return cs.navigate(grid, *ends, planner="fast_marching", **options)


def meets(blocked, p, q):
    """Whether a segment, in cells, passes through the inside of a blocked cell: by where it is in each."""
    low, high = np.floor(np.minimum(p, q)).astype(int), np.floor(np.maximum(p, q)).astype(int)
    for column in range(low[0], high[0] + 1):
        for row in range(low[1], high[1] + 1):
            if not (0 <= row < blocked.shape[0] and 0 <= column < blocked.shape[1]) or blocked[row, column]:
                begin, end = 0.0, 1.0
                for axis, cell in ((0, column), (1, row)):
                    step = q[axis] - p[axis]
                    if step == 0:
                        inside = cell < p[axis] < cell + 1
                        begin, end = (begin, end) if inside else (1.0, 0.0)
                        continue
                    a, b = sorted(((cell - p[axis]) / step, (cell + 1 - p[axis]) / step))
                    begin, end = max(begin, a), min(end, b)
                if end - begin > 1e-9:
                    return True
    return False


@pytest.mark.parametrize("cells", [25, 50, 100, 200])
def test_times_in_the_open_converge_to_distances(cells):
    side = 1.0 / cells
    grid = cs.OccupancyGrid(np.zeros((cells, cells), bool), side)
    times = arrival_times(grid, (0.5 * side, 0.5 * side))
    rows, columns = np.indices(times.shape)
    error = np.abs(times - side * np.hypot(rows, columns)).max()
    assert error <= side * np.log(cells)
    assert (times >= side * np.hypot(rows, columns) - 1e-12).all()


def test_times_have_no_minimum_but_the_goal():
    rng = np.random.default_rng(1)
    for _ in range(100):
        blocked = random_grid(rng)
        free = np.argwhere(~blocked)
        if not len(free):
            continue
        goal = tuple(free[rng.integers(len(free))])
        grid = cs.OccupancyGrid(blocked, 0.5)
        times = arrival_times(grid, grid.center_of(goal), slow_within=float(rng.choice([0, 1.5])))
        part = ndimage.label(~blocked, SIDES)[0]
        reached = np.isfinite(times)
        assert (reached == (part == part[goal])).all()
        padded = np.pad(times, 1, constant_values=np.inf)
        around = np.min([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]], axis=0)
        others = reached.copy()
        others[goal] = False
        assert (around[others] < times[others]).all()
        assert times[goal] == 0


def test_times_solve_the_upwind_equation():
    rng = np.random.default_rng(2)
    for _ in range(50):
        blocked = random_grid(rng)
        free = np.argwhere(~blocked)
        if not len(free):
            continue
        goal = tuple(free[rng.integers(len(free))])
        times = arrival_times(cs.OccupancyGrid(blocked), (goal[1] + 0.5, goal[0] + 0.5))
        padded = np.pad(times, 1, constant_values=np.inf)
        a = np.minimum(padded[1:-1, :-2], padded[1:-1, 2:])
        b = np.minimum(padded[:-2, 1:-1], padded[2:, 1:-1])
        others = np.isfinite(times)
        others[goal] = False
        t, a, b = times[others], a[others], b[others]
        sloped = np.maximum(t - a, 0) ** 2 + np.maximum(t - b, 0) ** 2
        assert np.abs(sloped - 1).max(initial=0) <= 1e-9


@pytest.mark.parametrize("slow_within", [0.0, 2.0])
def test_ways_arrive_where_cells_join_and_stay_in_free_cells(slow_within):
    rng = np.random.default_rng(3)
    found = 0
    for _ in range(200):
        blocked = random_grid(rng)
        free = np.argwhere(~blocked)
        if not len(free):
            continue
        start, goal = (tuple(map(int, c)) for c in free[rng.integers(len(free), size=2)])
        grid = cs.OccupancyGrid(blocked, 0.5, (1, 2))
        part = ndimage.label(~blocked, SIDES)[0]
        route = go(grid, start, goal, slow_within=slow_within)
        assert bool(route) == (part[start] == part[goal])
        if not route:
            assert route.status == "unreachable"
            assert "no path" in route.reason
            continue
        found += 1
        assert np.array_equal(route.path[0], grid.center_of(start))
        assert np.array_equal(route.path[-1], grid.center_of(goal))
        cells = (route.path - grid.origin) / grid.resolution
        assert not any(meets(blocked, p, q) for p, q in pairwise(cells))
        best = cs.navigate(grid, route.start, route.goal).length
        assert route.length >= best - 1e-9
    assert found > 60


def test_ways_in_the_open_are_nearly_straight():
    grid = cs.OccupancyGrid(np.zeros((60, 80), bool))
    for goal in [(59, 79), (0, 79), (30, 79), (59, 10)]:
        route = go(grid, (0, 0), goal)
        assert route.length <= 1.02 * np.hypot(*goal)


def test_a_slow_front_keeps_away_from_walls():
    blocked = np.zeros((41, 61), bool)
    blocked[15:26, 25:36] = True
    grid = cs.OccupancyGrid(blocked)
    clearance = cs.navigation.brushfire_diagram(grid).clearance

    def least(route):
        inside = [p for p in route.path if 20 < p[0] < 41]
        return min(clearance[grid.cell_of(p)] for p in inside)

    fast, slow = go(grid, (20, 2), (20, 58)), go(grid, (20, 2), (20, 58), slow_within=8.0)
    assert least(slow) > least(fast) + 3
    assert slow.length > fast.length


def test_the_trace_is_the_front():
    grid = cs.OccupancyGrid(np.zeros((9, 12), bool), 0.5)
    route = go(grid, (8, 11), (1, 1))
    trace = route.trace
    assert len(trace) == route.stats.nodes
    assert (np.diff(trace.value) >= 0).all()
    assert np.array_equal(trace.end[0], route.goal)
    assert trace.value[-1] == route.evidence["time"]


def test_what_it_refuses():
    grid = cs.OccupancyGrid([[0, 0]])
    with pytest.raises(ValueError, match="slow_within is -1"):
        go(grid, (0, 0), (0, 1), slow_within=-1)
    with pytest.raises(TypeError, match="OccupancyGrid"):
        arrival_times(cs.PolygonWorld([]), (0, 0))
