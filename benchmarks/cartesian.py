"""Cartesian motion and the whole way from a pose to a motion: benchmarks/results/cartesian.json.

Usage: python benchmarks/cartesian.py [--write] [--repeat 5]. `move` needs the shared data folder
($CSPACE_DATA, default ../shared/data): the MotionBenchMaker problems of the Panda. Times are processor
times of all threads, from Python, and of whole paths beside that those on the clock of the wall; medians of
the rounds per problem, then the median, the 95th percentile and the largest of the problems.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # threads that wait would count as processor time

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import problems, published_robot  # noqa: E402
from cspace.cartesian import follow_cartesian, follow_redundant, move_cartesian  # noqa: E402
from cspace.trajectory import CartesianPath, line_path  # noqa: E402

LINES = 40
REDUNDANT = ("panda", "iiwa14", "xarm7", "rizon4", "sawyer", "gen3")
PROBLEMS = 8
"""Every so many of the problems of the Panda are moved."""


def draw_lines(robot: cs.Robot, count: int, reach: float) -> Iterator[CartesianPath]:
    """Lines of up to half a metre and a radian, both ends of which are reached."""
    rng = np.random.default_rng(0)
    for q in robot.random_configuration(8 * count, rng=rng, reach=reach):
        T = robot.fk(q)
        goal = T.copy()
        goal[:3, 3] += rng.uniform(-0.3, 0.3, 3)
        goal[:3, :3] = cs.spatial.exp_so3(rng.uniform(-0.5, 0.5, 3)) @ T[:3, :3]
        if robot.ik(goal):
            yield line_path(T, goal)
            count -= 1
            if not count:
                return


def time_call(
    call: Callable[[], Any], repeat: int, clock: Callable[[], float] = time.process_time
) -> tuple[float, Any]:
    """Milliseconds of the median call, and its answer."""
    times = []
    for _ in range(repeat):
        began = clock()
        answer = call()
        times.append(1e3 * (clock() - began))
    return float(np.median(times)), answer


def summarize(times: list[float]) -> dict[str, float]:
    return {
        "median": float(np.median(times)),
        "p95": float(np.percentile(times, 95)),
        "slowest": float(max(times)),
    }


def measure_lines(repeat: int) -> dict[str, Any]:
    """Lines of a UR5e: every branch followed, ranked, the best timed on its own grid."""
    robot = cs.load_robot("ur5e")
    times, arrived, branches, deviation = [], 0, 0, 0.0
    for path in draw_lines(robot, LINES, 0.7):
        ms, motion = time_call(lambda path=path: move_cartesian(robot, path, acceleration=8.0), repeat)
        branches += len(motion.branches)
        if motion:
            arrived += 1
            times.append(ms)
            deviation = max(deviation, *motion.branches[motion.chosen].deviation)
    return {
        "lines": LINES,
        "arrived": arrived,
        "branches": branches,
        "deviation": deviation,
        "ms": summarize(times),
    }


def measure_redundant(name: str, repeat: int) -> dict[str, Any]:
    """Whole paths of a redundant arm; beside that, how many paths the least motion follows."""
    robot = cs.load_robot(name)
    times, passed, planned, least = [], [], 0, 0
    for path in draw_lines(robot, LINES, 0.7):

        def call(path: CartesianPath = path) -> Any:
            return follow_redundant(robot, path)

        ms, branch = time_call(call, repeat)
        times.append(ms)
        passed.append(time_call(call, repeat, time.perf_counter)[0])
        planned += bool(branch)
        least += bool(follow_cartesian(robot, path))
    return {
        "lines": LINES,
        "planned": planned,
        "least_motion": least,
        "ms": summarize(times),
        "wall_ms": summarize(passed),
    }


def measure_moves(repeat: int) -> dict[str, Any]:
    """cs.move among the obstacles of MotionBenchMaker, with limits of velocity, acceleration and jerk."""
    robot, _ = published_robot("panda")
    own = cs.load_robot("panda").limits
    limits = {"velocity": own.velocity, "acceleration": own.acceleration, "jerk": own.jerk}
    allowed = cs.Limits(robot.limits.lower, robot.limits.upper, own.velocity, own.acceleration, own.jerk)
    times, seconds, moved, kept = [], [], 0, 0
    chosen = [problem for k, problem in enumerate(problems("panda")) if k % PROBLEMS == 0]
    for _, _, scene, start, goals in chosen:
        ms, motion = time_call(
            lambda scene=scene, start=start, goals=goals: cs.move(robot, start, goals, scene, **limits),
            repeat,
        )
        times.append(ms)
        moved += bool(motion)
        kept += bool(motion and motion.check(allowed))
        seconds.append(motion.duration)
    return {
        "problems": len(chosen),
        "moved": moved,
        "within_limits": kept,
        "duration": float(np.median(seconds)),
        "ms": summarize(times),
    }


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--repeat", type=int, default=5)
    args = parser.parse_args()
    told: dict[str, Any] = {
        "line": measure_lines(args.repeat),
        "redundant": {name: measure_redundant(name, args.repeat) for name in REDUNDANT},
        "move": measure_moves(args.repeat),
    }
    print(json.dumps(told, indent=1))
    if args.write:
        (HERE / "results/cartesian.json").write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
