"""The planners without a map: verdicts against counted cells, bounds, paths, evidence and traces."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, UnknownNameError
from navigation.bugs.worlds import FAMILIES, questions
from oracles.cell_worlds import crosses_wall

BUGS = [("bug_1", {}), ("bug_2", {}), ("bug_1", {"hand": "right"}), ("bug_2", {"hand": "right"})]
TANGENT = [("tangent_bug", {"range": reach}) for reach in (0.0, 1.5, np.inf)]


def polygon_world(world):
    polygons = world.polygons()
    low, high = np.min(np.vstack(polygons), axis=0), np.max(np.vstack(polygons), axis=0)
    return cs.PolygonWorld(polygons, bounds=(*low, *high))


def perimeters(world):
    return np.array([np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).sum() for ring in world.walls])


def check_walk(route, start, goal):
    """The path is what the length, the evidence and the trace say."""
    steps = np.linalg.norm(np.diff(route.path, axis=0), axis=1)
    assert np.isclose(route.length, steps.sum(), rtol=1e-12)
    assert np.array_equal(route.path[0], start)
    if route:
        assert np.array_equal(route.path[-1], goal)
        assert route.evidence.shut is None
    else:
        assert route.status == "unreachable"
        assert "separates it from the goal" in route.reason
    trace = route.trace
    assert len(trace.only("hit")) == len(trace.only("leave")) == len(route.evidence.hits)
    assert np.allclose(trace.only("hit").start, route.evidence.hits, rtol=0, atol=1e-9)
    walked = np.linalg.norm(trace.only("follow").end - trace.only("follow").start, axis=1).sum()
    assert np.isclose(walked, route.evidence.walked.sum(), rtol=1e-9, atol=1e-9)


def check_bound(route, lengths, entries):
    D = np.linalg.norm(route.goal - route.start)
    met = route.evidence.rings
    if route.planner == "bug_1":
        assert len(set(met)) == len(met)  # no ring twice
        assert route.length <= (D + 1.5 * lengths[met].sum()) * (1 + 1e-12)
    else:
        assert len(met) <= entries
        assert np.all(route.evidence.walked <= lengths[met] * (1 + 1e-12))
        assert route.length <= (D + lengths[met].sum()) * (1 + 1e-12)


@pytest.mark.parametrize("family", FAMILIES, ids=lambda f: f.__name__)
def test_verdicts_and_bounds_in_worlds_of_cells(family):
    for world, start, goal in questions(0, 60, family):
        part = world.parts()
        reachable = bool(world.parts_at(start, part) & world.parts_at(goal, part))
        polygons = polygon_world(world)
        lengths, entries = perimeters(polygons), world.entries(start, goal)
        ends = [np.array(world.place(*map(float, point))) for point in (start, goal)]
        for planner, options in BUGS + TANGENT:
            route = cs.navigate(polygons, *ends, planner=planner, **options)
            assert bool(route) == reachable, (planner, options, start, goal, world)
            check_walk(route, *ends)
            assert not crosses_wall(route.path, world)
            if planner != "tangent_bug" and len(world.parts_at(start, part)) == 1:
                check_bound(route, lengths, entries)


def stars(rng, scale, offset):
    """Up to 20 overlapping polygons, some with corners on a lattice, near the origin or far from it."""
    polygons = []
    for _ in range(rng.integers(1, 21)):
        n = rng.integers(3, 9)
        angles, radii = np.sort(rng.uniform(0, 2 * np.pi, n)), rng.uniform(0.2, 3, (n, 1))
        corners = rng.uniform(0, 10, 2) + radii * np.c_[np.cos(angles), np.sin(angles)]
        polygons.append(scale * np.round(corners, rng.choice([0, 1, 15])) + offset)
    return polygons


def test_verdicts_in_fields_of_overlapping_polygons():
    rng = np.random.default_rng(3)
    judged = 0
    while judged < 150:
        scale = 10.0 ** rng.integers(-3, 4)
        offset = scale * rng.choice([0, 1e3, 1e6]) * rng.normal(size=2)
        bounds = (*(offset - scale), *(offset + 11 * scale))
        try:
            world = cs.PolygonWorld(stars(rng, scale, offset), bounds=bounds, repair=True)
        except InputError:  # rounding left a polygon without corners
            continue
        ring = world.walls[rng.integers(len(world.walls))]
        points = [*(offset + scale * rng.uniform(-1, 11, (3, 2))), ring[0], (ring[0] + ring[1]) / 2]
        points = [point for point in points if world.is_free(point)]
        start, goal = (points[k] for k in rng.integers(len(points), size=2))
        judged += 1
        # Two points of one triangulation: the parts of free space that hold them.
        parts = [set(world._core.components_at(point)) for point in (start, goal)]
        for planner, options in BUGS + TANGENT:
            route = cs.navigate(world, start, goal, planner=planner, **options)
            assert bool(route) == bool(parts[0] & parts[1]), (planner, options, start, goal)


def square(x, y, side):
    return np.array([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], dtype=float)


ROOM = (0.0, 0.0, 10.0, 10.0)


@pytest.mark.parametrize("planner", ["bug_1", "bug_2", "tangent_bug"])
def test_a_goal_that_is_shut_in_names_the_ring_and_a_point_of_it(planner):
    yard = [square(3, 3, 4), square(4, 4, 2)]
    world = cs.PolygonWorld([yard], bounds=ROOM)
    route = cs.navigate(world, (1, 5), (5, 5), planner=planner)
    ring, (x, y) = route.evidence.shut
    assert not route
    assert len(world.walls[ring]) == 4
    assert np.isclose(perimeters(world)[ring], 16)
    assert max(abs(x - 5), abs(y - 5)) == 2  # on the outside of the yard
    inside = cs.navigate(world, (5, 5), (1, 5), planner=planner)
    assert not inside
    assert np.isclose(perimeters(world)[inside.evidence.shut[0]], 8)


@pytest.mark.parametrize("planner", ["bug_1", "bug_2", "tangent_bug"])
def test_degenerate_ends(planner):
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    for start, goal in [
        ((1, 1), (1, 1)),
        ((4, 5), (6, 5)),
        ((4, 4), (6, 6)),
        ((0, 0), (10, 10)),
        ((0, 5), (5, 0)),
    ]:
        route = cs.navigate(world, start, goal, planner=planner)
        assert route
        assert np.array_equal(route.path[0], start)
        assert np.array_equal(route.path[-1], goal)
    along = cs.navigate(world, (1, 4), (9, 4), planner=planner)  # along a wall, without a hit
    assert np.isclose(along.length, 8)
    assert len(along.evidence.hits) == 0
    touching = cs.navigate(world, (3, 7), (5, 9), planner=planner)
    assert np.isclose(touching.length, np.sqrt(8))
    corner = cs.navigate(world, (2, 4), (4, 8), planner=planner)
    assert bool(corner)


@pytest.mark.parametrize("planner", ["bug_1", "bug_2", "tangent_bug"])
def test_obstacles_that_meet_in_a_point_are_not_passed_there(planner):
    world = cs.PolygonWorld([square(2, 2, 3), square(5, 5, 3)], bounds=ROOM)
    route = cs.navigate(world, (3, 7), (7, 3), planner=planner)  # the line leads through the point (5, 5)
    assert route
    assert route.length > 5 * np.sqrt(2)
    closed = cs.PolygonWorld([square(0, 0, 5), square(5, 5, 5)], bounds=ROOM)
    assert cs.navigate(closed, (3, 7), (7, 3), planner=planner).status == "unreachable"
    # From the point itself both sides can be reached.
    assert cs.navigate(closed, (5, 5), (7, 3), planner=planner)
    assert cs.navigate(closed, (5, 5), (3, 7), planner=planner)


def test_bug_1_returns_the_shorter_way():
    world = cs.PolygonWorld([np.array([(4, 2), (5, 2), (5, 8), (4, 8)])], bounds=ROOM)
    route = cs.navigate(world, (1, 3), (9, 3), planner="bug_1")
    assert np.isclose(route.length, 3 + 14 + 3 + 4)


def spiral(turns):
    """A wall that winds out from (0, 0), leg after leg, as rectangles."""
    at, walls = np.zeros(2), []
    for leg in range(4 * turns):
        along = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])[leg % 4]
        end = at + (2 + 2 * (leg // 2)) * along
        low, high = np.minimum(at, end) - 0.1, np.maximum(at, end) + 0.1
        walls.append(np.array([low, (high[0], low[1]), high, (low[0], high[1])]))
        at = end
    return walls


def test_bug_2_wins_among_convex_obstacles_and_bug_1_in_a_spiral():
    field = [square(2 + 3 * (k % 3), 1 + 3 * (k // 3), 1.5) for k in range(9)]
    world = cs.PolygonWorld(field, bounds=(0, 0, 12, 10))
    lengths = [cs.navigate(world, (0.5, 2), (11.5, 8), planner=p).length for p in ("bug_1", "bug_2")]
    assert lengths[1] < lengths[0]
    world = cs.PolygonWorld(spiral(8), bounds=(-50, -50, 50, 50))
    lengths = [cs.navigate(world, (1, 1), (1, 40), planner=p).length for p in ("bug_1", "bug_2")]
    assert 1.5 * lengths[0] < lengths[1]


def test_long_sight_shortens_the_walk_of_tangent_bug():
    rng = np.random.default_rng(5)
    total = np.zeros(3)
    for _ in range(30):
        field = [square(*rng.uniform(1, 18, 2), rng.uniform(0.5, 2)) for _ in range(20)]
        world = cs.PolygonWorld(field, bounds=(0, 0, 20, 20))
        routes = [cs.navigate(world, (0.1, 0.1), (19.9, 19.9), planner=p, **o) for p, o in TANGENT]
        assert all(routes)
        total += [route.length for route in routes]
    assert total[2] < total[1] < total[0]
    shortest = 30 * np.linalg.norm([19.8, 19.8])
    assert total[2] < 1.1 * shortest


def test_options_are_checked():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    with pytest.raises(UnknownNameError, match="did you mean 'left'"):
        cs.navigate(world, (1, 1), (9, 9), planner="bug_1", hand="lft")
    with pytest.raises(InputError, match="range is -1"):
        cs.navigate(world, (1, 1), (9, 9), planner="tangent_bug", range=-1)
    with pytest.raises(InputError, match="finite"):
        cs.navigate(world, (1, 1), (9, 9), planner="tangent_bug", range=np.nan)
    with pytest.raises(InputError, match="inside obstacle"):
        cs.navigate(world, (5, 5), (9, 9), planner="bug_2")


def test_a_robot_of_some_size_walks_around_grown_walls():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    route = cs.navigate(world, (1, 5), (9, 5), planner="bug_2", radius=0.5)
    assert route
    assert world.clearance(route.path).min() > 0.5 - 1e-9


def test_a_walk_is_repeatable_and_shares_no_state():
    world = cs.PolygonWorld([square(4, 4, 2)], bounds=ROOM)
    first = cs.navigate(world, (1, 5), (9, 5.5), planner="bug_1")
    for _ in range(3):
        again = cs.navigate(world, (1, 5), (9, 5.5), planner="bug_1")
        assert np.array_equal(again.path, first.path)
    assert first.stats.nodes > 0
    assert first.options == {"hand": "left"}
