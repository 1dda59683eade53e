"""Arms of one, two or three joints: every configuration that brings the tip to a point, or to a pose.

Any joint may turn or slide. With three joints a point in space has up to four configurations, none, or a
family of infinitely many; with two or one the points that can be reached lie on a surface or a curve.

Source: Pieper 1968 for three joints; the conditions are those of subproblem 5 (Elias & Wen 2022, §3.5).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.spatial import as_pose

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["ShortArmSolutions", "pose_solutions", "position_solutions"]

MOST = 8


@dataclass(frozen=True, eq=False)
class ShortArmSolutions:
    """Every configuration of a short arm for one goal or a batch of goals; true if every goal is reached.

    q: (..., 8, n) joints [rad or m], NaN beyond count.
    count: (...) how many of them.
    free: (..., 8) whether a configuration stands for a family of infinitely many, one for each curve of
        them. The rule: of the first and the last joint one that can take any value is at 0; where neither
        can, the first is at 0 if the others can follow, else the last, else the first is where they end.
    direction: (..., 8, n) unit direction in which the joints of a family start to move; NaN elsewhere.
    missing: (...) by how much the goal is out of reach [m], 0 where it is reached; NaN for poses, where it is
        not computed.
    nearest: (..., n) the joints that bring the tip nearest (NaN for poses).
    """

    q: Array
    count: npt.NDArray[np.int32]
    free: npt.NDArray[np.bool_]
    direction: Array
    missing: Array
    nearest: Array

    def __bool__(self) -> bool:
        return bool(np.all(self.count > 0))


def position_solutions(axes: Any, points: Any, joint_types: str, T_zero: Any, p: Any) -> ShortArmSolutions:
    """Every q with the tip at p: e^(ξ1 q1) … e^(ξn qn) tip = p, n ≤ 3.

    axes (n, 3) unit directions and points (n, 3) on the axes at zero, in base [m]; joint_types "R" or "P"
    each; T_zero (4, 4) the tip at zero; p (..., 3) goals [m].
    Raises InputError on more than three joints or an unknown type.
    """
    chain = chain_arrays(axes, points, joint_types, T_zero)
    goals = as_floats(p, "p", last=(3,))
    rows = np.ascontiguousarray(goals.reshape(-1, 3))
    found = room_for(len(rows), len(joint_types))
    _core.position_solutions(
        *chain, rows, found.q, found.direction, found.free, found.count, found.missing, found.nearest
    )
    return shaped(found, goals.shape[:-1])


def pose_solutions(axes: Any, points: Any, joint_types: str, T_zero: Any, T: Any) -> ShortArmSolutions:
    """Every q with the tip at the pose T: e^(ξ1 q1) … e^(ξn qn) T_zero = T, n ≤ 3.

    axes (n, 3) unit directions and points (n, 3) on the axes at zero, in base [m]; joint_types "R" or "P"
    each; T_zero (4, 4) the tip at zero; T (..., 4, 4) goals.
    Raises InputError on more than three joints or an unknown type.
    """
    chain = chain_arrays(axes, points, joint_types, T_zero)
    goals = as_pose(T, "T")
    rows = np.ascontiguousarray(goals.reshape(-1, 4, 4))
    found = room_for(len(rows), len(joint_types))
    _core.short_pose_solutions(*chain, rows, found.q, found.direction, found.free, found.count)
    found.missing[:] = np.nan
    found.nearest[:] = np.nan
    return shaped(found, goals.shape[:-2])


def chain_arrays(axes: Any, points: Any, joint_types: str, T_zero: Any) -> tuple[Array, Array, Any, Array]:
    """The chain as the core takes it: axes (n, 3), points (n, 3), prismatic (n,), T_zero (4, 4)."""
    n = len(joint_types)
    if not 1 <= n <= 3 or set(joint_types) - {"R", "P"}:
        raise InputError(f"joint_types is {joint_types!r}; a short arm has one to three joints, each R or P")
    rows = [as_floats(value, name, last=(n, 3)) for name, value in (("axes", axes), ("points", points))]
    for value, name in zip(rows, ("axes", "points"), strict=True):
        if value.ndim != 2:
            raise InputError(f"{name} has shape {value.shape}, expected ({n}, 3)")
    lengths = np.linalg.norm(rows[0], axis=-1)
    if np.abs(lengths - 1).max() > 1e-9:
        raise InputError(f"axes have lengths {lengths}; they must be unit vectors")
    prismatic = np.array([kind == "P" for kind in joint_types])
    tip = as_pose(T_zero, "T_zero")
    if tip.ndim != 2:
        raise InputError(f"T_zero has shape {tip.shape}, expected (4, 4)")
    directions, origins = (np.ascontiguousarray(value) for value in rows)
    return directions, origins, prismatic, np.ascontiguousarray(tip)


def room_for(rows: int, n: int) -> ShortArmSolutions:
    """Arrays for the answers to `rows` goals of an arm of n joints: q (rows, 8, n) and the rest."""
    return ShortArmSolutions(
        q=np.empty((rows, MOST, n)),
        count=np.empty(rows, dtype=np.int32),
        free=np.empty((rows, MOST), dtype=np.bool_),
        direction=np.empty((rows, MOST, n)),
        missing=np.empty(rows),
        nearest=np.empty((rows, n)),
    )


def shaped(found: ShortArmSolutions, batch: tuple[int, ...]) -> ShortArmSolutions:
    """The same answers with the leading axes of the goals: q (..., 8, n) and the rest."""
    n = found.q.shape[-1]
    return ShortArmSolutions(
        found.q.reshape(*batch, MOST, n),
        found.count.reshape(batch)[()],
        found.free.reshape(*batch, MOST),
        found.direction.reshape(*batch, MOST, n),
        found.missing.reshape(batch)[()],
        found.nearest.reshape(*batch, n),
    )
