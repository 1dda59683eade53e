"""Names for the branches of a closed form, read off the configurations themselves.

shoulder: seen from axis 1 towards the wrist, the arm's plane passes on the right or left of axis 1; an arm
whose plane contains axis 1 faces its goal (front) or has turned away and reaches over its back (back).
elbow: joint 3 lies above or below the line from shoulder to wrist, up being the direction of axis 1. wrist:
the sign of the middle wrist joint; flip where the second of the two wrist solutions is used.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array

__all__ = ["branch_labels"]

SPHERICAL_WRIST, THREE_PARALLEL = 1, 2
LAST_PARALLEL = 0
NOISE = 1e-9


def branch_labels(robot: Any, q: Array, numbers: tuple[int, ...]) -> tuple[str, ...]:
    """One label per configuration of q (k, dof), from the branches `numbers` of the closed form."""
    seen = _core._ik_geometry(robot)
    if seen is None or any(n < 0 for n in numbers):
        return ("",) * len(numbers)
    named = (
        not seen["reversed"]
        and seen["virtual_joints"] == 0
        and (
            seen["family"] == THREE_PARALLEL
            or (seen["family"] == SPHERICAL_WRIST and seen["first_three"] == LAST_PARALLEL)
        )
    )
    if not named:
        return tuple(f"branch {n + 1}" for n in numbers)
    # The wrist is where axis 5 meets its neighbours: axis 4 in a spherical wrist, axis 6 beside parallel
    # axes.
    other = 3 if seen["family"] == SPHERICAL_WRIST else 5
    wrist_bit = 0 if seen["family"] == SPHERICAL_WRIST else 1
    return tuple(
        f"shoulder {shoulder_word(points, n)}, elbow {elbow_word(points)}, wrist {wrist_word(n, wrist_bit)}"
        for points, n in ((arm_points(robot, row, other), n) for row, n in zip(q, numbers, strict=True))
    )


def arm_points(robot: Any, q: Array, other: int) -> dict[str, Array]:
    """Axis 1, axis 2 and points on axes 2 and 3 and at the wrist, of one configuration, in the base frame."""
    chain = robot.chain
    axes, points = moved_axes(chain.axes, chain.points, q)
    wrist = meeting_point(axes[4], points[4], axes[other], points[other])
    elbow_end = wrist if other == 3 else points[3]
    return {
        "h1": axes[0],
        "p1": points[0],
        "h2": axes[1],
        "shoulder": points[1],
        "elbow": points[2],
        "forearm end": elbow_end,
        "wrist": wrist,
    }


def moved_axes(axes: Array, points: Array, q: Array) -> tuple[Array, Array]:
    """Where the axes and points on them are at q, for revolute joints (product of exponentials)."""
    R, t = np.eye(3), np.zeros(3)
    moved = []
    for h, p, angle in zip(axes, points, q, strict=True):
        moved.append((R @ h, R @ p + t))
        K = np.array([[0, -h[2], h[1]], [h[2], 0, -h[0]], [-h[1], h[0], 0]])
        turn = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
        t = t + R @ (p - turn @ p)
        R = R @ turn
    return np.array([h for h, _ in moved]), np.array([p for _, p in moved])


def meeting_point(h1: Array, p1: Array, h2: Array, p2: Array) -> Array:
    """The point midway between two lines where they come closest."""
    n = np.cross(h1, h2)
    gap = p2 - p1
    on_first = p1 + (np.cross(gap, h2) @ n) / (n @ n) * h1
    on_second = p2 + (np.cross(gap, h1) @ n) / (n @ n) * h2
    return np.asarray(0.5 * (on_first + on_second))


def shoulder_word(at: dict[str, Array], number: int) -> str:
    to_wrist = at["wrist"] - at["p1"]
    forward = to_wrist - (to_wrist @ at["h1"]) * at["h1"]
    aside = (to_wrist @ at["h2"]) * at["h2"]
    side = np.cross(at["h1"], forward) @ aside
    if abs(side) <= NOISE:
        return "front" if number >= 4 else "back"
    return "left" if side > 0 else "right"


def elbow_word(at: dict[str, Array]) -> str:
    def in_plane(v: Array) -> Array:
        return np.asarray(v - (v @ at["h2"]) * at["h2"])

    line, upper = in_plane(at["forearm end"] - at["shoulder"]), in_plane(at["elbow"] - at["shoulder"])
    length2 = line @ line
    offset = upper - (upper @ line) / length2 * line if length2 > NOISE**2 else upper
    height = offset @ at["h1"]
    if np.linalg.norm(offset) <= 1e-6 * np.linalg.norm(upper):
        return "straight"
    return "up" if height > 0 else "down"


def wrist_word(number: int, bit: int) -> str:
    return "flip" if (number >> bit) & 1 else "no flip"
