"""Random serial arms built from what neighbouring axes share, so that each class holds by construction.

A class is a word of one letter per neighbouring pair of axes: X skew, P parallel, M meeting in a new point,
S meeting in the same point as the pair before.
"""

from __future__ import annotations

import numpy as np

from cspace.model import from_screws
from cspace.robot import Robot

CLASSES = {
    "wrist_skew": "XXXMS",
    "wrist_23_parallel": "XPXMS",
    "wrist_12_parallel": "PXXMS",
    "wrist_12_meet": "MXXMS",
    "wrist_23_meet": "XMXMS",
    "wrist_industrial": "MPXMS",
    "wrist_12_meet_23_meet": "MMXMS",
    "wrist_34_meet": "XPMMS",
    "wrist_34_parallel": "XXPMS",
    "shoulder_skew": "MSXXX",
    "shoulder_45_parallel": "MSXPX",
    "parallel_234_56_meet": "XPPXM",
    "parallel_234": "XPPXX",
    "parallel_234_ur": "MPPMM",
    "parallel_345_12_meet": "MXPPX",
    "parallel_345": "XXPPX",
    "parallel_123": "PPXXX",
    "parallel_456": "XXXPP",
}


def unit(v):
    return v / np.linalg.norm(v)


def random_direction(rng):
    return unit(rng.normal(size=3))


def random_rotation(rng):
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return Q * np.sign(np.linalg.det(Q))


def random_pose(rng, spread=1.0):
    T = np.eye(4)
    T[:3, :3] = random_rotation(rng)
    T[:3, 3] = rng.uniform(-spread, spread, 3)
    return T


def turned(h, rng, square):
    """A direction at a clear angle to h, at a right angle if `square`."""
    across = unit(np.cross(h, random_direction(rng)))
    angle = np.pi / 2 if square else rng.uniform(0.3, np.pi - 0.3)
    return np.cos(angle) * h + np.sin(angle) * across


def next_axis(letter, h, p, meeting, rng, square):
    """Direction and point of the axis after (h, p), and where the two meet if they do."""
    if letter == "P":
        across = unit(np.cross(h, random_direction(rng)))
        point = p + rng.uniform(0.1, 0.7) * across + rng.uniform(-0.3, 0.3) * h
        return rng.choice([-1.0, 1.0]) * h, point, None
    direction = turned(h, rng, square)
    if letter == "X":
        across = unit(np.cross(h, direction))
        return direction, p + rng.uniform(-0.5, 0.5) * h + rng.uniform(0.1, 0.7) * across, None
    if letter == "M":
        meeting = p + rng.choice([-1.0, 1.0]) * rng.uniform(0.1, 0.6) * h
    return direction, meeting, meeting


def random_screws(word, rng, square=False):
    """Axes (n, 3), points (n, 3) and T_zero (4, 4) of a random arm of the class `word`."""
    axes, points, meeting = [random_direction(rng)], [rng.uniform(-0.5, 0.5, 3)], None
    for letter in word:
        h, p, meeting = next_axis(letter, axes[-1], points[-1], meeting, rng, square)
        axes.append(h)
        points.append(p)
    axes, points = np.array(axes), np.array(points)
    T_zero = random_pose(rng, 0.3)
    T_zero[:3, 3] += points[-1]
    # The class lies in the axes, not in which of their points are named.
    slide = rng.uniform(-0.3, 0.3, len(axes))[:, None]
    return axes, points + slide * axes, T_zero


def random_arm(word, rng, *, square=False, mounted=True):
    axes, points, T_zero = random_screws(word, rng, square)
    robot = Robot(from_screws(axes, points, T_zero, name=f"random {word}"))
    if mounted:
        robot = robot.with_base(random_pose(rng)).with_tool(random_pose(rng, 0.2))
    return robot


def random_q(rng, *shape):
    return rng.uniform(-np.pi, np.pi, shape)


def angle_gap(a, b):
    """Largest difference of two configurations on the circle [rad]."""
    return np.abs((np.asarray(a) - b + np.pi) % (2 * np.pi) - np.pi).max(axis=-1)
