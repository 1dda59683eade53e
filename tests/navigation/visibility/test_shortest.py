"""The shortest path in a polygon world, found in two ways, and the chain of exact cells that is never
shorter."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputTypeError, UnknownNameError
from data import shared_data
from oracles.segments import enters

SHORTEST = ("any_angle", "visibility_graph")
ALL = (*SHORTEST, "exact_cells")


def convex_field(rng, count, side=100.0):
    """Disjoint convex polygons, one in each cell of a raster."""
    columns = math.ceil(math.sqrt(count))
    cell = side / columns
    obstacles = []
    for k in range(count):
        center = (np.array([k % columns, k // columns]) + 0.5) * cell
        angles = np.sort(rng.uniform(0, 2 * np.pi, 6))
        radius = rng.uniform(0.25, 0.48) * cell
        obstacles.append(center + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    return cs.PolygonWorld(obstacles, (0, 0, side, side))


def whole_numbers(rng, side=8, repair=True):
    """Polygons of whole numbers that touch, overlap and cross themselves."""
    count = rng.integers(1, 7)
    rings = [rng.integers(0, side + 1, (rng.integers(3, 6), 2)) for _ in range(count)]
    rings = [ring for ring in rings if len(np.unique(ring, axis=0)) > 2]
    return cs.PolygonWorld(rings, (0, 0, side, side), repair=repair)


def free_points(rng, world, count, step=0.5):
    xmin, ymin, xmax, ymax = world.bounds
    points = []
    while len(points) < count:
        p = np.round(rng.uniform((xmin, ymin), (xmax, ymax)) / step) * step
        if world.is_free(p):
            points.append(p)
    return points


def check_found(route, world):
    assert route.status == "found"
    assert route
    legs = np.diff(route.path, axis=0)
    assert route.length == pytest.approx(float(np.hypot(*legs.T).sum()), rel=1e-12)
    np.testing.assert_array_equal(route.path[0], route.start)
    np.testing.assert_array_equal(route.path[-1], route.goal)
    assert enters(route.path, world.obstacles, world.bounds) is None


@pytest.mark.data
@pytest.mark.parametrize("planner", SHORTEST)
def test_recorded_worlds(planner):
    for recorded in json.loads((shared_data() / "navigation/poly/worlds.json").read_text()):
        world = cs.PolygonWorld(recorded["polygons"], recorded["bounds"])
        for query in recorded["queries"]:
            route = cs.navigate(world, query["start"], query["goal"], planner)
            assert route.length == pytest.approx(query["length"], abs=1e-12)
            check_found(route, world)


@pytest.mark.slow
@pytest.mark.data
@pytest.mark.parametrize("name", ["arena", "brc202d", "AcrosstheCape"])
def test_every_line_of_the_grids(name):
    folder = shared_data() / "navigation"
    grid = cs.OccupancyGrid.from_movingai(folder / f"grid/{name}.map")
    lines = (folder / f"grid/{name}.map.scen").read_text().splitlines()[1:]
    ends = np.array([line.split()[4:8] for line in lines if line.strip()], float)
    truth = np.loadtxt(folder / f"mesh/anyangle_{name}.txt")
    found = np.array([cs.navigate(grid, row[:2], row[2:], "any_angle").length for row in ends])
    digits = np.where(truth < 1000, 6e-10, 6e-9)  # as many as the file has
    assert len(found) == len(truth)
    assert np.all(np.abs(found - truth) <= digits)


def test_convex_fields():
    rng = np.random.default_rng(1)
    for count in (1, 9, 40):
        world = convex_field(rng, count)
        for start, goal in rng.uniform(0, 100, (30, 2, 2)):
            if not (world.is_free(start) and world.is_free(goal)):
                continue
            routes = [cs.navigate(world, start, goal, planner) for planner in ALL]
            for route in routes:
                check_found(route, world)
            assert routes[0].length == pytest.approx(routes[1].length, rel=1e-12)
            assert routes[2].length >= routes[0].length * (1 - 1e-12)


def test_degenerate_worlds_of_whole_numbers():
    rng = np.random.default_rng(2)
    verdicts = set()
    for _ in range(60):
        world = whole_numbers(rng)
        if world.components == 0:
            continue
        points = free_points(rng, world, 8)
        for start, goal in zip(points[::2], points[1::2], strict=True):
            routes = [cs.navigate(world, start, goal, planner) for planner in ALL]
            assert len({route.status for route in routes}) == 1
            verdicts.add(routes[0].status)
            assert all(route.reason for route in routes)
            if routes[0]:
                assert routes[0].length == pytest.approx(routes[1].length, rel=1e-12)
                assert routes[2].length >= routes[0].length * (1 - 1e-12)
                straight = math.dist(start, goal)
                assert routes[0].length >= straight * (1 - 1e-12)
            else:
                assert routes[0].length == np.inf
                assert routes[0].path.shape == (0, 2)
    assert verdicts == {"found", "unreachable"}


def test_a_gap_without_width_is_no_way_but_one_of_a_hair_is():
    left, right = [(0, 4), (5, 4), (5, 6), (0, 6)], [(5, 4), (10, 4), (10, 6), (5, 6)]
    corner = [(5, 6), (10, 6), (10, 8), (5, 8)]
    for other in (right, corner):
        for planner in ALL:
            route = cs.navigate(cs.PolygonWorld([left, other], (0, 0, 10, 10)), (1, 1), (9, 9), planner)
            assert route.status == "unreachable"
    hair = [(x + 1e-9, y) for x, y in right]
    for planner in ALL:
        world = cs.PolygonWorld([left, hair], (0, 0, 10, 10))
        route = cs.navigate(world, (1, 1), (1, 9), planner)
        check_found(route, world)
        assert route.length == pytest.approx(2 * 5 + 2, abs=1e-6)


@pytest.mark.parametrize("planner", ALL)
def test_walls_may_be_touched(planner):
    world = cs.PolygonWorld([[(4, 4), (6, 4), (6, 6), (4, 6)]], (0, 0, 10, 10))
    ways = {((0, 4), (10, 4)): 10, ((4, 5), (6, 5)): 4, ((4, 4), (6, 6)): 4, ((3, 3), (3, 3)): 0}
    for (start, goal), length in ways.items():
        route = cs.navigate(world, start, goal, planner)
        assert route.length == pytest.approx(length, abs=1e-12)
        assert len(route.path) >= 1


@pytest.mark.parametrize("shift", [1e6, -1e6, 1e9])
def test_far_from_the_origin(shift):
    """Moved by whole numbers, a world of whole numbers has the same paths."""
    rng = np.random.default_rng(6)
    for _ in range(10):
        near = whole_numbers(rng, side=16)
        rings = [[ring + shift for ring in rings] for rings in near.obstacles]
        far = cs.PolygonWorld(rings, np.array(near.bounds) + shift, repair=True)
        start, goal = free_points(rng, near, 2, step=1.0)
        for planner in ALL:
            here = cs.navigate(near, start, goal, planner)
            there = cs.navigate(far, start + shift, goal + shift, planner)
            assert here.status == there.status
            if here:
                assert there.length == pytest.approx(here.length, abs=1e-6)


@pytest.mark.parametrize("planner", ALL)
def test_a_trace_replays_the_search(planner):
    world = convex_field(np.random.default_rng(7), 25)
    corner = [p for p in ((0.5, 0.5), (99.5, 99.5)) if world.is_free(p)]
    assert len(corner) == 2
    route = cs.navigate(world, *corner, planner)
    assert len(route.trace) > 0
    assert route.trace is route.trace
    assert {word for word, *_ in route.trace} == set(route.trace.words)
    assert len(route.trace.only(route.trace.words[0])) == len(route.trace)
    assert route.stats.nodes > 0
    assert route.stats.seconds > 0


def test_a_disc_keeps_its_radius():
    world = convex_field(np.random.default_rng(8), 16)
    route = cs.navigate(world, (1, 1), (99, 99), radius=0.5)
    assert route
    dense = np.vstack([np.linspace(a, b, 200) for a, b in zip(route.path, route.path[1:], strict=False)])
    assert world.clearance(dense).min() >= 0.5 - 1e-12


def test_questions_that_make_no_sense():
    world = cs.PolygonWorld([], (0, 0, 1, 1))
    with pytest.raises(UnknownNameError, match="visibility_graph"):
        cs.navigate(world, (0, 0), (1, 1), "visibility_grph")
    with pytest.raises(InputTypeError, match="weight"):
        cs.navigate(world, (0, 0), (1, 1), weight=2)
    with pytest.raises(InputTypeError, match=r"'metric'.*one value"):
        cs.navigate(world, (0, 0), (1, 1), "a_star", metric=["octile"])
    with pytest.raises(InputTypeError, match="PolygonWorld"):
        cs.navigate([[0, 0]], (0, 0), (1, 1))  # type: ignore[arg-type]


def test_the_graph_and_the_cells_can_be_looked_at():
    from cspace.navigation.cells.exact_cells import exact_cells
    from cspace.navigation.visibility.visibility_graph import visibility_graph

    world = cs.PolygonWorld([[(4, 4), (6, 4), (6, 6), (4, 6)]], (0, 0, 10, 10))
    graph = visibility_graph(world)
    nodes, edges = graph
    assert graph.corners is nodes
    assert graph.edges.shape == (len(edges), 2)
    assert len(nodes) == 4
    assert len(edges) == 4
    cells, doors = exact_cells(world)
    assert len(doors) >= 4
    x, y = cells[..., 0], cells[..., 1]
    area = 0.5 * np.abs(np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1), axis=1))
    assert area.sum() == pytest.approx(96)
    assert np.sum(area > 0) == 4
