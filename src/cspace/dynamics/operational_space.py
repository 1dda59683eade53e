"""The inertia of a robot as it is felt at a frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace.arrays import Array, as_floats, leading_axes
from cspace.dynamics.forward import forward_dynamics
from cspace.dynamics.rows import dynamic_rows, refuse_rows
from cspace.errors import InputError
from cspace.kinematics import jacobian
from cspace.kinematics.batch import check_output, check_robot, frame_number
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import LOST_MOTION


@tabulate()
@dataclass(frozen=True, eq=False)
class OperationalSpace:
    """How a frame answers wrenches: ν̇ = mobility · w, with ν = [v; ω] and w = [f; n] in the axes of the base.

    frame: its name. mobility (..., 6, 6): Λ⁻¹ = J M⁻¹ Jᵀ. inertia (..., 6, 6): Λ, its inverse, of which lost
    wrenches have no part. rank (...): how many directions are kept. lost (6 − rank, 6): an orthonormal basis
    of the wrenches that move nothing, empty at a regular configuration of six or more joints; of a batch
    (..., 6, 6), whose other rows are zero. J (..., 6, dof).
    """

    frame: str
    mobility: Array
    inertia: Array
    rank: NDArray[np.int64]
    lost: Array
    J: Array

    def effective_mass(self, direction: ArrayLike) -> Any:
        """The mass (...) [kg] that a force along a direction (..., 3) feels, 1 / (dᵀ Λ⁻¹ d); inf along a lost
        one. A float for one configuration and direction.

        Raises InputError for a direction of length zero or NaN.
        """
        d = as_floats(direction, "direction", last=(3,))
        largest = np.abs(d).max(axis=-1, keepdims=True)
        if not largest.all():
            raise InputError("direction has length 0; it must point somewhere")
        d = d / largest  # its square could overflow, or vanish
        d = d / np.linalg.norm(d, axis=-1, keepdims=True)
        lead = leading_axes(direction=d.shape[:-1], configurations=self.mobility.shape[:-2])
        moves = self.mobility[..., :3, :3]
        yields = np.einsum("...i,...ij,...j->...", d, moves, d)
        least = LOST_MOTION * np.abs(moves).max(axis=(-2, -1))
        mass = np.where(yields > least, 1.0 / np.where(yields > least, yields, 1.0), np.inf)
        return np.broadcast_to(mass, lead).copy() if lead else float(mass)

    def __repr__(self) -> str:
        if self.rank.ndim:
            return one_line("OperationalSpace", f"of {self.frame}, {count_things(self.rank.size, 'row')}")
        lost = f", {count_things(len(self.lost), 'direction')} lost" if len(self.lost) else ""
        return one_line("OperationalSpace", f"of {self.frame}, rank {int(self.rank)}{lost}")


def operational_space(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    T_world_base: PoseLike | None = None,
    out: Array | None = None,
    threads: int | None = None,
) -> OperationalSpace:
    """The inertia of a robot as it is felt at a frame.

    Λ = (J M⁻¹ Jᵀ)⁻¹ (Khatib 1987). Near a singularity nothing is damped: the directions that are lost are
    named in the answer, and Λ is zero there.

    q (..., n) [rad or m]. frame: its name; without it the tip. T_world_base (..., 4, 4): where the base is.
    out (..., 6, 6): float64 array for the inertia of the answer. threads: as in fk.
    Raises InputError for a wrong shape or NaN and where a joint moves no inertia, UnknownNameError for an
    unknown frame.
    """
    check_robot(robot)
    batch = dynamic_rows(robot, q, T_world_base=T_world_base, threads=threads)
    refuse_rows(batch)
    name, place = robot.frames[frame_number(robot, frame)], batch.T_world_base
    J = jacobian(robot, batch.q, frame, T_world_base=place, threads=threads)
    rest, none = np.zeros(robot.dof), np.zeros(3)
    # M⁻¹ Jᵀ: the accelerations under the torques of unit wrenches; a singular M is named there.
    responses = forward_dynamics(
        robot,
        batch.q[:, None] if batch.shape else batch.q[0],
        rest,
        J if batch.shape else J[0],
        gravity=none,
        friction=False,
        T_world_base=place if place is None or len(place) == 1 else place[:, None],
        threads=threads,
    ).reshape(J.shape)
    mobility = J @ responses.swapaxes(-1, -2)
    mobility = (mobility + mobility.swapaxes(-1, -2)) / 2
    # Metres and radians are made comparable by what each axis alone yields.
    own = np.diagonal(mobility, axis1=-2, axis2=-1)
    size = np.sqrt(np.where(own > LOST_MOTION * own.max(axis=-1, initial=0.0)[:, None], own, 1.0))
    values, vectors = np.linalg.eigh(mobility / (size[:, :, None] * size[:, None, :]))
    keeps = values > LOST_MOTION * values[:, -1:]
    axes = vectors / size[:, :, None]
    inertia = (axes * np.where(keeps, 1.0 / np.where(keeps, values, 1.0), 0.0)[:, None, :]) @ axes.swapaxes(
        -1, -2
    )
    rank, lost = keeps.sum(axis=-1), np.zeros_like(mobility)
    for row in np.flatnonzero(rank < 6):
        lost[row, : 6 - rank[row]] = np.linalg.qr(axes[row][:, ~keeps[row]])[0].T
    felt = check_output(out, (*batch.shape, 6, 6))
    felt[...] = inertia.reshape(felt.shape)
    if not batch.shape:
        return OperationalSpace(name, mobility[0], felt, rank[0], lost[0, : 6 - rank[0]], J[0])
    parts: list[Any] = [x.reshape(*batch.shape, *x.shape[1:]) for x in (mobility, rank, lost, J)]
    return OperationalSpace(name, parts[0], felt, *parts[1:])
