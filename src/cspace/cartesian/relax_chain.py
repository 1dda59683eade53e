"""The chain of configurations of least motion along a Cartesian path: Gauss-Newton in the null spaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.kinematics import KinematicModel
from cspace.model import Limits
from cspace.spatial import log_so3
from cspace.tolerances import CHAIN_AT_LIMIT, CHAIN_CORRECTION, CHAIN_HELD, CHAIN_RELAXED

ROUNDS: Final = 20
"""Of Gauss-Newton: chains beside singular configurations take most, others two to five."""

LONGEST_STEP: Final = 0.5
"""[rad or m] Of a joint in a round: farther off the equations are others."""

LEAST_SHARE: Final = 0.02
"""Of a step that is taken although a limit is near: the correction of another station is not held up."""

KEPT_ROOM: Final = 0.9
"""Of the distance from a limit that a step may take."""

DECREASE: Final = 0.9
"""Of the longest step from one round to the next; where it is less, damping grows."""

DAMPING_GROWTH: Final = 4.0
"""And where it is more, damping is divided by this."""

LEAST_DAMPING: Final = 0.1
"""Share of the stiffness of the chain, once there is any."""

LIMIT_WEIGHT: Final = 0.02
"""Of x²/(1 − x²), x the distance from the middle of the limits in half ranges, against joints that move by 1
rad per unit of the path: it keeps joints off their limits and does not turn them elsewhere."""


@dataclass(frozen=True, eq=False)
class ChainMotion:
    """The motion of a chain of configurations q (n, dof) of poses T (n, 4, 4) at parameters s (n,):

    Σ w · (q_{k+1} − q_k)² / (s_{k+1} − s_k), and the distance from the middle of the limits.

    freedom: how many dimensions a pose leaves free. weights (dof,): of the joints.
    """

    robot: KinematicModel
    s: Array
    T: Array
    freedom: int
    weights: Array
    bounds: Limits

    def relax(self, q: Array, *, keeps_start: bool) -> Array:
        """The chain (n, dof) of least motion near a chain; keeps_start: its first row stays as it is."""
        limited, first = self._find_limited(q), int(keeps_start)
        damping, longest = 0.0, np.inf
        for _ in range(ROUNDS):
            correction, null = self._linearise(q)
            correction[:first] = 0.0
            inner = self._solve(q, correction, null, limited, first, damping)
            step = correction + np.einsum("ka,kaj->kj", inner, null)
            q = q + self._shorten(q, step, limited) * step
            size = float(np.abs(step).max())
            if not size > CHAIN_RELAXED:
                break
            grows = size > DECREASE * longest
            damping = max(DAMPING_GROWTH * damping, LEAST_DAMPING) if grows else damping / DAMPING_GROWTH
            longest = size
        return q

    def _find_limited(self, q: Array) -> NDArray[np.bool_]:
        """The joints (dof,) with two limits that the chain keeps."""
        lower, upper = self.bounds.lower, self.bounds.upper
        keeps = (q >= lower).all(axis=0) & (q <= upper).all(axis=0)
        return np.asarray(keeps & np.isfinite(lower) & np.isfinite(upper) & (upper > lower))

    def _linearise(self, q: Array) -> tuple[Array, Array]:
        """The least steps (n, dof) onto the poses, and bases (n, freedom, dof) of the null spaces."""
        reached, J = self.robot.fk_jacobian(q)
        turned = log_so3(self.T[:, :3, :3] @ np.swapaxes(reached[:, :3, :3], 1, 2))
        error = np.concatenate([self.T[:, :3, 3] - reached[:, :3, 3], turned], axis=1)
        left, sizes, right = np.linalg.svd(J)
        rank = self.robot.dof - self.freedom
        sizes = sizes[:, :rank]
        parts = np.einsum("kij,ki->kj", left[:, :, :rank], error) * sizes / (sizes**2 + CHAIN_CORRECTION**2)
        return np.einsum("kj,kji->ki", parts, right[:, :rank]), right[:, rank:]

    def _solve(
        self,
        q: Array,
        correction: Array,
        null: Array,
        limited: NDArray[np.bool_],
        first: int,
        damping: float,
    ) -> Array:
        """The coordinates (n, freedom) of the step in the null spaces, by which the motion is least; none of
        the stations before the first. damping: share of the stiffness that holds the chain (Marquardt)."""
        pace = 1.0 / np.diff(self.s)
        share = np.zeros(len(q))  # of the path, around each station
        share[1:] += 0.5 / pace
        share[:-1] += 0.5 / pace
        slope, bend = self._differentiate_limits(q, limited)
        pull = self.weights * np.diff(q + correction, axis=0) * pace[:, None]
        gradient = 0.5 * share[:, None] * (slope + bend * correction)
        gradient[1:] += pull
        gradient[:-1] -= pull
        stiffness = np.zeros(len(q))
        stiffness[1:] += pace
        stiffness[:-1] += pace
        diagonal = (1.0 + CHAIN_HELD + damping) * self.weights * stiffness[:, None] + 0.5 * share[
            :, None
        ] * bend
        blocks = np.einsum("kai,ki,kbi->kab", null, diagonal, null)
        beside = -np.einsum("kai,i,kbi->kab", null[:-1], self.weights, null[1:]) * pace[:, None, None]
        inner: Array = -np.einsum("kai,ki->ka", null, gradient)
        inner[:first] = 0.0
        inner[first:] = solve_block_tridiagonal(blocks[first:], beside[first:], inner[first:])
        return inner

    def _differentiate_limits(self, q: Array, limited: NDArray[np.bool_]) -> tuple[Array, Array]:
        """The first two derivatives (n, dof) of the cost of the distance from the middle of the limits."""
        lower, upper = np.where(limited, self.bounds.lower, -1.0), np.where(limited, self.bounds.upper, 1.0)
        half = 0.5 * (upper - lower)
        x = np.where(limited, (q - lower) / half - 1.0, 0.0)
        most = 1.0 + CHAIN_AT_LIMIT
        room = most - np.minimum(x**2, 1.0)
        weight = np.where(limited, 2.0 * LIMIT_WEIGHT * most, 0.0) / half
        return weight * x / room**2, weight / half * (most + 3.0 * x**2) / room**3

    def _shorten(self, q: Array, step: Array, limited: NDArray[np.bool_]) -> float:
        """The share of a step that is taken."""
        room = np.where(step > 0.0, self.bounds.upper - q, q - self.bounds.lower)[:, limited]
        size = np.abs(step[:, limited])
        near = KEPT_ROOM * np.maximum(room, 0.0)[size > 0.0] / size[size > 0.0]
        far = LONGEST_STEP / max(float(np.abs(step).max()), LONGEST_STEP)
        return min(far, max(float(near.min(initial=1.0)), LEAST_SHARE))


def solve_block_tridiagonal(blocks: Array, beside: Array, right: Array) -> Array:
    """x (n, k) of the symmetric system with blocks (n, k, k) on the diagonal and (n − 1, k, k) above it, by
    cyclic reduction: every other row is eliminated (Golub and Van Loan 2013, section 4.5)."""
    if len(blocks) == 1 or not right.shape[1]:
        return np.asarray(np.linalg.solve(blocks, right[..., None])[..., 0])
    k, odd = right.shape[1], len(blocks) // 2
    before, behind = beside[0::2], beside[1::2]  # of the odd rows
    padded = np.zeros((odd, k, k))
    padded[: len(behind)] = behind
    sides = [np.swapaxes(before, 1, 2), padded, right[1::2, :, None]]
    parts = np.linalg.solve(blocks[1::2], np.concatenate(sides, axis=2))
    kept, rest = blocks[0::2].copy(), right[0::2].copy()
    along = before @ parts
    back = np.swapaxes(behind, 1, 2) @ parts[: len(behind)]
    kept[:odd] -= along[..., :k]
    rest[:odd] -= along[..., -1]
    kept[1:] -= back[..., k : 2 * k]
    rest[1:] -= back[..., -1]
    x = np.empty_like(right)
    x[0::2] = even = solve_block_tridiagonal(kept, -along[: len(behind), :, k : 2 * k], rest)
    x[1::2] = parts[..., -1] - np.einsum("nij,nj->ni", parts[..., :k], even[:odd])
    x[1::2][: len(behind)] -= np.einsum("nij,nj->ni", parts[: len(behind), :, k : 2 * k], even[1:])
    return x
