"""The inertia of a robot as it is felt at a frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.dynamics.forward import forward_dynamics
from cspace.errors import InputError
from cspace.kinematics import jacobian
from cspace.kinematics.batch import check_robot, frame_number
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tables import count_things, one_line
from cspace.tolerances import LOST_MOTION


@dataclass(frozen=True, eq=False)
class OperationalSpace:
    """How a frame answers wrenches: ν̇ = mobility · w, with ν = [v; ω] and w = [f; n] in the axes of the base.

    frame: its name. mobility (6, 6): Λ⁻¹ = J M⁻¹ Jᵀ. inertia (6, 6): Λ, its inverse, of which lost wrenches
    have no part. lost (k, 6): an orthonormal basis of the wrenches that move nothing, empty at a regular
    configuration of six or more joints. J (6, dof).
    """

    frame: str
    mobility: Array
    inertia: Array
    lost: Array
    J: Array

    def effective_mass(self, direction: ArrayLike) -> float:
        """The mass [kg] that a force along a direction (3,) feels, 1 / (dᵀ Λ⁻¹ d); inf along a lost one.

        Raises InputError for a direction of length zero or NaN.
        """
        d = one_array(direction, "direction", (3,))
        if not d.any():
            raise InputError("direction has length 0; it must point somewhere")
        d = d / np.abs(d).max()  # its square could overflow, or vanish
        d = d / np.linalg.norm(d)
        yields = float(d @ self.mobility[:3, :3] @ d)
        return 1.0 / yields if yields > LOST_MOTION * np.abs(self.mobility[:3, :3]).max() else np.inf

    def __repr__(self) -> str:
        lost = f", {count_things(len(self.lost), 'direction')} lost" if len(self.lost) else ""
        return one_line("OperationalSpace", f"of {self.frame}, rank {6 - len(self.lost)}{lost}")


def operational_space(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    T_world_base: PoseLike | None = None,
) -> OperationalSpace:
    """The inertia of a robot as it is felt at a frame, at one configuration.

    Λ = (J M⁻¹ Jᵀ)⁻¹ (Khatib 1987). Near a singularity nothing is damped: the directions that are lost are
    named in the answer, and Λ is zero there.

    q (n,) [rad or m]. frame: its name; without it the tip. T_world_base (4, 4): where the base is.
    Raises InputError for a wrong shape or NaN and where a joint moves no inertia, UnknownNameError for an
    unknown frame.
    """
    check_robot(robot)
    q = one_array(q, "q", (len(robot.joint_names),))
    name = robot.frames[frame_number(robot, frame)]
    J = jacobian(robot, q, frame, T_world_base=T_world_base)
    rest = np.zeros(robot.dof)
    none = np.zeros(3)
    # M⁻¹ Jᵀ: the accelerations under the torques of unit wrenches; a singular M is named there.
    responses = forward_dynamics(
        robot, q, rest, J, gravity=none, friction=False, T_world_base=T_world_base, threads=1
    )
    mobility = J @ responses.T
    mobility = (mobility + mobility.T) / 2
    # Metres and radians are made comparable by what each axis alone yields.
    own = np.diag(mobility)
    size = np.sqrt(np.where(own > LOST_MOTION * own.max(initial=0.0), own, 1.0))
    values, vectors = np.linalg.eigh(mobility / np.outer(size, size))
    keeps = values > LOST_MOTION * values[-1]
    kept = vectors[:, keeps] / size[:, None]
    inertia = (kept / values[keeps]) @ kept.T
    lost = np.linalg.qr(vectors[:, ~keeps] / size[:, None])[0].T if not keeps.all() else np.empty((0, 6))
    return OperationalSpace(name, mobility, inertia, lost, J)
