"""Is every solution found? All six-joint arms of the catalogue, nominal and disturbed as calibration finds
them, on random poses and next to singularities: benchmarks/results/completeness.json.

Usage: python benchmarks/completeness.py [--poses 5000] [--near 200] [--arms NAME …]. A pose is made from a
configuration; the answer must hold that configuration, within 1e-5 or, beside a fold, within what double
precision leaves of it. All is judged by the plain numpy forward kinematics of benchmarks/chains.py.
"""

from __future__ import annotations

import argparse
import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import arms
from chains import Arm, Array, fk, jacobian
from problems import random_configurations
from score import wrap

Indices = npt.NDArray[np.int_]
RESULT = Path(__file__).resolve().parent / "results/completeness.json"
SIZES = (0.0, 1e-3, 1e-4)
DISTANCES = (1e-2, 1e-4, 1e-6)

FOUND = 1e-5
"""How near [rad or m] an answer must be to the configuration that made the pose."""

ROUNDING = 1e-13
"""Rounding of a pose [m, unitless]; over the smallest singular value of the Jacobian it is how far the
configuration is known."""

GRID = 36
"""Places on a circle where the sign of det J is looked at: ten degrees apart."""


def singular_configurations(arm: Arm, count: int, rng: np.random.Generator) -> tuple[Array, Indices]:
    """Singular configurations (count, n) and the joint of each whose turning leads into the singularity.

    Many random configurations at once; one joint of each is turned until det J changes sign, and the place
    is bisected.
    """
    found, joints = np.zeros((0, arm.dof)), np.zeros(0, dtype=int)
    candidates = np.flatnonzero(arm.turns)
    candidates = candidates[(candidates > 0) & (candidates < arm.dof - 1)]
    while len(found) < count:
        q = random_configurations(arm, count, rng)
        joint, each = rng.choice(candidates, count), np.arange(count)
        angles = np.linspace(-np.pi, np.pi, GRID)
        lines = np.repeat(q[:, None], GRID, axis=1)
        lines[each, :, joint] = angles
        dets = np.linalg.det(jacobian(arm, lines))
        flips = dets[:, :-1] * dets[:, 1:] < 0
        rows = np.flatnonzero(flips.any(axis=1))
        q, joint, each = q[rows], joint[rows], np.arange(len(rows))
        first = np.argmax(np.where(flips[rows], rng.random(flips[rows].shape), -1), axis=1)
        low, high, below = angles[first], angles[first + 1], dets[rows, first]
        for _ in range(52):
            q[each, joint] = (low + high) / 2
            same = np.linalg.det(jacobian(arm, q)) * below > 0
            low, high = np.where(same, q[each, joint], low), np.where(same, high, q[each, joint])
        found, joints = np.concatenate([found, q]), np.concatenate([joints, joint])
    return found[:count], joints[:count]


def limits(arm: Arm, q: Array) -> Array:
    """How near an answer must be to each configuration (m, n), shape (m,)."""
    weakest = np.linalg.svd(jacobian(arm, q), compute_uv=False)[:, -1]
    return np.maximum(FOUND, ROUNDING / np.maximum(weakest, 1e-300))


def gaps(arm: Arm, q: Array, answers: Array) -> Array:
    """Distance [rad or m] of each configuration (m, n) to the nearest of its answers (m, k, n), inf for
    none."""
    gap = answers - q[:, None]
    gap = np.abs(np.where(arm.turns, wrap(gap), gap)).max(axis=-1, initial=0.0)
    return np.where(np.isnan(gap), np.inf, gap).min(axis=1, initial=np.inf)


def residual(arm: Arm, answers: Array, T: Array) -> float:
    """The largest difference of the poses of the answers (m, k, n) from the goals (m, 4, 4)."""
    pose, place = np.nonzero(~np.isnan(answers[..., 0]))
    worst = 0.0
    for part in np.array_split(np.arange(len(pose)), 1 + len(pose) // 20_000):
        if len(part):
            reached = fk(arm, answers[pose[part], place[part]])
            worst = max(worst, float(np.abs(reached - T[pose[part]]).max()))
    return worst


def examine(arm: Arm, robot: Any, q: Array) -> dict[str, float]:
    """Counts over the poses of the configurations (m, n)."""
    T = fk(arm, q)
    answer = robot.ik(T, threads=1)
    far = gaps(arm, q, answer.q)
    missed = far > FOUND
    suspects = np.flatnonzero(missed)
    if len(suspects):
        missed[suspects] = far[suspects] > limits(arm, q[suspects])
    return {
        "poses": len(q),
        "missed": int(missed.sum()),
        "false": int((missed & answer.complete).sum()),
        "withheld": int((~answer.complete).sum()),
        "residual": residual(arm, answer.q, T),
    }


def run(name: str, size: float, poses: int, near: int) -> dict[str, Any]:
    """An arm of the catalogue, disturbed by this size, on random poses and at each distance."""
    import cspace as cs

    arm = arms.load(f"{name}+{size:.0e}" if size else name)
    robot = cs.Robot(cs.model.from_screws(arm.axes, arm.points, arm.T_zero, joint_types=arm.joint_types))
    rng = np.random.default_rng([2026, zlib.crc32(arm.name.encode())])
    found: dict[str, Any] = {"random": examine(arm, robot, random_configurations(arm, poses, rng))}
    singular, joints = singular_configurations(arm, near, rng)
    for distance in DISTANCES:
        q = singular.copy()
        q[np.arange(near), joints] += distance * rng.choice([-1, 1], near)
        found[f"{distance:.0e}"] = examine(arm, robot, q)
    return found


def six_joint_arms() -> list[str]:
    import cspace as cs

    return [name for name in cs.robots.names() if cs.load_robot(name).dof == 6 and is_chain(name)]


def is_chain(name: str) -> bool:
    import cspace as cs

    try:
        return len(cs.load_robot(name).chain.joint_types) == 6
    except cs.errors.CspaceError:
        return False


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=5000)
    parser.add_argument("--near", type=int, default=200)
    parser.add_argument("--arms", nargs="*")
    options = parser.parse_args()
    results: dict[str, Any] = {}
    for name in options.arms or six_joint_arms():
        results[name] = {f"{size:g}": run(name, size, options.poses, options.near) for size in SIZES}
        print(name, json.dumps(results[name]), flush=True)
    RESULT.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
