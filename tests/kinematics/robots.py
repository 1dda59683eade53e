"""The robots that the tests of this folder share: random trees and chains, and differences."""

from __future__ import annotations

import numpy as np

from cspace.model import Description, Joint, Link
from cspace.robot import Robot
from model.random_robots import random_inertial, random_pose, random_tree

STEP = 1e-6  # of central differences: truncation 1e-12, rounding 1e-10 relative to sizes of one


def tree(seed: int, **kinds: object) -> Robot:
    """A random robot that branches, with turns, slides, fixed links and mimicking joints."""
    rng = np.random.default_rng(seed)
    while True:
        robot = Robot(random_tree(rng, **kinds))
        if robot.tip is None:
            return robot


def arm(seed: int, joint_types: str = "RRRRRR", **options: object) -> Robot:
    """A random serial arm with a rigid tool link."""
    rng = np.random.default_rng(seed)
    n = len(joint_types)
    links = [Link(f"link_{i}", random_inertial(rng)) for i in range(n + 2)]
    joints = [
        Joint(
            f"joint_{i}",
            {"R": "revolute", "P": "prismatic"}[kind],
            f"link_{i}",
            f"link_{i + 1}",
            random_pose(rng),
            rng.normal(size=3),
            lower=-2.5,
            upper=2.5,
        )
        for i, kind in enumerate(joint_types)
    ]
    joints.append(Joint("flange", "fixed", f"link_{n}", f"link_{n + 1}", random_pose(rng)))
    return Robot(Description(f"arm {seed}", tuple(links), tuple(joints)), **options)


def planar(*lengths: float, lower: float = -np.inf, upper: float = np.inf) -> Robot:
    """An arm of parallel joints about z with links along x."""
    n = len(lengths)
    links = [Link(f"link_{i}") for i in range(n + 1)] + [Link("tip")]
    joints = []
    for i in range(n + 1):
        origin = np.eye(4)
        origin[0, 3] = lengths[i - 1] if i else 0.0
        if i == n:
            joints.append(Joint("end", "fixed", f"link_{n}", "tip", origin))
        else:
            limits = {"lower": lower, "upper": upper}
            kind = "continuous" if np.isinf(lower) else "revolute"
            joints.append(
                Joint(f"joint_{i}", kind, f"link_{i}", f"link_{i + 1}", origin, [0, 0, 1], **limits)
            )
    return Robot(Description(f"planar {n}R", tuple(links), tuple(joints)))


def random_q(robot: Robot, rng: np.random.Generator, *lead: int) -> np.ndarray:
    return rng.uniform(-2.5, 2.5, (*lead, len(robot.joint_names)))


def small_rotation(R: np.ndarray) -> np.ndarray:
    """The rotation vector of a rotation that is almost the identity."""
    return np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2


def twist_between(T_0: np.ndarray, T_1: np.ndarray, dt: float, point: np.ndarray) -> np.ndarray:
    """[v; ω] in base axes that takes the point of a frame from T_0 to T_1 within dt."""
    p_0, p_1 = T_0[:3, :3] @ point + T_0[:3, 3], T_1[:3, :3] @ point + T_1[:3, 3]
    w = small_rotation(T_1[:3, :3] @ T_0[:3, :3].T) / dt
    return np.concatenate([(p_1 - p_0) / dt, w])
