"""The Voronoi roadmap: points as far from two walls, all of them, and the widest way along them."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, UnknownNameError
from cspace.navigation import voronoi_diagram
from data import shared_data
from oracles import roadmap
from oracles.clearance import is_free, nearest, rings_of, widest_over_grid


def blob(rng, center, size, corners):
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    radii = size * rng.uniform(0.4, 1, corners)
    return np.asarray(center) + np.column_stack((radii * np.cos(angles), radii * np.sin(angles)))


def field(seed, per_side=4, integer=False):
    """Obstacles of random corners, some of which touch or overlap."""
    rng = np.random.default_rng(seed)
    obstacles = []
    for i in range(per_side):
        for j in range(per_side):
            if rng.random() < 0.85:
                ring = blob(rng, (i + 0.5, j + 0.5), rng.uniform(0.2, 0.65), int(rng.integers(3, 8)))
                ring = np.round(ring * 4) / 4 if integer else ring
                if len(np.unique(ring, axis=0)) > 1:
                    obstacles.append(ring)
    return cs.PolygonWorld(obstacles, bounds=(0, 0, per_side, per_side), repair=True)


def corridors():
    return cs.PolygonWorld(
        [[(x, y), (x + 2, y), (x + 2, y + 2), (x, y + 2)] for x in (0, 4) for y in (0, 4)],
        bounds=(0, 0, 6, 6),
    )


def comb():
    teeth = [[(x, 0), (x + 1, 0), (x + 1, 5), (x, 5)] for x in (1, 5)]
    teeth += [[(x, 1), (x + 1, 1), (x + 1, 6), (x, 6)] for x in (3, 7)]
    return cs.PolygonWorld(teeth, bounds=(0, 0, 9, 6))


def thin_walls():
    walls = [[(2, 5), (8, 5), (2, 5)], [(5, 2), (5, 8), (5, 2)], [(1, 1), (2, 1), (2, 2), (1, 2)]]
    walls.append([(2, 2), (3, 2), (3, 3), (2, 3)])
    return cs.PolygonWorld(walls, bounds=(0, 0, 10, 10), repair=True)


WORLDS = {f"field {seed}": (lambda seed=seed: field(seed)) for seed in range(6)}
WORLDS |= {f"quarters {seed}": (lambda seed=seed: field(seed, integer=True)) for seed in range(6)}
WORLDS["a disc that bulges beyond a point"] = lambda: field(296, per_side=5)
WORLDS |= {"corridors": corridors, "comb": comb, "thin walls": thin_walls}


@pytest.fixture(params=list(WORLDS))
def world(request):
    return WORLDS[request.param]()


def free_points(world, count, seed=0):
    rng = np.random.default_rng(seed)
    left, low, right, high = world.bounds
    points = rng.uniform((left, low), (right, high), (20 * count, 2))
    return points[is_free(points, world)][:count]


def side_of(world):
    left, low, right, high = world.bounds
    return max(right - left, high - low)


def distance_to_lines(points, lines):
    best = np.full(len(points), np.inf)
    for line in lines:
        for a, b in itertools.pairwise(line):
            along = b - a
            size = along @ along
            t = np.clip((points - a) @ along / size, 0, 1) if size else np.zeros(len(points))
            best = np.minimum(best, np.hypot(*(points - a - t[:, None] * along).T))
    return best


@pytest.mark.slow
def test_every_arc_is_as_far_from_walls_as_it_says(world):
    diagram = voronoi_diagram(world)
    rings = rings_of(world)
    assert diagram.is_whole
    for (line, clearance), ends in zip(diagram.arcs, diagram.ends, strict=True):
        assert np.allclose(nearest(line, rings)[0], clearance, rtol=0, atol=1e-9 * side_of(world))
        assert np.allclose(line[[0, -1]], diagram.vertices[ends], rtol=0, atol=1e-6 * side_of(world))


@pytest.mark.slow
def test_every_point_where_two_walls_are_nearest_lies_on_it(world):
    """From free points away from their nearest wall until another is as near, by bisection."""
    rings = rings_of(world)
    points = free_points(world, 150)
    clearance, foot = nearest(points, rings)
    points, foot, clearance = (x[clearance > 1e-3] for x in (points, foot, clearance))
    away = (points - foot) / clearance[:, None]
    low, high = clearance.copy(), np.full(len(points), 2 * side_of(world))
    for _ in range(60):
        middle = (low + high) / 2
        holds = nearest(foot + middle[:, None] * away, rings)[0] >= middle * (1 - 1e-9)
        low, high = np.where(holds, middle, low), np.where(holds, high, middle)
    lines = [line for line, _ in voronoi_diagram(world, tolerance=1e-6).arcs]
    assert distance_to_lines(foot + low[:, None] * away, lines).max() < 1e-4


@pytest.mark.slow
def test_no_way_over_a_fine_grid_is_wider(world):
    left, low, right, high = world.bounds
    step = side_of(world) / 120
    xs, ys = np.arange(left + step / 2, right, step), np.arange(low + step / 2, high, step)
    nodes = np.stack(np.meshgrid(xs, ys), axis=-1)
    flat = nodes.reshape(-1, 2)
    clearance = np.where(is_free(flat, world), nearest(flat, rings_of(world))[0], 0)
    clearance = clearance.reshape(nodes.shape[:2])
    rng = np.random.default_rng(3)
    cells = np.argwhere(clearance > step)
    for a, b in rng.choice(cells, (8, 2)):
        route = cs.navigate(world, nodes[tuple(a)], nodes[tuple(b)], "voronoi")
        least = route.evidence.least_clearance if route else 0
        over_grid = widest_over_grid(clearance, a, b)
        if max(least, over_grid) > 1.5 * step:
            assert abs(least - over_grid) <= step * 0.7072
        assert route.status == cs.navigate(world, nodes[tuple(a)], nodes[tuple(b)]).status


@pytest.mark.slow
@pytest.mark.parametrize("prefer", ["clearance", "length"])
def test_ways_keep_the_clearance_they_claim(world, prefer):
    points = free_points(world, 24, seed=5)
    rings = rings_of(world)
    for start, goal in points.reshape(-1, 2, 2):
        route = cs.navigate(world, start, goal, "voronoi", prefer=prefer, tolerance=1e-4)
        shortest = cs.navigate(world, start, goal)
        assert route.status == shortest.status
        if not route:
            assert "walls separate" in route.reason
            continue
        assert np.array_equal(route.path[[0, -1]], [start, goal])
        assert route.length >= shortest.length - 1e-9
        dense = np.concatenate(
            [np.linspace(a, b, 30) for a, b in zip(route.path, route.path[1:], strict=False)]
        )
        assert is_free(dense, world).all()
        least = nearest(dense, rings)[0].min()
        assert least >= route.evidence.least_clearance * 0.99 - 1e-12
        assert least <= route.evidence.least_clearance + side_of(world) * 1e-2


def test_the_shorter_choice_is_shorter_and_the_wider_wider(world):
    points = free_points(world, 40, seed=9)
    for start, goal in points.reshape(-1, 2, 2):
        wide = cs.navigate(world, start, goal, "voronoi")
        quick = cs.navigate(world, start, goal, "voronoi", prefer="length")
        if wide:
            assert quick.length <= wide.length * (1 + 1e-3)
            assert wide.evidence.least_clearance >= quick.evidence.least_clearance - 1e-9


@pytest.mark.slow
def test_of_the_widest_ways_it_is_the_shortest(world):
    """Beside Dijkstra on the drawn diagram, once over what is a little wider and once a little narrower."""
    step, rings = 0.005 * side_of(world), rings_of(world)
    diagram = voronoi_diagram(world, tolerance=1e-4)
    for start, goal in free_points(world, 8, seed=21).reshape(-1, 2, 2):
        route = cs.navigate(world, start, goal, "voronoi", tolerance=1e-4)
        if not route:
            continue
        legs = route.trace.only("retract")
        graph, (a, b) = roadmap.pieces_of(diagram, legs.end, rings, step)
        of_ends = float(nearest(np.array([start, goal]), rings)[0].min())
        least = min(of_ends, roadmap.widest(graph, a, b))
        assert route.evidence.least_clearance == pytest.approx(least, abs=step)
        on_diagram = route.length - np.hypot(*(legs.end - legs.start).T).sum()
        lowest, highest = (roadmap.shortest(graph, a, b, least + off) for off in (-2 * step, 2 * step))
        assert lowest - step <= on_diagram <= highest + step


def test_no_detour_is_made_for_what_an_end_has_lost_already():
    """A gap of 1 m beside the start, and one of 3 m far from it, for a start 0.3 m from a wall."""
    walls = [[(1, 9), (9, 9), (9, 11), (1, 11)], [(12, 9), (20, 9), (20, 11), (12, 11)]]
    world = cs.PolygonWorld(walls, bounds=(0, 0, 20, 20))
    near, far = ((0.3, 6), (0.3, 14)), ((1.5, 6), (1.5, 14))
    assert cs.navigate(world, *near, "voronoi").length < 16
    wide = cs.navigate(world, *far, "voronoi")
    assert wide.length > 20
    assert wide.evidence.least_clearance == pytest.approx(1.5)
    assert cs.navigate(world, *near, "voronoi").evidence.least_clearance == pytest.approx(0.3)


def test_a_path_from_wall_to_wall_and_from_the_diagram():
    world = corridors()
    route = cs.navigate(world, (2, 1), (3, 5), "voronoi")
    assert route.evidence.least_clearance == 0
    assert route.evidence.on_diagram == pytest.approx(1)
    assert cs.navigate(world, (3, 3), (3, 3), "voronoi").length == 0
    for corner in [(2, 2), (4, 2), (0, 3), (2, 0)]:
        assert cs.navigate(world, corner, (3, 3), "voronoi")


def test_parts_that_touch_in_a_point_stay_apart():
    walls = [[(0, 0), (2, 2), (0, 4)], [(4, 0), (2, 2), (4, 4)]]
    world = cs.PolygonWorld(walls, bounds=(0, 0, 4, 4))
    route = cs.navigate(world, (2, 0.5), (2, 3.5), "voronoi")
    assert route.status == "unreachable"
    assert cs.navigate(world, (2, 2), (2, 3.5), "voronoi")
    assert cs.navigate(world, (2, 2), (2, 0.5), "voronoi")


def test_the_trace_retracts_then_widens_then_expands():
    trace = cs.navigate(field(1), (0.01, 0.01), (3.9, 3.9), "voronoi").trace
    assert trace.words == ("retract", "widen", "expand")
    assert len(trace.only("retract")) == 2
    assert len(trace.only("widen")) > 0
    assert np.all(np.diff(trace.only("widen").value) <= 1e-12)


def test_the_shared_worlds():
    for given in json.loads((shared_data() / "navigation" / "poly" / "worlds.json").read_text()):
        world = cs.PolygonWorld(given["polygons"], bounds=given["bounds"])
        assert voronoi_diagram(world).is_whole
        for query in given["queries"]:
            route = cs.navigate(world, query["start"], query["goal"], "voronoi")
            assert route
            assert route.length >= query["length"] - 1e-9


def test_far_from_the_origin_it_is_the_same():
    near = field(2)
    moved = [ring + 2.0**20 for rings in near.obstacles for ring in rings]
    far = cs.PolygonWorld(moved, bounds=np.array(near.bounds) + 2.0**20)
    start, goal = np.array([0.01, 0.02]), np.array([3.9, 3.8])
    a = cs.navigate(near, start, goal, "voronoi")
    b = cs.navigate(far, start + 2.0**20, goal + 2.0**20, "voronoi")
    assert b.evidence.on_diagram == pytest.approx(a.evidence.on_diagram, abs=1e-8)
    assert b.length == pytest.approx(a.length, abs=1e-6)


def test_what_cannot_be_asked():
    world = corridors()
    with pytest.raises(UnknownNameError, match="did you mean 'length'"):
        cs.navigate(world, (3, 1), (3, 5), "voronoi", prefer="lenght")
    with pytest.raises(InputError, match="must be positive"):
        cs.navigate(world, (3, 1), (3, 5), "voronoi", tolerance=0)
    with pytest.raises(InputError, match="start"):
        cs.navigate(world, (1, 1), (3, 5), "voronoi")
