"""A robot in motion: its state, how a state is moved, and the friction of its joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.dynamics.rows import Wrenches
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial import exp_so3

Flags = NDArray[np.bool_]
WrenchLaw = Callable[[float, Array, Array], Wrenches]
"""(t, q, qd) → the wrenches from time t on."""


@dataclass(frozen=True, eq=False)
class State:
    """Where a robot is and how it moves: q (..., n) [rad or m], qd (..., dof), T_world_base (..., 4, 4)."""

    q: Array
    qd: Array
    T_world_base: Array | None


@dataclass(frozen=True, eq=False)
class Mechanics:
    """A robot and what acts on it at every time.

    gravity (3,) [m/s²]. expressed_in: the axes of wrenches. damping (dof,) [N·m·s/rad or N·s/m] and dry
    (dof,) [N·m or N]: the friction of the joints, zero for a floating base. friction_speed: where dry
    friction has 76 % of its value [rad/s or m/s].
    """

    robot: KinematicModel
    gravity: Array
    expressed_in: str
    damping: Array
    dry: Array
    friction_speed: float
    threads: int


def find_resistances(robot: KinematicModel) -> tuple[Array, Array]:
    """Damping and dry friction (dof,) of the coordinates, those of joints that mimic them included."""
    assembly = robot._assembly
    result = np.zeros((2, robot.dof))
    joints = result[:, robot.dof - assembly.n_coordinates :]
    np.add.at(joints[0], assembly.coordinate, assembly.ratio**2 * assembly.damping)
    np.add.at(joints[1], assembly.coordinate, np.abs(assembly.ratio) * assembly.friction)
    return result[0], result[1]


def advance_state(state: State, dx: Array, dv: Array, floating: bool) -> State:
    """The state after a displacement and a change of the velocities (..., dof).

    The first six displacements of a floating base are that of its origin and a rotation vector, in axes of
    the world: R ← exp(u) R.
    """
    if not floating:
        return State(state.q + dx, state.qd + dv, state.T_world_base)
    assert state.T_world_base is not None
    T = state.T_world_base.copy()
    T[..., :3, 3] += dx[..., :3]
    T[..., :3, :3] = exp_so3(dx[..., 3:6]) @ T[..., :3, :3]
    return State(state.q + dx[..., 6:], state.qd + dv, T)
