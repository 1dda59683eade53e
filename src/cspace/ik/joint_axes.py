"""Where the axes of an arm are at a configuration, in the base frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.tolerances import UPRIGHT_TIP


@dataclass(frozen=True, eq=False)
class Placed:
    """An arm at a configuration. axes (n, 3), points (n, 3) on them [m], tip (3,) [m]; face (3,): the side of
    axis 1, in the plane that joint 2 turns in, which the arm calls its front (zero for one joint).
    """

    axes: Array
    points: Array
    tip: Array
    face: Array


def are_parallel(h1: Array, h2: Array) -> bool:
    return bool(np.linalg.norm(np.cross(h1, h2)) <= _core.AXIS_RELATION)


def are_square(h1: Array, h2: Array) -> bool:
    return bool(abs(h1 @ h2) <= _core.AXIS_RELATION)


def place_axes(chain: Any, q: Array) -> Placed:
    """The arm at q by its product of exponentials."""
    R, t = np.eye(3), np.zeros(3)
    axes, points = np.empty((2, len(q), 3))
    face = front_at_zero(chain)
    for i, (h, p, kind, angle) in enumerate(zip(chain.axes, chain.points, chain.joint_types, q, strict=True)):
        axes[i], points[i] = R @ h, R @ p + t
        if kind == "P":
            t = t + R @ (angle * h)
            continue
        K = np.array([[0, -h[2], h[1]], [h[2], 0, -h[0]], [-h[1], h[0], 0]])
        turn = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
        t = t + R @ (p - turn @ p)
        R = R @ turn
        if i == 0:
            face = R @ face
    return Placed(axes, points, R @ chain.T_zero[:3, 3] + t, face)


def front_at_zero(chain: Any) -> Array:
    """The direction perpendicular to axes 1 and 2 in which the tip lies from axis 1 at zero; if it stands
    upright, the one in which joint 2 tilts it."""
    if len(chain.axes) < 2:
        return np.zeros(3)
    (h1, h2), p1, tip = chain.axes[:2], chain.points[0], chain.T_zero[:3, 3]
    square = np.cross(h1, h2)
    ahead, size = square @ (tip - p1), np.linalg.norm(tip - p1)
    if abs(ahead) <= UPRIGHT_TIP * size:
        ahead = square @ np.cross(h2, tip - chain.points[1])
    return np.asarray(square if ahead >= 0 else -square)


def meeting_point(h1: Array, p1: Array, h2: Array, p2: Array) -> Array:
    """The point midway between two lines where they come closest."""
    n = np.cross(h1, h2)
    gap = p2 - p1
    on_first = p1 + (np.cross(gap, h2) @ n) / (n @ n) * h1
    on_second = p2 + (np.cross(gap, h1) @ n) / (n @ n) * h2
    return np.asarray(0.5 * (on_first + on_second))
