"""How soon long calls heed Ctrl-C: the time from a signal until KeyboardInterrupt is raised.

Usage: python benchmarks/interrupts.py [NAME …] [--signals 20]. Each call runs in a fresh process; a timer
raises in its course, at moments spread evenly over it. Prints how long the call takes, and the median and
the worst latency [ms]; --list prints the names.
"""

from __future__ import annotations

import argparse
import json
import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import cspace as cs

Call = Callable[[], Any]
CALLS: dict[str, Callable[[], Call]] = {}


def call(make: Callable[[], Call]) -> Callable[[], Call]:
    """Registers what prepares a call and returns it."""
    CALLS[make.__name__] = make
    return make


def grid(side: int, share: float = 0.2) -> tuple[Any, Any, Any]:
    blocked = np.random.default_rng(1).random((side, side)) < share
    blocked[:3] = blocked[-3:] = False
    return cs.OccupancyGrid(blocked), (0.5, 0.5), (side - 0.5, side - 0.5)


def navigation(planner: str, side: int, **options: Any) -> Callable[[], Call]:
    def make() -> Call:
        world, start, goal = grid(side)
        return lambda: cs.navigate(world, start, goal, planner, **options)

    return make


for planner, side in {
    **{"dijkstra": 2500, "theta_star": 1500, "any_angle": 1500, "jump_point_search": 3000},
    **{"d_star_lite": 3000, "wavefront": 3000, "fast_marching": 1500, "brushfire": 3000},
    **{"harmonic": 700, "potential_a_star": 2000, "focal_search": 1500},
}.items():
    CALLS[planner] = navigation(planner, side)


def squares(count: int) -> Any:
    side = math.isqrt(count)
    rng = np.random.default_rng(2)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 0.5
    rings = [
        corners * rng.uniform(0.5, 1.0) + [i + 0.3, j + 0.3 * rng.random()]
        for i in range(side)
        for j in range(side)
    ]
    return cs.PolygonWorld(rings, bounds=(-1, -1, side + 1, side + 1)), (-0.5, -0.5), (side + 0.5, side + 0.5)


def between(planner: str, count: int, **options: Any) -> Callable[[], Call]:
    def make() -> Call:
        world, start, goal = squares(count)

        rings, bounds = list(world.obstacles), world.bounds

        def plan() -> Any:
            return cs.navigate(cs.PolygonWorld(rings, bounds=bounds), start, goal, planner, **options)

        return plan

    return make


for planner, count, options in (
    ("prm", 100, {"samples": 200_000, "rng": 1}),
    ("rrt", 400, {"samples": 1_000_000, "rng": 1, "step": 0.01, "goal_bias": 0.0}),
    ("rrt_star", 100, {"samples": 200_000, "rng": 1}),
    ("bug_1", 400, {}),
    ("tangent_bug", 2500, {}),
    ("voronoi_bug", 2500, {}),
):
    CALLS[planner] = between(planner, count, **options)


@call
def voronoi_bug_noise() -> Call:
    world, start, goal = squares(100)
    planner = cs.navigation.VoronoiBug(noise=0.01, range=2.0, rng=1)
    return lambda: planner.plan(world, start, goal)


def made_anew(use: Callable[[Any, Any, Any], Any], count: int) -> Callable[[], Call]:
    """A call whose world is made anew by it."""

    def make() -> Call:
        world, start, goal = squares(count)
        outlines, bounds = list(world.obstacles), world.bounds
        return lambda: use(cs.PolygonWorld(outlines, bounds=bounds), start, goal)

    return make


for planner, count in {"voronoi": 5000, "visibility_graph": 1000, "exact_cells": 20000}.items():
    CALLS[planner] = made_anew(lambda world, a, b, planner=planner: cs.navigate(world, a, b, planner), count)
CALLS["approximate_cells"] = made_anew(
    lambda world, a, b: cs.navigate(world, a, b, "approximate_cells", depth=9), 2500
)
CALLS["any_angle_polygons"] = made_anew(lambda world, a, b: cs.navigate(world, a, b, "any_angle"), 20000)
CALLS["potential_field"] = made_anew(lambda world, a, b: cs.navigate(world, a, b, "potential_field"), 2500)
CALLS["rimon_koditschek"] = made_anew(lambda world, a, b: cs.navigate(world, a, b, "rimon_koditschek"), 60)
CALLS["voronoi_diagram"] = made_anew(lambda world, a, b: cs.navigation.voronoi_diagram(world), 5000)
CALLS["polygon_world"] = made_anew(lambda world, a, b: world, 20000)
CALLS["inflate_polygons"] = made_anew(lambda world, a, b: world.inflate(0.05), 5000)


@call
def brushfire_polygons() -> Call:
    world = squares(100)[0]
    return lambda: cs.navigation.brushfire_diagram(world.to_grid(0.004))


@call
def occupancy_grid() -> Call:
    blocked = np.random.default_rng(1).random((6000, 6000)) < 0.2
    return lambda: cs.OccupancyGrid(blocked)


@call
def inflate_grid() -> Call:
    world = grid(4000, 0.001)[0]
    return lambda: world.inflate(30.0)


@call
def d_star_lite_steps() -> Call:
    world, start, goal = grid(3000)
    rows = np.repeat(np.arange(2990), 200)
    cells = np.stack([rows, np.tile(np.arange(1000, 1200), 2990)], axis=1)

    def steps() -> Any:
        search = cs.navigation.DStarLite(world, start, goal)
        search.set_blocked(cells)
        search.set_blocked(cells, False)
        return search.route

    return steps


@call
def arrival_times() -> Call:
    world, _, goal = grid(1500)
    return lambda: cs.navigation.arrival_times(world, goal)


@call
def brushfire_diagram() -> Call:
    world = grid(3000)[0]
    return lambda: cs.navigation.brushfire_diagram(world)


@call
def coverage() -> Call:
    world, start, _ = grid(1000, 0.05)
    return lambda: cs.navigation.coverage(world, start)


@call
def hybrid_a_star() -> Call:
    world = grid(600, 0.01)[0]
    car = cs.navigation.Car(length=0.8, width=0.4, wheelbase=0.5, rear=0.1)
    ends = [(5.5, 1.5, 0.0), (590.5, 598.5, 0.0)]
    return lambda: cs.navigation.hybrid_a_star(world, *ends, vehicle=car)


@call
def follow() -> Call:
    s = np.linspace(0, 400, 4000)
    path = np.stack([s, 5 * np.sin(s / 10)], axis=1)
    return lambda: cs.navigation.follow(path, time_step=0.001)


@call
def cast_rays() -> Call:
    world = grid(2000, 0.001)[0]
    angles = np.linspace(0, 6, 500_000)
    return lambda: cs.navigation.cast_rays(world, np.full((500_000, 2), 3.5), angles)


@call
def curve_sample() -> Call:
    curve = cs.navigation.dubins((0, 0, 0), (10, 0, 1), 1.0)
    return lambda: curve.sample(5e-6)


def batch(name: str, rows: int, use: Callable[[Any, Any, Any], Any]) -> Callable[[], Call]:
    def make() -> Call:
        robot = cs.load_robot(name)
        q = robot.random_configuration(rows, rng=1)
        return lambda: use(robot, q, None)

    return make


def goals(name: str, rows: int, use: Callable[[Any, Any, Any], Any]) -> Callable[[], Call]:
    def make() -> Call:
        robot = cs.load_robot(name)
        q = robot.random_configuration(rows, rng=1)
        T = robot.fk(q)
        return lambda: use(robot, q, T)

    return make


CALLS["fk"] = batch("ur5e", 4_000_000, lambda robot, q, T: robot.fk(q))
CALLS["fk_all"] = batch("ur5e", 1_000_000, lambda robot, q, T: robot.fk_all(q))
CALLS["jacobian"] = batch("ur5e", 4_000_000, lambda robot, q, T: robot.jacobian(q))
CALLS["jacobian_dot"] = batch("ur5e", 1_000_000, lambda robot, q, T: robot.jacobian_dot(q, q))
CALLS["manipulability"] = batch("ur5e", 1_000_000, lambda robot, q, T: robot.manipulability(q))
CALLS["random_configuration"] = batch(
    "ur5e", 10, lambda robot, q, T: robot.random_configuration(10_000_000, rng=1)
)
CALLS["workspace"] = batch("ur5e", 10, lambda robot, q, T: robot.workspace(2_000_000, rng=1))
CALLS["ik_general"] = goals("jaco2", 100_000, lambda robot, q, T: robot.ik(T))
CALLS["ik_closed"] = goals("ur5e", 2_000_000, lambda robot, q, T: robot.ik(T))
CALLS["ik_singular"] = goals("ur5e", 2_000, lambda robot, q, T: robot.ik(robot.fk(np.round(q * 2) / 2 * 0)))
CALLS["ik_near"] = goals("ur5e", 200_000, lambda robot, q, T: robot.ik(T, near=q))
CALLS["ik_redundant"] = goals("panda", 10_000, lambda robot, q, T: robot.ik(T))
CALLS["ik_redundant_near"] = goals("panda", 20_000, lambda robot, q, T: robot.ik(T, near=q + 0.5))
CALLS["ik_locked"] = goals("panda", 200_000, lambda robot, q, T: robot.ik(T, locked={6: 0.5}))
CALLS["ik_position"] = goals("ur5e", 20_000, lambda robot, q, T: robot.ik(position=T[:, :3, 3]))
CALLS["ik_numeric"] = goals("ur5e", 200_000, lambda robot, q, T: robot.ik_numeric(T, q + 0.3))
CALLS["ik_many_starts"] = goals(
    "ur5e", 5, lambda robot, q, T: robot.ik_many_starts(T[0], starts=50_000, rng=1)
)
CALLS["ik_tasks"] = goals("ur5e", 5, lambda robot, q, T: robot.ik_tasks([cs.PoseTask(None, T[0])], q[1]))
CALLS["resolved_rate"] = goals(
    "ur5e", 1_000_000, lambda robot, q, T: robot.resolved_rate(q, np.ones((len(q), 6)))
)


@call
def track() -> Call:
    robot = cs.load_robot("ur5e")
    a, b = robot.fk(robot.random_configuration(2, rng=1))
    T = cs.interpolate(a, b, np.linspace(0, 1, 20_000))
    return lambda: robot.track(T)


@call
def track_redundant() -> Call:
    robot = cs.load_robot("panda")
    q = robot.random_configuration(2, rng=1)
    T = robot.fk(q[0] + np.linspace(0, 0.2, 5_000)[:, None] * (q[1] - q[0]))
    return lambda: robot.track(T)


@call
def interpolate() -> Call:
    a, b = cs.random_pose(2, rng=1)
    return lambda: cs.interpolate(a, b, np.linspace(0, 1, 3_000_000))


@call
def as_pose() -> Call:
    T = cs.random_pose(2_000_000, rng=1)
    return lambda: cs.as_pose(T)


def make_loops(poses: int, loops: int, robust_share: float = 0.0) -> Any:
    """A walk in the plane with loops to places nearby, of which a share are false."""
    rng = np.random.default_rng(5)
    turns = rng.choice([0, 0, 0, np.pi / 2, -np.pi / 2], poses - 1)
    heading = np.append(0.0, np.cumsum(turns))
    steps = np.stack([np.cos(heading[:-1]), np.sin(heading[:-1])], axis=1)
    truth = np.column_stack([np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]), heading])
    cells: dict[tuple[int, int], int] = {}
    pairs = []
    for k, place in enumerate(np.round(truth[:, :2]).astype(int).tolist()):
        if (seen := cells.setdefault((place[0], place[1]), k)) < k - 20:
            pairs.append((seen, k))
    chosen = np.array(pairs)[rng.permutation(len(pairs))[:loops]]
    edges = np.concatenate([np.stack([np.arange(poses - 1), np.arange(1, poses)], axis=1), chosen])
    noise = rng.normal(0, [0.05, 0.05, 0.02], (len(edges), 3))
    T = cs.pose_2d(xytheta=truth)
    motions = cs.to_xytheta(np.linalg.inv(T[edges[:, 0]]) @ T[edges[:, 1]] @ cs.pose_2d(xytheta=noise))
    false = rng.random(len(edges)) < robust_share
    false[: poses - 1] = False
    motions[false, :2] += rng.uniform(-9.0, 9.0, (int(false.sum()), 2))
    return cs.PoseGraph(
        poses=np.zeros((poses, 3)), edges=edges, motions=motions, information=np.diag([400.0, 400.0, 2500.0])
    )


@call
def pose_graph() -> Call:
    graph = make_loops(100_000, 60_000)
    return lambda: graph.optimize()


@call
def pose_graph_rotations() -> Call:
    graph = make_loops(50_000, 30_000)
    return lambda: graph.optimize(start="rotations")


@call
def pose_graph_robust() -> Call:
    graph = make_loops(5_000, 3_000, 0.3)
    return lambda: graph.optimize(robust="dcs")


@call
def pose_graph_graduated() -> Call:
    graph = make_loops(5_000, 3_000, 0.3)
    return lambda: graph.optimize(robust="gnc")


@call
def pose_graph_marginals() -> Call:
    graph = make_loops(50_000, 30_000)
    return lambda: graph.optimize().marginals


@call
def time_path() -> Call:
    path = cs.spline(np.random.default_rng(1).uniform(-1.5, 1.5, (100_000, 7)))
    return lambda: cs.time_parametrize(path, velocity=2.0, acceleration=8.0)


@call
def time_path_with_jerk() -> Call:
    path = cs.spline(np.random.default_rng(1).uniform(-1.5, 1.5, (100, 7)), degree=5)
    return lambda: cs.time_parametrize(path, velocity=2.0, acceleration=8.0, jerk=80.0)


@call
def follow_redundant() -> Call:
    robot = cs.load_robot("gen3")
    q = robot.random_configuration(2, rng=1, reach=0.5)
    path = cs.trajectory.line_path(*robot.fk(q))
    return lambda: cs.cartesian.follow_redundant(robot, path)


def measure(name: str, signals: int) -> dict[str, Any]:
    """The time of a call [s] and its latencies [s]."""
    run = CALLS[name]()
    run()
    began = time.perf_counter()
    run()
    whole = time.perf_counter() - began

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGALRM, interrupt)
    latencies = []
    for k in range(signals):
        after = whole * (k + 0.5) / signals
        due = time.perf_counter() + after
        try:
            signal.setitimer(signal.ITIMER_REAL, after)
            run()
        except KeyboardInterrupt:
            latencies.append(time.perf_counter() - due)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
    return {"whole": whole, "latencies": latencies}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=[])
    parser.add_argument("--signals", type=int, default=20)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.one:
        print(json.dumps(measure(args.one, args.signals)))
        return
    for name in args.names or CALLS:
        if args.list:
            print(name)
            continue
        command = [sys.executable, __file__, "--one", name, "--signals", str(args.signals)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            print(f"{name:24} failed: {done.stderr.strip().splitlines()[-1]}", flush=True)
            continue
        told = json.loads(done.stdout)
        ms = np.array(sorted(told["latencies"])) * 1e3
        least = f"median {np.median(ms):7.1f} ms, worst {ms[-1]:7.1f} ms" if len(ms) else "no signal came"
        print(f"{name:24} {told['whole']:7.3f} s, {least}, {len(ms)} signals", flush=True)


if __name__ == "__main__":
    main()
