"""A Cartesian path followed by a redundant arm beside a guiding curve in the space of its joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.cartesian.refine import Nodes
from cspace.kinematics import KinematicModel
from cspace.kinematics.jacobian import jacobian_dot
from cspace.spatial.rotations import rotvec_of_matrix
from cspace.tolerances import POSE_ROUNDING
from cspace.trajectory.cartesian_path import CartesianPath, Indices
from cspace.trajectory.path import Path
from cspace.trajectory.splines import quintic_controls

ANCHOR: Final = 1e9
"""Weight of the start in the smoothing: it stays where it is."""

FARTHEST_JOINT: Final = 1e6
"""[rad or m] And per metre: a configuration or a slope that is beyond is lost beside a singular one."""

CORRECTIONS: Final = 12
"""Of Newton's method from the spline between stations."""


def smooth_rows(s: Array, rows: Array, weight: float) -> Path:
    """A smooth curve near rows (n, k) at parameters s (n,), through the first of them (Whittaker 1922).

    weight: of the squared second differences.
    """
    n = len(rows)
    second = np.diff(np.eye(n), 2, axis=0)
    anchor = np.zeros(n)
    anchor[0] = ANCHOR
    matrix = np.eye(n) + np.diag(anchor) + weight * second.T @ second
    smooth = np.asarray(np.linalg.solve(matrix, rows + anchor[:, None] * rows), dtype=np.float64)
    return Path(s, quintic_controls(np.diff(s), smooth, "natural"))


def null_bases(robot: KinematicModel, q: Array, count: int) -> Array:
    """Orthonormal bases (n, count, dof) of the null spaces of the Jacobian along a chain q (n, dof), each
    turned as near to the one before it as it can be (Schönemann 1966)."""
    null: Array = np.linalg.svd(robot.jacobian(q))[2][:, robot.dof - count :]
    if count == 1:
        null[1:] *= np.cumprod(np.where(np.sum(null[1:] * null[:-1], axis=2) < 0, -1.0, 1.0), axis=0)[:, None]
        return null
    for k in range(1, len(null) if count else 0):
        left, _, right = np.linalg.svd(null[k - 1] @ null[k].T)
        null[k] = left @ right @ null[k]
    return null


@dataclass(frozen=True, eq=False)
class Guided:
    """Corrects with d · (q − r) = 0 besides the pose, for a guiding curve r(s) and one or more directions
    d(s), all of them the rows of `curve`."""

    robot: KinematicModel
    path: CartesianPath
    curve: Path

    def guide(self, piece: Indices, u: Array, order: int) -> tuple[Array, Array]:
        """Derivatives of r (n, dof) and of the directions (n, count, dof) of that order."""
        s = np.minimum(self.path.breaks[piece] + u, self.curve.length)
        values = self.curve(s, order).reshape(len(s), -1, self.robot.dof)
        return values[:, 0], values[:, 1:]

    def __call__(self, piece: Indices, u: Array, T: Array, guess: Array) -> Nodes:
        """Newton's method; then J q' = t and J q'' = t' − J' q', with the derivatives of the last row.

        A node that is lost beside a singular configuration is on the guiding curve, with an infinite rest.
        """
        r, d = zip(*(self.guide(piece, u, order) for order in range(3)), strict=True)
        lost = ~_are_usable(guess)
        q = np.where(lost[:, None], r[0], guess)
        left = np.full(len(q), np.inf)
        for _ in range(CORRECTIONS):
            error, left = self._measure_error(q, T)
            if not (left[~lost] > POSE_ROUNDING).any():
                break
            moved = q + self._solve(q, d[0], error, _dot(d[0], r[0] - q))
            lost |= ~_are_usable(moved)
            q = np.where(lost[:, None], r[0], moved)
        twist, rate = self.path.twists_on(piece, u)
        slope = self._solve(q, d[0], twist, _dot(d[0], r[1]) + _dot(d[1], r[0] - q))
        lost |= ~_are_usable(slope)
        slope[lost] = 0.0
        rate = rate - np.einsum("nij,nj->ni", jacobian_dot(self.robot, q, slope), slope)
        last = _dot(d[0], r[2]) + 2 * _dot(d[1], r[1] - slope) + _dot(d[2], r[0] - q)
        bend = self._solve(q, d[0], rate, last)
        bend[lost] = 0.0
        return Nodes(q, slope, bend, np.where(lost, np.inf, left))

    def _solve(self, q: Array, direction: Array, task: Array, last: Array) -> Array:
        """x with J x = task and d · x = last, for each row; NaN where it is singular.

        An arm that cannot move in all six directions is solved by least squares: the path asks for none of
        the others.
        """
        matrix = np.concatenate([self.robot.jacobian(q), direction], axis=1)
        right = np.concatenate([task, last], axis=1)
        if matrix.shape[1] != matrix.shape[2]:
            return np.stack([_solve_least_squares(*row) for row in zip(matrix, right, strict=True)])
        try:
            return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
        except np.linalg.LinAlgError:
            return np.stack([_solve_one(*row) for row in zip(matrix, right, strict=True)])

    def _measure_error(self, q: Array, T: Array) -> tuple[Array, Array]:
        reached = self.robot.fk(q)
        turned = rotvec_of_matrix(T[:, :3, :3] @ np.swapaxes(reached[:, :3, :3], 1, 2))
        error = np.concatenate([T[:, :3, 3] - reached[:, :3, 3], turned], axis=1)
        return error, np.abs(error).max(axis=1)


def _are_usable(rows: Array) -> NDArray[np.bool_]:
    """Which rows (n, dof) are numbers from which there is a way on: beside singular ones they are huge."""
    return np.asarray((np.abs(rows) < FARTHEST_JOINT).all(axis=1))


def _solve_one(matrix: Array, right: Array) -> Array:
    """x with matrix x = right; NaN where it is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        return np.full_like(right, np.nan)


def _solve_least_squares(matrix: Array, right: Array) -> Array:
    """x with matrix x as near to right as it can be; NaN where a number is none."""
    if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
        return np.full(matrix.shape[1], np.nan)
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0])


def _dot(a: Array, b: Array) -> Array:
    """Directions a (n, count, dof) times vectors b (n, dof)."""
    return np.asarray(np.einsum("nij,nj->ni", a, b))
