"""Which freedom a configuration is about to lose, and which joints lose it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.kinematics.jacobian import jacobian
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.kinematics.manipulability import ROWS, select_rows
from cspace.spatial.checks import PoseLike
from cspace.tables import join_words, one_line, tabulate
from cspace.tolerances import SINGULAR_ROUNDING, SINGULAR_VALUE

MOST_COLUMNS = 12
"""Joints among which every set is tried: 2509 sets of up to six."""


@tabulate()
@dataclass(frozen=True, eq=False)
class Singularity:
    """The singularity that is nearest to a configuration; true if the configuration is singular itself.

    distance: smallest singular value of the Jacobian. rank: how many are not zero. direction (6,): the unit
    twist [v; ω] that is lost there (in the axes asked for; 0 in rows that were not). joints: the smallest
    set of joints whose columns become dependent, by name. motion (n,): unit joint velocities, of these
    joints alone, that move the frame by no more than `moves`.
    """

    distance: float
    rank: int
    direction: Array
    joints: tuple[str, ...]
    motion: Array
    moves: float

    def __bool__(self) -> bool:
        return self.distance <= SINGULAR_VALUE

    def __repr__(self) -> str:
        return one_line("Singularity", str(self))

    def __str__(self) -> str:
        near = "singular" if self else f"{self.distance:.3g} from singular"
        parts = [
            f"{value:+.2f} {name}"
            for value, name in zip(self.direction, ROWS, strict=True)
            if abs(value) > 0.005
        ]
        return f"{near}: {join_words(self.joints)} lose {' '.join(parts)}"


def singularity(
    robot: KinematicModel,
    q: ArrayLike,
    frame: str | None = None,
    *,
    rows: str | Iterable[str] = "auto",
    point: ArrayLike | None = None,
    expressed_in: str = "base",
    T_world_base: PoseLike | None = None,
) -> Singularity:
    """The freedom that a configuration has lost, or is nearest to losing, and the joints that lose it.

    With J = U Σ Vᵀ the twist u_k of the smallest σ_k is the one lost. Joints are dependent where their
    columns are: let s(m) be the smallest singular value that m columns can have among themselves; it falls
    with m, steeply where the last joint that is needed comes in, and the set at the steepest fall is named.
    At the wrist singularity of a six-joint arm, for instance, these are joints 4 and 6.

    q (n,) [rad or m]: one configuration. frame, rows, point (3,), expressed_in, T_world_base (4, 4): as in
    singular_values.

    Raises InputError for more than one configuration (distance_to_singularity takes batches) and for a robot
    without joints.
    """
    chosen, rank = select_rows(robot, frame, rows, point)
    J = jacobian(robot, q, frame, point=point, expressed_in=expressed_in, T_world_base=T_world_base)
    if J.ndim != 2:
        raise InputError(
            f"singularity takes one configuration, got {J.shape[:-2]} of them;"
            " distance_to_singularity accepts batches"
        )
    J = J[:, robot.dof - len(robot.joint_names) :]
    on_path = np.flatnonzero(np.abs(J).max(axis=0, initial=0.0) > 0.0)
    if on_path.size == 0:
        raise InputError(f"no joint of {robot.name} moves this frame, so it has no singularity")
    J = J[chosen][:, on_path]
    U, sigma, Vt = np.linalg.svd(J)
    sigma = sigma[:rank]
    dependent = _dependent(J, Vt[sigma.size - 1], sigma.size)
    _, inner, weights = np.linalg.svd(J[:, dependent], full_matrices=False)
    motion = np.zeros(len(robot.joint_names))
    motion[on_path[dependent]] = weights[-1]
    direction = np.zeros(6)
    direction[chosen] = U[:, sigma.size - 1]
    return Singularity(
        distance=float(sigma[-1]),
        rank=int(np.sum(sigma > SINGULAR_VALUE)),
        direction=direction,
        joints=tuple(robot.joint_names[i] for i in on_path[dependent]),
        motion=motion,
        moves=float(inner[-1]),
    )


def _dependent(J: Array, weights: Array, rank: int) -> list[int]:
    """The columns of J (m, n) that become dependent, at most `rank`; weights (n,): the weakest motion."""
    sizes = np.linalg.norm(J, axis=0)
    taking_part = np.flatnonzero(sizes > SINGULAR_VALUE)
    if taking_part.size < rank:
        taking_part = np.arange(J.shape[1])
    best: list[list[int]] = [[]]
    smallest = [float(sizes.max())]
    for size in range(1, rank + 1):
        sets = _candidates(taking_part, size, weights)
        columns = J[:, sets].swapaxes(0, 1)  # (sets, rows, size)
        values = np.linalg.svd(columns, compute_uv=False)[:, -1]
        best.append(sets[int(np.argmin(values))].tolist())
        smallest.append(max(float(values.min()), SINGULAR_ROUNDING))
    falls = [before / after for before, after in pairwise(smallest)]
    return best[1 + int(np.argmax(falls))]


def _candidates(columns: npt.NDArray[np.intp], size: int, weights: Array) -> npt.NDArray[np.intp]:
    """Sets of columns to try, (sets, size): all of them, or of many columns those that move most."""
    if columns.size > MOST_COLUMNS:
        moving_most = columns[np.argsort(-np.abs(weights[columns]), kind="stable")]
        columns = np.sort(moving_most[:MOST_COLUMNS])
    return np.array(list(combinations(columns.tolist(), size)), dtype=np.intp)
