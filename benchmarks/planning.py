"""Plans and checks of arms on MotionBenchMaker problems: benchmarks/results/planning.json.

Usage: python benchmarks/planning.py [--repeat 5] [--vamp FOLDER] [--robots panda ur5 fetch] [--trees]. Needs
the shared data folder ($CSPACE_DATA, default ../shared/data). --trees compares RRT, RRT*, informed RRT* and
AORRTC at equal numbers of motions instead (planning_trees.json). FOLDER holds programs vamp_panda, vamp_ur5
and vamp_fetch that print a line per problem of problems/NAME.txt, with the columns that a first line names
(VAMP 0.6.4, Thomason et al. 2024, compiled for each robot): valid, solved, rrt_median_us, total_median_us,
cost_raw and cost_simplified are read. They run between our rounds.

Times are those of the thread's processor clock, the median of the rounds per problem; "wall" is what a caller
of cs.plan waits for in a scene that was not checked before.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, problems, published_robot  # noqa: E402
from cspace.planning import AORRTC, RRT, ArmSpace, InformedRRTStar, RRTConnect, RRTStar  # noqa: E402
from planning_summary import summarize  # noqa: E402

IMPROVE = 8000
"""Motions that AORRTC may check: about ten milliseconds."""

TREE_PROBLEMS, TREE_EDGES, TREE_BUDGETS = 60, 20_000, (1000, 5000, 20_000)
"""Of the comparison of trees: problems of a robot, motions until the first path, and after it."""

COLUMNS = {
    "rrt_connect": "rrt_median_us",
    "plan": "total_median_us",
    "raw_cost": "cost_raw",
    "cost": "cost_simplified",
}
"""Of the peer's lines."""


def measure_plans(name: str, repeat: int, vamp: Path | None) -> dict[str, Any]:
    """All planners on all valid problems of a robot."""
    robot, _ = published_robot(name)
    given = [(ArmSpace(robot, scene), start, goals, scene) for _, _, scene, start, goals in problems(name)]
    planners = {
        "rrt_connect": RRTConnect(simplify=False, certify=False, search="sampled"),
        "plan": RRTConnect(),
        "aorrtc": AORRTC(improve=IMPROVE),
    }
    times: dict[str, list[list[float]]] = {key: [[] for _ in given] for key in (*planners, "wall")}
    costs: dict[str, list[float]] = {key: [] for key in planners}
    valid = [not planners["plan"].plan(*problem[:3]).status.startswith("invalid") for problem in given]
    peer: list[Any] = []
    for turn in range(repeat):
        for key, planner in planners.items():
            for k, (space, start, goals, _) in enumerate(given):
                if not valid[k]:
                    continue
                begin = time.thread_time_ns()
                plan = planner.plan(space, start, goals)
                spent = (time.thread_time_ns() - begin) / 1000.0
                if plan:
                    times[key][k].append(spent)
                    if turn == 0:
                        costs[key].append(plan.cost)
        for k, (_, start, goals, scene) in enumerate(given):
            if valid[k]:
                begin = time.perf_counter_ns()
                cs.plan(robot, start, goals, scene)
                times["wall"][k].append((time.perf_counter_ns() - begin) / 1000.0)
        if vamp is not None:
            peer.append(run_vamp(vamp, name))
    results: dict[str, Any] = {"valid": sum(valid)}
    for key in times:
        results[key] = summarize([float(np.median(row)) for row in times[key] if row])
        results[key]["solved"] = sum(map(bool, times[key]))
    for key, found in costs.items():
        results[key]["cost"] = summarize(found)
    if peer:
        results["vamp"] = merge_vamp(peer)
    return results


def run_vamp(folder: Path, name: str) -> dict[str, list[float]]:
    """One round of the peer: columns of its lines."""
    command = [str(folder / f"vamp_{name}"), "plan", str(folder / "problems" / f"{name}.txt"), "1"]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    titles = lines[0].lstrip("# ").split()
    rows = [dict(zip(titles, line.split(), strict=True)) for line in lines[1:] if not line.startswith("#")]
    solved = [row for row in rows if row["valid"] == row["solved"] == "1"]
    return {ours: [float(row[theirs]) for row in solved] for ours, theirs in COLUMNS.items()}


def merge_vamp(rounds: list[dict[str, list[float]]]) -> dict[str, Any]:
    """Medians over rounds, then over problems."""
    merged = {key: np.median([one[key] for one in rounds], axis=0).tolist() for key in rounds[0]}
    return {key: summarize(values) for key, values in merged.items()} | {
        "solved": len(next(iter(rounds[0].values())))
    }


def measure_checks(name: str) -> dict[str, float]:
    """Microseconds of one call at the start of a problem and at random, configurations per second of a batch
    on one core."""
    robot, _ = published_robot(name)
    _, _, scene, start, _ = next(iter(problems(name)))
    q, rows = np.array(start, dtype=float), robot.random_configuration(1 << 16, rng=0)
    robot.collides(q, scene)
    single, batch = [], []
    for _ in range(50):
        begin = time.thread_time_ns()
        for _ in range(2000):
            robot.collides(q, scene)
        single.append((time.thread_time_ns() - begin) / 2000e3)
        begin = time.thread_time_ns()
        robot.collides(rows, scene, threads=1)
        batch.append(len(rows) / (time.thread_time_ns() - begin) * 1e9)
    drawn = list(rows[:2000])
    random = []
    for _ in range(50):
        begin = time.thread_time_ns()
        for q in drawn:
            robot.collides(q, scene)
        random.append((time.thread_time_ns() - begin) / 2000e3)
    return {
        "one_us": float(np.median(single)),
        "one_random_us": float(np.median(random)),
        "rows_per_second": float(np.median(batch)),
    }


def compare_trees(name: str) -> dict[str, Any]:
    """One tree against two at equal numbers of motions: costs where all have a path, and time per problem."""
    robot, _ = published_robot(name)
    given = [(ArmSpace(robot, scene), start, goals) for _, _, scene, start, goals in problems(name)]
    first = RRTConnect(edges=TREE_EDGES)
    valid = [row for row in given if not first.plan(*row).status.startswith("invalid")]
    chosen = [valid[k * len(valid) // TREE_PROBLEMS] for k in range(TREE_PROBLEMS)]
    planners = {"rrt_connect": first, "rrt": RRT(edges=TREE_EDGES)}
    for budget in TREE_BUDGETS:
        for planner in (RRTStar, InformedRRTStar, AORRTC):
            planners[f"{planner.name} {budget}"] = planner(edges=TREE_EDGES, improve=budget)
    plans, results = {}, {}
    for key, planner in planners.items():
        begin = time.thread_time_ns()
        plans[key] = [planner.plan(*row) for row in chosen]
        results[key] = {"mean_ms": (time.thread_time_ns() - begin) / 1e6 / len(chosen)}
        results[key]["solved"] = sum(map(bool, plans[key]))
    shared = [k for k in range(len(chosen)) if all(row[k] for row in plans.values())]
    for key, row in plans.items():
        results[key]["cost"] = summarize([row[k].cost for k in shared])
        results[key]["motions"] = float(np.mean([row[k].stats["edges"] for k in shared]))
    return {"problems": len(chosen), "solved_by_all": len(shared), "planners": results}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--vamp", type=Path)
    parser.add_argument("--trees", action="store_true")
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    results: dict[str, Any] = {"version": cs.__version__, "isa": cs._core.isa}
    if given.trees:
        for name in given.robots:
            results[name] = compare_trees(name)
            print(name, json.dumps(results[name], indent=1), flush=True)
        (HERE / "results/planning_trees.json").write_text(json.dumps(results, indent=1) + "\n")
        return
    results["improve"] = IMPROVE
    for name in given.robots:
        results[name] = measure_plans(name, given.repeat, given.vamp) | {"checks": measure_checks(name)}
        print(name, json.dumps(results[name], indent=1), flush=True)
    (HERE / "results/planning.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
