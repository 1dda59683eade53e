"""Navigation functions: zero at the goal alone, one on walls, one minimum; descents always arrive."""

from __future__ import annotations

import copy
import itertools
import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.navigation import NavigationFunction, navigation_function
from oracles.segments import enters

BOUNDS = (0, 0, 10, 10)


def discs_of(rng, most):
    kept = [(0.0, 0.0, 10.0)]
    for _ in range(most):
        x, y, r = *rng.uniform(-8, 8, 2), rng.uniform(0.3, 1.8)
        apart = all(np.hypot(x - a, y - b) > r + s + 0.1 for a, b, s in kept[1:])
        if apart and np.hypot(x, y) + r < 9.9:
            kept.append((x, y, r))
    return np.array(kept)


def free_of(rng, discs, margin=0.0):
    while True:
        p = rng.uniform(-10, 10, 2)
        far = np.hypot(*(p - discs[:, :2]).T) - discs[:, 2]
        if -far[0] > margin and np.all(far[1:] > margin):
            return p


def stars_of(rng, count):
    """Star-shaped polygons, one in each cell of a raster."""
    found = []
    for k in range(count):
        angles = 2 * np.pi * np.arange(n := rng.integers(5, 13)) / n
        center = 1.25 + 2.5 * np.array([k % 4, k // 4])
        radius = rng.uniform(0.2, 1.1, n)[:, None]
        found.append(center + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    return cs.PolygonWorld(found, BOUNDS)


def direct_v(discs, goal, kappa, p):
    """V by its definition, in plain numbers."""
    scale = discs[0, 2]
    gamma = np.sum((p - goal) ** 2) / scale**2
    left = (np.sum((p - discs[:, :2]) ** 2, axis=1) - discs[:, 2] ** 2) / scale**2
    return kappa * np.log(gamma) - np.log(-left[0]) - np.sum(np.log(left[1:]))


def test_it_is_the_function_of_the_papers():
    rng = np.random.default_rng(1)
    for _ in range(20):
        discs = discs_of(rng, 10)
        goal, kappa = free_of(rng, discs, 0.1), float(rng.integers(1, 9))
        f = navigation_function(discs, goal, kappa=kappa)
        for _ in range(20):
            p = free_of(rng, discs)
            v = direct_v(discs, goal, kappa, p)
            assert f.log_odds(p) == pytest.approx(v, rel=1e-10, abs=1e-10)
            gamma_kappa, beta = np.exp(v), 1.0
            assert f(p) == pytest.approx((gamma_kappa / (gamma_kappa + beta)) ** (1 / kappa), rel=1e-9)
        assert f(goal) == 0
        assert f([(20, 0), discs[-1, :2]]).tolist() == [1, 1]


def newton(discs, goal, kappa, p):
    """A flat place near p by Newton's method on differences of V; None where it runs away."""

    def slope(q):
        h = 1e-5
        rows = [
            (direct_v(discs, goal, kappa, q + d) - direct_v(discs, goal, kappa, q - d)) for d in np.eye(2) * h
        ]
        return np.array(rows) / (2 * h)

    for _ in range(30):
        g = slope(p)
        H = np.array([(slope(p + d) - slope(p - d)) / 2e-4 for d in np.eye(2) * 1e-4])
        step = np.linalg.solve(H, g)
        p = p - step * min(1, 0.3 / max(np.linalg.norm(step), 1e-300))
        far = np.hypot(*(p - discs[:, :2]).T) - discs[:, 2]
        if -far[0] < 0.01 or np.any(far[1:] < 0.01) or np.hypot(*(p - goal)) < 0.01:
            return None
        if np.linalg.norm(step) < 1e-6:
            return p, np.linalg.eigvalsh(H)
    return None


@pytest.mark.slow
def test_every_flat_place_is_a_saddle_and_there_is_one_for_each_disc():
    """Newton's method from many places, on differences of the definition, knows no others."""
    rng = np.random.default_rng(2)
    seen = 0
    for _ in range(6):
        discs = discs_of(rng, 8)
        goal = free_of(rng, discs, 0.3)
        f = navigation_function(discs, goal)
        assert f.is_proven
        assert len(f.saddles) == len(discs) - 1
        for _ in range(40):
            with np.errstate(all="ignore"):
                flat = newton(discs, goal, f.kappa, free_of(rng, discs, 0.02))
            if flat is None:
                continue
            at, bends = flat
            assert bends[0] < 0 < bends[1]
            assert np.min(np.hypot(*(f.saddles - at).T)) < 1e-3
            seen += 1
    assert seen > 40


def lowest_on_raster(f, world, count):
    """Places of a raster that are lower than the eight around them."""
    side = np.linspace(0, 10, count)
    at = np.stack(np.meshgrid(side, side), axis=-1)
    v = np.where(world.is_free(at.reshape(-1, 2)).reshape(count, count), f.log_odds(at), np.inf)
    low = np.ones((count - 2, count - 2), bool)
    middle = v[1:-1, 1:-1]
    for i, j in itertools.product((0, 1, 2), repeat=2):
        if (i, j) != (1, 1):
            low &= middle < v[i : i + count - 2, j : j + count - 2]
    return at[1:-1, 1:-1][low]


def felt_down(f, rng, at, goal):
    """Down by trial alone: the lowest of points around, nearer where none is lower. True at the goal."""
    radius, value = 0.1, f.log_odds(at)
    while radius > 1e-9:
        if np.hypot(*(at - goal)) < 0.05:
            return True
        angle = rng.uniform(0, 2 * np.pi, 48)
        around = at + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        found = f.log_odds(around)
        best = int(np.argmin(found))
        if found[best] < value:
            at, value, radius = around[best], found[best], 2 * radius
        else:
            radius /= 2
    return False


def test_star_worlds_have_the_goal_as_their_only_lowest_place():
    rng = np.random.default_rng(3)
    for count in (1, 4, 9):
        world = stars_of(rng, count)
        goal = (9.0, 9.0)
        f = navigation_function(world, goal)
        assert f.is_proven
        assert len(f.saddles) == count
        for low in lowest_on_raster(f, world, 201):
            assert felt_down(f, rng, low, goal)
        walls = np.concatenate(world.walls)
        assert np.all(f(walls) > 1 - 1e-6)


@pytest.mark.slow
def test_descents_arrive_from_everywhere_and_keep_out_of_obstacles():
    rng = np.random.default_rng(4)
    for k in range(12):
        world = stars_of(rng, 1 + k)
        goal = (9.3, 8.9)
        for _ in range(6):
            start = rng.uniform(0, 10, 2)
            if not world.is_free(start):
                continue
            route = cs.navigate(world, start, goal, "rimon_koditschek")
            assert route
            assert route.evidence.function.is_proven
            assert enters(route.path, world.obstacles, BOUNDS) is None
            value = route.trace.value
            assert len(value) == len(route.path) - 1
            assert np.all(np.diff(value) <= 0)
            assert np.array_equal(route.path[0], start)
            assert np.array_equal(route.path[-1], goal)


def test_it_starts_from_walls_corners_and_saddles():
    world = cs.PolygonWorld([[(4, 4), (6, 4), (6, 6), (4, 6)]], BOUNDS)
    for start in ((0, 0), (4, 5), (4, 4), (0, 3.3), (6, 6)):
        assert cs.navigate(world, start, (9, 5), "rimon_koditschek")
    route = cs.navigate(world, (1, 5), (9, 5), "rimon_koditschek")  # straight at a saddle
    assert route
    assert route.evidence.pushes > 0
    assert "pushed off" in route.reason
    saddle = route.evidence.function.saddles[0]
    assert cs.navigate(world, saddle, (9, 5), "rimon_koditschek")


def test_a_low_power_has_another_minimum_and_is_found_out():
    wall = np.array([(0, 0, 10)] + [(0, 1.7 * k, 0.8) for k in range(-3, 4)], float)
    low = navigation_function(wall, (8, 0), kappa=2)
    assert not low.is_proven
    assert low.descend((-1.0, 0.6)) is None
    assert navigation_function(wall, (8, 0)).descend((-1.0, 0.6)) is not None


def test_what_is_no_star_world_is_named():
    trap = [(3, 2), (7, 2), (7, 8), (3, 8), (3, 7.5), (6.5, 7.5), (6.5, 2.5), (3, 2.5)]
    square = [(1, 1), (2, 1), (2, 2), (1, 2)]
    world = cs.PolygonWorld([square, trap], BOUNDS)
    route = cs.navigate(world, (0.5, 0.5), (9, 9), "rimon_koditschek")
    assert route.status == "undetermined"
    assert "obstacle 1" in route.reason
    assert "harmonic" in route.reason
    with pytest.raises(InputError, match=r"obstacle 1 .* not star-shaped"):
        navigation_function(world, (9, 9))
    touching = cs.PolygonWorld([square, [(2, 2), (3, 2), (3, 3), (2, 3)], [(0, 5), (1, 5), (1, 6)]], BOUNDS)
    with pytest.raises(InputError, match=r"touches another|not star-shaped"):
        navigation_function(touching, (9, 9))
    assert (
        "wall"
        in cs.navigate(stars_of(np.random.default_rng(0), 2), (9, 9), (0, 5), "rimon_koditschek").reason
    )


def test_parts_that_no_way_connects():
    ring = [[(2, 2), (8, 2), (8, 8), (2, 8)], [(3, 3), (7, 3), (7, 7), (3, 7)]]
    world = cs.PolygonWorld([ring], BOUNDS)
    for start, goal in (((1, 1), (5, 5)), ((5, 5), (1, 1))):
        route = cs.navigate(world, start, goal, "rimon_koditschek")
        assert route.status == "unreachable"
        assert len(route.trace) == 0
    assert cs.navigate(world, (4, 4), (6, 6), "rimon_koditschek")


@pytest.mark.parametrize(
    ("discs", "said"),
    [
        ([(0, 0, 5), (4, 0, 2)], "reaches the wall"),
        ([(0, 0, 9), (1, 0, 2), (3, 0, 2)], "touch"),
        ([(0, 0, -1)], "positive radius"),
        ([(0, 0, 9), (3, 3, 2)], "interior"),
    ],
)
def test_discs_that_are_no_sphere_world(discs, said):
    with pytest.raises(InputError, match=said):
        navigation_function(discs, (3, 3.5))
    with pytest.raises(InputError, match="kappa"):
        navigation_function([(0, 0, 9)], (0, 0), kappa=-1)
    assert isinstance(navigation_function([(0, 0, 9)], (0, 0)), NavigationFunction)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda made: pickle.loads(pickle.dumps(made))])
def test_copies_are_the_same_function(again):
    world = cs.PolygonWorld([[(3, 3), (5, 3), (5, 5), (3, 5)]], bounds=(0, 0, 10, 10))
    discs = [(0, 0, 10), (3, 3, 1), (-4, 2, 2)]
    points = np.random.default_rng(2).uniform(0, 6, (40, 2))
    for made in (
        navigation_function(world, (8, 8)),
        navigation_function(discs, (1, -5)),
        navigation_function(discs, (1, -5), kappa=6.5),
    ):
        same = again(made)
        assert (same.kappa, same.is_proven, same.obstacles) == (made.kappa, made.is_proven, made.obstacles)
        np.testing.assert_array_equal(same(points), made(points))
        np.testing.assert_array_equal(same.goal, made.goal)
        with pytest.raises(ValueError, match="read-only"):
            same.goal[0] = 3
