"""Arms that turn with up to three joints and slide with the others: the turns first, then linear equations.

Turns about different directions make the orientation alone. Three turns about parallel axes with slides along
them (SCARA) place the last of these axes in the plane across; the orientation is what is left for it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array, Solutions, admit, answer, inverse, joint_motion, rotation

__all__ = ["solve_turns_first"]

FLAT = 1e-9  # levers below this fix nothing


def angle_about(h: Array, a: Array, b: Array, idle: float) -> float:
    """The angle about h from a to b, both seen along h; idle where there is nothing to see."""
    if np.linalg.norm(np.cross(h, a)) < FLAT:
        return idle
    return float(np.arctan2(h @ np.cross(a, b), a @ b - (h @ a) * (h @ b)))


def angles_with(a: float, b: float, r: float) -> list[float]:
    """Both t with a cos t + b sin t = r, rounding beyond the ends cut off."""
    size = float(np.hypot(a, b))
    if size < FLAT or abs(r) > (1 + 1e-6) * size:
        return []
    middle, away = np.arctan2(b, a), np.arccos(np.clip(r / size, -1, 1))
    return [float(middle + away), float(middle - away)]


def turns_of_orientation(h: Array, R: Array, idle: Array) -> list[list[float]]:
    """Angles about the directions h (k, 3), k up to 3, that make R together."""
    found: list[list[float]] = [[]]
    if len(h) == 3:
        along = (h[1] @ h[2]) * h[1]
        lean, square = h[0] @ (h[2] - along), h[0] @ np.cross(h[1], h[2])
        found = []
        for t in angles_with(lean, square, float(h[0] @ R @ h[2] - h[0] @ along)):
            found.append([angle_about(h[0], rotation(h[1], t) @ h[2], R @ h[2], float(idle[0])), t])
    elif len(h) == 2:
        found = [[angle_about(h[0], h[1], R @ h[1], float(idle[0]))]]
    for angles in found if len(h) else []:
        rest = R
        for axis, t in zip(h[:-1], angles, strict=True):
            rest = rotation(axis, -t) @ rest
        across = np.cross(h[-1], np.eye(3)[int(np.argmin(np.abs(h[-1])))])
        angles.append(angle_about(h[-1], across, rest @ across, 0.0))
    return found


def turns_in_plane(arm: dict[str, Any], turning: list[int], G: Array, idle: Array) -> list[list[float]]:
    """Angles of three parallel joints: two bring the axis of the third to its place, both elbows."""
    h = arm["axes"][turning]
    p = [point - (point @ h[0]) * h[0] for point in arm["points"][turning]]
    there = G[:3, :3] @ arm["points"][turning[2]] + G[:3, 3]
    there = there - (there @ h[0]) * h[0] - p[0]
    upper, fore = p[1] - p[0], p[2] - p[1]
    found = []
    for t in angles_with(
        2 * float(upper @ fore),
        2 * float(upper @ np.cross(h[1], fore)),
        float(there @ there - upper @ upper - fore @ fore),
    ):
        first = angle_about(h[0], upper + rotation(h[1], t) @ fore, there, float(idle[turning[0]]))
        rest = rotation(h[1], -t) @ rotation(h[0], -first) @ G[:3, :3]
        across = np.cross(h[2], np.eye(3)[int(np.argmin(np.abs(h[2])))])
        found.append([first, t, angle_about(h[2], across, rest @ across, 0.0)])
    return found


def solve_turns_first(arm: dict[str, Any], T: Array, idle: Array) -> Solutions:
    """Every configuration; joints that nothing fixes at their idle values."""
    turning, slides = np.flatnonzero(~arm["slides"]).tolist(), np.flatnonzero(arm["slides"])
    G, h = T @ inverse(arm["T_zero"]), arm["axes"][turning]
    if len(turning) == 3 and np.linalg.norm(np.cross(h[0], h[1])) < 1e-6:
        choices = turns_in_plane(arm, turning, G, idle)
    else:
        choices = turns_of_orientation(h, G[:3, :3], idle[turning])
    found: list[Array] = []
    for angles in choices:
        q, directions, at = idle.copy(), [], np.eye(4)
        q[turning] = angles
        for i, value in enumerate(q):
            directions.append(at[:3, :3] @ arm["axes"][i])
            at = at @ joint_motion(arm, i, value)
        D = np.array(directions)[slides].T
        q[slides] += np.linalg.lstsq(D, T[:3, 3] - (at @ arm["T_zero"])[:3, 3], rcond=None)[0]
        admit(arm, T, found, q)
    return answer(arm, T, found)
