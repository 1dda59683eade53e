"""Arms made from their screws, so that pictures are tested without the catalogue."""

from __future__ import annotations

import numpy as np

from cspace.model import from_screws
from cspace.robot import Robot

Z = [0.0, 0.0, 1.0]
Y = [0.0, 1.0, 0.0]


def at(x: float, y: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def elbow_arm() -> Robot:
    """Six joints with a spherical wrist."""
    axes = [Z, Y, Y, [1.0, 0.0, 0.0], Y, [1.0, 0.0, 0.0]]
    points = [[0, 0, 0.2], [0, 0, 0.4], [0, 0, 0.8], [0.4, 0, 0.8], [0.4, 0, 0.8], [0.4, 0, 0.8]]
    return Robot(from_screws(axes, points, at(0.5, 0, 0.8), name="elbow"))


def planar_arm(lengths: tuple[float, ...] = (0.5, 0.4)) -> Robot:
    """Turning joints about z in the xy plane."""
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    points = [[x, 0.0, 0.0] for x in ends[:-1]]
    return Robot(from_screws([Z] * len(lengths), points, at(ends[-1], 0, 0), name="planar"))


def scara() -> Robot:
    """Two turns and a slide."""
    return Robot(
        from_screws(
            [Z, Z, [0, 0, -1.0], Z],
            [[0, 0, 0.3], [0.3, 0, 0.3], [0.5, 0, 0.3], [0.5, 0, 0.3]],
            at(0.5, 0, 0.2),
            joint_types="RRPR",
            lower=[-2, -2, 0, -3],
            upper=[2, 2, 0.15, 3],
            name="scara",
        )
    )
