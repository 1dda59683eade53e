"""Is every answer true? A million random and adversarial goals to all six-joint arms of the catalogue,
nominal and disturbed: benchmarks/results/soundness.json.

Usage: python benchmarks/soundness.py [--random 6000] [--each 50] [--arms NAME …] [--part I N]. A false
solution misses its goal by more than 1e-9; judged by the plain numpy forward kinematics of
benchmarks/chains.py. An exception is counted as a crash, fifty goals that take longer than ten seconds as a
hang; every arm is asked in a process of its own, and one that dies counts all its goals as crashes. Arms
that are not asked, with --arms or in the other parts, keep what the file says of them.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import numpy as np

import arms
import completeness
from chains import Arm, Array, fk, rotations
from peers import cspace_
from problems import random_configurations

RESULT = Path(__file__).resolve().parent / "results/soundness.json"
FALSE = 1e-9
"""A residual [m, unitless] above this makes a solution false."""

TOGETHER = 50
"""Goals of one call."""

HANG = 10.0
"""Seconds of processor time of such a call."""

SMALL = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
"""Steps [rad, m] away from what is special."""

Rng = np.random.Generator


def right_angles(arm: Arm, count: int, rng: Rng) -> Array:
    """Every joint at a multiple of a right angle: often singular in several ways at once."""
    return fk(arm, rng.integers(-2, 3, (count, arm.dof)) * (np.pi / 2))


def almost_right_angles(arm: Arm, count: int, rng: Rng) -> Array:
    q = rng.integers(-2, 3, (count, arm.dof)) * (np.pi / 2)
    return fk(arm, q + rng.choice(SMALL, (count, 1)) * rng.normal(size=q.shape))


def next_to_singular(arm: Arm, count: int, rng: Rng) -> Array:
    q, joints = completeness.singular_configurations(arm, count, rng)
    q[np.arange(count), joints] += rng.choice([0.0, *SMALL], count) * rng.choice([-1, 1], count)
    return fk(arm, q)


def rim_of_reach(arm: Arm, count: int, rng: Rng) -> Array:
    """Poses next to singular ones, pushed along the way from the base to the tip: just in or out of reach."""
    T = next_to_singular(arm, count, rng)
    T[:, :3, 3] *= 1 + (rng.choice(SMALL, count) * rng.choice([-1, 1], count))[:, None]
    return T


def out_of_reach(arm: Arm, count: int, rng: Rng) -> Array:
    T = fk(arm, random_configurations(arm, count, rng))
    T[:, :3, 3] *= rng.choice([2.0, 10.0, 1e3, 1e6], count)[:, None]
    return T


def turned(arm: Arm, count: int, rng: Rng) -> Array:
    """Places the arm reaches with turns that it may not: random ones, half turns, quarter turns."""
    T = fk(arm, random_configurations(arm, count, rng))
    for pose in T:
        axis = rng.normal(size=3) if rng.random() < 0.5 else np.eye(3)[rng.integers(3)]
        axis /= np.linalg.norm(axis)
        pose[:3, :3] = rotations(axis, np.asarray(rng.choice([np.pi, np.pi / 2, rng.uniform(0, np.pi)])))
    return T


def random(arm: Arm, count: int, rng: Rng) -> Array:
    return fk(arm, random_configurations(arm, count, rng))


KINDS: dict[str, Callable[[Arm, int, Rng], Array]] = {
    "random": random,
    "right angles": right_angles,
    "almost right angles": almost_right_angles,
    "next to singular": next_to_singular,
    "rim of reach": rim_of_reach,
    "out of reach": out_of_reach,
    "turned": turned,
}


def judge(arm: Arm, q: Array, T: Array) -> Array:
    """The residual of every answer of q (m, k, n), one number each."""
    goal, place = np.nonzero(~np.isnan(q[..., 0]))
    return np.abs(fk(arm, q[goal, place]) - T[goal]).max(axis=(-1, -2), initial=0.0)


def examine(arm: Arm, robot: Any, T: Array) -> dict[str, float]:
    """Counts over goals (m, 4, 4), some of them in each call."""
    counts = {"goals": len(T), "solutions": 0, "false": 0, "crashes": 0, "hangs": 0, "residual": 0.0}
    counts["seconds"] = 0.0
    for goals in np.array_split(T, -(-len(T) // TOGETHER)):
        start = time.process_time()
        try:
            q = robot.ik(goals, threads=1).q
        except Exception as error:
            print(arm.name, repr(error), flush=True)
            counts["crashes"] += len(goals)
            continue
        spent = time.process_time() - start
        off = judge(arm, q, goals)
        counts["solutions"] += len(off)
        counts["false"] += int((off > FALSE).sum())
        counts["hangs"] += int(spent > HANG)
        counts["residual"] = max(counts["residual"], float(off.max(initial=0.0)))
        counts["seconds"] = max(counts["seconds"], spent / len(goals))
    return counts


def ask(name: str, size: float, many: int, each: int) -> dict[str, Any]:
    """Every kind of goal, to an arm disturbed by this size."""
    arm = arms.load(f"{name}+{size:.0e}" if size else name)
    robot, rng = cspace_.robot(arm), arms.seeded(f"soundness {arm.name}")
    robot.ik(fk(arm, np.zeros(arm.dof)))  # the solver is built
    return {
        kind: examine(arm, robot, goals(arm, many if kind == "random" else each, rng))
        for kind, goals in KINDS.items()
    }


def lost(many: int, each: int) -> dict[str, Any]:
    """What is counted for an arm whose process died."""
    nothing = {"solutions": 0, "false": 0, "hangs": 0, "residual": 0.0, "seconds": 0.0}
    counts = {kind: many if kind == "random" else each for kind in KINDS}
    return {kind: {"goals": n, "crashes": n, **nothing} for kind, n in counts.items()}


def alone(name: str, many: int, each: int) -> dict[str, Any]:
    """An arm, nominal and disturbed, in a process of its own."""
    found: dict[str, Any] = {}
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        for size in completeness.SIZES:
            try:
                found[f"{size:g}"] = pool.submit(ask, name, size, many, each).result()
            except BrokenProcessPool:
                found[f"{size:g}"] = lost(many, each)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, default=6000)
    parser.add_argument("--each", type=int, default=50)
    parser.add_argument("--arms", nargs="*")
    parser.add_argument("--part", nargs=2, type=int, default=(0, 1), metavar=("I", "N"))
    options = parser.parse_args()
    results = json.loads(RESULT.read_text()) if RESULT.exists() else {}
    part, parts = options.part
    for name in (options.arms or completeness.six_joint_arms())[part::parts]:
        results[name] = alone(name, options.random, options.each)
        print(name, json.dumps(results[name]), flush=True)
        RESULT.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
