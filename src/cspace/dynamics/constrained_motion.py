"""Motions that constraints allow: those of least kinetic energy among the solutions of K x = b.

With an orthonormal basis G of the null space of K and a solution x_p of least length, x = x_p + G y, where Gᵀ
M G y = Gᵀ (p − M x_p) makes ½ xᵀ M x − pᵀ x least (Gauss's principle). The rank of K is that of its singular
values, so dependent rows do no harm, and M itself may be singular as long as every motion that is allowed has
kinetic energy.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.kinematics import LoopConstraints
from cspace.kinematics.loop_constraints import Placement
from cspace.kinematics.loop_freedom import find_rank_tolerance, find_scaled_jacobian
from cspace.tolerances import SINGULAR_INERTIA

Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class AllowedMotions:
    """The singular value decomposition of the scaled K of closed loops, rows (...).

    U (..., r, m), s (..., m): zero where they count as such. V (..., n, n): its columns from rank on, free
    (..., n), are the motions that are allowed. row_unit (r,), unit (n,): K = U s Vᵀ / row_unit / unit.
    """

    U: Array
    s: Array
    V: Array
    free: Flags
    row_unit: Array
    unit: Array

    def solve_rates(self, b: Array) -> Array:
        """The x (..., n) of least scaled length with K x = b (..., r)."""
        m = self.s.shape[-1]
        kept = self.s > 0.0
        weights = np.einsum("...ri,...r->...i", self.U, b * self.row_unit)
        weights = weights * kept / np.where(kept, self.s, 1.0)
        result: Array = np.einsum("...ji,...i->...j", self.V[..., :m], weights) * self.unit
        return result

    def solve_multipliers(self, force: Array) -> Array:
        """The λ (..., r) of least scaled length with Kᵀ λ = force (..., n), which must have no part along
        G."""
        m = self.s.shape[-1]
        kept = self.s > 0.0
        weights = np.einsum("...ji,...j->...i", self.V[..., :m], force * self.unit)
        weights = weights * kept / np.where(kept, self.s, 1.0)
        result: Array = np.einsum("...ri,...i->...r", self.U, weights) * self.row_unit
        return result

    def find_basis(self) -> Array:
        """G (..., n, n): the allowed motions as columns, zero in the columns of the others."""
        result: Array = self.V * self.free[..., None, :] * self.unit[:, None]
        return result


def find_allowed_motions(constraints: LoopConstraints, at: Placement) -> AllowedMotions:
    """The motions that closed loops allow at a placement."""
    K = find_scaled_jacobian(constraints, at)
    U, s, Vt = np.linalg.svd(K)
    n, m = K.shape[-1], s.shape[-1]
    tolerance = find_rank_tolerance(constraints, at)[..., None]
    kept = s > tolerance * s[..., :1]
    free = np.ones((*K.shape[:-2], n), dtype=bool)
    free[..., :m] = ~kept
    return AllowedMotions(
        U[..., :m],
        np.where(kept, s, 0.0),
        Vt.swapaxes(-1, -2),
        free,
        constraints.scale,
        constraints.unit,
    )


def solve_least_energy(allowed: AllowedMotions, M: Array, b: Array, p: Array, name: str) -> Array:
    """The x (..., n) with K x = b (..., r) that makes ½ xᵀ M x − pᵀ x least; see the head of this file.

    p (..., n). name: of the robot. Raises InputError where an allowed motion has no kinetic
    energy.
    """
    x = allowed.solve_rates(b)
    G = allowed.find_basis()
    pull = p - np.einsum("...ij,...j->...i", M, x)
    H = G.swapaxes(-1, -2) @ M @ G
    diagonal = np.arange(H.shape[-1])
    own = H[..., diagonal, diagonal]
    largest = own.max(axis=-1, initial=0.0)[..., None]
    H[..., diagonal, diagonal] += np.where(allowed.free, 0.0, np.where(largest > 0.0, largest, 1.0))
    try:
        L = np.linalg.cholesky(H)
        left = L[..., diagonal, diagonal] ** 2
        is_regular = bool((left > SINGULAR_INERTIA * H[..., diagonal, diagonal]).all())
    except np.linalg.LinAlgError:
        is_regular = False
    if not is_regular:
        raise InputError(
            f"a motion that the loops of {name} allow moves no inertia; give its links a mass or a joint an"
            " armature"
        )
    y = np.linalg.solve(H, np.einsum("...ij,...i->...j", G, pull)[..., None])
    result: Array = x + (G @ y)[..., 0]
    return result
