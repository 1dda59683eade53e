"""Descents in potentials: they go down, never through walls, and where they rest is what they say it is."""

from __future__ import annotations

import itertools
from collections import Counter

import numpy as np
import pytest

import cspace as cs
from cspace.navigation import potential
from oracles import potentials

BOUNDS = (0, 0, 10, 10)


def box(x0, y0, x1, y1):
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)


def random_world(rng, most=20):
    obstacles = []
    for _ in range(rng.integers(most)):
        angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 8)))
        round_ = np.column_stack((np.cos(angles), np.sin(angles)))
        obstacles.append(rng.uniform(0, 10, 2) + rng.uniform(0.1, 0.7) * round_)
    return cs.PolygonWorld(obstacles, BOUNDS, repair=True)


def random_free(rng, world):
    while True:
        point = rng.uniform(0, 10, 2)
        if world.is_free(point):
            return point


def go(world, start, goal, **options):
    return cs.navigate(world, start, goal, planner="potential_field", **options)


def around(point, radius, count=64):
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return point + radius * np.column_stack((np.cos(angles), np.sin(angles)))


def check(world, route):
    """The path begins at the start, goes down, and passes through no wall; a verdict holds where it ends."""
    gains = {name: route.evidence.gains[name] for name in ("k", "k_r", "rho_0", "cone")}
    assert np.array_equal(route.path[0], route.start)
    assert not potentials.passes_through(world.walls, route.path)
    heights = potential(world, route.goal, route.path, **gains)
    assert (np.diff(heights[1:]) <= 1e-9 * (1 + np.abs(heights[1:-1]))).all()
    assert (route.status == "found") == (route.evidence.kind == "goal")
    if route:
        assert np.array_equal(route.path[-1], route.goal)
        return
    assert route.evidence.kind != "budget"
    assert (route.status == "local_minimum") == (route.evidence.kind in ("minimum", "crease"))
    assert "the descent ended at" in route.reason
    at = route.path[-1]
    assert np.hypot(*(at - route.goal)) > 1e-3 * gains["rho_0"]
    here = potentials.potential(world.walls, route.goal, at, **gains)
    if route.evidence.kind in ("minimum", "crease"):
        radius = 0.01 * min(float(world.clearance(at)), gains["rho_0"])
        assert (potential(world, route.goal, around(at, radius), **gains) >= here * (1 - 1e-12)).all()


def test_the_potential_is_that_of_all_distances():
    rng = np.random.default_rng(1)
    for _ in range(20):
        world = random_world(rng)
        goal = random_free(rng, world)
        points = np.array([random_free(rng, world) for _ in range(30)])
        gains = {"k": 2.0, "k_r": 0.3, "rho_0": float(rng.uniform(0.1, 5)), "cone": 1.5}
        expected = [potentials.potential(world.walls, goal, p, **gains) for p in points]
        assert np.allclose(potential(world, goal, points, **gains), expected, rtol=1e-12)


def test_every_descent_goes_down_and_every_rest_is_one():
    rng = np.random.default_rng(2)
    kinds = Counter()
    for _ in range(150):
        world = random_world(rng)
        route = go(world, random_free(rng, world), random_free(rng, world))
        check(world, route)
        kinds[route.evidence.kind] += 1
    assert kinds["goal"] > 75
    assert kinds["minimum"] > 15


def swings(path):
    """How often a path turns by more than 20 degrees one way, and at once by as much the other way."""
    steps = np.diff(path, axis=0)
    steps = steps[np.hypot(*steps.T) > 1e-9]
    turns = np.diff(np.arctan2(steps[:, 1], steps[:, 0]))
    turns = (turns + np.pi) % (2 * np.pi) - np.pi
    both = np.minimum(np.abs(turns[1:]), np.abs(turns[:-1]))
    return int(np.sum((turns[1:] * turns[:-1] < 0) & (both > np.radians(20))))


@pytest.mark.slow
def test_along_walls_it_does_not_swing():
    rng = np.random.default_rng(2)
    for gains in ({}, {"rho_0": 0.1}, {"k_r": 1.0}, {"k_r": 1e-8}):
        for _ in range(40):
            world = random_world(rng)
            route = go(world, random_free(rng, world), random_free(rng, world), **gains)
            check(world, route)
            assert swings(route.path) <= 10
    walls = cs.PolygonWorld([box(2, 3, 8, 4), box(2, 4.3, 8, 5.5)], BOUNDS)
    for start, goal in [((3, 4.05), (9, 4.2)), ((3, 4.25), (9, 4.05)), ((1, 2.9), (9, 3.2))]:
        for k_r in (1e-4, 1e-6, 1e-8):
            route = go(walls, start, goal, rho_0=0.5, k_r=k_r)
            check(walls, route)
            assert swings(route.path) <= 2
            assert route.stats.edges < 5000


def test_no_piece_of_the_way_climbs():
    rng = np.random.default_rng(5)
    for _ in range(40):
        world = random_world(rng)
        route = go(world, random_free(rng, world), random_free(rng, world))
        gains = {name: route.evidence.gains[name] for name in ("k", "k_r", "rho_0", "cone")}
        middle = (route.path[1:] + route.path[:-1]) / 2
        before = potential(world, route.goal, route.path[:-1], **gains)
        inside = potential(world, route.goal, middle, **gains)
        assert (inside <= before * (1 + 1e-9) + 1e-9).all()


def test_looks_that_run_out_are_told_with_what_saves_them():
    world = cs.PolygonWorld([box(4, 4, 6, 6)], BOUNDS)
    assert go(world, (1, 1), (9, 2), step=0.001)
    short = go(world, (1, 1), (9, 2), step=1e-5)
    assert short.status == "undetermined"
    assert short.evidence.kind == "budget"
    assert "the descent was at" in short.reason
    assert "a longer step= than 1e-05 m" in short.reason
    assert "ended" not in short.reason


def test_a_trap_holds_it_and_is_no_arrival():
    trap = np.array([(3, 3), (7, 3), (7, 7), (3, 7), (3, 6.5), (6.5, 6.5), (6.5, 3.5), (3, 3.5)])
    world = cs.PolygonWorld([trap], BOUNDS)
    route = go(world, (4, 5), (9, 5))
    check(world, route)
    assert route.status == "local_minimum"
    assert route.path[-1][0] < 6.5
    assert cs.navigate(world, (4, 5), (9, 5))


@pytest.mark.parametrize("sides", [4, 6, 24])
def test_a_corner_straight_ahead_is_a_saddle_that_is_left_and_a_flat_side_holds_it(sides):
    angles = np.pi + 2 * np.pi * np.arange(sides) / sides
    disc = np.array([5, 5]) + np.column_stack((np.cos(angles), np.sin(angles)))
    world = cs.PolygonWorld([disc], BOUNDS)
    route = go(world, (1, 5), (8.5, 5), rho_0=1.0)
    check(world, route)
    assert route
    assert route.evidence.saddles > 0
    flat = go(cs.PolygonWorld([box(4, 4, 6, 6)], BOUNDS), (1, 5), (9, 5), rho_0=2.0)
    assert flat.evidence.kind == "minimum"


def test_a_goal_beside_a_wall_is_missed_by_little_and_that_is_said():
    world = cs.PolygonWorld([box(4, 4, 6, 6)], BOUNDS)
    route = go(world, (1, 5), (3.9, 5), rho_0=1.0)
    check(world, route)
    assert route.status == "local_minimum"
    assert np.hypot(*(route.path[-1] - route.goal)) < 0.6
    assert "the goal itself is near a wall" in route.reason
    assert go(world, (1, 5), (3.9, 5), rho_0=0.05)


@pytest.mark.parametrize("width", [0.02, 0.2, 0.8])
def test_a_corridor_of_one_ring_does_not_make_it_swing(width):
    rooms = [box(3, 0, 7, 5 - width / 2), box(3, 5 + width / 2, 7, 10)]
    world = cs.PolygonWorld(rooms, BOUNDS)
    assert len(world.walls) == 1
    route = go(world, (1, 5), (9, 5), rho_0=1.0, k_r=1e-4)
    check(world, route)
    inside = (route.path[:, 0] > 3.5) & (route.path[:, 0] < 6.5)
    assert inside.any() == (width > 0.1)  # its mouth repels as its walls do
    assert np.abs(route.path[inside, 1] - 5).max(initial=0) < width / 4
    off = go(world, (3.5, 5 + 0.4 * width), (6.5, 5 - 0.4 * width), rho_0=1.0, k_r=1e-12)
    check(world, off)
    assert off


def test_it_starts_from_walls_and_corners():
    world = cs.PolygonWorld([box(4, 4, 6, 6)], BOUNDS)
    for start in [(4, 5), (6, 6), (5, 4), (0, 0), (10, 3)]:
        route = go(world, start, (1, 9))
        check(world, route)
        assert len(route.path) > 2


def test_it_knows_nothing_of_what_cannot_be_reached():
    world = cs.PolygonWorld([[box(3, 3, 7, 7), box(4, 4, 6, 6)]], BOUNDS)
    route = go(world, (1, 1), (5, 5))
    check(world, route)
    assert route.status == "local_minimum"


def test_a_world_without_walls_within_reach_is_walked_straight():
    route = go(cs.PolygonWorld([], BOUNDS), (2, 2), (8, 8))
    assert route.length == pytest.approx(np.hypot(6, 6), rel=1e-12)


def summed(world, goal, path, gains):
    """The integral of the potential along a path, and half the slope's part of it by the trapezoid rule."""
    pieces = [np.linspace(a, b, 9) for a, b in itertools.pairwise(path)]
    total = 0.0
    for piece in pieces:
        heights = potential(world, goal, piece, **gains)
        total += np.hypot(*(piece[1] - piece[0])) * (heights.sum() - (heights[0] + heights[-1]) / 2)
    return total


def test_the_way_down_is_not_locally_shortest_in_the_summed_potential():
    """The lecture calls the descent locally optimal in its metric, the potential summed along the path. It is
    where the path is straight; where it bends around obstacles, some smooth bump of the path sums less."""
    rng = np.random.default_rng(3)
    improved = total = 0
    gains_worst = 0.0
    for _ in range(60):
        world = random_world(rng)
        route = go(world, random_free(rng, world), random_free(rng, world))
        if not route or len(route.path) < 12:
            continue
        path = route.path
        gains = {name: route.evidence.gains[name] for name in ("k", "k_r", "rho_0", "cone")}
        along = np.concatenate(([0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
        bump = np.sin(np.pi * along / along[-1])
        chord = path[-1] - path[0]
        normal = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
        best = base = summed(world, route.goal, path, gains)
        for size in (-0.05, -0.01, 0.01, 0.05):
            best = min(best, summed(world, route.goal, path + size * bump[:, None] * normal, gains))
        total += 1
        improved += best < base * (1 - 1e-9)
        gains_worst = max(gains_worst, 1 - best / base)
    assert total > 30
    assert 0 < improved < total
    assert gains_worst > 0


def test_the_trace_is_the_descent():
    world = cs.PolygonWorld([box(4, 4, 6, 6)], BOUNDS)
    route = go(world, (1, 5), (9, 5.1), rho_0=1.0)
    trace = route.trace
    steps = trace.only("descend")
    assert np.array_equal(np.vstack([steps.start[:1], steps.end]), route.path)
    assert len(trace.only("rest")) == (not route)


def test_what_it_refuses():
    world = cs.PolygonWorld([box(4, 4, 6, 6)], BOUNDS)
    for name in ("k", "k_r", "rho_0", "cone", "step"):
        with pytest.raises(ValueError, match=name):
            go(world, (1, 1), (2, 2), **{name: -1.0})
    with pytest.raises(ValueError, match="lies inside obstacle 0"):
        go(world, (5, 5), (2, 2))
    with pytest.raises(TypeError, match="PolygonWorld"):
        potential(cs.OccupancyGrid([[0]]), (0, 0), (0, 0))
