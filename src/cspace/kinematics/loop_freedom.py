"""How many independent motions closed loops leave, and which of their rows repeat others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.kinematics.loop_constraints import LoopConstraints, Placement
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import ALIKE_ROWS, FARTHEST, LOOP_RANK, LOOP_RANK_SLACK


@tabulate()
@dataclass(frozen=True, eq=False)
class LoopFreedom:
    """The freedom of a mechanism at a configuration.

    dof: n − rank K, the independent velocities. rank: of K. rows: of K. dependent: the names of rows that
    follow from the others, as a planar linkage in space has them; forces along them cannot be known.
    """

    dof: int
    rank: int
    rows: int
    dependent: tuple[str, ...]

    def __repr__(self) -> str:
        extra = f", {count_things(len(self.dependent), 'row')} dependent" if self.dependent else ""
        return one_line("LoopFreedom", f"{self.dof} dof, rank {self.rank} of {self.rows}{extra}")


def loop_freedom(constraints: LoopConstraints, q: ArrayLike) -> LoopFreedom:
    """The degrees of freedom at a configuration, n − rank K, and the rows of K that depend on others.

    Unlike the formula of Grübler and Kutzbach (model.mobility) this counts what the geometry really leaves,
    also where the axes of a loop are parallel or meet in a point, and the momentary freedom of a singular
    configuration.

    q (n,) [rad or m]: one configuration, with closed loops. Raises InputError for a wrong shape or NaN.
    """
    n = len(constraints.robot.joint_names)
    at = constraints.place(one_array(q, "q", (n,), largest=FARTHEST)[None])
    K, tolerance = find_scaled_jacobian(constraints, at)[0], find_rank_tolerance(constraints, at)[0]
    kept = find_independent_rows(K, float(tolerance))
    dependent = [name for r, name in enumerate(constraints.rows) if r not in set(kept)]
    return LoopFreedom(constraints.robot.dof - len(kept), len(kept), len(constraints.rows), tuple(dependent))


def find_scaled_jacobian(constraints: LoopConstraints, at: Placement) -> Array:
    """K (..., r, dof) without units: lengths are divided by the size of the mechanism."""
    K = constraints.find_jacobian(at) * constraints.scale[:, None]
    return K * constraints.unit


def find_rank_tolerance(constraints: LoopConstraints, at: Placement) -> Array:
    """(...): the singular value of the scaled K, relative to the largest, up to which a row depends on
    others.

    Rows that depend on each other where the loops are closed do so less by as much as these are open.
    """
    phi = np.linalg.norm(at.phi * constraints.scale, axis=-1)
    result: Array = LOOP_RANK + LOOP_RANK_SLACK * phi
    return result


def find_independent_rows(K: Array, tolerance: float) -> list[int]:
    """The numbers of as many independent rows of K (r, n) as there are, the first ones where rows are alike.

    QR of Kᵀ with column pivoting (Businger and Golub 1965) by orthogonalisation, twice for each row.
    """
    rest = K.copy()
    kept: list[int] = []
    basis = np.zeros((0, K.shape[1]))
    first = 0.0
    for _ in range(min(K.shape)):
        sizes = np.linalg.norm(rest, axis=1)
        sizes[kept] = 0.0
        largest = float(sizes.max())
        first = first or largest
        if largest <= tolerance * first or largest == 0.0:
            break
        row = int(np.flatnonzero(sizes >= (1.0 - ALIKE_ROWS) * largest)[0])
        unit = rest[row] - (rest[row] @ basis.T) @ basis
        unit = unit / np.linalg.norm(unit)
        basis = np.concatenate([basis, unit[None]])
        kept.append(row)
        rest = rest - np.outer(rest @ unit, unit)
    return sorted(kept)
