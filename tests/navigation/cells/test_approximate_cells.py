"""Approximate cells: squares that are free lie in free space, a path keeps out of obstacles, a proof is a
proof, and what is left open closes as squares shrink."""

from __future__ import annotations

import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.navigation import approximate_cells
from oracles.segments import enters

FREE, MIXED, FULL = range(3)


def ask(world, start, goal, **options):
    """A route whose path, where there is one, is checked."""
    route = cs.navigate(world, start, goal, "approximate_cells", **options)
    assert route.reason
    assert min(route.evidence[:3]) >= 0
    if route:
        np.testing.assert_array_equal(route.path[[0, -1]], [start, goal])
        assert enters(route.path, world.obstacles, world.bounds) is None
        assert route.length == pytest.approx(np.hypot(*np.diff(route.path, axis=0).T).sum(), rel=1e-12)
    else:
        assert len(route.path) == 0
    return route


def gate(low, high, side=16.0):
    """A wall across a square world with a gap from low to high."""
    left, right = side / 2 - 0.3, side / 2 + 0.3
    below = [(left, 0), (right, 0), (right, low), (left, low)]
    above = [(left, high), (right, high), (right, side), (left, side)]
    return cs.PolygonWorld([below, above], (0, 0, side, side))


def are_connected(world, start, goal):
    one, other = (set(world._core.components_at(tuple(map(float, p)))) for p in (start, goal))
    return bool(one & other)


@pytest.mark.parametrize("shift", [0.0, 0.5, 0.25])
@pytest.mark.parametrize("width", [0.98, 1.02, 1.98, 2.02])
def test_gaps_about_as_wide_as_a_square(width, shift):
    """Squares of one metre: a gap is seen if it holds a whole row of them."""
    world = gate(5 + shift, 5 + shift + width)
    holds = math.floor(5 + shift + width) - math.ceil(5 + shift) >= 1
    route = ask(world, (1.3, 5.4), (14.2, 5.6), depth=4, refine=False)
    assert route.status == ("found" if holds else "undetermined")
    assert ask(world, (1.3, 5.4), (14.2, 5.6), depth=4)
    assert ask(world, (1.3, 5.4), (14.2, 5.6), depth=2, min_size=1.0).status == route.status


@pytest.mark.parametrize("angle", [0.0, 0.3, math.pi / 4, 1.2])
@pytest.mark.parametrize("width", [0.6, 0.1])
def test_corridors_at_an_angle(angle, width):
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([(c, -s), (s, c)])
    near, far = width / 2, 30
    blocks = [[(-4, k * near), (4, k * near), (4, k * far), (-4, k * far)] for k in (1, -1)]
    world = cs.PolygonWorld([np.array(block) @ turn.T for block in blocks], (-8, -8, 8, 8))
    start, goal = turn @ (-6, 0.01), turn @ (6, 0.02)
    assert ask(world, start, goal, depth=3, refine=False).status == "undetermined"
    assert ask(world, start, goal, depth=3)


def test_a_gap_without_width_is_no_way():
    for low in (5.3, 5.0):
        route = ask(gate(low, low), (1, 1), (15, 15), max_depth=10)
        assert route.status in {"unreachable", "undetermined"}
    boxes = [[(0, 0), (4, 0), (4, 4), (0, 4)], [(4, 4), (8, 4), (8, 8), (4, 8)]]
    assert ask(cs.PolygonWorld(boxes, (0, 0, 8, 8)), (1, 7), (7, 1)).status == "unreachable"


def test_a_wall_without_thickness_on_a_line_of_the_tree():
    for end, status in ((8.0, "unreachable"), (7.9, "found")):
        world = cs.PolygonWorld([[(4, 0), (4, end), (4, 0)]], (0, 0, 8, 8), repair=True)
        assert ask(world, (1, 1), (7, 1)).status == status


def test_a_goal_in_a_mixed_square_is_joined_to_a_free_one_that_it_sees():
    world = cs.PolygonWorld([[(3.1, 3.1), (6.2, 3.1), (6.2, 6.2), (3.1, 6.2)]], (0, 0, 8, 8))
    assert ask(world, (1, 1), (3.0, 4.0), depth=2, refine=False)
    assert ask(world, (1, 1), (3.0, 4.0), depth=1, refine=False).status == "undetermined"
    slanted = cs.PolygonWorld([[(3, 3), (5, 4), (4, 6)]], (0, 0, 8, 8))
    for goal in ((4, 3.5), (3, 3), (4, 6), (4.5, 5)):
        route = ask(slanted, (1, 1), goal)
        assert route, goal
        assert enters(route.path, slanted.obstacles, slanted.bounds) is None


def test_whole_numbers_against_what_is_connected():
    rng = np.random.default_rng(4)
    seen = set()
    for _ in range(40):
        rings = [rng.integers(0, 9, (rng.integers(3, 6), 2)) for _ in range(rng.integers(1, 7))]
        rings = [ring for ring in rings if len(np.unique(ring, axis=0)) > 2]
        world = cs.PolygonWorld(rings, (0, 0, 8, 8), repair=True)
        points = [p for p in rng.integers(0, 33, (12, 2)) / 4 if world.is_free(p)]
        for start, goal in zip(points[::2], points[1::2], strict=False):
            route = ask(world, start, goal, max_depth=8)
            seen.add(route.status)
            if route.status != "undetermined":
                assert bool(route) == are_connected(world, start, goal)
    assert {"found", "unreachable"} <= seen


def test_uniform_squares_are_manhattan_optimal():
    """Against breadth-first steps over the same squares."""
    rng = np.random.default_rng(5)
    rings = [np.array([(0, 0), (1.7, 0.2), (0.9, 1.6)]) + rng.uniform(0.2, 14, 2) for _ in range(22)]
    world = cs.PolygonWorld(rings, (0, 0, 16, 16), repair=True)
    squares, kinds = approximate_cells(world, 5, uniform=True)
    free = {tuple(map(int, 2 * square[:2])) for square in squares[kinds == FREE]}
    first, last = min(free), max(free)
    steps, wave = {first: 0}, [first]
    for x, y in wave:
        for near in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            if near in free and near not in steps:
                steps[near] = steps[x, y] + 1
                wave.append(near)
    start, goal = (np.array(first) + 0.5) / 2, (np.array(last) + 0.5) / 2
    route = ask(world, start, goal, depth=5, uniform=True, refine=False)
    assert np.abs(np.diff(route.path, axis=0)).sum() == pytest.approx(steps[last] * 0.5, rel=1e-12)


def test_the_squares_tile_the_world():
    world = cs.PolygonWorld([[(2, 2), (5, 3), (3, 6)], [(6, 1), (7, 1), (7, 2)]], (0, 0, 8, 6.5))
    cells = approximate_cells(world, 6)
    squares, kinds = cells.squares, cells.kinds
    areas = (squares[:, 2:] - squares[:, :2]).prod(axis=1)
    assert areas.sum() == pytest.approx(64)
    free, mixed = areas[kinds == FREE].sum(), areas[kinds == MIXED].sum()
    assert free < 8 * 6.5 - 5.5 - 0.5 < free + mixed
    middles = 0.5 * (squares[:, :2] + squares[:, 2:])
    assert np.all(world.is_free(middles[kinds == FREE]))
    assert not np.any(world.is_free(middles[kinds == FULL]))


def test_trace_and_evidence():
    route = ask(gate(5.2, 5.9), (1, 1), (15, 15), depth=2)
    assert {word for word, *_ in route.trace} == {"split", "free", "expand"}
    assert len(route.trace.only("expand")) >= route.stats.nodes > 0
    assert route.evidence.depth > 2
    assert route.evidence.side == 16 / 2**route.evidence.depth


def test_options_that_make_no_sense():
    world = gate(5, 6)
    with pytest.raises(UnknownNameError, match="manhattan"):
        ask(world, (1, 1), (2, 2), metric="manhatten")
    for options in ({"depth": -1}, {"max_depth": 99}, {"min_size": -1.0}):
        with pytest.raises(InputError, match="it must be"):
            ask(world, (1, 1), (2, 2), **options)
    with pytest.raises(InputTypeError, match="depth is a float; it must be a whole number"):
        ask(world, (1, 1), (2, 2), depth=2.5)


@pytest.mark.slow
def test_a_tree_that_is_kept_answers_as_one_made_anew():
    rng = np.random.default_rng(6)
    corners = rng.uniform(0, 9, (25, 2))
    world = cs.PolygonWorld(
        [c + 0.8 * rng.random((3, 2)) for c in corners], bounds=(0, 0, 10, 10), repair=True
    )
    free = [p for p in rng.uniform(0, 10, (60, 2)) if world.is_free(p)]
    choices = ({}, {"depth": 2}, {"depth": 2, "max_depth": 8}, {"depth": 3, "uniform": True})
    asked = [(*pair, options) for options in choices for pair in zip(free[::2], free[1::2], strict=False)]
    fresh = [ask(pickle.loads(pickle.dumps(world)), a, b, **options) for a, b, options in asked]
    with ThreadPoolExecutor(3) as pool:
        routes = list(pool.map(lambda one: ask(world, one[0], one[1], **one[2]), asked * 2))
    for route, other in zip(routes, fresh * 2, strict=True):
        np.testing.assert_array_equal(route.path, other.path)
        assert (route.status, route.evidence, route.stats[:2]) == (
            *(other.status, other.evidence),
            other.stats[:2],
        )
    assert any(route.evidence.depth > route.options["depth"] for route in fresh)
