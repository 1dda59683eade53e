"""Time parametrisation beside toppra and copp-py: benchmarks/results/path_timing.json.

Usage: python benchmarks/path_timing.py [--paths 20] [--rounds 7] [--write]

Random cubic splines of seven joints, |q̇| ≤ 2, |q̈| ≤ 8. For each contender the coarsest uniform grid whose
duration is within 0.1 % of that of 20,000 intervals, then its automatic grid, then torque limits of
the panda, then limits of jerk (80) along quintic splines.
Processor time of one thread per call from Python, medians over rounds in turns; the limits that each
answer exceeds at ten places of every interval stand beside it.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import platform
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # threads that wait would count as processor time

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from cspace.trajectory import Path as JointPath  # noqa: E402
from oracles.path_timing import copp_call, copp_jerk_call, duration, excess, toppra_call  # noqa: E402

VELOCITY, ACCELERATION, JERK = np.full(7, 2.0), np.full(7, 8.0), np.full(7, 80.0)
COPP_INTERVALS = 100
"""Of copp-py under limits of jerk."""
FINE = 20_000
WITHIN = 1e-3
GRIDS = (60, 100, 150, 200, 300, 400, 600, 800, 1200, 1600, 2400, 3200, 4800)
COUNTS = (5, 10, 20, 50)
Rows = dict[str, dict[str, float]]


def spend(call: Callable[[], Any]) -> float:
    """Microseconds of processor time of one call."""
    begin = time.process_time_ns()
    call()
    return (time.process_time_ns() - begin) / 1e3


def time_calls(calls: dict[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Medians over rounds in turns [µs]; a call shorter than a millisecond is repeated."""
    repeats = {name: max(1, int(1000 / max(spend(call), 1.0))) for name, call in calls.items()}
    found: dict[str, list[float]] = {name: [] for name in calls}
    gc.disable()
    for _ in range(rounds):
        for name, call in calls.items():
            begin = time.process_time_ns()
            for _ in range(repeats[name]):
                call()
            found[name].append((time.process_time_ns() - begin) / 1e3 / repeats[name])
    gc.enable()
    return {name: float(np.median(each)) for name, each in found.items()}


def time_ours(path: JointPath, grid: int | None) -> cs.trajectory.TimedPath:
    return cs.time_parametrize(path, velocity=VELOCITY, acceleration=ACCELERATION, grid=grid)


def coarsest(solve: Callable[[int], tuple[np.ndarray, np.ndarray]], exact: float) -> int:
    """The first number of intervals whose duration is within the tolerance; with zero speeds it is not."""
    for count in GRIDS:
        if abs(duration(*solve(count)) / exact - 1.0) <= WITHIN:
            return count
    return GRIDS[-1]


def uniform(path: JointPath, count: int) -> np.ndarray:
    """A grid with the breaks of the path, as ours has it."""
    return np.asarray(time_ours(path, count).grid)


def measure_uniform(path: JointPath, rounds: int) -> Rows:
    fine = time_ours(path, FINE)

    def ours(count: int) -> tuple[np.ndarray, np.ndarray]:
        timed = time_ours(path, count)
        return timed.grid, timed.squared_speed

    solvers = {"cspace": ours}
    for name, make in (("toppra", toppra_call), ("copp-py", copp_call)):

        def solve(count: int, make: Any = make) -> tuple[np.ndarray, np.ndarray]:
            grid = uniform(path, count)
            return grid, make(path, VELOCITY, ACCELERATION, grid)()

        solvers[name] = solve
    counts = {name: coarsest(solve, fine.duration) for name, solve in solvers.items()}
    calls: dict[str, Callable[[], Any]] = {"cspace": lambda: time_ours(path, counts["cspace"])}
    for name, make in (("toppra", toppra_call), ("copp-py", copp_call)):
        calls[name] = make(path, VELOCITY, ACCELERATION, uniform(path, counts[name]))
    times = time_calls(calls, rounds)
    rows: Rows = {}
    for name, solve in solvers.items():
        grid, x = solve(counts[name])
        over = excess(path, grid, x, VELOCITY, ACCELERATION)
        rows[name] = {
            "intervals": counts[name],
            "us": times[name],
            "longer": duration(grid, x) / fine.duration - 1.0,
            "over_velocity": over[0],
            "over_acceleration": over[1],
        }
    return rows


def measure_automatic(path: JointPath, rounds: int) -> Rows:
    exact = time_ours(path, 4 * FINE).duration
    toppra = toppra_call(path, VELOCITY, ACCELERATION, None)
    times = time_calls({"cspace": lambda: time_ours(path, None), "toppra": toppra}, rounds)
    timed, x = time_ours(path, None), toppra()
    grid: np.ndarray = toppra.grid  # type: ignore[attr-defined]
    rows: Rows = {}
    for name, places, squared, rises, seconds in (
        ("cspace", timed.grid, timed.squared_speed, timed.rises, timed.duration),
        ("toppra", grid, x, 0.0, duration(grid, x)),
    ):
        over = excess(path, places, squared, VELOCITY, ACCELERATION, rises)
        rows[name] = {
            "intervals": len(places) - 1,
            "us": times[name],
            "longer": seconds / exact - 1.0,
            "over_velocity": over[0],
            "over_acceleration": over[1],
        }
    return rows


def measure_torque(rng: np.random.Generator, count: int, rounds: int) -> dict[str, float]:
    robot = cs.load_robot("panda")
    low, high = robot.limits.range
    found = []
    for _ in range(count):
        path = cs.spline(low + (high - low) * rng.uniform(0.25, 0.75, (5, 7)))

        def call(path: JointPath = path) -> Any:
            return cs.time_parametrize(path, robot, torque=0.6 * robot.limits.effort, grid=100)

        timed = call()
        found.append([time_calls({"cspace": call}, rounds)["cspace"], len(timed.grid) - 1])
    us, intervals = np.median(found, axis=0)
    return {"us": float(us), "intervals": float(intervals)}


def measure_jerk(rng: np.random.Generator, count: int, rounds: int) -> Rows:
    """Ours on its default grid, copp-py on 100 intervals with one and three rounds of its solver."""
    rows: list[Rows] = []
    for _ in range(count):
        path = cs.spline(rng.uniform(-1.5, 1.5, (5, 7)), degree=5)
        limits = {"velocity": VELOCITY, "acceleration": ACCELERATION, "jerk": JERK}

        def ours(path: JointPath = path, limits: Any = limits) -> Any:
            return cs.time_parametrize(path, **limits)

        grid = np.linspace(0.0, path.length, COPP_INTERVALS + 1)
        calls: dict[str, Callable[[], Any]] = {"cspace": ours}
        for number in (1, 3):
            name = f"copp-py, {number} round{'s' * (number > 1)}"
            calls[name] = copp_jerk_call(path, VELOCITY, ACCELERATION, JERK, grid, number)
        times = time_calls(calls, rounds)
        timed = ours()
        intervals = {name: COPP_INTERVALS for name in calls} | {"cspace": len(timed.grid) - 1}
        seconds = {name: float(call()[-1]) for name, call in calls.items() if name != "cspace"}
        seconds["cspace"] = timed.duration
        row: Rows = {}
        for name in calls:
            longer = seconds[name] / timed.duration - 1.0
            row[name] = {"intervals": intervals[name], "us": times[name], "longer": longer}
        rows.append(row)
    return summarize(rows)


def summarize(rows: list[Rows]) -> Rows:
    """Medians of numbers of intervals, times and durations; the largest excess of limits."""
    made: Rows = {}
    for name in rows[0]:
        each = {key: [row[name][key] for row in rows] for key in rows[0][name]}
        made[name] = {
            key: float(np.max(values) if key.startswith("over") else np.median(values))
            for key, values in each.items()
        }
    return made


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--paths", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    rng = np.random.default_rng(1)
    results: dict[str, Any] = {"machine": platform.processor(), "uniform": {}, "automatic": {}}
    for count in COUNTS:
        paths = [cs.spline(rng.uniform(-1.5, 1.5, (count, 7))) for _ in range(options.paths)]
        results["uniform"][count] = summarize([measure_uniform(path, options.rounds) for path in paths])
        results["automatic"][count] = summarize([measure_automatic(path, options.rounds) for path in paths])
        for kind in ("uniform", "automatic"):
            for name, row in results[kind][count].items():
                print(
                    f"{kind:9} {count:3} waypoints {name:8}", {k: float(f"{v:.3g}") for k, v in row.items()}
                )
    results["torque"] = measure_torque(rng, options.paths, options.rounds)
    print("torque", results["torque"])
    results["jerk"] = measure_jerk(rng, options.paths, options.rounds)
    print("jerk", json.dumps(results["jerk"]))
    if options.write:
        text = json.dumps(results, indent=1) + "\n"
        (HERE / "results/path_timing.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
