"""Poses as goals, and many problems on threads: benchmarks/results/planning_goals.json.

Usage: python benchmarks/planning_goals.py [--repeat 5] [--problems 10000] [--robots panda ur5 fetch]. Needs
the shared data folder ($CSPACE_DATA, default ../shared/data).

Goals: cs.plan to the configuration that a problem gives, and to its pose, inverse kinematics included; both
in turn, processor time of the thread, the median of the rounds per problem. Threads: cs.plan_many of random
pairs of free configurations in one scene, and in fifty, and to poses, wall and processor time on one and on
two threads in turn, with the load of the machine. --threads measures these alone.
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

SCENES_APART = 7
"""Every seventh problem lends its scene: those that follow each other are alike."""


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


def draw_pairs(robot: cs.Robot, scene: cs.Scene, count: int) -> tuple[Any, Any]:
    """Random starts and goals that are free."""
    q = robot.random_configuration(8 * count, rng=0)
    free = q[~robot.collides(q, scene)][: 2 * count]
    half = len(free) // 2
    return free[:half], free[half : 2 * half]


def bound_ratio(plans: list[cs.planning.Plans]) -> float:
    """The ratio that the longest problem of each call leaves possible on two threads."""
    spent = [
        [sum(value for key, value in plan.stats.items() if key.endswith("_seconds")) for plan in each]
        for each in plans
    ]
    return sum(map(sum, spent)) / sum(max(max(row), sum(row) / 2) for row in spent)


def measure_threads(
    name: str, scenes: int, count: int, repeat: int, to_poses: bool = False
) -> dict[str, Any]:
    """Wall seconds of plan_many in scenes on one and two threads, and their ratio. Processor seconds on one
    thread, and of the calling thread on two: what the walls would be if nothing else ran."""
    robot, _ = published_robot(name)
    chosen = [scene for _, _, scene, _, _ in problems(name)][::SCENES_APART][:scenes]
    given = [(*draw_pairs(robot, scene, count), scene) for scene in chosen]
    if to_poses:
        given = [(starts, robot.fk(goals), scene) for starts, goals, scene in given]
    cs.plan_many(robot, given[0][0][:10], given[0][1][:10], given[0][2], threads=2)  # imports, warms up
    rows, paths, bounds = [], {}, []
    for _ in range(repeat):
        walls, works = [], []
        for threads in (1, 2):
            begin, work = time.perf_counter(), (time.process_time(), time.thread_time())
            plans = [cs.plan_many(robot, *problem, threads=threads) for problem in given]
            walls.append(time.perf_counter() - begin)
            works.append((time.process_time() - work[0], time.thread_time() - work[1]))
            paths[threads] = [each.path for each in plans]
            if threads == 1:
                bounds.append(bound_ratio(plans))
        works_ratio = works[0][0] / works[1][1]
        rows.append([*walls, walls[0] / walls[1], works[0][0], works[1][1], works_ratio, os.getloadavg()[0]])
    same = all(np.array_equal(a, b, equal_nan=True) for a, b in zip(paths[1], paths[2], strict=True))
    return {
        "scenes": len(given),
        "problems": sum(len(starts) for starts, _, _ in given),
        "found": int(sum(each.found.sum() for each in plans)),
        "rounds_wall_one_two_ratio_work_one_calling_ratio_load": [list(map(float, row)) for row in rows],
        "median_ratio": float(np.median([row[2] for row in rows])),
        "best_ratio": float(max(row[2] for row in rows)),
        "median_ratio_of_work": float(np.median([row[5] for row in rows])),
        "bound_by_longest_problems": float(np.median(bounds)),
        "same_bits": same,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--problems", type=int, default=10_000)
    parser.add_argument("--threads", action="store_true")
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    path = HERE / "results/planning_goals.json"
    results: dict[str, Any] = json.loads(path.read_text()) if given.threads else {}
    results |= {"version": cs.__version__, "isa": cs._core.isa}
    for name in () if given.threads else given.robots:
        results[name] = measure_goals(name, given.repeat)
        print(name, json.dumps(results[name], indent=1), flush=True)
    results["threads"] = measure_threads("panda", 1, given.problems, given.repeat)
    results["threads_in_scenes"] = measure_threads("panda", 50, given.problems // 50, given.repeat)
    results["threads_to_poses"] = measure_threads("panda", 1, given.problems // 5, given.repeat, True)
    parts = [results[key] for key in ("threads", "threads_in_scenes", "threads_to_poses")]
    print(json.dumps(parts, indent=1), flush=True)
    path.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
