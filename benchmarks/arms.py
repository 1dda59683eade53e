"""The arms of the benchmarks: of the catalogue, disturbed as calibration finds them, with a locked joint,
drawn at random. Only the numbers leave this file."""

from __future__ import annotations

import zlib

import numpy as np

from chains import Arm, Array, motion

CLASSIC = {"ur5e": "UR5e", "puma560": "PUMA 560", "kr6_r900": "KR6"}
GENERAL = {
    "jaco2": "JACO 2",
    "crx10ia": "CRX-10iA",
    "xarm6": "xArm6",
    "piper": "PiPER",
    "gen3_lite": "gen3 lite",
    "m1013": "M1013",
}
CALIBRATED = {
    f"{name}+{size}": f"{title}, disturbed by {size}"
    for name, title in (("ur5e", "UR5e"), ("puma560", "PUMA 560"))
    for size in ("1e-3", "1e-4")
}
LOCKED = {f"iiwa14-{joint}": f"iiwa 14, joint {joint} locked" for joint in (1, 2, 3, 5, 6, 7)}
"""Without the fourth: between a spherical shoulder and a spherical wrist it alone sets their distance."""
SLIDES = {
    "stanford": "Stanford arm (RRPRRR)",
    "random:RPRRRR": "random RPRRRR",
    "random:RRPRPR": "random RRPRPR",
    "scara": "SCARA (RRPR)",
}
SEVEN = {"panda": "Panda", "iiwa14": "iiwa 14"}
TITLES = CLASSIC | GENERAL | CALIBRATED | LOCKED | SLIDES | SEVEN
SETS = {"measurements": CLASSIC, "general": GENERAL, "calibrated": CALIBRATED | LOCKED, "slides": SLIDES}
"""File of results → its arms."""


def seeded(name: str) -> np.random.Generator:
    """The generator of an arm: its name fixes the numbers."""
    return np.random.default_rng([2026, zlib.crc32(name.encode())])


def load(name: str) -> Arm:
    """NAME of the catalogue; NAME+SIZE disturbed; NAME-JOINT with that joint locked; random:WORD drawn."""
    if name.startswith("random:"):
        return drawn(name)
    if "+" in name:
        nominal, size = name.split("+")
        return disturbed(load(nominal), float(size), seeded(name), name)
    if "-" in name:
        nominal, joint = name.rsplit("-", 1)
        arm = load(nominal)
        return locked(arm, int(joint) - 1, seeded(name).uniform(0.3, 1.5), name)
    import cspace as cs

    robot = cs.load_robot(name)
    chain = robot.chain
    return numbers(
        name,
        chain.axes,
        chain.points,
        chain.T_zero,
        chain.joint_types,
        robot.limits.lower,
        robot.limits.upper,
    )


def numbers(
    name: str, axes: Array, points: Array, T_zero: Array, joint_types: str, lower: Array, upper: Array
) -> Arm:
    """An arm and its table of Denavit and Hartenberg."""
    import cspace as cs
    import cspace.model

    robot = cs.Robot(cs.model.from_screws(axes, points, T_zero, joint_types=joint_types))
    table = cspace.model.to_dh(robot.chain, convention="standard")
    chain = robot.chain
    return Arm(
        name,
        chain.axes,
        chain.points,
        T_zero,
        lower,
        upper,
        table.rows,
        table.T_base,
        table.T_tool,
        joint_types,
    )


def disturbed(arm: Arm, size: float, rng: np.random.Generator, name: str) -> Arm:
    """Every axis and every point moved by normal numbers of this size [rad, m]."""
    axes, points = (values + size * rng.normal(size=(arm.dof, 3)) for values in (arm.axes, arm.points))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    return numbers(name, axes, points, arm.T_zero, arm.joint_types, arm.lower, arm.upper)


def locked(arm: Arm, joint: int, angle: float, name: str) -> Arm:
    """The arm with a joint locked at an angle."""
    T = motion(arm, joint, np.asarray(angle))
    axes, points = arm.axes.copy(), arm.points.copy()
    axes[joint + 1 :] = arm.axes[joint + 1 :] @ T[:3, :3].T
    points[joint + 1 :] = arm.points[joint + 1 :] @ T[:3, :3].T + T[:3, 3]
    left = np.arange(arm.dof) != joint
    types = "".join(kind for kind, stays in zip(arm.joint_types, left, strict=True) if stays)
    return numbers(name, axes[left], points[left], T @ arm.T_zero, types, arm.lower[left], arm.upper[left])


def drawn(name: str) -> Arm:
    """An arm of this word of R and P with axes, points and tip drawn at random, of about a metre."""
    word, rng = name.split(":")[1], seeded(name)
    axes = rng.normal(size=(len(word), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    points = np.cumsum(rng.uniform(-0.3, 0.3, (len(word), 3)), axis=0)
    T_zero = np.eye(4)
    T_zero[:3, 3] = points[-1] + rng.uniform(-0.2, 0.2, 3)
    free = np.full(len(word), np.inf)
    return numbers(name, axes, points, T_zero, word, -free, free)
