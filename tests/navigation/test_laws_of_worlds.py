"""Metamorphic laws: the same world told in another way has the same answer, and one obstacle more never opens
or shortens a way."""

from __future__ import annotations

import itertools
import math
from typing import Any, Final

import numpy as np
import pytest

import cspace as cs
from oracles.plane import shortest
from touching_worlds import slanted_touch, triangle

SHORTEST: Final = ("any_angle", "visibility_graph")
CERTAIN: Final = (*SHORTEST, "exact_cells", "bug_1", "bug_2", "tangent_bug", "voronoi_bug")
"""Planners in the plane whose verdict is never open."""
OPTIMAL: Final = ("dijkstra", "a_star", "jump_point_search", "d_star_lite", "wavefront")
OTHERS: Final = ("weighted_a_star", "focal_search", "greedy_best_first", "theta_star", "brushfire")
CASES: Final = 40


def touching_case(seed: int) -> tuple[list[Any], int, Any, Any, float]:
    """Obstacles of a square world, its side, two free points of it, and the length of the shortest way."""
    rng = np.random.default_rng([7, seed])
    while True:
        side = int(rng.integers(4, 9))
        obstacles = slanted_touch(rng, side)
        world = cs.PolygonWorld(obstacles, (0, 0, side, side))
        ends = [p for p in rng.integers(0, side + 1, (8, 2)) if world.is_free(p)]
        if len(ends) > 1 and not np.array_equal(ends[0], ends[-1]):
            bounds = (0, 0, side, side)
            length = shortest([[ring] for ring in obstacles], bounds, ends[0], ends[-1])
            return obstacles, side, ends[0], ends[-1], length


def agree(world: cs.PolygonWorld, start: Any, goal: Any, length: float) -> None:
    """All planners say what an exact oracle says."""
    for planner in CERTAIN:
        route = cs.navigate(world, start, goal, planner)
        assert route.status == ("found" if length < math.inf else "unreachable"), planner
        if planner in SHORTEST:
            assert route.length == pytest.approx(length, rel=1e-12), planner


def test_a_crossed_edge_keeps_the_corner_that_stands_on_it():
    y, x, z = [(0, 2), (0, 0), (4, 0), (4, 4)], [(2, 3), (3, 5), (1, 5)], [(4, 5), (4, 1), (2, 1)]
    for obstacles in ([x, y], *itertools.permutations([x, y, z])):
        agree(cs.PolygonWorld(obstacles, (0, 0, 4, 5)), (0, 5), (4, 5), math.inf)


@pytest.mark.parametrize("seed", range(CASES))
def test_the_order_of_obstacles_changes_nothing(seed):
    obstacles, side, start, goal, length = touching_case(seed)
    orders = list(itertools.permutations(obstacles))
    for order in orders[:: max(1, len(orders) // 24)]:
        agree(cs.PolygonWorld(order, (0, 0, side, side)), start, goal, length)


@pytest.mark.parametrize("seed", range(CASES))
def test_corners_and_turns_of_outlines_change_nothing(seed):
    obstacles, side, start, goal, length = touching_case(seed)
    rng = np.random.default_rng(seed)
    told = [np.roll(ring, rng.integers(3), axis=0)[:: rng.choice([-1, 1])] for ring in obstacles]
    agree(cs.PolygonWorld(told, (0, 0, side, side)), start, goal, length)


@pytest.mark.slow
@pytest.mark.parametrize("scale", [2.0**-30, 0.25, 3, 10, 1000, 7 * 2.0**20])
@pytest.mark.parametrize("by", [(0, 0), (5, -3), (-1001, 4096)])
def test_scaled_and_moved_a_world_has_the_same_ways(scale, by):
    for seed in range(0, CASES, 8):
        obstacles, side, start, goal, length = touching_case(seed)
        place = [scale * (np.asarray(points) + by) for points in (*obstacles, start, goal)]
        bounds = (*(scale * np.array(by)), *(scale * (np.array(by) + side)))
        agree(cs.PolygonWorld(place[:-2], bounds), *place[-2:], scale * length)


MIRRORS: Final = [np.array(m) for m in ([[-1, 0], [0, 1]], [[0, 1], [1, 0]], [[0, -1], [1, 0]])]


@pytest.mark.slow
@pytest.mark.parametrize("mirror", MIRRORS, ids=["left and right", "x and y", "a quarter turn"])
def test_mirrored_and_turned_a_world_has_the_same_ways(mirror):
    for seed in range(CASES):
        obstacles, side, start, goal, length = touching_case(seed)
        *rings, start, goal = (np.asarray(points) @ mirror.T for points in (*obstacles, start, goal))
        bounds = np.sort(np.array([(0, 0), (side, side)]) @ mirror.T, axis=0).ravel()
        agree(cs.PolygonWorld(rings, bounds), start, goal, length)


@pytest.mark.parametrize("seed", range(CASES))
def test_one_obstacle_more_opens_nothing_and_shortens_nothing(seed):
    obstacles, side, start, goal, length = touching_case(seed)
    rng = np.random.default_rng(seed)
    for _ in range(6):
        world = cs.PolygonWorld([*obstacles, triangle(rng, side)], (0, 0, side, side))
        if not (world.is_free(start) and world.is_free(goal)):
            continue
        for planner in CERTAIN:
            route = cs.navigate(world, start, goal, planner)
            assert not (route and length == math.inf), planner
            if route and planner in SHORTEST:
                assert route.length >= length * (1 - 1e-12)


def likenesses(obstacles: Any, side: float, rng: Any) -> list[tuple[Any, Any, float]]:
    """Worlds like one, each with what to do to its points and by how much lengths grow."""

    def told(change: Any, rings: Any = obstacles) -> tuple[Any, Any]:
        corners = np.array([change(p) for p in ((0, 0), (side, side))])
        bounds = (*corners.min(axis=0), *corners.max(axis=0))
        return cs.PolygonWorld([np.array([change(p) for p in ring]) for ring in rings], bounds), change

    def linear(matrix: Any, by: Any = (0, 0)) -> Any:
        return lambda p: np.asarray(matrix, dtype=float) @ p + by

    outlines = [np.roll(ring, rng.integers(3), axis=0)[:: rng.choice([-1, 1])] for ring in obstacles]
    return [
        (*told(linear(np.eye(2)), obstacles[::-1]), 1.0),
        (*told(linear(np.eye(2)), outlines), 1.0),
        (*told(linear(np.eye(2), (5, -3))), 1.0),
        *((*told(linear(scale * np.eye(2))), scale) for scale in (2.0**-30, 0.25, 3.0, 1000.0)),
        *((*told(linear(mirror)), 1.0) for mirror in MIRRORS),
    ]


@pytest.mark.parametrize("seed", range(CASES))
def test_a_descent_of_a_potential_is_the_same_in_worlds_that_are_alike(seed):
    """Where it does not pass a saddle, at which rounding decides, as it does between obstacles that touch."""
    rng, side = np.random.default_rng([9, seed]), 8
    while True:
        obstacles = [triangle(rng, side) for _ in range(2)]
        world, (start, goal) = cs.PolygonWorld(obstacles, (0, 0, side, side)), rng.uniform(0.3, 7.7, (2, 2))
        if world.is_free(start) and world.is_free(goal):
            break
    route = cs.navigate(world, start, goal, "potential_field")
    for other, change, scale in likenesses(obstacles, side, rng):
        like = cs.navigate(other, change(start), change(goal), "potential_field")
        assert like.status == route.status
        assert like.length == pytest.approx(scale * route.length, rel=1e-9)


@pytest.mark.parametrize("seed", range(CASES))
def test_a_descent_of_a_potential_finds_no_way_where_there_is_none(seed):
    obstacles, side, start, goal, length = touching_case(seed)
    route = cs.navigate(cs.PolygonWorld(obstacles, (0, 0, side, side)), start, goal, "potential_field")
    assert not (route and length == math.inf)
    assert not route or route.length >= length * (1 - 1e-12)


def grid_case(seed: int) -> tuple[Any, Any, Any]:
    """Blocked cells, and two free ones (row, column)."""
    rng = np.random.default_rng([8, seed])
    while True:
        blocked = rng.random(rng.integers(3, 20, 2)) < rng.uniform(0.1, 0.5)
        free = rng.permutation(np.argwhere(~blocked))
        if len(free) > 1:
            return blocked, free[0], free[1]


def walk(blocked: Any, start: Any, goal: Any, planner: str, **frame: Any) -> Any:
    grid = cs.OccupancyGrid(blocked, **frame)
    return cs.navigate(grid, grid.center_of(start), grid.center_of(goal), planner)


def mirrored(blocked: Any, *cells: Any) -> list[Any]:
    """The grid and cells of it, mirrored at either axis and at the diagonal."""
    rows, columns = blocked.shape
    return [
        (blocked[::-1], *([rows - 1 - r, c] for r, c in cells)),
        (blocked[:, ::-1], *([r, columns - 1 - c] for r, c in cells)),
        (blocked.T, *([c, r] for r, c in cells)),
    ]


@pytest.mark.parametrize("planner", [*OPTIMAL, *OTHERS])
def test_mirrored_a_grid_has_the_same_ways(planner):
    for seed in range(CASES):
        route = walk(*grid_case(seed), planner)
        for case in mirrored(*grid_case(seed)):
            other = walk(*case, planner)
            assert other.status == route.status
            if planner in OPTIMAL:
                assert other.length == pytest.approx(route.length, rel=1e-12)


@pytest.mark.parametrize("planner", [*OPTIMAL, *OTHERS])
def test_scaled_and_moved_a_grid_has_the_same_ways(planner):
    for seed in range(CASES):
        route = walk(*grid_case(seed), planner)
        for resolution, origin in [(0.25, (0, 0)), (3, (0, 0)), (1, (-40, 7)), (0.05, (1.5, -2.25))]:
            other = walk(*grid_case(seed), planner, resolution=resolution, origin=origin)
            assert other.status == route.status
            if planner in OPTIMAL:
                assert other.length == pytest.approx(resolution * route.length, rel=1e-9)


@pytest.mark.parametrize("planner", [*OPTIMAL, *OTHERS])
def test_one_cell_more_opens_nothing_and_shortens_nothing(planner):
    for seed in range(CASES):
        blocked, start, goal = grid_case(seed)
        route = walk(blocked, start, goal, planner)
        rng = np.random.default_rng(seed)
        for cell in rng.permutation(np.argwhere(~blocked))[:4]:
            if np.array_equal(cell, start) or np.array_equal(cell, goal):
                continue
            more = blocked.copy()
            more[tuple(cell)] = True
            other = walk(more, start, goal, planner)
            assert route or not other
            if other and planner in OPTIMAL:
                assert other.length >= route.length * (1 - 1e-12)


@pytest.mark.parametrize("far", [1e3, 1e6, -3e6])
@pytest.mark.parametrize("side", [1e-3, 0.05, 1, 2.0**-10])
def test_voronoi_bug_walks_the_same_way_in_a_grid_that_is_moved(side, far):
    """Over many cells, to where coordinates tell no more than a billionth of a cell apart."""
    for seed in range(25):
        rng = np.random.default_rng(seed)
        blocked = rng.random(rng.integers(4, 25, 2)) < rng.choice([0.2, 0.3, 0.4])
        cells = rng.choice(np.argwhere(~blocked), 2) + rng.uniform(0.1, 0.9, (2, 2))
        reach = side * rng.choice([1.5, 4, np.inf])
        answers = []
        for by in (0, far):
            grid = cs.OccupancyGrid(blocked, side, (by * side, by / 2 * side))
            ends = (np.array([by, by / 2]) + cells[:, ::-1]) * side
            answers.append(cs.navigate(grid, *ends, "voronoi_bug", range=reach))
        near, moved = answers
        assert moved.status == near.status
        assert moved.length == pytest.approx(near.length, rel=1e-5, abs=1e-6 * side)


def test_millimetres_a_kilometre_away_are_explored_like_those_at_the_origin():
    rng = np.random.default_rng(52)
    rng.integers(10), rng.choice(6)
    blocked = rng.random((20, 33)) < 0.4
    for far in (0, 1, 1e3, 1e4):
        grid = cs.OccupancyGrid(blocked, 1e-3, (far, far))
        ends = far + np.array([(0.0185, 0.0085), (0.0185, 0.0185)])
        route = cs.navigate(grid, *ends, "voronoi_bug")
        assert route.status == "unreachable"
        assert route.length == pytest.approx(0.37400554601, rel=1e-6)
