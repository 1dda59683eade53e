"""Resolved rate: the joint velocities that move a frame as wanted."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, bounded_number
from cspace.errors import InputError
from cspace.ik.numeric.problem import largest_speeds
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import broadcast_rows, thread_count
from cspace.kinematics.jacobian import jacobian
from cspace.tolerances import FARTHEST, WEAK_DIRECTION

MOST_JOINTS = 128


def resolved_rate(
    robot: KinematicModel,
    q: Any,
    twist: Any,
    *,
    frame: str | None = None,
    point: Any = None,
    expressed_in: str = "base",
    damping: float | None = None,
    null_space: Any = None,
    velocity: Any = False,
    T_world_base: Any = None,
    threads: int | None = None,
) -> Array:
    """The least joint velocities that give a frame, or a point of it, a twist.

    q̇ = Jᵀ (J Jᵀ + λ² I)⁻¹ t + N q̇₀, with N the projection onto the null space of J.

    q (..., n) [rad, m], twist t (..., 6): [v; ω] [m/s, rad/s]. frame, point (..., 3), expressed_in,
    T_world_base (..., 4, 4): as in jacobian. damping λ: None damps weak directions alone: where a singular
    value σ of J is below ε = 0.01 its gain is σ/ε² in place of 1/σ, so near a singularity the robot slows
    down along what it cannot do, and elsewhere the twist is met exactly; 0 gives the pseudo-inverse.
    null_space q̇₀ (..., dof): wished besides, without moving the frame. velocity: True for the robot's
    limits, or (dof,) [rad/s, m/s]: where they would be exceeded the motion in the null space gives way, then
    all joints slow down alike, so the direction of the twist stays.

    Returns q̇ (..., dof) [rad/s, m/s].
    Raises InputError for wrong shapes, NaN or a negative damping; UnknownNameError for an unknown frame.

    Whitney 1969; Liégeois 1977; Nakamura and Hanafusa 1986; Wampler 1986; Maciejewski and Klein 1988.
    """
    J = jacobian(robot, q, frame, point=point, expressed_in=expressed_in, T_world_base=T_world_base)
    dof = robot.dof
    if dof > MOST_JOINTS:
        raise InputError(f"{robot.name} has {dof} velocities; resolved_rate takes up to {MOST_JOINTS}")
    given = {"q": (J, 2), "twist": (as_floats(twist, "twist", last=(6,), largest=FARTHEST), 1)}
    if null_space is not None:
        given["null_space"] = as_floats(null_space, "null_space", last=(dof,), largest=FARTHEST), 1
    lead, rows = broadcast_rows(given)
    workers = thread_count(threads, lead)
    speeds = largest_speeds(robot, velocity)
    if speeds.size:  # those of a floating base are unlimited
        speeds = np.concatenate([np.full(dof - speeds.size, np.inf), speeds])
    qd = np.empty((math.prod(lead), dof))
    weight = -1.0
    if damping is not None:
        weight = bounded_number(damping, "damping", 0.0, "it must be one number, 0 or more", FARTHEST)
    wishes = rows.get("null_space", np.empty((0, dof)))
    _core._resolved_rate(rows["q"], rows["twist"], wishes, speeds, weight, WEAK_DIRECTION, workers, qd)
    return qd.reshape(*lead, dof)
