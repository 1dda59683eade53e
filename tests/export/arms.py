"""Arms of every kind that an export has to know: of the catalogue, and made for their geometry."""

from __future__ import annotations

import os

import numpy as np

import cspace as cs
from cspace.model import from_screws
from cspace.robot import Robot
from ik.geometries import CLASSES, random_arm, random_screws

# One per family and case: closed forms with and without lanes, read from the tip, idealised, completed by
# virtual joints; the general solver; up to three joints, sliding ones among them.
KINDS = [
    *("ur5e", "yam", "irb120", "kr6_r900", "puma560_urdf", "romeo_left_leg", "al5d", "so101"),
    *("crx10ia", "gen3_lite", "calibrated", "planar_1r", "planar_2r", "simplified_puma", "rpr"),
    *("scara", "stanford", "RRPRRR", "PRRPRR", "PPPRRR", "RRPRP", "neighbours"),
    *("PRRR", "gantry", "rail"),
    *("wrist_12_meet", "wrist_23_meet", "wrist_12_parallel", "wrist_skew", "parallel_234", "parallel_123"),
]

ASKED = KINDS if os.environ.get("CSPACE_EVERY_EXPORT") else ["irb120", "stanford", "rpr", "PRRR", "rail"]
"""The kinds that the tests compile and ask: to compile them all takes a quarter of an hour."""


def arm(name: str) -> Robot:
    """A named arm: of KINDS, or of the catalogue; a word of R and P is an arm in general position."""
    rng = np.random.default_rng(list(map(ord, name)))
    if name in CLASSES:
        return random_arm(CLASSES[name], rng)
    if set(name) <= set("RP"):
        axes, points, T_zero = random_screws("X" * (len(name) - 1), rng)
        return Robot(from_screws(axes, points, T_zero, joint_types=name, name=f"Arm {name}"))
    made = {
        "calibrated": calibrated,
        "neighbours": parallel_and_square,
        "coaxial": coaxial,
        "gantry": gantry,
        "rail": rail,
    }
    return made[name]() if name in made else cs.load_robot(name)


def calibrated() -> Robot:
    """A UR5e as its calibration might find it: no two axes are parallel."""
    chain, rng = cs.load_robot("ur5e").chain, np.random.default_rng(5)
    axes = chain.axes + rng.normal(scale=1e-3, size=chain.axes.shape)
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    points = chain.points + rng.normal(scale=1e-3, size=axes.shape)
    return Robot(from_screws(axes, points, chain.T_zero, name="UR5e of cell 3"))


def parallel_and_square() -> Robot:
    """Axes in odd places: no closed form and no regular formulation, so that neighbours of the arm serve."""
    x, y, z = np.eye(3)
    points = [[0, 0, 0], [0, 0, 0.3], [0, 0.4, 0.3], [0.1, 0.4, 0.3], [0, 0, 0], [0.1, 0.6, 0.5]]
    T_zero = np.eye(4)
    T_zero[:3, 3] = 0.2, 0.6, 0.5
    return Robot(from_screws([z, x, x, y, z, y], points, T_zero, joint_types="RRRRPR", name="odd"))


def coaxial() -> Robot:
    """Four joints, the first two of which turn about one line."""
    _, y, z = np.eye(3)
    points = [[0, 0, 0], [0, 0, 0.2], [0, 0, 0.4], [0.5, 0, 0.4]]
    T_zero = np.eye(4)
    T_zero[:3, 3] = 1, 0, 0.4
    return Robot(from_screws([z, z, y, y], points, T_zero, name="coaxial"))


def gantry() -> Robot:
    """Three slides along the coordinate axes and a wrist."""
    x, y, z = np.eye(3)
    T_zero = np.eye(4)
    T_zero[:3, 3] = 0.1, 0.2, 0.4
    points = [[0, 0, 0]] * 3 + [[0.1, 0.2, 0.3]] * 3
    return Robot(from_screws([x, y, z, z, y, z], points, T_zero, joint_types="PPPRRR", name="gantry"))


def rail() -> Robot:
    """An arm of two joints with a wrist, on a rail."""
    x, y, z = np.eye(3)
    T_zero = np.eye(4)
    T_zero[:3, 3] = 0.7, 0.1, 0.5
    points = [[0, 0, 0], [0, 0, 0], [0.1, 0, 0.5], [0.6, 0.1, 0.5], [0.6, 0.1, 0.5], [0.6, 0.1, 0.5]]
    return Robot(from_screws([x, z, y, x, y, x], points, T_zero, joint_types="PRRRRR", name="rail"))
