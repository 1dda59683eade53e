"""What makes a simulation stiff: friction and gains that change velocities faster than its steps follow."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.dynamics.controllers import PD, ComputedTorque
from cspace.dynamics.mass_matrix import mass_matrix
from cspace.dynamics.mechanics import Mechanics, State
from cspace.kinematics import KinematicModel

STIFF: Final = 2.0
"""Decays within one step from which on a velocity grows instead: 2.8 with RK4, less with others and with
torques that are held."""

STIFF_SPRING: Final = 4.0
"""kp dt² / m from which on a spring whose force is held over a step gains energy whatever its damping."""


def find_mobility(robot: KinematicModel, start: State) -> Array:
    """The accelerations (dof,) of joints under a unit torque on each, the largest over all rows."""
    M = mass_matrix(robot, start.q, T_world_base=start.T_world_base)
    mobility = np.diagonal(np.linalg.inv(M), axis1=-2, axis2=-1)
    most: Array = mobility.reshape(-1, robot.dof).max(axis=0)
    return most


def find_fastest(robot: KinematicModel, rates: Array) -> tuple[str, float]:
    """The joint with the highest of rates (dof,), and that."""
    joints = rates[robot.dof - len(robot.joint_names) :]
    fastest = int(joints.argmax())
    return robot.joint_names[fastest], float(joints[fastest])


def name_stiff_friction(mechanics: Mechanics, start: State, dt: float) -> str | None:
    """The sentence about friction that is too stiff for explicit steps, None if none is."""
    stiff = mechanics.damping + mechanics.dry / mechanics.friction_speed
    if not stiff.any() or not start.q.size:
        return None
    joint, rate = find_fastest(mechanics.robot, stiff * find_mobility(mechanics.robot, start))
    if dt * rate <= STIFF:
        return None
    return (
        f"the friction of joint {joint!r} stops it within {1.0 / rate:.2g} s; use a"
        f' dt below {STIFF / rate:.2g} s or method="variational"'
    )


def name_stiff_gain(robot: KinematicModel, control: Any, start: State, dt: float) -> str | None:
    """The sentence about gains that are too high for torques held over a step, None if none is."""
    if type(control) not in (PD, ComputedTorque) or not start.q.size:
        return None
    kp, kd = control.find_gains(robot)
    first = robot.dof - len(robot.joint_names)
    mobility = find_mobility(robot, start)[first:] if type(control) is PD else np.ones(robot.dof - first)
    for name, gain, power, most in (("kd", kd, 1, STIFF), ("kp", kp, 2, STIFF_SPRING)):
        each = np.zeros(robot.dof)
        each[first:] = np.asarray(gain * mobility).reshape(-1, robot.dof - first).max(axis=0)
        joint, rate = find_fastest(robot, each)
        if rate * dt**power <= most:
            continue
        lower = np.asarray(gain).reshape(-1, robot.dof - first).max(axis=0)[robot.joint_names.index(joint)]
        return (
            f"{name} of joint {joint!r} is too high for torques that are held over a step; use at most"
            f" {lower * most / (rate * dt**power):.2g}, or a dt below {(most / rate) ** (1 / power):.2g} s"
        )
    return None
