"""Slices of configuration spaces by proofs, against brute force over the same cells: time and proved share.

    python benchmarks/joint_space.py [--robots panda,ur5e,fetch] [--slices 50]

Both run in turn on the same slices, on one thread; times are processor time. Every bitmap is compared.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import cspace as cs

SIZES = (64, 256, 1024)
SCENE = cs.Scene(
    [
        cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], name="wall"),
        cs.Cylinder(0.06, 0.7, [-0.1, 0.45, 0.35], name="post"),
        cs.HalfSpace(offset=-0.1, name="floor"),
    ]
)


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and its processor time [ms]."""
    began = time.process_time()
    answer = call()
    return answer, 1e3 * (time.process_time() - began)


def measure(robot: cs.Robot, size: int, count: int) -> str:
    """A row of the table: medians over random slices."""
    space = cs.configuration_space(robot, SCENE)
    rng = np.random.default_rng(1)
    rows = []
    for _ in range(count):
        joints = [int(k) for k in rng.permutation(space.dof)[:2]]
        at = rng.uniform(space.lower, space.upper)
        part, ours = timed(lambda j=joints, q=at: space.slice(j, at=q, size=size, threads=1))
        q, rows_made = timed(part.configurations)
        brute, theirs = timed(lambda q=q: robot.collides(q, SCENE, threads=1))
        _, named = timed(lambda p=part: p.obstacle_map)
        assert np.array_equal(brute, part.bitmap)
        rows.append((ours, theirs, theirs + rows_made, named, 100 * part.proved, part.proved == 1.0))
    done = np.array(rows, dtype=float)
    ours, theirs, _, named, proved, _ = np.median(done, axis=0)
    late = np.percentile(done[:, 0], 95)
    whole = 100 * done[:, 5].mean()
    return (
        f"| {robot.name} | {size} × {size} | {ours:.1f} ({late:.1f}) | {theirs:.1f} | {named:.1f} |"
        f" {proved:.1f} % | {whole:.0f} % |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--robots", default="panda,ur5e,fetch")
    parser.add_argument("--slices", type=int, default=50)
    args = parser.parse_args()
    print(
        "| robot | cells | slice, median (p95) [ms] | brute force [ms] | names [ms] | proved | all proved |"
    )
    print("|---|---|---|---|---|---|---|")
    for name in args.robots.split(","):
        robot = cs.load_robot(name)
        for size in SIZES:
            print(measure(robot, size, args.slices), flush=True)


if __name__ == "__main__":
    main()
