"""Controllers for simulations: torques that bring joints to a goal, or along a motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.dynamics.inverse import gravity_torques, inverse_dynamics
from cspace.dynamics.mechanics import find_resistances
from cspace.dynamics.rows import EARTH
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics.batch import check_flag
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tables import show_fields
from cspace.tolerances import FARTHEST

Motion = Callable[[float], tuple[ArrayLike, ArrayLike, ArrayLike]]
"""t → q, qd and qdd."""


@show_fields
@dataclass(frozen=True, eq=False)
class PD:
    """Proportional and derivative control: tau = kp (q_goal − q) − kd q̇ + g(q).

    q_goal (..., n) [rad or m]. kp, kd: one number or (n,) [N·m/rad, N·m·s/rad or N/m, N·s/m], not negative.
    gravity_compensation: whether g(q) is added; without it the arm sags. A floating base is not actuated.
    Raises InputError for NaN and for negative gains.

    Takegaki and Arimoto 1981.
    """

    q_goal: ArrayLike
    kp: ArrayLike
    kd: ArrayLike
    gravity_compensation: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "q_goal", as_floats(self.q_goal, "q_goal", last=(None,), largest=FARTHEST))
        for name in ("kp", "kd"):
            object.__setattr__(self, name, _check_gain(getattr(self, name), name))
        check_flag(self.gravity_compensation, "gravity_compensation")

    def __call__(
        self,
        robot: KinematicModel,
        t: float,
        q: Array,
        qd: Array,
        *,
        gravity: ArrayLike = EARTH,
        T_world_base: PoseLike | None = None,
    ) -> Array:
        """The torques (..., dof) at q (..., n) and qd (..., dof)."""
        first = robot.dof - q.shape[-1]
        kp, kd = self.find_gains(robot)
        joints = kp * (self.find_goal(robot) - q) - kd * qd[..., first:]
        if self.gravity_compensation:
            joints = (
                joints + gravity_torques(robot, q, gravity=gravity, T_world_base=T_world_base)[..., first:]
            )
        tau = np.zeros((*joints.shape[:-1], robot.dof))
        tau[..., first:] = joints
        return tau

    def find_gains(self, robot: KinematicModel) -> tuple[Array, Array]:
        """kp and kd of each joint (..., n)."""
        return _spread_gain(self.kp, "kp", robot), _spread_gain(self.kd, "kd", robot)

    def find_goal(self, robot: KinematicModel) -> Array:
        """q_goal (..., n); InputError if it has another number of joints."""
        return _check_count(self.q_goal, "q_goal", robot)


@show_fields
@dataclass(frozen=True, eq=False)
class ComputedTorque:
    """Computed torque control: the torques that give q̈ = q̈_d + kd (q̇_d − q̇) + kp (q_d − q).

    motion: t → (q_d, qd_d, qdd_d), (..., n) each, or a trajectory, at whose end the arm is held. kp, kd: one
    number or (n,) [1/s², 1/s], not negative; kd = 2 √kp is critically damped. Damping is cancelled at the
    velocity of the joints, dry friction at that of the motion. Raises InputError for negative gains, and
    where the base floats, InputTypeError for a motion that cannot be called.

    Luh, Walker and Paul 1980.
    """

    motion: Motion
    kp: ArrayLike
    kd: ArrayLike

    def __post_init__(self) -> None:
        if not callable(self.motion):
            raise InputTypeError(
                f"motion is {name_type(self.motion)}, expected a function of the time [s] that returns"
                " q, qd and qdd"
            )
        for name in ("kp", "kd"):
            object.__setattr__(self, name, _check_gain(getattr(self, name), name))

    def __call__(
        self,
        robot: KinematicModel,
        t: float,
        q: Array,
        qd: Array,
        *,
        gravity: ArrayLike = EARTH,
        T_world_base: PoseLike | None = None,
    ) -> Array:
        """The torques (..., dof) at q (..., n) and qd (..., dof)."""
        self.refuse_floating(robot)
        q_d, qd_d, qdd_d = find_motion(self.motion, t, robot)
        kp, kd = self.find_gains(robot)
        wanted = qdd_d + kd * (qd_d - qd) + kp * (q_d - q)
        more = {"gravity": gravity, "friction": False, "T_world_base": T_world_base}
        damping, dry = find_resistances(robot)
        tau: Array = inverse_dynamics(robot, q, qd, wanted, **more)  # type: ignore[arg-type]
        return tau + damping * qd + dry * np.sign(qd_d)

    def find_gains(self, robot: KinematicModel) -> tuple[Array, Array]:
        """kp and kd of each joint (..., n)."""
        return _spread_gain(self.kp, "kp", robot), _spread_gain(self.kd, "kd", robot)

    def refuse_floating(self, robot: KinematicModel) -> None:
        """InputError for a robot whose base floats."""
        if robot.floating:
            raise InputError(
                f"the base of {robot.name} floats; no torque of a joint accelerates it as wanted"
            )


def find_motion(motion: Motion, t: float, robot: KinematicModel) -> tuple[Array, Array, Array]:
    """q, qd and qdd (..., n) of a motion at a time; InputError for NaN or another number of joints."""
    names, place = ("q", "qd", "qdd"), f"the motion at t = {t:g} s"
    answer: Any = getattr(motion, "state", motion)(t)
    try:
        values = tuple(answer)
    except TypeError:
        raise InputTypeError(f"{place} is {name_type(answer)}, expected q, qd and qdd") from None
    if len(values) != len(names):
        raise InputError(f"{place} has {len(values)} parts, expected q, qd and qdd")
    q, qd, qdd = (
        _check_count(as_floats(value, f"{name} of {place}", largest=FARTHEST), f"{name} of {place}", robot)
        for name, value in zip(names, values, strict=True)
    )
    return q, qd, qdd


def _check_gain(value: ArrayLike, name: str) -> Array:
    gain = as_floats(value, name, largest=FARTHEST)
    if (gain < 0.0).any():
        raise InputError(f"{name} holds {gain.min():g}; a negative gain drives the joints away from the goal")
    return gain


def _spread_gain(gain: ArrayLike, name: str, robot: KinematicModel) -> Array:
    array, n = np.asarray(gain), len(robot.joint_names)
    return np.broadcast_to(array, (n,)) if array.ndim == 0 else _check_count(array, name, robot)


def _check_count(value: ArrayLike, name: str, robot: KinematicModel) -> Array:
    array, n = np.asarray(value), len(robot.joint_names)
    if array.ndim == 0 or array.shape[-1] != n:
        raise InputError(
            f"{name} has shape {array.shape}, expected (..., {n}): one value per joint of {robot.name}"
        )
    return array
