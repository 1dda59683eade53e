"""The seeded problems: random configurations of an arm, its poses there, and poses next to singularities."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from chains import Arm, Array, fk, jacobian

SINGULAR_DISTANCES = (1e-4, 1e-6)


@dataclass(frozen=True)
class Problems:
    """q (m, n) and its poses T (m, 4, 4); near[d] the same at a distance d [rad] from a singular one."""

    q: Array
    T: Array
    q_near_4: Array
    T_near_4: Array
    q_near_6: Array
    T_near_6: Array

    def save(self, path: Path) -> None:
        np.savez(path, **self.__dict__)

    @staticmethod
    def load(path: Path) -> Problems:
        with np.load(path) as data:
            return Problems(**{key: data[key] for key in data.files})


def random_configurations(arm: Arm, count: int, rng: np.random.Generator) -> Array:
    """Uniform angles (count, n) in (−π, π], whatever the limits: the peers filter by limits or they do
    not. Slides are at 0 to 1 m."""
    q = rng.uniform(-np.pi, np.pi, (count, arm.dof))
    return np.where(arm.turns, q, (q + np.pi) / (2 * np.pi))


def within_limits(arm: Arm, count: int, rng: np.random.Generator) -> Array:
    """Uniform configurations (count, n) within the limits of the arm."""
    return rng.uniform(arm.lower, arm.upper, (count, arm.dof))


def singular_configurations(arm: Arm, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Singular configurations (count, n) and the joint of each that leads into the singularity.

    A joint of a random configuration is turned until det J changes sign; the root is refined by bisection.
    Arms whose Jacobian is not square have none here.
    """
    if arm.dof != 6:
        return np.zeros((0, arm.dof)), np.zeros(0, dtype=int)
    found, joints = [], []
    while len(found) < count:
        q = random_configurations(arm, 1, rng)[0]
        joint = int(rng.integers(1, arm.dof - 1))
        if not arm.turns[joint]:
            continue
        grid = np.linspace(-np.pi, np.pi, 181)
        line = np.repeat(q[None], len(grid), axis=0)
        line[:, joint] = grid
        dets = np.linalg.det(jacobian(arm, line))
        flips = np.flatnonzero(dets[:-1] * dets[1:] < 0)
        if len(flips) == 0:
            continue
        k = int(rng.choice(flips))
        low, high, sign = grid[k], grid[k + 1], np.sign(dets[k])
        for _ in range(60):
            q[joint] = (low + high) / 2
            low, high = (
                (q[joint], high) if np.sign(np.linalg.det(jacobian(arm, q))) == sign else (low, q[joint])
            )
        found.append(q.copy())
        joints.append(joint)
    return np.array(found), np.array(joints)


def make(arm: Arm, count: int, near_count: int, seed: int = 2026) -> Problems:
    """The problems of an arm; the seed and the name of the arm fix them."""
    rng = np.random.default_rng([seed, zlib.crc32(arm.name.encode())])
    q = random_configurations(arm, count, rng)
    singular, joints = singular_configurations(arm, near_count, rng)
    near = []
    for distance in SINGULAR_DISTANCES:
        moved = singular.copy()
        moved[np.arange(len(joints)), joints] += distance * rng.choice([-1, 1], len(joints))
        near.append(moved)
    return Problems(q, fk(arm, q), near[0], fk(arm, near[0]), near[1], fk(arm, near[1]))
