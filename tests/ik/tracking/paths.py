"""Paths of poses, and a slow oracle: the solutions of a fine path matched from pose to pose."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.spatial import interpolate_decoupled

TURN = 2 * np.pi
LOST = 0.05
"""A joint that has to move this much [rad, m] between poses of a fine path has changed its branch."""


def straight(T0: Any, T1: Any, n: int) -> Any:
    """n poses from T0 to T1, as tracking moves between two."""
    return interpolate_decoupled(T0, T1, np.linspace(0, 1, n))


def random_path(robot: Any, rng: Any, n: int, size: float = 0.5) -> Any:
    """n poses between those of two configurations not far from each other."""
    limits = np.clip([robot.limits.lower, robot.limits.upper], -np.pi, np.pi)
    q = rng.uniform(*limits)
    return straight(robot.fk(q), robot.fk(q + size * rng.normal(size=q.size)), n)


def matched(robot: Any, path: Any, start: Any) -> Any:
    """The configurations along a fine path, each the solution nearest to where the last two point.

    Ends where none is near: on a branch too, if the path begins so close to a fold that the joints race.
    """
    found = robot.ik(path)
    turns = np.array([TURN * (kind == "R") for kind in robot.joint_types])
    q = [start]
    for k in range(1, len(path)):
        guess = q[-1] if k == 1 else 2 * q[-1] - q[-2]
        away = found.q[k, : found.count[k]] - guess
        away -= turns * np.round(away / TURN)
        if not len(away) or np.abs(away).max(axis=1).min() > LOST:
            break
        q.append(guess + away[np.abs(away).max(axis=1).argmin()])
    return np.array(q)
