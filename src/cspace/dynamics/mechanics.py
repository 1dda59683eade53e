"""A robot in motion: its state, how a state is moved, and the friction of its joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.dynamics.rows import Wrenches
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial import exp_so3

Flags = NDArray[np.bool_]
WrenchLaw = Callable[[float, Array, Array], Wrenches]
"""(t, q, qd) → the wrenches from time t on."""


LARGEST_STATE: Final = 1e50
"""Largest coordinate or velocity of a state: the square of a velocity times any inertia still fits a
double."""


@dataclass(frozen=True, eq=False)
class State:
    """Where a robot is and how it moves: q (..., n) [rad or m], qd (..., dof), T_world_base (..., 4, 4)."""

    q: Array
    qd: Array
    T_world_base: Array | None

    def wild(self) -> Flags:
        """Which rows (...) are not finite, or too large for the functions of dynamics."""
        largest = np.maximum(
            np.abs(self.q).max(axis=-1, initial=0.0), np.abs(self.qd).max(axis=-1, initial=0.0)
        )
        result: Flags = np.asarray(~(largest < LARGEST_STATE))
        return result

    def with_rows(self, rows: Flags, other: State) -> State:
        """The state whose rows (...) that are set come from another one."""
        T, T_other = self.T_world_base, other.T_world_base
        moved = T is None or T_other is None or T is T_other
        return State(
            np.where(rows[..., None], other.q, self.q),
            np.where(rows[..., None], other.qd, self.qd),
            T if moved else np.where(rows[..., None, None], T_other, T),  # type: ignore[arg-type]
        )


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
    the world: R ← exp(u) R. Rows that rotate by half a turn or more become NaN.
    """
    if not floating:
        return State(state.q + dx, state.qd + dv, state.T_world_base)
    assert state.T_world_base is not None
    u = dx[..., 3:6]
    far = ~(np.einsum("...i,...i", u, u) < np.pi**2)
    T = state.T_world_base.copy()
    T[..., :3, 3] += dx[..., :3]
    T[..., :3, :3] = exp_so3(np.where(far[..., None], 0.0, u)) @ T[..., :3, :3]
    q = state.q + dx[..., 6:]
    qd = state.qd + dv
    return State(q, np.where(far[..., None], np.nan, qd) if far.any() else qd, T)
