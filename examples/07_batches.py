"""Batches: leading axes on every function, thousands of poses in one call."""

from __future__ import annotations

import time

import numpy as np

import cspace as cs
from cspace.ik import SolutionsBatch


def main() -> None:
    robot = cs.load_robot("ur5e")
    q = robot.random_configuration(20_000, rng=7)

    start = time.perf_counter()
    T = robot.fk(q)
    J = robot.jacobian(q)
    print(f"fk {T.shape}, jacobian {J.shape}: {1e3 * (time.perf_counter() - start):.1f} ms")

    start = time.perf_counter()
    answer = robot.ik(T)
    assert isinstance(answer, SolutionsBatch)  # many goals; type checkers do not know how many axes T has
    print(f"ik, every solution {answer.q.shape}: {1e3 * (time.perf_counter() - start):.1f} ms")

    # Rows are padded with NaN behind the last solution; `count` says how many there are.
    counts, how_often = np.unique(answer.count, return_counts=True)
    for count, times in zip(counts, how_often, strict=True):
        print(f"{times:6} poses with {count} solutions")

    found = answer.q[np.arange(answer.q.shape[1]) < answer.count[:, None]]
    goals = np.repeat(T, answer.count, axis=0)
    print("worst error of the forward kinematics:", np.abs(robot.fk(found) - goals).max())
    assert answer.reachable.all()


if __name__ == "__main__":
    main()
