"""Roadmaps and trees of random points: exactly free, the same for one seed, and in the limit the shortest."""

from __future__ import annotations

import itertools
import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from oracles.segments import enters

ALL = ("prm", "rrt", "rrt_star")


RECORDED = 48, (1028, 650, 1029), 42.37007271787687


def boxes(*corners):
    return [[(x, y), (u, y), (u, v), (x, v)] for x, y, u, v in corners]


def scattered(seed):
    """Polygons that touch, overlap and stick out."""
    rng = np.random.default_rng(seed)
    obstacles = []
    for _ in range(25):
        angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 8)))
        around = np.column_stack((np.cos(angles), np.sin(angles)))
        obstacles.append(rng.uniform(0, 10, 2) + rng.uniform(0.3, 1.2) * around)
    return cs.PolygonWorld(obstacles, bounds=(0, 0, 10, 10), repair=True)


def whole_numbers(seed):
    """Polygons of whole numbers: corners meet in points, sides lie in line."""
    rng = np.random.default_rng(seed)
    rings = [rng.integers(0, 9, (rng.integers(3, 6), 2)) for _ in range(6)]
    rings = [ring for ring in rings if len(np.unique(ring, axis=0)) > 2]
    return cs.PolygonWorld(rings, (0, 0, 8, 8), repair=True)


def slalom():
    walls = boxes((2, 0, 2.5, 7), (4, 3, 4.5, 10), (6, 0, 6.5, 7), (8, 3, 8.5, 10))
    return cs.PolygonWorld(walls, bounds=(0, 0, 10, 10))


def trap():
    return cs.PolygonWorld(boxes((3, 3, 7, 3.5), (6.5, 3, 7, 7), (3, 6.5, 7, 7)), bounds=(0, 0, 10, 10))


def narrow(gap=1e-3):
    walls = boxes((4, 0, 6, 5 - gap / 2), (4, 5 + gap / 2, 6, 10))
    return cs.PolygonWorld(walls, bounds=(0, 0, 10, 10))


WORLDS = {f"scattered {seed}": (lambda seed=seed: scattered(seed)) for seed in range(4)}
WORLDS |= {"slalom": slalom, "trap": trap}


def free_pair(world, seed):
    """A start and a goal that do not see each other."""
    rng = np.random.default_rng(seed)
    left, low, right, high = world.bounds
    while True:
        pair = rng.uniform((left, low), (right, high), (2, 2))
        if all(map(world.is_free, pair)) and len(cs.navigate(world, *pair).path) > 2:
            return pair


@pytest.mark.parametrize("planner", ALL)
@pytest.mark.parametrize("name", WORLDS)
def test_paths_keep_out_of_obstacles_exactly(name, planner):
    world = WORLDS[name]()
    for seed in range(6):
        start, goal = free_pair(world, seed)
        route = cs.navigate(world, start, goal, planner, samples=2000, rng=seed)
        assert route.status in {"found", "undetermined"}
        if not route:
            continue
        assert enters(route.path, world.obstacles, world.bounds) is None
        assert np.array_equal(route.path[[0, -1]], [start, goal])
        assert route.length == pytest.approx(np.hypot(*np.diff(route.path, axis=0).T).sum(), rel=1e-12)
        assert route.length >= cs.navigate(world, start, goal).length * (1 - 1e-12)


@pytest.mark.parametrize("planner", ALL)
def test_worlds_of_whole_numbers_are_passed_nowhere_but_through_free_space(planner):
    """Starts and goals on corners and sides, obstacles that meet in points: verdicts agree with the exact."""
    found = 0
    for seed in range(150):
        world = whole_numbers(seed)
        rng = np.random.default_rng(seed)
        for _ in range(4):
            start, goal = rng.integers(0, 17, (2, 2)) / 2
            if not (world.is_free(start) and world.is_free(goal)):
                continue
            exact = cs.navigate(world, start, goal)
            route = cs.navigate(world, start, goal, planner, samples=1500, rng=seed)
            assert (route.status == "unreachable") == (exact.status == "unreachable")
            if route:
                found += 1
                assert enters(route.path, world.obstacles, world.bounds) is None
                assert route.length >= exact.length - 1e-9
    assert found > 40


@pytest.mark.parametrize("name", WORLDS)
def test_rrt_star_tends_to_the_shortest_and_never_back(name):
    world = WORLDS[name]()
    start, goal = free_pair(world, 11)
    shortest = cs.navigate(world, start, goal).length
    for seed in range(3):
        lengths = [
            cs.navigate(world, start, goal, "rrt_star", samples=n, rng=seed).length
            for n in (100, 300, 1000, 3000, 6000)
        ]
        assert all(later <= earlier for earlier, later in itertools.pairwise(lengths))
        assert shortest * (1 - 1e-12) <= lengths[-1] <= 1.05 * shortest


@pytest.mark.parametrize("name", WORLDS)
def test_roadmaps_tend_to_the_shortest(name):
    world = WORLDS[name]()
    start, goal = free_pair(world, 11)
    shortest = cs.navigate(world, start, goal).length
    for options in ({}, {"neighbours": 30}):
        route = cs.navigate(world, start, goal, "prm", samples=4000, rng=1, **options)
        assert shortest * (1 - 1e-12) <= route.length <= 1.06 * shortest


def test_in_an_empty_world_rrt_star_goes_straight():
    world = cs.PolygonWorld([], bounds=(0, 0, 10, 10))
    route = cs.navigate(world, (1, 1), (9, 7), "rrt_star", rng=0)
    assert route.length == 10.0
    assert route.evidence.samples == 0


@pytest.mark.parametrize("planner", ALL)
def test_one_seed_gives_one_path(planner):
    world = scattered(2)
    start, goal = free_pair(world, 3)
    first, again, other = (
        cs.navigate(world, start, goal, planner, samples=800, rng=rng) for rng in (5, 5, 6)
    )
    assert np.array_equal(first.path, again.path)
    assert first.evidence == again.evidence
    assert not np.array_equal(first.path, other.path)
    drawn = cs.navigate(world, start, goal, planner, samples=800, rng=np.random.default_rng(1))
    assert np.array_equal(drawn.path, cs.navigate(world, start, goal, planner, **drawn.options).path)


def test_the_samples_are_those_of_every_machine():
    """The path of one seed, written down."""
    route = cs.navigate(slalom(), (1, 1), (9, 9), "rrt", rng=2024)
    assert (len(route.path), route.evidence) == RECORDED[:2]
    assert route.length == pytest.approx(RECORDED[2], rel=1e-14)


@pytest.mark.parametrize("planner", ALL)
def test_a_narrow_passage_is_missed_and_nothing_is_claimed(planner):
    world = narrow()
    route = cs.navigate(world, (1, 2), (9, 8), planner, samples=300, rng=0)
    assert route.status == "undetermined"
    assert not route
    assert len(route.path) == 0
    assert math.isinf(route.length)
    assert "a path exists" in route.reason
    assert cs.navigate(world, (1, 2), (9, 8))


@pytest.mark.parametrize("planner", ALL)
def test_walls_that_divide_are_seen_on_the_map(planner):
    world = cs.PolygonWorld(boxes((4, 0, 6, 10)), bounds=(0, 0, 10, 10))
    route = cs.navigate(world, (1, 2), (9, 8), planner, rng=0)
    assert route.status == "unreachable"
    assert "known from the map" in route.reason
    assert route.evidence == (0, 0, 0)


@pytest.mark.parametrize("planner", ALL)
def test_no_way_leads_through_a_point_where_obstacles_meet(planner):
    world = cs.PolygonWorld(boxes((0, 5, 5, 10), (5, 0, 10, 5)), bounds=(0, 0, 10, 10))
    route = cs.navigate(world, (1, 1), (9, 9), planner, rng=0)
    assert route.status == "unreachable"
    from_point = cs.navigate(world, (5, 5), (9, 9), planner, rng=0)
    assert from_point
    assert from_point.length < 1.5 * math.hypot(4, 4)


@pytest.mark.parametrize("planner", ALL)
def test_the_trace_is_the_search(planner):
    world = slalom()
    route = cs.navigate(world, (1, 1), (9, 9), planner, samples=3000)
    trace = route.trace
    joined = trace.only("connect")
    assert 0 < len(joined) <= route.evidence.edges
    assert planner == "rrt_star" or len(trace.only("rewire")) == 0
    for _, a, b, _ in list(joined)[:200]:
        assert enters([a, b], world.obstacles, world.bounds) is None
    drawn = {tuple(sorted((tuple(a), tuple(b)))) for _, a, b, _ in trace}
    for a, b in itertools.pairwise(route.path):
        assert tuple(sorted((tuple(a), tuple(b)))) in drawn


def test_start_is_goal():
    for planner in ALL:
        route = cs.navigate(trap(), (1, 1), (1, 1), planner, samples=10, rng=0)
        assert route.length == 0


@pytest.mark.parametrize(
    ("planner", "options", "error", "said"),
    [
        ("prm", {"samples": 0}, InputError, "samples is 0"),
        ("prm", {"samples": 1.5}, InputTypeError, "samples is a float"),
        ("prm", {"neighbours": 0}, InputError, "neighbours is 0"),
        ("rrt", {"step": 0}, InputError, "step is 0"),
        ("rrt", {"goal_bias": 1.5}, InputError, "goal_bias is 1.5"),
        ("rrt_star", {"rng": -1}, InputError, "rng is -1"),
        ("rrt_star", {"rng": 2**64}, InputError, "below 2\\*\\*64"),
        ("rrt_star", {"neighbours": 3}, InputTypeError, "neighbours"),
    ],
)
def test_a_misuse_is_named(planner, options, error, said):
    with pytest.raises(error, match=said):
        cs.navigate(trap(), (1, 1), (9, 9), planner, **options)


def test_a_roadmap_that_is_kept_is_the_one_made_anew():
    world, rng = scattered(4), np.random.default_rng(5)
    free = [p for p in rng.uniform(0, 10, (60, 2)) if world.is_free(p)]
    for start, goal in itertools.pairwise(free[:10]):
        for options in ({"rng": 3, "samples": 300}, {"rng": 3, "samples": 300, "neighbours": 5}):
            kept = [cs.navigate(world, start, goal, "prm", **options) for _ in range(2)]
            fresh = cs.navigate(pickle.loads(pickle.dumps(world)), start, goal, "prm", **options)
            for route in kept:
                np.testing.assert_array_equal(route.path, fresh.path)
                assert (route.status, route.evidence) == (fresh.status, fresh.evidence)
            assert len(kept[0].trace) == len(fresh.trace)


def test_threads_that_ask_one_world_for_roadmaps_get_their_own():
    world = scattered(4)
    ends = (0.1, 0.1), (9.9, 9.9)
    alone = [cs.navigate(scattered(4), *ends, "prm", rng=seed, samples=400) for seed in range(4)]
    asked = [seed % 4 for seed in range(32)]
    with ThreadPoolExecutor(4) as pool:
        routes = list(pool.map(lambda seed: cs.navigate(world, *ends, "prm", rng=seed, samples=400), asked))
    for seed, route in zip(asked, routes, strict=True):
        np.testing.assert_array_equal(route.path, alone[seed].path)
