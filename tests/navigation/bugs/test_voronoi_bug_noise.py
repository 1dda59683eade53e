"""Voronoi Bug with noise: what it finds, that its walks are free, that it never claims too much."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from navigation.bugs.test_bugs import ROOM, polygon_world, spiral, square
from navigation.bugs.worlds import FAMILIES, questions
from oracles.cell_worlds import crosses_wall
from oracles.clearance import nearest, rings_of
from oracles.segments import enters


def convex_field(rng):
    polygons = []
    for _ in range(10):
        angles = np.sort(rng.uniform(0, 2 * np.pi, 5))
        reach = rng.uniform(0.3, 1.2)
        polygons.append(rng.uniform(1, 9, 2) + reach * np.c_[np.cos(angles), np.sin(angles)])
    world = cs.PolygonWorld(polygons, bounds=ROOM, repair=True)
    ends = [p for p in rng.uniform(0, 10, (60, 2)) if world.is_free(p)][:2]
    return polygons, world, ends


def off_middle(noise, rng):
    """How far from the middle of a corridor a robot is at most that follows it."""
    world = cs.PolygonWorld([square(0, 4, 8)], bounds=(0, 0, 12, 12))
    route = cs.navigate(world, (1, 0.5), (9.5, 11.5), planner="voronoi_bug", range=5.0, noise=noise, rng=rng)
    assert route
    middle = route.trace.only("trace").start
    middle = middle[(middle[:, 0] > 2.5) & (middle[:, 0] < 7)]
    return np.abs(middle[:, 1] - 2).mean()


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES, ids=lambda f: f.__name__)
def test_walks_are_free_and_goals_are_never_called_unreachable(family):
    reachable = found = 0
    for number, (world, start, goal) in enumerate(questions(2, 6, family)):
        part = world.parts()
        polygons = polygon_world(world)
        ends = [np.array(world.place(*map(float, point))) for point in (start, goal)]
        is_reachable = bool(world.parts_at(start, part) & world.parts_at(goal, part))
        for reach, noise in [(2.0, 0.02), (2.0, 0.1), (np.inf, 0.05)]:
            options = {"range": reach, "noise": noise, "rng": number}
            route = cs.navigate(polygons, *ends, planner="voronoi_bug", **options)
            assert route.status in ("found", "undetermined")
            assert is_reachable or not route
            assert not crosses_wall(route.path, world)
            assert np.array_equal(route.path[0], ends[0])
            assert route.evidence.scans > 0
            assert route.evidence.shut is None
            reachable += is_reachable
            found += bool(route)
    assert found >= 0.85 * reachable


def test_paths_keep_out_of_polygons_exactly():
    rng = np.random.default_rng(11)
    reachable = found = 0
    for number in range(8):
        polygons, world, ends = convex_field(rng)
        for noise in (0.02, 0.1):
            route = cs.navigate(world, *ends, planner="voronoi_bug", range=2.0, noise=noise, rng=number)
            assert enters(route.path, [[p] for p in polygons], ROOM) is None
            reachable += bool(cs.navigate(world, *ends, planner="any_angle"))
            found += bool(route)
    assert found >= 0.9 * reachable


def test_less_noise_comes_nearer_to_the_middle():
    assert off_middle(1e-9, 0) < 0.03
    assert np.mean([off_middle(0.05, seed) for seed in range(5)]) < 0.05
    assert np.mean([off_middle(0.25, seed) for seed in range(5)]) < 0.15


def test_clearance_is_about_that_without_noise():
    world = cs.PolygonWorld(spiral(4), bounds=(-20, -20, 20, 20))
    exact = cs.navigate(world, (1, 1), (1, 19), planner="voronoi_bug")
    for seed in range(3):
        route = cs.navigate(world, (1, 1), (1, 19), planner="voronoi_bug", noise=0.05, rng=seed)
        assert route
        assert route.length < 1.5 * exact.length
        curve = route.trace.only("trace").end
        far, _ = nearest(curve, rings_of(world))
        assert far.min() > 0.7 * exact.evidence.clearance


def test_the_same_seed_is_the_same_walk():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    ask = {"planner": "voronoi_bug", "range": 3.0, "noise": 0.1}
    one, two, other = (cs.navigate(world, (1, 1), (9, 9), rng=seed, **ask) for seed in (4, 4, 5))
    assert np.array_equal(one.path, two.path)
    assert not np.array_equal(one.path, other.path)
    assert one.options["rng"] == 4
    assert np.array_equal(one.trace.end[-1], one.path[-1])
    drawn = cs.navigate(world, (1, 1), (9, 9), **ask)
    assert np.array_equal(drawn.trace.start, drawn.path[:-1])
    generator = np.random.default_rng(3)
    assert cs.navigate(world, (1, 1), (9, 9), rng=generator, **ask)


def test_a_goal_that_is_shut_in_stays_undetermined():
    world = cs.PolygonWorld([[square(3, 3, 4), square(4, 4, 2)]], bounds=ROOM)
    for start, goal in [((1, 5), (5, 5)), ((5, 5), (1, 5))]:
        route = cs.navigate(world, start, goal, planner="voronoi_bug", range=2.0, noise=0.05, rng=1)
        assert route.status == "undetermined"
        assert "which is no proof" in route.reason


def test_noise_is_checked():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    ask = {"planner": "voronoi_bug", "range": 2.0}
    for wrong in (-0.1, 0.41):
        with pytest.raises(InputError, match="a fifth of the farthest reading"):
            cs.navigate(world, (1, 1), (9, 9), noise=wrong, **ask)
    with pytest.raises(InputError, match="a fifth of the farthest reading"):
        cs.navigate(world, (1, 1), (9, 9), planner="voronoi_bug", noise=1e160)
    with pytest.raises(InputError, match="finite"):
        cs.navigate(world, (1, 1), (9, 9), noise=np.nan, **ask)
    with pytest.raises(InputError, match="seed"):
        cs.navigate(world, (1, 1), (9, 9), noise=0.1, rng=-1, **ask)
