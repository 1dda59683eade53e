"""Voronoi Bug: verdicts against counted cells, paths in whole fractions, clearance, evidence and traces."""

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

RANGES = [0.05, 0.7, 2.0, np.inf]


def check_walk(route, start, goal):
    steps = np.linalg.norm(np.diff(route.path, axis=0), axis=1)
    assert np.isclose(route.length, steps.sum(), rtol=1e-12)
    assert np.array_equal(route.path[0], start)
    assert not route or np.array_equal(route.path[-1], goal)
    assert (route.evidence.shut is not None) == (route.status == "unreachable")
    trace = route.trace
    assert np.array_equal(trace.start, route.path[:-1])
    assert np.allclose(trace.end[:-1], route.path[1:-1], rtol=0, atol=0)
    curves = trace.only("trace")
    rings = [np.asarray(ring) for ring in route.world.walls]
    if len(curves):
        far, _ = nearest(curves.end, rings)
        assert np.all(far >= curves.value * (1 - 1e-6) - 1e-9)
        assert curves.value.min() >= route.evidence.clearance


@pytest.mark.parametrize("family", FAMILIES, ids=lambda f: f.__name__)
def test_verdicts_in_worlds_of_cells(family):
    for world, start, goal in questions(1, 40, family):
        part = world.parts()
        reachable = bool(world.parts_at(start, part) & world.parts_at(goal, part))
        polygons = polygon_world(world)
        ends = [np.array(world.place(*map(float, point))) for point in (start, goal)]
        for reach in RANGES:
            route = cs.navigate(polygons, *ends, planner="voronoi_bug", range=reach)
            assert route.status in ("found" if reachable else "unreachable", "undetermined")
            check_walk(route, *ends)
            assert not crosses_wall(route.path, world)


def test_paths_keep_out_of_polygons_exactly():
    rng = np.random.default_rng(7)
    for _ in range(12):
        polygons = []
        for _ in range(8):
            angles = np.sort(rng.uniform(0, 2 * np.pi, 5))
            polygons.append(
                rng.uniform(1, 9, 2) + rng.uniform(0.3, 1.5) * np.c_[np.cos(angles), np.sin(angles)]
            )
        world = cs.PolygonWorld(polygons, bounds=ROOM, repair=True)
        ends = [p for p in rng.uniform(0, 10, (40, 2)) if world.is_free(p)][:2]
        walked = cs.navigate(world, *ends, planner="any_angle")
        for reach in RANGES[1:]:
            route = cs.navigate(world, *ends, planner="voronoi_bug", range=reach)
            assert bool(route) == bool(walked)
            assert enters(route.path, [[p] for p in polygons], ROOM) is None


def test_it_walks_in_the_middle_of_a_corridor():
    world = cs.PolygonWorld([square(0, 4, 8)], bounds=(0, 0, 12, 12))
    route = cs.navigate(world, (1, 0.5), (9.5, 11.5), planner="voronoi_bug", range=5.0)
    assert route
    middle = route.trace.only("trace")
    straight = middle.start[(middle.start[:, 0] > 1.5) & (middle.start[:, 0] < 7)]
    assert len(straight)
    assert np.allclose(straight[:, 1], 2)
    assert np.isclose(middle.value.max(), 2)


def test_a_wall_alone_is_followed_at_the_range():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    route = cs.navigate(world, (0.8, 5), (9.2, 5), planner="voronoi_bug", range=0.5)
    assert route
    rolled = route.trace.only("roll").end
    assert len(rolled)
    far, _ = nearest(rolled, rings_of(world))
    assert np.all((far > 0.49) & (far < 0.5))
    assert np.isclose(route.evidence.clearance, far.max(), rtol=1e-6)


def test_a_goal_that_is_shut_in_names_the_ring():
    world = cs.PolygonWorld([[square(3, 3, 4), square(4, 4, 2)]], bounds=ROOM)
    for reach in RANGES:
        route = cs.navigate(world, (1, 5), (5, 5), planner="voronoi_bug", range=reach)
        assert route.status == "unreachable"
        ring, (x, y) = route.evidence.shut
        assert len(world.walls[ring]) == 4
        assert max(abs(x - 5), abs(y - 5)) == 2
        assert "exhausted" in route.reason
        inside = cs.navigate(world, (5, 5), (1, 5), planner="voronoi_bug", range=reach)
        assert inside.status == "unreachable"
        assert inside.evidence.dead_ends == 4


def test_out_of_a_spiral_however_far_it_sees():
    world = cs.PolygonWorld(spiral(4), bounds=(-20, -20, 20, 20))
    for reach in RANGES:
        route = cs.navigate(world, (1, 1), (1, 19), planner="voronoi_bug", range=reach)
        assert route
        assert route.evidence.clearance <= max(0.9, reach)
    # With a hole too small for none: a point passes gaps of any width, and says how wide they were.
    assert cs.navigate(world, (1, 1), (1, 19), planner="voronoi_bug").evidence.clearance > 0.8


def test_obstacles_that_meet_in_a_point_are_not_passed_there():
    closed = cs.PolygonWorld([square(0, 0, 5), square(5, 5, 5)], bounds=ROOM)
    for reach in RANGES:
        assert cs.navigate(closed, (3, 7), (7, 3), planner="voronoi_bug", range=reach).status == "unreachable"
        assert cs.navigate(closed, (5, 5), (7, 3), planner="voronoi_bug", range=reach)
        assert cs.navigate(closed, (5, 5), (3, 7), planner="voronoi_bug", range=reach)


def test_the_range_is_checked():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    for wrong in (0, -1):
        with pytest.raises(InputError, match="more than zero"):
            cs.navigate(world, (1, 1), (9, 9), planner="voronoi_bug", range=wrong)
    with pytest.raises(InputError, match="finite"):
        cs.navigate(world, (1, 1), (9, 9), planner="voronoi_bug", range=np.nan)
    with pytest.raises(InputError, match="inside obstacle"):
        cs.navigate(world, (5, 5), (9, 9), planner="voronoi_bug")
