"""Long calls heed Ctrl-C: each is stopped long before it would be done, and what it used still works."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import cspace as cs

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no timer signals there")

AFTER = 0.05
"""When the signal comes [s]."""
SOON = 1.0
"""How soon after it a call must have ended [s]: each takes several times as long when nothing stops it."""

Call = Callable[[], Any]
CALLS: dict[str, Callable[[], Call]] = {}


def call(make: Callable[[], Call]) -> Callable[[], Call]:
    """Registers what prepares a call and returns it."""
    CALLS[make.__name__] = make
    return make


@pytest.fixture
def timer() -> Iterator[Callable[..., None]]:
    """Sets a handler that is called after so many seconds, once or, with every=, again and again."""
    before = signal.getsignal(signal.SIGALRM)

    def start(handler: Any, after: float, every: float = 0) -> None:
        signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, after, every)

    yield start
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def blocks(side: int, share: float = 0.2) -> tuple[Any, Any, Any]:
    """A grid with scattered blocked cells, and two free points far from each other."""
    blocked = np.random.default_rng(1).random((side, side)) < share
    blocked[:3] = blocked[-3:] = False
    return cs.OccupancyGrid(blocked), (0.5, 0.5), (side - 0.5, side - 0.5)


def squares(side: int) -> tuple[Any, Any, Any]:
    """A world of many squares, and two free points far from each other."""
    corners = np.array([[0.3, 0.3], [0.7, 0.35], [0.7, 0.7], [0.3, 0.7]])
    rings = [corners + np.array([i, j]) for i in range(side) for j in range(side)]
    bounds = (-1, -1, side + 1, side + 1)
    return cs.PolygonWorld(rings, bounds=bounds), (-0.5, -0.5), (side + 0.5, side + 0.5)


def on_grid(planner: str, side: int) -> Callable[[], Call]:
    def make() -> Call:
        world, start, goal = blocks(side)
        return lambda: cs.navigate(world, start, goal, planner)

    return make


def among_squares(planner: str, side: int, **options: Any) -> Callable[[], Call]:
    def make() -> Call:
        world, start, goal = squares(side)
        return lambda: cs.navigate(world, start, goal, planner, **options)

    return make


for name, side in {"d_star_lite": 4000, "brushfire": 4000, "harmonic": 1500, "fast_marching": 4000}.items():
    CALLS[name] = on_grid(name, side)
for name, options in {
    "prm": {"samples": 1_000_000, "rng": 1},
    "rrt": {"samples": 1_000_000, "rng": 1, "step": 1e-3, "goal_bias": 0.0},
    "rrt_star": {"samples": 1_000_000, "rng": 1},
    "approximate_cells": {"depth": 12, "uniform": True},
}.items():
    CALLS[name] = among_squares(name, 8, **options)


@call
def to_grid() -> Call:
    world = squares(10)[0]
    return lambda: world.to_grid(0.0005)


@call
def from_grid() -> Call:
    world = blocks(2500)[0]
    return lambda: cs.PolygonWorld.from_grid(world)


@call
def from_free_grid() -> Call:
    world = cs.OccupancyGrid(np.zeros((200, 300_000)))
    return lambda: [cs.PolygonWorld.from_grid(world) for _ in range(10)]


@call
def coverage() -> Call:
    world, start, _ = blocks(3000, 0.1)
    return lambda: cs.navigation.coverage(world, start)


@call
def arrival_times() -> Call:
    world, _, goal = blocks(4000)
    return lambda: cs.navigation.arrival_times(world, goal)


@call
def follow() -> Call:
    x = np.linspace(0, 3000, 30_000)
    path = np.stack([x, 5 * np.sin(x / 10)], axis=1)
    return lambda: cs.navigation.follow(path, time_step=0.0005, time_limit=4000)


@call
def cast_rays() -> Call:
    world = blocks(2000, 1e-5)[0]
    angles = np.linspace(0, 6, 2_000_000)
    return lambda: cs.navigation.cast_rays(world, np.full((len(angles), 2), 3.5), angles)


@call
def slam() -> Call:
    rng = np.random.default_rng(4)
    angles = np.linspace(-np.pi / 2, np.pi / 2, 180)
    times = 0.1 * np.arange(3000)
    ranges = rng.uniform(2, 9, 180) + 0.3 * rng.random((3000, 180))
    scans = cs.localization.Scans(times, ranges, angles)
    odometry = cs.localization.Odometry.from_increments(times, np.tile([0.1, 0.0, 0.02], (2999, 1)))
    log = cs.localization.Log(odometry, scans=scans)
    return lambda: cs.slam(log)


@call
def search_pose() -> Call:
    rng = np.random.default_rng(2)
    field = cs.OccupancyGrid(rng.random((3000, 3000)) < 0.003, 0.05).likelihood_field(0.2)
    points = rng.normal(size=(200, 2)) * 5
    return lambda: cs.localization.search_pose(points, field, heading_step=0.002, least_score=0.0)


@call
def optimize_graph() -> Call:
    n, rng = 30_000, np.random.default_rng(3)
    loops = np.sort(rng.integers(0, n, (600, 2)), axis=1)
    edges = np.concatenate(
        [np.stack([np.arange(n - 1), np.arange(1, n)], axis=1), loops[loops[:, 0] < loops[:, 1]]]
    )
    graph = cs.PoseGraph(
        np.tile(np.eye(4), (n, 1, 1)), edges, cs.exp_se3(rng.normal(0, 0.1, (len(edges), 6))), np.eye(6)
    )
    return lambda: graph.optimize(start="given")


@call
def likelihood_field() -> Call:
    grid = cs.OccupancyGrid(np.random.default_rng(2).random((12_000, 12_000)) < 1e-4, 0.05)
    return lambda: grid.likelihood_field(0.2)


@call
def map_scans() -> Call:
    turns = np.linspace(-np.pi, np.pi, 1000)
    ranges = np.full((4000, 1000), 40.0, np.float32)
    scans = cs.localization.Scans(np.arange(4000.0), ranges, turns)
    return lambda: cs.maps.EvidenceGrid.from_scans(scans, np.zeros((4000, 3)))


@call
def cast_polygon_rays() -> Call:
    world = cs.PolygonWorld([[(1, 1), (2, 1), (2, 2)]], (0, 0, 9, 9))
    turns = np.linspace(0, 6, 4_000_000)
    return lambda: cs.maps.cast_rays(world, np.full((len(turns), 2), 3.5), turns)


@call
def cover() -> Call:
    corners = np.random.default_rng(1).normal(size=(200, 3))
    hull = cs.Hull(corners)
    return lambda: cs.shapes.cover_mesh(hull, 0.02, cache=False)


def two_joints(use: Callable[[Any], Any]) -> Callable[[], Call]:
    """A call of an arm among small squares that touch each other."""

    def make() -> Call:
        places = 0.1 * np.stack(np.meshgrid(np.arange(-19, 19), np.arange(-19, 19)), axis=-1).reshape(-1, 2)
        places = places[np.hypot(*(places + 0.05).T) > 1.2][::2]
        squares = [place + 0.1 * np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) for place in places]
        space = cs.configuration_space(cs.load_robot("planar_2r"), squares)
        return lambda: use(space)

    return make


CALLS["components"] = two_joints(lambda space: space.components)
CALLS["bitmap"] = two_joints(lambda space: [space.bitmap(5000) for _ in range(50)])


def joint_space(use: Callable[[Any], Any]) -> Callable[[], Call]:
    """A call of the configuration space of an arm among a thousand balls."""

    def make() -> Call:
        places = np.random.default_rng(1).uniform(-1, 1, (1000, 3)) * [1, 1, 0.5] + [0, 0, 0.9]
        scene = cs.Scene([cs.Sphere(0.03, p) for p in places if np.hypot(*p[:2]) > 0.3])
        space = cs.configuration_space(cs.load_robot("panda"), scene)
        return lambda: use(space)

    return make


CALLS["slice"] = joint_space(lambda space: [space.slice((k, 3), size=4096) for k in (0, 1, 2)])
CALLS["obstacle_map"] = joint_space(lambda space: space.slice((0, 1), size=2048).obstacle_map)
CALLS["project"] = joint_space(lambda space: space.project((0, 1), size=2048, samples=100))
CALLS["volume"] = joint_space(lambda space: space.volume(10**8))


def batch(name: str, rows: int, use: Callable[[Any, Any, Any], Any]) -> Callable[[], Call]:
    """A call over rows of configurations and their poses, of which there are only some different ones."""

    def make() -> Call:
        robot = cs.load_robot(name)
        some = robot.random_configuration(100, rng=1)
        q = np.tile(some, (rows // 100, 1))
        T = np.tile(robot.fk(some), (rows // 100, 1, 1))
        return lambda: use(robot, q, T)

    return make


CALLS["fk_all"] = batch("ur5e", 4_000_000, lambda robot, q, T: robot.fk_all(q, threads=1))
CALLS["manipulability"] = batch("ur5e", 4_000_000, lambda robot, q, T: robot.manipulability(q, threads=1))
CALLS["ik_general"] = batch("jaco2", 300_000, lambda robot, q, T: robot.ik(T, threads=1))
CALLS["ik_near"] = batch("ur5e", 2_000_000, lambda robot, q, T: robot.ik(T, near=q))
CALLS["ik_redundant"] = batch("panda", 30_000, lambda robot, q, T: robot.ik(T, threads=1))
CALLS["ik_locked"] = batch("panda", 3_000_000, lambda robot, q, T: robot.ik(T, locked={6: 0.5}, threads=1))
CALLS["ik_numeric"] = batch("ur5e", 1_000_000, lambda robot, q, T: robot.ik_numeric(T, q + 0.9, threads=1))
CALLS["resolved_rate"] = batch(
    "ur5e", 2_000_000, lambda robot, q, T: robot.resolved_rate(q, np.ones((len(q), 6)), threads=1)
)
CALLS["ik_many_starts"] = batch(
    "ur5e", 100, lambda robot, q, T: robot.ik_many_starts(T[0], starts=1_000_000, rng=1, threads=1)
)


@call
def self_motion() -> Call:
    robot = cs.load_robot("ur5e")
    curve = robot.ik(robot.fk([0.3, -1.2, 1.4, -0.8, 0.0, 0.1])).self_motions[0]
    return lambda: [curve.sample(100_000) for _ in range(3)]


CALLS["on_threads"] = batch("jaco2", 600_000, lambda robot, q, T: robot.ik(T, threads=4))


@pytest.mark.parametrize("name", CALLS)
def test_an_interrupt_ends_a_long_call(name: str, timer: Callable[..., None]) -> None:
    run = CALLS[name]()
    timer(signal.default_int_handler, AFTER)
    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        run()
    assert time.perf_counter() - began < AFTER + SOON


def test_d_star_lite_goes_on_where_it_was_stopped(timer: Callable[..., None]) -> None:
    world, start, goal = blocks(1500)
    whole = cs.navigate(world, start, goal, "a_star").length
    search = cs.navigation.DStarLite(world, start, goal)
    stops = 0
    while search._route is None:
        timer(signal.default_int_handler, 0.03)
        try:
            assert search.route.length == whole
            signal.setitimer(signal.ITIMER_REAL, 0)  # or it would go off behind the try
        except KeyboardInterrupt:
            stops += 1
    assert stops > 0


def test_a_handler_is_refused_the_search_that_it_interrupts(timer: Callable[..., None]) -> None:
    world, start, goal = blocks(1500)
    search = cs.navigation.DStarLite(world, start, goal)
    told = []

    def ask(*_: Any) -> None:
        try:
            told.append(search.route)
        except cs.CspaceError as error:
            told.append(error)

    timer(ask, 0.03)
    route = search.route
    signal.setitimer(signal.ITIMER_REAL, 0)
    assert "being searched" in str(told[0])
    assert route.length == cs.navigate(world, start, goal, "a_star").length


@pytest.mark.parametrize("planner", ["any_angle", "visibility_graph"])
def test_a_handler_may_ask_the_same_world(planner: str, timer: Callable[..., None]) -> None:
    world, start, goal = squares(50)
    alone = cs.navigate(world, start, goal, planner)
    near = cs.navigate(world, start, (5.1, 2.1), planner)
    asked: list[Any] = []
    while len(asked) < 10:
        timer(lambda *_: asked.append(cs.navigate(world, start, (5.1, 2.1), planner)), 0.001)
        amid = cs.navigate(world, start, goal, planner)
        np.testing.assert_array_equal(amid.path, alone.path)
    signal.setitimer(signal.ITIMER_REAL, 0)
    assert asked
    assert {route.length for route in asked} == {near.length}


def test_results_do_not_depend_on_signals(timer: Callable[..., None]) -> None:
    robot = cs.load_robot("jaco2")
    T = robot.fk(robot.random_configuration(5_000, rng=3))
    alone = robot.ik(T, threads=1).q
    heard = []
    timer(lambda *_: heard.append(1), 0.005, 0.005)
    amid = robot.ik(T, threads=3).q
    signal.setitimer(signal.ITIMER_REAL, 0)
    np.testing.assert_array_equal(amid, alone)
    assert heard
