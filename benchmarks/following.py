"""Paths and descents: every branch along a path, and one configuration from a start.

Usage: python benchmarks/following.py [--rounds 5] [--seconds 0.3]. Writes benchmarks/results/following.json.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

import arms
import run
import turns
from chains import Arm, Array, fk
from peers import cspace_
from problems import within_limits
from score import VERIFIED, wrap
from turns import Question

POSES, BRANCHES, GOALS = 1000, 8, 500
FIRST, LAST = np.array([0.3, -1.2, 1.3, -0.9, -1.1, 0.4]), np.array([0.6, -0.95, 1.0, -0.7, -0.8, 0.2])
"""The ends of a line in the joints of a UR5e; its poses are the path."""

STARTS = {"0.05 rad away": 0.05, "0.5 rad away": 0.5, "random": None}
"""How far each joint of a start is from the configuration that made the goal."""


def straightness(arm: Arm, branches: list[Array], T: Array, line: Array) -> dict[str, float]:
    """How many branches reach the last pose, the worst residual, and how far [rad] the nearest of them is
    from the line that made the path."""
    whole = [q for q in branches if len(q) == len(T)]
    worst = max((float(np.abs(fk(arm, q) - T).max()) for q in whole), default=np.inf)
    away = min((float(np.abs(wrap(q - line)).max()) for q in whole), default=np.inf)
    return {"branches": len(whole), "residual": worst, "away": away}


def paths() -> list[Question]:
    """A path of a UR5e that all branches follow."""
    arm = arms.load("ur5e")
    line = FIRST + np.linspace(0, 1, POSES)[:, None] * (LAST - FIRST)
    T, what = fk(arm, line), f"{POSES} poses, {BRANCHES} branches"
    robot = cspace_.robot(arm)
    judged = straightness(arm, [branch.q for branch in robot.track(T).branches], T, line)
    items = POSES * BRANCHES
    found = [Question(arm.name, what, "cspace_", cspace_.VERSION, robot.track, [T], items, judged)]
    if importlib.util.find_spec("ssik"):
        from peers import ssik_

        follow, prepare = ssik_.path(arm)
        goals = prepare(T)
        judged = straightness(arm, list(ssik_.tracks(follow(goals))), T, line)
        version = importlib.metadata.version("ssik")
        found.append(Question(arm.name, what, "ssik_", version, follow, [goals], items, judged))
    return found


def arrivals(arm: Arm, step: Callable[[Any], Array], inputs: list[Any], T: Array) -> dict[str, float]:
    """The share of goals reached and the worst residual of those."""
    gaps = np.abs(fk(arm, np.concatenate([np.atleast_2d(step(x)) for x in inputs])) - T).max(axis=(-1, -2))
    there = gaps <= VERIFIED  # false for NaN
    return {"reached": float(there.mean()), "residual": float(gaps[there].max(initial=0.0))}


def descents(name: str) -> list[Question]:
    """From a start to a goal, limits aside, one descent each and no other start."""
    arm = arms.load(name)
    rng = arms.seeded(f"following {name}")
    q = within_limits(arm, GOALS, rng)
    T = fk(arm, q)
    robot = cspace_.robot(arm)
    found = []
    for word, away in STARTS.items():
        starts = within_limits(arm, GOALS, rng) if away is None else q + away * rng.choice([-1, 1], q.shape)
        what = f"descent from a start {word}"

        def ours(goal: tuple[Array, Array]) -> Array:
            return robot.ik_numeric(goal[0], goal[1], limits=False, starts=1).q

        def batch(goals: tuple[Array, Array]) -> Array:
            return robot.ik_numeric(goals[0], goals[1], limits=False, starts=1, threads=1).q

        rows = list(zip(T, starts, strict=True))
        judged = arrivals(arm, ours, rows, T)
        found.append(Question(name, what, "cspace_", cspace_.VERSION, ours, rows, judged=judged))
        whole, judged = [(T, starts)], arrivals(arm, batch, [(T, starts)], T)
        label = f"{what}, batch"
        found.append(Question(name, label, "cspace_", cspace_.VERSION, batch, whole, GOALS, judged))
        if importlib.util.find_spec("pinocchio"):
            found.append(peer_descent(arm, what, T, starts))
    return found


def peer_descent(arm: Arm, what: str, T: Array, starts: Array) -> Question:
    from peers import pinocchio_

    step, prepare = pinocchio_.descent(arm)
    inputs = [(prepare(goal), start) for goal, start in zip(T, starts, strict=True)]
    version = importlib.metadata.version("pin")
    judged = arrivals(arm, step, inputs, T)
    return Question(arm.name, what, "pinocchio_", version, step, inputs, judged=judged)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=0.3)
    options = parser.parse_args()
    busy = run.load()
    asked = [*paths(), *descents("ur5e"), *descents("panda")]
    turns.write("following", turns.measure(asked, options.rounds, options.seconds), busy)


if __name__ == "__main__":
    main()
