"""Motions of seven joints from state to state beside Ruckig, from Python: benchmarks/results/trajectory.json.

Usage: python benchmarks/trajectory.py [--problems 2000] [--rounds 9] [--core FILE] [--write]. Needs
`pip install ruckig`. FILE: what bench_states of benchmarks/cpp printed, built with -DCSPACE_BENCHMARKS=ON
where CMake finds Ruckig.

Random problems, the same for both: from rest to rest, and between moving states. Each contender sets its
problem from arrays and computes the motion. Times are processor times of one thread, medians over rounds in
turns. A batch is one call of ours; Ruckig has none. Durations are compared first, then both motions are
sampled 1,000 times each: how far limits are exceeded.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import ruckig

import cspace as cs

HERE = Path(__file__).resolve().parent
DOF = 7
LIMITS = {"velocity": 2.0, "acceleration": 8.0, "jerk": 80.0}
SAMPLES = 1000
CHECKED = 100
"""Motions whose limits are checked."""


def make_problems(count: int, moving: bool) -> dict[str, np.ndarray]:
    """Boundary states (count, DOF) each."""
    rng = np.random.default_rng(7)
    problems = {"start": rng.uniform(-2, 2, (count, DOF)), "goal": rng.uniform(-2, 2, (count, DOF))}
    if moving:
        problems["start_velocity"], problems["goal_velocity"] = rng.uniform(-1, 1, (2, count, DOF))
        problems["start_acceleration"] = rng.uniform(-4, 4, (count, DOF))
    return problems


class RuckigContender:
    """Ruckig with its objects made beforehand."""

    def __init__(self) -> None:
        self.solver, self.task = ruckig.Ruckig(DOF), ruckig.InputParameter(DOF)
        for name, value in LIMITS.items():
            setattr(self.task, f"max_{name}", [value] * DOF)

    def solve(self, problem: dict[str, list[float]]) -> Any:
        task, motion = self.task, ruckig.Trajectory(DOF)
        task.current_position, task.target_position = problem["start"], problem["goal"]
        if "start_velocity" in problem:
            task.current_velocity, task.target_velocity = problem["start_velocity"], problem["goal_velocity"]
            task.current_acceleration = problem["start_acceleration"]
        self.solver.calculate(task, motion)
        return motion


def solve_ours(problem: dict[str, Any]) -> Any:
    return cs.trajectory.state_to_state(**problem, **LIMITS)


def rows_of(problems: dict[str, np.ndarray], as_lists: bool) -> list[dict[str, Any]]:
    count = len(problems["start"])
    return [{k: v[i].tolist() if as_lists else v[i] for k, v in problems.items()} for i in range(count)]


def clock(call: Callable[[], object]) -> float:
    begin = time.thread_time()
    call()
    return time.thread_time() - begin


def excess(values: dict[int, np.ndarray]) -> float:
    """The largest share by which a limit is exceeded."""
    kinds = ("velocity", "acceleration", "jerk")
    return max(
        float(np.abs(values[k]).max() / LIMITS[kind] - 1) for k, kind in enumerate(kinds, 1) if k in values
    )


def compare_motions(problems: dict[str, np.ndarray]) -> dict[str, float]:
    """The largest relative difference of durations, and how far each contender exceeds limits."""
    peer, worst, ours_excess, theirs_excess = RuckigContender(), 0.0, 0.0, 0.0
    batch = cs.trajectory.state_to_state(**problems, **LIMITS)
    for i, row in enumerate(rows_of(problems, True)):
        theirs = peer.solve(row)
        worst = max(worst, abs(theirs.duration / batch.durations[i] - 1))
        if i >= CHECKED:
            continue
        times, ours = np.linspace(0, theirs.duration, SAMPLES), batch[i]
        samples = [theirs.at_time(t) for t in times]
        theirs_excess = max(theirs_excess, excess({k: np.array([s[k] for s in samples]) for k in (1, 2)}))
        inner = np.linspace(0, ours.duration, SAMPLES)
        ours_excess = max(ours_excess, excess({k: ours(inner, k) for k in (1, 2, 3)}))
    return {"duration_difference": worst, "excess": ours_excess, "excess_ruckig": theirs_excess}


def measure_kind(count: int, rounds: int, moving: bool) -> dict[str, Any]:
    """Times [µs] per motion of one kind of problem."""
    problems = make_problems(count, moving)
    result: dict[str, Any] = compare_motions(problems)
    peer, arrays, lists = RuckigContender(), rows_of(problems, False), rows_of(problems, True)
    contenders: dict[str, Callable[[], object]] = {
        "ours": lambda: [solve_ours(row) for row in arrays],
        "ruckig": lambda: [peer.solve(row) for row in lists],
        "ours_batch": lambda: cs.trajectory.state_to_state(**problems, **LIMITS, threads=1),
    }
    times: dict[str, list[float]] = {name: [] for name in contenders}
    for _ in range(rounds):
        for name, call in contenders.items():
            times[name].append(1e6 * clock(call) / count)
    return result | {f"{name}_us": statistics.median(each) for name, each in times.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--problems", type=int, default=10000)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--core", type=Path, help="what bench_states of benchmarks/cpp printed")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    results: dict[str, Any] = {
        "version": cs.__version__,
        "ruckig": ruckig.__version__,
        "joints": DOF,
        "problems": given.problems,
        "rest": measure_kind(given.problems, given.rounds, False),
        "moving": measure_kind(given.problems, given.rounds, True),
    }
    if given.core is not None:
        lines = map(json.loads, given.core.read_text(encoding="utf-8").splitlines())
        results["core"] = {line["name"]: line["median"] for line in lines}
    print(json.dumps(results, indent=1))
    if given.write:
        (HERE / "results/trajectory.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
