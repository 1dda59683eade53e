"""Hybrid A*: every way is made of arcs no tighter than allowed, meets its goal and touches nothing."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from oracles import car_words, rectangles

nav = cs.navigation
CAR = nav.Car(wheelbase=2.0, length=3.0, width=1.4, rear=0.5, max_steering=0.6)
BODY = (0.5, 2.5, 0.7)


def grid_of(blocked, resolution=0.5, origin=(0.0, 0.0)):
    return cs.OccupancyGrid(np.asarray(blocked, bool), resolution=resolution, origin=origin)


def check(route, blocked, resolution=0.5, origin=(0.0, 0.0)):
    """Arcs within the bound, from start to goal, and no cell covered along the way."""
    radius = route.curve.radius
    pose = np.array([*route.start[:2] / radius, route.start[2]])
    poses = []
    for s in route.curve.segments:
        assert abs(s.curvature) <= 1 / radius + 1e-12
        turn, length = int(np.sign(s.curvature)), s.direction * s.length / radius
        n = int(np.ceil(s.length / 0.05))
        poses += [car_words.drive(pose, turn, length * k / n) * [radius, radius, 1] for k in range(n + 1)]
        pose = car_words.drive(pose, turn, length)
    np.testing.assert_allclose(pose[:2] * radius, route.goal[:2], atol=1e-9)
    assert abs(np.remainder(pose[2] - route.goal[2] + np.pi, 2 * np.pi) - np.pi) < 1e-9
    deepest = max(rectangles.depth(p, BODY, blocked, resolution, origin) for p in poses)
    assert deepest <= 1e-3 * resolution
    np.testing.assert_allclose(route.poses[-1][:2], route.goal[:2], atol=1e-9)
    assert route.length >= nav.reeds_shepp_distance(route.start, route.goal, radius) - 1e-9


def free_pose(rng, blocked, resolution=0.5):
    size = np.array(blocked.shape[::-1]) * resolution
    while True:
        pose = np.array([*rng.uniform(0, 1, 2) * size, rng.uniform(-np.pi, np.pi)])
        if rectangles.depth(pose, BODY, blocked, resolution) < 0:
            return pose


def rooms(rng, n=50, walls=6):
    blocked = np.zeros((n, n), bool)
    for _ in range(walls):
        r, c = rng.integers(0, n, 2)
        if rng.random() < 0.5:
            blocked[r, c : c + rng.integers(5, 25)] = True
        else:
            blocked[r : r + rng.integers(5, 25), c] = True
    return blocked


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("reverse", [True, False])
def test_ways_are_arcs_without_contact(seed, reverse):
    rng = np.random.default_rng(seed)
    blocked = rooms(rng)
    grid, found = grid_of(blocked), 0
    for _ in range(3):
        start, goal = free_pose(rng, blocked), free_pose(rng, blocked)
        route = nav.hybrid_a_star(grid, start, goal, vehicle=CAR, reverse=reverse)
        if route:
            check(route, blocked)
            found += 1
            if not reverse:
                assert all(s.direction == 1 for s in route.curve.segments)
        else:
            assert route.status in ("unreachable", "undetermined")
    assert found or not reverse


def test_without_obstacles_it_is_the_shortest_curve():
    rng = np.random.default_rng(1)
    blocked = np.zeros((80, 80), bool)
    for _ in range(20):
        start, goal = (np.array([*rng.uniform(12, 28, 2), rng.uniform(-np.pi, np.pi)]) for _ in range(2))
        route = nav.hybrid_a_star(grid_of(blocked), start, goal, vehicle=CAR)
        assert route.length == pytest.approx(nav.reeds_shepp_distance(start, goal, CAR.turning_radius))
        check(route, blocked)


def test_a_gap_too_narrow_for_any_disc_is_a_proof():
    blocked = np.zeros((40, 60), bool)
    blocked[:, 30] = True
    blocked[20, 30] = False  # half a metre wide
    route = nav.hybrid_a_star(grid_of(blocked), (5, 10, 0), (25, 10, 0), vehicle=CAR)
    assert not route
    assert route.status == "unreachable"
    assert "disc" in route.reason
    assert route.length == np.inf
    assert route.path.shape == (0, 2)
    assert route.stats.nodes == 0


def test_a_gap_just_wide_enough_is_passed():
    """The car is 1.4 m wide, three cells of half a metre are 1.5 m."""
    blocked = np.zeros((40, 60), bool)
    blocked[:, 30] = True
    blocked[19:22, 30] = False
    route = nav.hybrid_a_star(grid_of(blocked), (5, 5, 0), (25, 15, 1.0), vehicle=CAR)
    assert route, route.reason
    check(route, blocked)


def test_what_a_disc_passes_and_a_car_does_not_is_undetermined():
    blocked = np.ones((40, 40), bool)
    blocked[2:6, 2:20] = False  # a corner two metres wide, too tight for the car forwards alone
    blocked[2:30, 16:20] = False
    route = nav.hybrid_a_star(grid_of(blocked), (2, 2, 0), (9, 12, np.pi / 2), vehicle=CAR, reverse=False)
    assert not route
    assert route.status == "undetermined"
    few = nav.hybrid_a_star(grid_of(blocked), (2, 2, 0), (9, 12, np.pi / 2), vehicle=CAR, max_nodes=1)
    assert few.status == "undetermined"
    assert "max_nodes" in few.reason


def test_parking_between_two_cars_takes_both_gears():
    blocked = np.zeros((24, 60), bool)
    blocked[0:5, 0:20] = True
    blocked[0:5, 29:60] = True  # a bay 4.5 m long and 2.5 m deep
    start, goal = np.array([5.0, 5.0, 0.0]), np.array([10.8, 1.3, 0.0])
    route = nav.hybrid_a_star(grid_of(blocked), start, goal, vehicle=CAR)
    assert route, route.reason
    check(route, blocked)
    assert len(route.curve.cusps)
    assert not nav.hybrid_a_star(grid_of(blocked), start, goal, vehicle=CAR, reverse=False)


def test_a_wall_that_is_touched_is_no_contact():
    """Driving along a wall at no distance: the side of the car on the border of the cells."""
    blocked = np.zeros((20, 40), bool)
    blocked[0:4] = True
    car = nav.Car(wheelbase=2.0, length=3.0, width=1.0, rear=0.5)
    route = nav.hybrid_a_star(grid_of(blocked), (2, 2.5, 0), (15, 2.5, 0), vehicle=car)
    assert route.length == pytest.approx(13)
    with pytest.raises(InputError, match="start"):
        nav.hybrid_a_star(grid_of(blocked), (2, 2.49, 0), (15, 2.5, 0), vehicle=car)


@pytest.mark.parametrize("seed", range(4))
def test_only_what_no_disc_passes_is_unreachable(seed):
    """A disc of the car on a grid four times finer: where it passes, nothing is called proven."""
    rng = np.random.default_rng(seed)
    fine, verdicts = 4, set()
    for _ in range(12):
        blocked = rng.random((24, 24)) < 0.04
        start, goal = free_pose(rng, blocked), free_pose(rng, blocked)
        route = nav.hybrid_a_star(grid_of(blocked), start, goal, vehicle=CAR, max_nodes=2000)
        places = (np.indices((24 * fine, 24 * fine)).reshape(2, -1).T[:, ::-1] + 0.5) / fine * 0.5
        cells = np.argwhere(np.pad(blocked, 1, constant_values=True))[:, ::-1] * 0.5 - 0.25
        gap = np.maximum(np.abs(places[:, None] - cells[None]) - 0.25, 0)
        clear = (np.hypot(gap[..., 0], gap[..., 1]).min(1) >= 0.7).reshape(24 * fine, -1)
        middles = [p[:2] + np.array([np.cos(p[2]), np.sin(p[2])]) for p in (start, goal)]
        ends = [tuple((m[::-1] / 0.5 * fine).astype(int)) for m in middles]
        if clear[ends[0]] and clear[ends[1]] and connected(clear, *ends):
            assert route.status != "unreachable"
        verdicts.add(route.status)
    assert "found" in verdicts


def connected(clear, a, b):
    seen = np.zeros_like(clear)
    seen[a] = True
    while True:
        grown = seen.copy()
        grown[1:] |= seen[:-1]
        grown[:-1] |= seen[1:]
        grown[:, 1:] |= seen[:, :-1]
        grown[:, :-1] |= seen[:, 1:]
        grown &= clear
        if grown[b]:
            return True
        if (grown == seen).all():
            return False
        seen = grown


def test_a_car_can_follow_the_way():
    blocked = np.zeros((40, 60), bool)
    blocked[:25, 20] = blocked[15:, 40] = True
    route = nav.hybrid_a_star(grid_of(blocked), (4, 4, 0), (26, 16, 0), vehicle=CAR, radius=5.0)
    check(route, blocked)
    run = nav.follow(route, vehicle=CAR, speed=1.5, lookahead=1.2, tolerance=0.2)
    assert run, run.reason
    assert np.abs(run.cross_track).max() < 0.5


def test_what_is_no_question_is_refused():
    grid = grid_of(np.zeros((40, 40)))
    with pytest.raises(InputTypeError, match="OccupancyGrid"):
        nav.hybrid_a_star(np.zeros((4, 4)), (5, 5, 0), (9, 9, 0))
    with pytest.raises(InputTypeError, match="Car"):
        nav.hybrid_a_star(grid, (5, 5, 0), (9, 9, 0), vehicle=nav.Unicycle())
    with pytest.raises(InputError, match="radius"):
        nav.hybrid_a_star(grid, (5, 5, 0), (9, 9, 0), vehicle=CAR, radius=1.0)
    with pytest.raises(InputError, match="goal"):
        nav.hybrid_a_star(grid, (5, 5, 0), (19.9, 9, 0), vehicle=CAR)
    with pytest.raises(InputError, match="headings"):
        nav.hybrid_a_star(grid, (5, 5, 0), (9, 9, 0), vehicle=CAR, headings=1)
    blocked = np.zeros((40, 40), bool)
    blocked[:, 20] = True
    nowhere = nav.hybrid_a_star(grid_of(blocked), (5, 5, 0), (15, 5, 0), vehicle=CAR)
    with pytest.raises(InputError, match="not found"):
        nav.follow(nowhere)
