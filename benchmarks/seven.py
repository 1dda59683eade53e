"""Seven joints: samples of a locked joint, swivels, the nearest configuration, feasible intervals.

Usage: python benchmarks/seven.py [--rounds 5] [--seconds 0.3]. Writes benchmarks/results/seven.json. Goals
are the poses of random configurations within the limits; answers are judged by the plain numpy forward
kinematics of benchmarks/chains.py.
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
from score import wrap
from turns import Question

GOALS, VALUES, FEW = 1000, 1000, 200
JUDGED = 20
"""Calls whose answers are judged."""

SEEDS = {"0.05 rad away": 0.05, "random": None}
"""How far each joint of a seed is from the configuration that made the goal."""


def misses(arm: Arm, q: Array, T: Array) -> float:
    """The largest difference of the poses of the answers (..., k, n) from the goals (..., 4, 4), of what is
    not NaN."""
    gaps = np.abs(fk(arm, q) - T[..., None, :, :])
    return float(np.nanmax(gaps, initial=0.0))


def listing(arm: Arm, what: str, step: Callable[[Array], Any], inputs: list[Array], items: int) -> Question:
    """A question answered with all branches of each item; step: goals → a batch of solutions."""
    answers, worst = 0, 0.0
    for T in inputs[:JUDGED]:
        q = step(T).q
        answers += int(np.isfinite(q[..., 0]).sum())
        worst = max(worst, misses(arm, q, T))
    judged = {"answers": answers / (items * len(inputs[:JUDGED])), "residual": worst}
    return Question(arm.name, what, "cspace_", cspace_.VERSION, step, inputs, items, judged)


def samples(arm: Arm, robot: Any, q: Array, T: Array) -> list[Question]:
    """A joint locked at many values for one goal, and at one value for each of many goals."""
    found = []
    for joint in (2, 6):
        values = np.linspace(arm.lower[joint], arm.upper[joint], VALUES)

        def sweep(goal: Array, joint: int = joint, values: Array = values) -> Any:
            return robot.ik(goal, locked={joint: values}, threads=1)

        def each(goals: Array, joint: int = joint) -> Any:
            return robot.ik(goals, locked={joint: q[:, joint]}, threads=1)

        name = f"joint {joint + 1} locked"
        found.append(listing(arm, f"{name}: {VALUES} values for a goal", sweep, list(T), VALUES))
        found.append(listing(arm, f"{name}: a value for each goal", each, [T], len(T)))
    return found


def swivels(arm: Arm, robot: Any, q: Array, T: Array) -> list[Question]:
    """The same for the swivel of the elbow."""
    from cspace.ik import swivel

    angles, own = np.linspace(-np.pi, np.pi, VALUES), swivel(robot, q)
    return [
        listing(
            arm, f"swivel: {VALUES} values for a goal", lambda T: robot.ik(T, swivel=angles), list(T), VALUES
        ),
        listing(arm, "swivel: a value for each goal", lambda T: robot.ik(T, swivel=own), [T], len(T)),
    ]


def seeds_of(arm: Arm, q: Array, away: float | None, rng: np.random.Generator) -> Array:
    return within_limits(arm, len(q), rng) if away is None else q + away * rng.choice([-1, 1], q.shape)


def nearness(arm: Arm, answers: Array, q: Array, seeds: Array, T: Array) -> dict[str, float]:
    """The share of goals whose answer is as near to the seed as the configuration that made the goal, and
    the worst residual."""
    way, known = (np.linalg.norm(wrap(rows - seeds), axis=-1) for rows in (answers, q))
    return {"near": float((way <= known + 1e-9).mean()), "residual": misses(arm, answers[:, None], T)}


def nearest(arm: Arm, robot: Any, q: Array, T: Array, rng: np.random.Generator) -> list[Question]:
    found = []
    for name, away in SEEDS.items():
        seeds = seeds_of(arm, q, away, rng)
        few = slice(None, FEW)
        batch = robot.ik(T[few], near=seeds[few], threads=1).q[:, 0]
        judged = nearness(arm, batch, q[few], seeds[few], T[few])
        rows = list(zip(T, seeds, strict=True))
        one = Question(
            arm.name,
            f"nearest to a seed {name}",
            "cspace_",
            cspace_.VERSION,
            lambda x: robot.ik(x[0], near=x[1]),
            rows,
            judged=judged,
        )
        many = Question(
            arm.name,
            f"nearest to a seed {name}, batch",
            "cspace_",
            cspace_.VERSION,
            lambda x: robot.ik(x[0], near=x[1], threads=1),
            [(T[few], seeds[few])],
            FEW,
            judged,
        )
        found += [one, many]
        found += peer_nearest(arm, name, q, seeds, T)
    return found


def peer_nearest(arm: Arm, name: str, q: Array, seeds: Array, T: Array) -> list[Question]:
    """What ssik answers first when it is given the seed."""
    if not importlib.util.find_spec("ssik"):
        return []
    from peers import ssik_

    solve, prepare = ssik_.nearest(arm)
    rows = [(prepare(goal), seed) for goal, seed in zip(T, seeds, strict=True)]
    answers = np.array([solve(row) for row in rows[:FEW]])
    judged = nearness(arm, answers, q[:FEW], seeds[:FEW], T[:FEW])
    version = importlib.metadata.version("ssik")
    return [Question(arm.name, f"nearest to a seed {name}", "ssik_", version, solve, rows, 1, judged)]


def intervals(arm: Arm, robot: Any, q: Array, T: Array) -> Question:
    """Feasible intervals of joint 7 for each goal; right where one of them holds the value that made it."""
    complete = holds = 0
    for goal, own in zip(T[:FEW], q[:FEW, 6], strict=True):
        found = robot.redundancy(goal, 6)
        complete += bool(found.complete)
        holds += any(i.lower - 1e-9 <= own <= i.upper + 1e-9 for i in found.intervals)
    judged = {"complete": complete / FEW, "holds": holds / FEW}
    return Question(
        arm.name,
        "feasible intervals of joint 7",
        "cspace_",
        cspace_.VERSION,
        lambda goal: robot.redundancy(goal, 6),
        list(T),
        1,
        judged,
    )


def questions(name: str) -> list[Question]:
    arm = arms.load(name)
    robot = cspace_.robot(arm)
    rng = arms.seeded(f"seven {name}")
    q = within_limits(arm, GOALS, rng)
    T = fk(arm, q)
    found = samples(arm, robot, q, T)
    if name == "iiwa14":
        found += swivels(arm, robot, q, T)
    return [*found, *nearest(arm, robot, q, T, rng), intervals(arm, robot, q, T)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=0.3)
    options = parser.parse_args()
    busy = run.load()
    asked = [question for name in arms.SEVEN for question in questions(name)]
    turns.write("seven", turns.measure(asked, options.rounds, options.seconds), busy)


if __name__ == "__main__":
    main()
