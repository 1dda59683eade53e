"""Roadmaps of arms on MotionBenchMaker problems, beside RRT-Connect.

Usage: python benchmarks/planning_roadmaps.py [--problems 60] [--repeat 5] [--robots panda ur5 fetch]. Needs
the shared data folder ($CSPACE_DATA, default ../shared/data). Writes results/planning_roadmaps.json.

A roadmap is made per robot and number of samples, and used in all scenes. "cold" is a plan in a scene that
the roadmap was not used in before, "warm" the same plan again. Times are those of the thread's processor
clock, the median of the rounds per problem.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path += [str(HERE.parent / "tests"), str(HERE)]

import numpy as np  # noqa: E402

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, problems, published_robot  # noqa: E402
from cspace.planning import PRM, ArmSpace, LazyPRM, Plan, PRMStar, Roadmap, RRTConnect  # noqa: E402
from planning_summary import summarize  # noqa: E402

SIZES = (1000, 4000, 10000)
"""Samples of the roadmaps."""


def choose_problems(name: str, count: int) -> list[tuple[ArmSpace, Any, Any]]:
    """Valid problems of a robot, spread over all sets."""
    robot, _ = published_robot(name)
    given = [(ArmSpace(robot, scene), start, goals) for _, _, scene, start, goals in problems(name)]
    valid = [each for each in given if not RRTConnect().plan(*each).status.startswith("invalid")]
    return valid[:: max(1, len(valid) // count)][:count]


def time_plan(planner: Any, problem: tuple[ArmSpace, Any, Any]) -> tuple[float, Plan]:
    """Microseconds, and the plan."""
    begin = time.thread_time_ns()
    plan: Plan = planner.plan(*problem)
    return (time.thread_time_ns() - begin) / 1000.0, plan


def measure_planner(make: Any, given: list[tuple[ArmSpace, Any, Any]], repeat: int) -> dict[str, Any]:
    """A planner on all problems, cold and warm; make(): a planner that was not used before."""
    cold: list[list[float]] = [[] for _ in given]
    warm: list[list[float]] = [[] for _ in given]
    plans: list[Plan] = []
    for turn in range(repeat):
        planner = make()
        for k, problem in enumerate(given):
            spent, plan = time_plan(planner, problem)
            cold[k].append(spent)
            warm[k].append(time_plan(planner, problem)[0])
            if turn == 0:
                plans.append(plan)
    solved = [k for k, plan in enumerate(plans) if plan]
    return {
        "solved": len(solved),
        "cold": summarize([float(np.median(row)) for row in cold]),
        "warm": summarize([float(np.median(row)) for row in warm]),
        "edges": summarize([float(plan.stats["edges"]) for plan in plans]),
        "costs": {k: plans[k].cost for k in solved},
    }


def measure_building(name: str, samples: int, neighbours: int | None, repeat: int) -> dict[str, Any]:
    """Seconds on one thread and on all, nodes and edges."""
    robot, _ = published_robot(name)
    spent: dict[int, list[float]] = {1: [], 0: []}
    for _ in range(repeat):
        for threads, seconds in spent.items():
            begin = time.perf_counter()
            made = Roadmap(robot, samples=samples, neighbours=neighbours, threads=threads)
            seconds.append(time.perf_counter() - begin)
    return {
        "nodes": len(made),
        "edges": len(made.edges),
        "components": made.components,
        "seconds": float(np.median(spent[1])),
        "seconds_all_threads": float(np.median(spent[0])),
    }


def refresh_planner(kind: Any, roadmap: Roadmap) -> Any:
    """A planner on a roadmap that knows no scene."""
    return kind(roadmap=roadmap.extend(0))


def measure_robot(name: str, count: int, repeat: int) -> dict[str, Any]:
    """All roadmaps of a robot, and RRT-Connect."""
    robot, _ = published_robot(name)
    given = choose_problems(name, count)
    found = {"rrt_connect": measure_planner(RRTConnect, given, repeat)}
    building = {}
    for samples in SIZES:
        for kind, neighbours in ((LazyPRM, 15), (PRMStar, None)):
            title = f"{kind.name} {samples}"
            building[title] = measure_building(name, samples, neighbours, repeat)
            roadmap = Roadmap(robot, samples=samples, neighbours=neighbours)
            found[title] = measure_planner(lambda k=kind, m=roadmap: refresh_planner(k, m), given, repeat)
    roadmap = Roadmap(robot, samples=SIZES[1])
    found[f"prm {SIZES[1]}"] = measure_planner(lambda: refresh_planner(PRM, roadmap), given, 1)
    base = found["rrt_connect"]["costs"]
    for row in found.values():
        own = row.pop("costs")
        shared = [own[k] / base[k] for k in own if k in base and base[k] > 0.0]
        row["cost_of_rrt_connect"] = float(np.median(shared))
    return {"problems": len(given), "planners": found, "building": building}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--problems", type=int, default=60)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    results: dict[str, Any] = {"version": cs.__version__, "isa": cs._core.isa}
    for name in given.robots:
        results[name] = measure_robot(name, given.problems, given.repeat)
        print(name, json.dumps(results[name], indent=1), flush=True)
    (HERE / "results/planning_roadmaps.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
