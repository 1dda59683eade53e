"""How long a solver takes to build: every six-joint arm of the catalogue, calibrated ones, one that is solved
through its neighbours: benchmarks/results/building.json.

Usage: python benchmarks/building.py [--robots 9]. The processor time of the first answer of a fresh robot,
less that of a second one to the same goal.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

import arms
import completeness
import run
import turns
from chains import Arm, Array, fk
from peers import cspace_
from problems import random_configurations

CALIBRATED = ["ur5e+1e-3", "puma560+1e-3", "kr6_r900+1e-4"]


def through_neighbours() -> Arm:
    """An arm with special axes, no closed form and no regular formulation."""
    x, y, z = np.eye(3)
    points = np.array(
        [[0, 0.4, 0.4], [0, 0, 0.4], [0.2, 0.2, 0.4], [0, 0, 0.2], [0.4, 0, 0.2], [0.2, 0, 0.2]]
    )
    T_zero = np.eye(4)
    T_zero[:3, 3] = [0.3, 0.2, 0.5]
    free = np.full(6, np.inf)
    return arms.numbers("neighbours", np.array([y, z, x, y, x, z]), points, T_zero, "RPRRRR", -free, free)


def spent(robot: Any, T: Array) -> float:
    """Seconds of processor time of one answer."""
    start = time.process_time()
    robot.ik(T)
    return time.process_time() - start


def build(arm: Arm, robots: int) -> dict[str, Any]:
    """Milliseconds of each of several fresh robots."""
    goals = fk(arm, random_configurations(arm, robots, arms.seeded(f"building {arm.name}")))
    times = []
    for T in goals:
        robot = cspace_.robot(arm)
        first = spent(robot, T)
        times.append(1000 * (first - spent(robot, T)))
    median, most = float(np.median(times)), float(np.max(times))
    return {"arm": arm.name, "version": cspace_.VERSION, "median": median, "max": most}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", type=int, default=9)
    options = parser.parse_args()
    busy = run.load()
    build(arms.load("ur5e"), 1)
    catalogue = [arms.load(name) for name in [*completeness.six_joint_arms(), *CALIBRATED]]
    rows = [build(arm, options.robots) for arm in [*catalogue, through_neighbours()]]
    turns.write("building", rows, busy)


if __name__ == "__main__":
    main()
