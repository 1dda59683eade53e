"""Potential fields and grids of arms on random problems: how descents end, what searches cost.

Usage: python benchmarks/planning_fields.py [--problems 1000]. Problems are random scenes of boxes, spheres
and capsules around planar_2r, planar_3r, so101 and ur5, as many for each, with a free start and goal. Every
stop of a descent is judged by values of the potential around it in numpy. On the planar arms the potential as
the heuristic of A* and of best-first search is compared with A*, Dijkstra's search and breadth-first search
over the same grid. Times are those of the thread's processor clock. Writes
benchmarks/results/planning_fields.json.
"""

from __future__ import annotations

import argparse
import json
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
from cspace.planning import ArmSpace, GridSearch, PotentialField, PotentialRest, potential

HERE = Path(__file__).resolve().parent
ARMS = {"planar_2r": 1.7, "planar_3r": 2.6, "so101": 0.35, "ur5": 0.8}
"""The arms, and the radius of the ring in which obstacles stand [m]."""
PLANAR = ("planar_2r", "planar_3r")
STEPS = {"planar_2r": 0.05, "planar_3r": 0.15}
"""Steps of the grids [rad]."""
SEARCHES: dict[str, dict[str, Any]] = {
    "A*": {},
    "Dijkstra": {"method": "dijkstra"},
    "breadth first": {"method": "breadth_first"},
    "A*, potential, w = 1": {"heuristic": "potential", "weight": 1.0},
    "A*, potential, w = 1.5": {"heuristic": "potential"},
    "best first, distance": {"method": "best_first"},
    "best first, potential": {"method": "best_first", "heuristic": "potential"},
}
BASE = "Dijkstra"
SAME_COST = 1e-9
"""Relative difference of two costs of one path length, summed in another order."""

GOAL_ROUNDING = 1e-12
"""A goal is reached exactly; a multiple of 2π rounds [rad]."""


def problems(name: str, count: int) -> Iterator[tuple[ArmSpace, Any, Any]]:
    """Random scenes with two free configurations."""
    robot, ring = cs.load_robot(name), ARMS[name]
    rng = np.random.default_rng(sum(map(ord, name)))
    while count:
        scene = cs.Scene([random_shape(rng, ring, name in PLANAR) for _ in range(rng.integers(1, 6))])
        q = robot.random_configuration(40, rng=rng, reach=np.pi)
        free = q[~robot.collides(q, scene)]
        if len(free) < 2 or bool(robot.collides(free[0], scene)):
            continue
        yield ArmSpace(robot, scene), free[0], free[1]
        count -= 1


def random_shape(rng: np.random.Generator, ring: float, is_planar: bool) -> Any:
    """A box, a sphere or a capsule somewhere around the arm."""
    at = rng.normal(size=3)
    if is_planar:
        at[2] = 0.0
    at *= ring * rng.uniform(0.5, 1.1) / np.linalg.norm(at)
    size = ring * rng.uniform(0.06, 0.2)
    T = cs.pose(at, rpy=[0.0, 0.0, rng.uniform(-3.0, 3.0)])
    kind = rng.integers(3)
    if kind == 0:
        return cs.Box(2.0 * size * rng.uniform(0.5, 1.5, 3), T)
    return cs.Sphere(size, at) if kind == 1 else cs.Capsule(0.5 * size, 2.0 * size, T)


def judge_rest(space: ArmSpace, goal: Any, rest: PotentialRest) -> str:
    """What is wrong with the name of a rest; empty if nothing is."""
    gains = {name: rest.gains[name] for name in ("k", "k_r", "rho_0", "cone", "rho_links")}
    here = potential(space, goal, rest.q, **gains)
    if rest.kind == "goal":
        apart = np.linalg.norm(space.unwrap(rest.q, goal) - rest.q)
        return "" if apart < GOAL_ROUNDING else "not at the goal"
    if rest.kind not in ("minimum", "crease"):
        return ""
    rng = np.random.default_rng(0)
    offsets = rng.normal(size=(64, space.dof))
    offsets *= 1e-4 / np.linalg.norm(offsets, axis=1)[:, None]
    around = rest.q + offsets
    if not space.wraps.all():
        closed = space.wraps == 0
        around[:, closed] = np.clip(around[:, closed], space.lower[closed], space.upper[closed])
    values = potential(space, goal, around, **gains).value
    if (values < here.value - 1e-9 * abs(here.value)).any():
        return "the potential is lower beside it"
    return ""


def measure_descents(name: str, given: list[Any]) -> dict[str, Any]:
    """How the descents of an arm end."""
    ends: Counter[str] = Counter()
    faults: Counter[str] = Counter()
    times, steps = [], []
    for space, start, goal in given:
        begin = time.thread_time_ns()
        plan = PotentialField().plan(space, start, goal)
        times.append((time.thread_time_ns() - begin) / 1e6)
        rest = plan.stats["rest"]
        ends[rest.kind] += 1
        steps.append(len(rest.values))
        if fault := judge_rest(space, goal, rest):
            faults[fault] += 1
        if plan and (not plan.certified or plan.clearance < -2e-6):
            faults["the path touches something"] += 1
        if bool(plan) != (rest.kind == "goal") or (plan.status == "local_minimum") != (
            rest.kind in ("minimum", "crease")
        ):
            faults["the status does not fit"] += 1
    return {
        "ends": dict(ends),
        "faults": dict(faults),
        "median_ms": float(np.median(times)),
        "p95_ms": float(np.quantile(times, 0.95)),
        "steps": float(np.median(steps)),
    }


def measure_searches(name: str, given: list[Any]) -> dict[str, Any]:
    """What the searches over a grid find where the straight motion is not free, and for which price."""
    given = [each for each in given if not each[0].edge(each[1], each[2])]
    costs: dict[str, list[float]] = {key: [] for key in SEARCHES}
    expansions: dict[str, list[float]] = {key: [] for key in SEARCHES}
    times: dict[str, list[float]] = {key: [] for key in SEARCHES}
    for space, start, goal in given:
        for key, options in SEARCHES.items():
            planner = GridSearch(step=STEPS[name], simplify=False, **options)
            begin = time.thread_time_ns()
            plan = planner.plan(space, start, goal)
            times[key].append((time.thread_time_ns() - begin) / 1e6)
            costs[key].append(plan.cost)
            expansions[key].append(plan.stats["expansions"])
    best = np.array(costs[BASE])
    solved = np.isfinite(best)
    found: dict[str, Any] = {"problems": len(given), "solved": int(solved.sum())}
    for key in SEARCHES:
        cost = np.array(costs[key])
        ratio = cost[solved] / np.maximum(best[solved], 1e-300)
        share = np.array(expansions[key])[solved] / np.array(expansions[BASE])[solved]
        found[key] = {
            "differing": int((np.isfinite(cost) != solved).sum()),
            "shortest": int((ratio <= 1.0 + SAME_COST).sum()),
            "mean_ratio": float(ratio.mean()),
            "worst_ratio": float(ratio.max()),
            "expansions": float(np.median(np.array(expansions[key])[solved])),
            "share": float(np.exp(np.log(share).mean())),
            "median_ms": float(np.median(np.array(times[key])[solved])),
        }
    return found


def print_searches(name: str, found: dict[str, Any]) -> None:
    print(
        f"{name}: of {found['problems']} problems whose straight motion is blocked, a grid of "
        f"{STEPS[name]} rad holds a path in {found['solved']}"
    )
    print("  search | other verdict | cost ratio mean, worst | expansions median | of Dijkstra's | ms")
    for key in SEARCHES:
        each = found[key]
        print(
            f"  {key:24} {each['differing']:3} {each['mean_ratio']:8.4f} {each['worst_ratio']:8.4f} "
            f"{each['expansions']:9.0f} {each['share']:8.3f} {each['median_ms']:8.2f}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--problems", type=int, default=1000)
    count = parser.parse_args().problems // len(ARMS)
    results: dict[str, Any] = {"version": cs.__version__, "isa": cs._core.isa}
    for name in ARMS:
        given = list(problems(name, count))
        descents = measure_descents(name, given)
        results[name] = {"descents": descents}
        ends = ", ".join(f"{kind} {n}" for kind, n in sorted(descents["ends"].items()))
        print(
            f"{name}: {count} descents: {ends}; faults {descents['faults'] or 'none'}; "
            f"{descents['median_ms']:.2f} ms, p95 {descents['p95_ms']:.2f}, {descents['steps']:.0f} steps",
            flush=True,
        )
        if name in PLANAR:
            results[name]["searches"] = measure_searches(name, given)
            print_searches(name, results[name]["searches"])
    (HERE / "results/planning_fields.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
