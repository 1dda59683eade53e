"""Where the axes of an arm are at a configuration, in the base frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.ik.conditions import common_point
from cspace.model import Chain
from cspace.spatial import exp_so3
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


def place_axes(chain: Chain, q: Array) -> Placed:
    """The arm at q by its product of exponentials."""
    R, t = np.eye(3), np.zeros(3)
    axes, points = np.empty((2, len(q), 3))
    face = front_at_zero(chain)
    turns = exp_so3(chain.axes * q[:, None])
    for i, (h, p, kind) in enumerate(zip(chain.axes, chain.points, chain.joint_types, strict=True)):
        axes[i], points[i] = R @ h, R @ p + t
        if kind == "P":
            t = t + R @ (q[i] * h)
            continue
        t = t + R @ (p - turns[i] @ p)
        R = R @ turns[i]
        if i == 0:
            face = R @ face
    return Placed(axes, points, R @ chain.T_zero[:3, 3] + t, face)


def front_at_zero(chain: Chain) -> Array:
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


def meeting_point(at: Placed, i: int, j: int) -> Array:
    """The point midway between two axes where they come closest."""
    return common_point(at.axes[[i, j]], at.points[[i, j]])[0]
