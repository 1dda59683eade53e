"""Poses as goals, and many problems on threads: benchmarks/results/planning_goals.json.

Usage: python benchmarks/planning_goals.py [--repeat 5] [--problems 10000] [--robots panda ur5 fetch]. Needs
the shared data folder ($CSPACE_DATA, default ../shared/data).

Goals: cs.plan to the configuration that a problem gives, and to its pose, inverse kinematics included; both
in turn, processor time of the thread, the median of the rounds per problem. Threads: cs.plan_many of random
pairs of free configurations in one scene, wall time on one and on two threads in turn, with the load of the
machine.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, problems, published_robot  # noqa: E402


def measure_goals(name: str, repeat: int) -> dict[str, Any]:
    """Times [µs], costs and problems solved, to configurations and to their poses."""
    robot, _ = published_robot(name)
    kinds = ("configuration", "pose")
    times: dict[str, list[float]] = {kind: [] for kind in kinds}
    costs: dict[str, list[float]] = {kind: [] for kind in kinds}
    valid = 0
    for _, _, scene, start, goals in problems(name):
        q = np.atleast_2d(goals)[0]
        goal = {"configuration": q, "pose": robot.fk(q)}
        if robot.collides(np.array([start, q]), scene).any():
            continue
        valid += 1
        spent: dict[str, list[float]] = {kind: [] for kind in kinds}
        for _ in range(repeat):
            for kind in kinds:
                begin = time.thread_time_ns()
                plan = cs.plan(robot, start, goal[kind], scene)
                spent[kind].append((time.thread_time_ns() - begin) / 1000.0)
                if len(spent[kind]) == repeat and plan:
                    costs[kind].append(plan.cost)
        for kind in kinds:
            times[kind].append(float(np.median(spent[kind])))
    found = {
        kind: {
            "solved": len(costs[kind]),
            "median_us": float(np.median(times[kind])),
            "mean_us": float(np.mean(times[kind])),
            "p95_us": float(np.quantile(times[kind], 0.95)),
            "median_cost": float(np.median(costs[kind])),
        }
        for kind in kinds
    }
    one, all_ = found["configuration"], found["pose"]
    ratios = {key: all_[key] / one[key] for key in ("median_us", "mean_us", "median_cost")}
    return {"valid": valid, **found, "ratios": ratios}


def measure_threads(name: str, count: int, repeat: int) -> dict[str, Any]:
    """Wall seconds of plan_many on one and two threads, and their ratio."""
    robot, _ = published_robot(name)
    _, _, scene, _, _ = next(iter(problems(name)))
    q = robot.random_configuration(8 * count, rng=0)
    free = q[~robot.collides(q, scene)][: 2 * count]
    starts, goals = free[: len(free) // 2], free[len(free) // 2 :][: len(free) // 2]
    rows, plans = [], []
    for _ in range(repeat):
        walls = []
        for threads in (1, 2):
            begin = time.perf_counter()
            plans.append(cs.plan_many(robot, starts, goals, scene, threads=threads))
            walls.append(time.perf_counter() - begin)
        rows.append([*walls, walls[0] / walls[1], os.getloadavg()[0]])
    same = all(np.array_equal(plan.path, plans[0].path, equal_nan=True) for plan in plans[:2])
    found = [list(map(float, row)) for row in rows]
    return {
        "problems": len(starts),
        "found": int(plans[0].found.sum()),
        "rounds_one_two_ratio_load": found,
        "median_ratio": float(np.median([row[2] for row in rows])),
        "best_ratio": float(max(row[2] for row in rows)),
        "same_bits": same,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--problems", type=int, default=10_000)
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    results: dict[str, Any] = {"version": cs.__version__, "isa": cs._core.isa}
    for name in given.robots:
        results[name] = measure_goals(name, given.repeat)
        print(name, json.dumps(results[name], indent=1), flush=True)
    results["threads"] = measure_threads("panda", given.problems, given.repeat)
    print(json.dumps(results["threads"], indent=1), flush=True)
    (HERE / "results/planning_goals.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
