"""Harmonic potentials: the mean of the cells beside, no rest but the goal, descents that arrive."""

from __future__ import annotations

import signal
import time

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputTypeError
from cspace.navigation import harmonic


def solved(blocked, goal):
    """The chances by dense linear algebra."""
    free = [tuple(c) for c in np.argwhere(~blocked)]
    number = {c: k for k, c in enumerate(free)}
    A, b = np.eye(len(free)), np.zeros(len(free))
    for (r, c), k in number.items():
        if (r, c) == goal:
            b[k] = 1
            continue
        for beside in ((r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)):
            if beside in number:
                A[k, number[beside]] = -0.25
    chance = np.zeros(blocked.shape)
    chance[~blocked] = np.linalg.solve(A, b)
    return chance


def center(cell):
    return cell[1] + 0.5, cell[0] + 0.5


def test_it_agrees_with_linear_algebra():
    rng = np.random.default_rng(1)
    for share in (0, 0.1, 0.3, 0.4):
        blocked = rng.random((23, 31)) < share
        goal = tuple(rng.integers(0, 23, 2))
        blocked[goal] = False
        chance = solved(blocked, goal)
        field = harmonic(cs.OccupancyGrid(blocked), center(goal))
        near = chance > 1e-12
        assert np.allclose(np.exp(-field[near]), chance[near], rtol=1e-7)
        assert np.all(np.isinf(field) == (chance == 0))
        assert field[goal] == 0


def maze(rng, rows, columns):
    """A maze of corridors one cell wide, a tree, by depth-first search."""
    blocked = np.ones((2 * rows + 1, 2 * columns + 1), bool)
    stack = [(0, 0)]
    blocked[1, 1] = False
    while stack:
        r, c = stack[-1]
        steps = [
            (dr, dc)
            for dr, dc in ((1, 0), (-1, 0), (0, 1), (0, -1))
            if 0 <= r + dr < rows and 0 <= c + dc < columns and blocked[2 * (r + dr) + 1, 2 * (c + dc) + 1]
        ]
        if not steps:
            stack.pop()
            continue
        dr, dc = steps[rng.integers(len(steps))]
        blocked[2 * r + 1 + dr, 2 * c + 1 + dc] = blocked[2 * (r + dr) + 1, 2 * (c + dc) + 1] = False
        stack.append((r + dr, c + dc))
    return blocked


def test_descents_arrive_through_mazes_where_doubles_would_not_do():
    rng = np.random.default_rng(2)
    for size in (5, 20, 40):
        grid = cs.OccupancyGrid(maze(rng, size, size))
        start, goal = (1.5, 1.5), (2 * size - 0.5, 2 * size - 0.5)
        route = cs.navigate(grid, start, goal, "harmonic")
        assert route
        assert route.evidence.rests == 0
        assert route.evidence.residual <= 1e-11
        assert route.length == pytest.approx(cs.navigate(grid, start, goal, "dijkstra").length)
        value = route.trace.value
        assert np.all(np.diff(value) < 0)
    assert harmonic(grid, goal)[1, 1] > 745  # less than the least double


def test_paths_stay_in_free_cells_and_away_from_corners():
    rng = np.random.default_rng(3)
    for _ in range(20):
        blocked = rng.random((30, 30)) < 0.25
        blocked[0, 0] = blocked[29, 29] = False
        grid = cs.OccupancyGrid(blocked)
        route = cs.navigate(grid, (0.5, 0.5), (29.5, 29.5), "harmonic")
        shortest = cs.navigate(grid, (0.5, 0.5), (29.5, 29.5), "dijkstra")
        assert bool(route) == bool(shortest)
        if not route:
            assert route.status == "unreachable"
            continue
        assert route.length >= shortest.length - 1e-9
        for a, b in zip(route.path[:-1], route.path[1:], strict=True):
            for t in np.linspace(0, 1, 50):
                x, y = a + t * (b - a)
                assert not blocked[min(int(y), 29), min(int(x), 29)]


def test_a_polygon_world_is_converted():
    world = cs.PolygonWorld(
        [[(3, 2), (7, 2), (7, 8), (3, 8), (3, 7.5), (6.5, 7.5), (6.5, 2.5), (3, 2.5)]], (0, 0, 10, 10)
    )
    assert cs.navigate(world, (4, 5), (9, 5), "harmonic", resolution=0.1)
    with pytest.raises(InputTypeError, match="give an OccupancyGrid"):
        harmonic(world, (9, 5))


def test_walls_that_divide_are_told_without_a_solution():
    blocked = np.zeros((400, 400), bool)
    blocked[:, 200] = True
    grid = cs.OccupancyGrid(blocked)
    route = cs.navigate(grid, (1.5, 1.5), (399.5, 399.5), "harmonic")
    assert route.status == "unreachable"
    assert route.evidence.cycles == 0
    assert "walls separate" in route.reason
    assert len(route.trace) == 0
    assert route.stats.seconds < 0.05


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer that interrupts")
def test_an_interrupt_ends_the_solution():
    grid = cs.OccupancyGrid(np.zeros((700, 700), bool))

    def ring(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        began = time.perf_counter()
        with pytest.raises(KeyboardInterrupt):
            harmonic(grid, (0.5, 0.5))
        assert time.perf_counter() - began < 1.5
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert harmonic(cs.OccupancyGrid(np.zeros((3, 3), bool)), (0.5, 0.5))[0, 0] == 0
