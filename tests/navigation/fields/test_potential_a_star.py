"""Searches that count on a potential: exact, bounded and greedy against a plain Dijkstra."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from oracles import grids


def random_grid(rng):
    rows, columns = rng.integers(1, 24, 2)
    return rng.random((rows, columns)) < rng.uniform(0, 0.5)


def questions(seed, count):
    rng = np.random.default_rng(seed)
    while count:
        blocked = random_grid(rng)
        free = np.argwhere(~blocked)
        if not len(free):
            continue
        start, goal = (tuple(map(int, c)) for c in free[rng.integers(len(free), size=2)])
        rule = str(rng.choice(["never", "one", "always"]))
        lengths = grids.distances(grids.graph(blocked, rule), start, blocked.shape[1])
        count -= 1
        yield rng, blocked, start, goal, rule, lengths[goal[0] * blocked.shape[1] + goal[1]]


def go(grid, start, goal, **options):
    ends = grid.center_of(start), grid.center_of(goal)
    return cs.navigate(grid, *ends, planner="potential_a_star", **options)


def check(grid, blocked, route, best, rule, factor):
    assert bool(route) == np.isfinite(best)
    if not route:
        assert route.status == "unreachable"
        return
    length = grids.walked(blocked, [grid.cell_of(p) for p in route.path], rule)
    assert length is not None
    assert abs(length * grid.resolution - route.length) <= 1e-9
    assert best - 1e-9 <= length <= factor * best + 1e-9


def random_gains(rng):
    return {
        "k_r": float(rng.choice([0.0, 0.1, 1.0, 1e4])),
        "rho_0": float(rng.uniform(0.2, 5)),
        "scale": float(rng.choice([0.0, 0.5, 1.0, 10.0])),
    }


def test_exact_is_shortest_whatever_the_gains():
    for rng, blocked, start, goal, rule, best in questions(1, 300):
        grid = cs.OccupancyGrid(blocked, 0.5)
        route = go(grid, start, goal, mode="exact", corners=rule, **random_gains(rng))
        check(grid, blocked, route, best, rule, 1.0)


def test_bounded_keeps_its_bound_whatever_the_gains():
    for rng, blocked, start, goal, rule, best in questions(2, 300):
        grid = cs.OccupancyGrid(blocked, 0.5)
        weight = float(rng.choice([1.0, 1.1, 2.0, 5.0]))
        route = go(grid, start, goal, mode="bounded", weight=weight, corners=rule, **random_gains(rng))
        check(grid, blocked, route, best, rule, weight)


def test_greedy_is_complete():
    for rng, blocked, start, goal, rule, best in questions(3, 300):
        grid = cs.OccupancyGrid(blocked, 0.5)
        route = go(grid, start, goal, mode="greedy", corners=rule, **random_gains(rng))
        check(grid, blocked, route, best, rule, np.inf if best else 1.0)


@pytest.mark.parametrize("mode", ["exact", "bounded"])
def test_without_gain_it_is_a_star(mode):
    """Both settle all cells over which a way may be shorter than the best, and of the others only such over
    which one may be as long."""
    for _, blocked, start, goal, rule, best in questions(4, 150):
        grid = cs.OccupancyGrid(blocked)
        route = go(grid, start, goal, mode=mode, k_r=0.0, corners=rule)
        ends = grid.center_of(start), grid.center_of(goal)
        plain = cs.navigate(grid, *ends, planner="a_star", metric="euclidean", corners=rule)
        assert route.length == plain.length
        so_far = grids.distances(grids.graph(blocked, rule), start, blocked.shape[1])
        over = so_far + np.hypot(*(np.indices(blocked.shape).reshape(2, -1) - np.array(goal)[:, None]))
        needed, allowed = np.sum(over < best - 1e-9), np.sum(np.isfinite(over) & (over <= best + 1e-9))
        for one in (route, plain):
            assert needed <= one.stats.nodes <= allowed


def test_a_trap_costs_cells_but_no_completeness():
    blocked = np.zeros((60, 60), bool)
    blocked[10:50, 45] = blocked[10, 10:45] = blocked[49, 10:45] = True
    grid = cs.OccupancyGrid(blocked)
    ends = grid.center_of((30, 20)), grid.center_of((30, 55))
    plain = cs.navigate(grid, *ends, planner="a_star")
    for k_r in (0.0, 1.0, 1e6):
        for mode, factor in (("exact", 1.0), ("bounded", 2.0), ("greedy", 3.0)):
            options = {"mode": mode, "weight": 2.0, "k_r": k_r}
            route = cs.navigate(grid, *ends, planner="potential_a_star", **options)
            assert route
            assert route.length <= factor * plain.length + 1e-9


def test_the_trace_is_what_was_settled():
    grid = cs.OccupancyGrid(np.zeros((9, 9), bool), 0.5)
    route = go(grid, (1, 1), (7, 5))
    trace = route.trace
    assert len(trace) == route.stats.nodes
    assert np.array_equal(trace.end[0], route.start)
    assert np.array_equal(trace.end[-1], route.goal)
    straight = np.hypot(*(trace.end - route.goal).T)
    assert (trace.value >= straight - 1e-12).all()


def test_what_it_refuses():
    grid = cs.OccupancyGrid([[0, 0]])
    with pytest.raises(KeyError, match="mode"):
        go(grid, (0, 0), (0, 1), mode="exakt")
    with pytest.raises(ValueError, match=r"weight is 0\.5"):
        go(grid, (0, 0), (0, 1), weight=0.5)
    with pytest.raises(ValueError, match="k_r is -1"):
        go(grid, (0, 0), (0, 1), k_r=-1)
