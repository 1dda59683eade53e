"""The planners of the grid family against a plain Dijkstra, on random grids, under all metrics and corner
rules."""

from __future__ import annotations

import threading
from itertools import pairwise

import numpy as np
import pytest

import cspace as cs
from cspace.errors import UnknownNameError
from cspace.navigation import Route
from oracles import grids

MOVES = [("octile", rule) for rule in ("never", "one", "always")] + [("manhattan", "never")]
MOVES += [("euclidean", "never")]


def random_grid(rng, rows, columns, share):
    blocked = rng.random((rows, columns)) < share
    blocked[0, 0] = False
    return blocked


def random_free(rng, blocked):
    free = np.argwhere(~blocked)
    return tuple(map(int, free[rng.integers(len(free))]))


@pytest.mark.parametrize("metric", ["octile", "manhattan"])
def test_an_unknown_corner_rule_is_named_whatever_the_metric(metric):
    grid = cs.OccupancyGrid(np.zeros((3, 3), bool))
    with pytest.raises(UnknownNameError, match=r"no corner rule 'some'.* corner rules: always, never, one"):
        cs.navigate(grid, (0.5, 0.5), (2.5, 2.5), "a_star", metric=metric, corners="some")


def centre(cell):
    return (cell[1] + 0.5, cell[0] + 0.5)


def cells_of(grid, route):
    return [grid.cell_of(point) for point in route.path]


def questions(seed, count, largest=24):
    """Random grids with a start, a goal, and the moves to be used."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        rows, columns = rng.integers(1, largest, 2)
        blocked = random_grid(rng, rows, columns, rng.uniform(0, 0.55))
        yield rng, blocked, random_free(rng, blocked), random_free(rng, blocked), MOVES[k % len(MOVES)]


def truth_of(blocked, start, goal, metric, corners, costs=None):
    steps = grids.graph(blocked, corners, metric != "manhattan", costs)
    return grids.distances(steps, start, blocked.shape[1])[goal[0] * blocked.shape[1] + goal[1]]


def check(grid, route, blocked, best, metric, corners, factor=1.0):
    """The verdict is right, the way is allowed, and its length within a factor of the best."""
    assert bool(route) == np.isfinite(best)
    if not route:
        assert route.status == "unreachable"
        assert route.length == np.inf
        assert len(route.path) == 0
        assert "no path" in route.reason
        return
    length = grids.walked(blocked, cells_of(grid, route), corners, metric != "manhattan")
    assert length is not None, "a step that is not allowed"
    assert abs(length - route.length) <= 1e-9
    assert best - 1e-9 <= length <= factor * best + 1e-9


FAMILY = ("greedy_best_first", "weighted_a_star", "focal_search", "theta_star")
OPTIMAL = ("a_star", "dijkstra", "jump_point_search")


@pytest.mark.parametrize("planner", OPTIMAL)
def test_optimal_planners_equal_dijkstra(planner):
    for _, blocked, start, goal, (metric, corners) in questions(1, 400):
        grid = cs.OccupancyGrid(blocked)
        best = truth_of(blocked, start, goal, metric, corners)
        route = cs.navigate(
            grid, centre(start), centre(goal), planner=planner, metric=metric, corners=corners
        )
        check(grid, route, blocked, best, metric, corners)


def test_bounded_planners_keep_their_bound():
    for rng, blocked, start, goal, (metric, corners) in questions(2, 300):
        grid = cs.OccupancyGrid(blocked)
        best = truth_of(blocked, start, goal, metric, corners)
        moves = {"metric": metric, "corners": corners}
        bound = float(rng.choice([1.0, 1.05, 1.3, 2.0, 5.0]))
        ends = centre(start), centre(goal)
        weighted = cs.navigate(grid, *ends, planner="weighted_a_star", weight=bound, **moves)
        check(grid, weighted, blocked, best, metric, corners, bound)
        focal = cs.navigate(grid, *ends, planner="focal_search", bound=bound, **moves)
        check(grid, focal, blocked, best, metric, corners, bound)
        if focal:
            assert focal.evidence["at_least"] <= best + 1e-9
            assert focal.length <= bound * focal.evidence["at_least"] + 1e-9
        greedy = cs.navigate(grid, *ends, planner="greedy_best_first", **moves)
        check(grid, greedy, blocked, best, metric, corners, np.inf if best else 1.0)


def test_bounds_hold_over_costs_and_costs_are_exact():
    for rng, blocked, start, goal, (metric, corners) in questions(3, 300):
        grid = cs.OccupancyGrid(blocked, resolution=0.5)
        costs = (
            rng.choice([1.0, 2.0, 7.5], blocked.shape)
            if rng.random() < 0.5
            else rng.uniform(0.1, 9, blocked.shape)
        )
        best = truth_of(blocked, start, goal, metric, corners, costs) * 0.5
        ends = tuple(grid.center_of(start)), tuple(grid.center_of(goal))
        moves = {"metric": metric, "corners": corners, "costs": costs}
        for planner, factor, more in (
            ("a_star", 1.0, {}),
            ("dijkstra", 1.0, {}),
            ("weighted_a_star", 1.7, {"weight": 1.7}),
            ("focal_search", 1.7, {"bound": 1.7}),
        ):
            route = cs.navigate(grid, *ends, planner=planner, **moves, **more)
            assert bool(route) == np.isfinite(best)
            if route:
                cost = route.evidence["cost"]
                cells = cells_of(grid, route)
                walked = grids.walked(blocked, cells, corners, metric != "manhattan", costs) * 0.5
                assert abs(walked - cost) <= 1e-9 * max(1, cost)
                assert best * (1 - 1e-9) <= cost <= factor * best * (1 + 1e-9) + 1e-12


@pytest.mark.parametrize("spread", [0.5, 8])
def test_focal_search_takes_few_cells_often(spread):
    """Whatever the costs, and where the goal is shut in: at most twice as often as there are cells."""
    rng = np.random.default_rng(3)
    blocked = np.zeros((60, 60), bool)
    costs = 10 ** rng.uniform(-spread, spread, blocked.shape)
    for shut in (False, True):
        blocked[55:58, 55:58] = shut
        blocked[56, 56] = False
        grid = cs.OccupancyGrid(blocked)
        route = cs.navigate(grid, (0.5, 0.5), (56.5, 56.5), "focal_search", bound=1.5, costs=costs)
        assert route.stats.nodes <= 2 * 62 * 62
        assert route.status == ("unreachable" if shut else "found")
        if not shut:
            best = cs.navigate(grid, (0.5, 0.5), (56.5, 56.5), "dijkstra", costs=costs).evidence["cost"]
            assert best * (1 - 1e-12) <= route.evidence["cost"] <= 1.5 * best
            assert route.evidence["at_least"] <= best * (1 + 1e-12)


def test_waves_by_four_moves_are_shortest_and_by_eight_have_the_fewest_steps():
    for _, blocked, start, goal, _ in questions(4, 300):
        grid = cs.OccupancyGrid(blocked)
        ends = centre(start), centre(goal)
        best = truth_of(blocked, start, goal, "manhattan", "never")
        check(grid, cs.navigate(grid, *ends, planner="wavefront"), blocked, best, "manhattan", "never")
        route = cs.navigate(grid, *ends, planner="wavefront", metric="octile", corners="one")
        steps = grids.graph(blocked, "one")
        steps.data[:] = 1
        fewest = grids.distances(steps, start, blocked.shape[1])[goal[0] * blocked.shape[1] + goal[1]]
        assert bool(route) == np.isfinite(fewest)
        if route:
            corners = np.array(cells_of(grid, route))
            assert np.abs(np.diff(corners, axis=0)).max(axis=1, initial=0).sum() == fewest


def sees(blocked, a, b, corners):
    """Whether the line between two centres meets no inside of a blocked cell, nor a corner that is closed; in
    whole numbers of half cells."""
    (r0, c0), (r1, c1) = a, b
    dy, dx = r1 - r0, c1 - c0

    def side(y, x):
        return np.sign(dx * (y - 2 * r0 - 1) - dy * (x - 2 * c0 - 1))

    low_r, high_r, low_c, high_c = min(r0, r1), max(r0, r1), min(c0, c1), max(c0, c1)
    for r in range(low_r, high_r + 1):
        for c in range(low_c, high_c + 1):
            sides = {side(2 * r + y, 2 * c + x) for y in (0, 2) for x in (0, 2)}
            if blocked[r, c] and {-1, 1} <= sides:
                return False
            if r > low_r and c > low_c and side(2 * r, 2 * c) == 0:
                rising = (dx > 0) == (dy > 0)
                beside = (
                    int(blocked[r, c - 1]) + int(blocked[r - 1, c])
                    if rising
                    else int(blocked[r, c]) + int(blocked[r - 1, c - 1])
                )
                if beside > {"never": 0, "one": 1, "always": 2}[corners]:
                    return False
    return True


@pytest.mark.parametrize("lazy", [False, True])
def test_theta_star_keeps_in_sight_and_is_never_shorter_than_the_truth(lazy):
    """The truth: the shortest way over the graph of all cells that see each other; every such way is one of
    it."""
    ratios = []
    for _, blocked, start, goal, (_, corners) in questions(5, 120, largest=9):
        grid = cs.OccupancyGrid(blocked)
        free = [tuple(map(int, cell)) for cell in np.argwhere(~blocked)]
        weights = np.zeros((len(free), len(free)))
        for i, a in enumerate(free):
            for j in range(i):
                if sees(blocked, a, free[j], corners):
                    weights[i, j] = weights[j, i] = np.hypot(a[0] - free[j][0], a[1] - free[j][1])
        best = grids.dijkstra(weights, indices=free.index(start))[free.index(goal)]
        route = cs.navigate(
            grid, centre(start), centre(goal), planner="theta_star", corners=corners, lazy=lazy
        )
        assert bool(route) == np.isfinite(best)
        if route:
            cells = cells_of(grid, route)
            assert all(sees(blocked, a, b, corners) for a, b in pairwise(cells))
            assert route.length >= best - 1e-9
            ratios.append(route.length / best if best else 1.0)
    assert np.mean(ratios) < 1.01


def left(cell, goal, metric):
    """The length of the shortest way between two cells of an empty grid."""
    down, along = abs(goal[0] - cell[0]), abs(goal[1] - cell[1])
    return down + along if metric == "manhattan" else max(down, along) + (2**0.5 - 1) * min(down, along)


def test_jump_points_settle_none_that_a_star_would_not():
    """Where the way to a jump point and on is not longer than the shortest way, A* may settle it, too; and
    few are settled twice."""
    settled = by_a_star = 0
    for _, blocked, start, goal, (metric, corners) in questions(6, 300):
        if metric == "euclidean":
            continue
        grid = cs.OccupancyGrid(blocked)
        truth = grids.distances(grids.graph(blocked, corners, metric != "manhattan"), start, blocked.shape[1])
        ends, moves = (centre(start), centre(goal)), {"metric": metric, "corners": corners}
        route = cs.navigate(grid, *ends, planner="jump_point_search", **moves)
        if not route:
            continue
        trace = route.trace
        for point, way in zip(trace.end, trace.value, strict=True):
            cell = grid.cell_of(point)
            reached = truth[cell[0] * blocked.shape[1] + cell[1]]
            assert way >= reached - 1e-9
            assert way + left(cell, goal, metric) <= route.length + 1e-9
        settled += len(trace)
        by_a_star += cs.navigate(grid, *ends, planner="a_star", **moves).stats.nodes
    assert settled < by_a_star


def test_traces_begin_at_the_start_and_end_at_the_goal():
    rng = np.random.default_rng(7)
    blocked = random_grid(rng, 20, 30, 0.2)
    grid = cs.OccupancyGrid(blocked, 0.25, (-3, 2))
    best = 0
    while not best:
        start, goal = random_free(rng, blocked), random_free(rng, blocked)
        best = truth_of(blocked, start, goal, "octile", "never") < np.inf and start != goal
    ends = grid.center_of(start), grid.center_of(goal)
    for name, row in cs.navigation.PLANNERS.items():
        if row.world != "grid" or name not in FAMILY + OPTIMAL:
            continue
        route = cs.navigate(grid, *ends, planner=name)
        assert np.array_equal(route.trace.end[0], ends[0])
        assert np.array_equal(route.trace.end[-1], ends[1])
        assert len(route.trace) == route.stats.nodes
        assert route.trace is route.trace


def test_paths_in_metres_join_start_centres_and_goal():
    grid = cs.OccupancyGrid(np.zeros((4, 5), bool), 2.0, (10, -4))
    route = cs.navigate(grid, (10.5, -3.0), (18.9, 3.1), planner="a_star")
    assert np.allclose(route.path[0], (10.5, -3.0))
    assert np.allclose(route.path[-1], (18.9, 3.1))
    assert np.allclose(route.path[1], (11, -3))
    assert np.allclose(route.path[-2], (19, 3))
    pieces = np.hypot(*np.diff(route.path, axis=0).T)
    assert abs(route.length - pieces.sum()) <= 1e-12
    within = cs.navigate(grid, (10.1, -3.9), (11.9, -2.1), planner="a_star")
    assert np.array_equal(within.path, [(10.1, -3.9), (11.9, -2.1)])
    assert abs(within.length - np.hypot(1.8, 1.8)) <= 1e-12
    still = cs.navigate(grid, (10.1, -3.9), (10.1, -3.9), planner="a_star")
    assert still
    assert still.length == 0


def test_walls_may_be_touched():
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 1, 0], [0, 0, 0]])
    route = cs.navigate(grid, (1.0, 0.5), (2.0, 0.5), planner="jump_point_search")
    assert route
    assert abs(route.length - (0.5 + 6 + 0.5)) <= 1e-12


@pytest.mark.parametrize(
    ("ends", "message"),
    [
        (((1.5, 0.5), (0.5, 0.5)), r"start \(1.5, 0.5\) lies in cell \(0, 1\), which is blocked"),
        (((0.5, 0.5), (1.5, 0.5)), r"goal \(1.5, 0.5\) lies in cell \(0, 1\), which is blocked"),
        (((0.5, 0.5), (3.5, 0.5)), r"goal \(3.5, 0.5\) is outside the grid, which spans x 0 … 3, y 0 … 2"),
        (((np.nan, 0.5), (0.5, 0.5)), "start .* finite"),
        (((0.5, 0.5, 1), (0.5, 0.5)), r"start has shape \(3,\), expected"),
        ((((0.5, 0.5),), (0.5, 0.5)), r"start has shape \(1, 2\), expected \(2,\)"),
    ],
)
def test_points_that_cannot_be_used(ends, message):
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 0, 0]])
    with pytest.raises(cs.errors.InputError, match=message):
        cs.navigate(grid, *ends, planner="jump_point_search")


@pytest.mark.parametrize(
    ("planner", "options", "error", "message"),
    [
        ("a_star", {"metric": "octal"}, KeyError, "did you mean 'octile'"),
        ("a_star", {"corners": "nver"}, KeyError, "did you mean 'never'"),
        (
            "a_star",
            {"costs": np.ones((2, 2))},
            ValueError,
            r"costs has shape \(2, 2\); the grid has \(2, 3\)",
        ),
        ("a_star", {"costs": np.zeros((2, 3))}, ValueError, r"costs\[0, 0\] is 0; costs must be positive"),
        ("weighted_a_star", {"weight": 0.5}, ValueError, "weight is 0.5; it must be 1 or more"),
        ("focal_search", {"bound": 0.5}, ValueError, "bound is 0.5; it must be 1 or more"),
        ("theta_star", {"lazy": 1}, TypeError, "lazy must be True or False"),
        ("jump_point_search", {"costs": np.ones((2, 3))}, TypeError, "no option 'costs'"),
    ],
)
def test_options_that_cannot_be_used(planner, options, error, message):
    grid = cs.OccupancyGrid([[0, 1, 0], [0, 0, 0]])
    with pytest.raises(error, match=message):
        cs.navigate(grid, (0.5, 0.5), (2.5, 0.5), planner=planner, **options)


def test_lists_and_arrays_and_integers_are_points():
    grid = cs.OccupancyGrid(np.zeros((3, 3), bool))
    for start in ([0.5, 0.5], np.array([0.5, 0.5]), np.array([0.5, 0.5], np.float32)):
        assert cs.navigate(grid, start, (2, 2), planner="a_star")


def test_threads_do_not_disturb_each_other():
    rng = np.random.default_rng(8)
    blocked = random_grid(rng, 150, 160, 0.3)
    grid = cs.OccupancyGrid(blocked)
    cells = [(random_free(rng, blocked), random_free(rng, blocked)) for _ in range(40)]

    def ask() -> list[Route]:
        return [
            cs.navigate(grid, centre(a), centre(b), planner=planner)
            for a, b in cells
            for planner in ("jump_point_search", "a_star", "theta_star")
        ]

    alone = [route.length for route in ask()]
    results: list[list[float]] = []
    threads = [
        threading.Thread(target=lambda: results.append([route.length for route in ask()])) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [alone] * 4
