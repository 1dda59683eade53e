"""A platform that moves freely in space, by three prismatic and three revolute joints."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.model import Inertial, Joint, Link

PLATFORM: Final = ("x", "y", "z", "rx", "ry", "rz")
"""The coordinates of a platform: its position, and rotations about its own axes x, then y, then z."""


def make_platform(body: Inertial) -> tuple[list[Link], list[Joint]]:
    """The links from "base" to "platform", of which only the last has a mass, and the joints PLATFORM."""
    names = ["base", *(f"platform_{name}" for name in PLATFORM[:-1]), "platform"]
    links = [Link(name) for name in names[1:-1]]
    links.append(Link("platform", body))
    joints = [
        Joint(name, "prismatic" if i < 3 else "continuous", names[i], names[i + 1], axis=np.eye(3)[i % 3])
        for i, name in enumerate(PLATFORM)
    ]
    return links, joints


def find_platform_angles(R: Array) -> Array:
    """The angles (3,) rx, ry, rz of R = Rx Ry Rz (3, 3), with ry in [−π/2, π/2]."""
    ry = np.arctan2(R[0, 2], np.hypot(R[0, 0], R[0, 1]))
    if np.hypot(R[0, 0], R[0, 1]) <= np.finfo(float).eps:
        return np.array([np.arctan2(R[2, 1], R[1, 1]), ry, 0.0])
    return np.array([np.arctan2(-R[1, 2], R[2, 2]), ry, np.arctan2(-R[0, 1], R[0, 0])])
