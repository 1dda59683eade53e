"""CartesianPath: the pose of a tip along a path, with its first two derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError
from cspace.spatial import exp_so3
from cspace.spatial.vectors import cross
from cspace.tables import count_things, one_line
from cspace.tolerances import TIME_ROUNDING
from cspace.trajectory.rotation_rates import angular_rates

DEGREE: Final = 5
"""Of the polynomials of a piece."""

Indices: TypeAlias = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class CartesianPiece:
    """A stretch of a path over its parameter s from 0 to `length`.

    The point is p(s) = Σ point_k sᵏ + Rot(axis, rate s) arm, and the rotation exp(Σ turn_k sᵏ) R: polynomials
    for lines and blends, the rotating arm for arcs and screws.

    point, turn (6, 3); axis (3,), a unit vector; rate [rad per unit of s]; arm (3,) [m]; R (3, 3).
    """

    length: float
    point: Array
    turn: Array
    R: Array
    axis: Array
    rate: float
    arm: Array


class CartesianPath:
    """The pose of a tip along a path, in the base; a call gives poses.

    s is the way of the point [m], or where the tip turns faster, its angle [rad]: per unit of s the point
    moves by at most 1 m and the tip turns by at most 1 rad, in blends up to 1.4 times as much. length: of the
    whole path, in units of s. breaks (k + 1,): where pieces meet. stops: values of s at which the direction
    of the path jumps, so that a motion has to stop there; the ends are not among them.
    """

    def __init__(self, pieces: Sequence[CartesianPiece], stops: Sequence[float] = ()) -> None:
        self.lengths: Array = np.array([piece.length for piece in pieces])
        self.breaks: Array = np.concatenate([[0.0], np.cumsum(self.lengths)])
        self.stops: Array = np.array(stops, dtype=float)
        self._point = _derivatives(np.array([piece.point for piece in pieces]))
        self._turn = _derivatives(np.array([piece.turn for piece in pieces]))
        self._R = np.array([piece.R for piece in pieces])
        self._axis = np.array([piece.axis for piece in pieces])
        self._rate = np.array([piece.rate for piece in pieces])
        self._arm = np.array([piece.arm for piece in pieces])

    @property
    def length(self) -> float:
        """The largest value of s."""
        return float(self.breaks[-1])

    def part(self, end: float) -> CartesianPath:
        """The path up to the parameter `end`, above 0. Raises InputError for one that is not on the path."""
        piece, u, _ = self._locate(end)
        if not end > 0.0:
            raise InputError(f"end is {end:g}; a part of a path needs a length")
        last = int(piece[0]) if u[0] > 0.0 else int(piece[0]) - 1
        made = CartesianPath.__new__(CartesianPath)
        made.lengths = self.lengths[: last + 1].copy()
        made.lengths[last] = end - self.breaks[last]
        made.breaks = np.append(self.breaks[: last + 1], end)
        made.stops = self.stops[self.stops < end]
        made._point, made._turn = ([row[:, : last + 1] for row in rows] for rows in (self._point, self._turn))
        made._R, made._axis, made._rate, made._arm = (
            row[: last + 1] for row in (self._R, self._axis, self._rate, self._arm)
        )
        return made

    def __repr__(self) -> str:
        return one_line(
            type(self).__name__, f"{count_things(len(self.lengths), 'piece')}, length {self.length:.4g}"
        )

    def __call__(self, s: ArrayLike) -> Array:
        """The poses (..., 4, 4) at s (...). Raises InputError for s outside of 0 … length."""
        piece, u, shape = self._locate(s)
        return self.poses_on(piece, u).reshape((*shape, 4, 4))

    def twists(self, s: ArrayLike) -> tuple[Array, Array]:
        """The first and second derivative of the pose by s, as [v; ω] in base axes at the tip (..., 6).

        v is the derivative of the origin of the tip, ω its angular velocity per unit of s. The second is the
        derivative of the first. Where it jumps, it is that of the later piece.
        """
        piece, u, shape = self._locate(s)
        first, second = self.twists_on(piece, u)
        return first.reshape((*shape, 6)), second.reshape((*shape, 6))

    def poses_on(self, piece: Indices, u: Array) -> Array:
        """The poses (n, 4, 4) of pieces (n,) at u (n,) from their begin."""
        T = np.zeros((len(u), 4, 4))
        T[:, :3, :3] = exp_so3(_evaluate(self._turn[0], piece, u)) @ self._R[piece]
        T[:, :3, 3] = _evaluate(self._point[0], piece, u) + self._rotated_arm(piece, u)
        T[:, 3, 3] = 1.0
        return T

    def twists_on(self, piece: Indices, u: Array) -> tuple[Array, Array]:
        """As twists, of pieces (n,) at u (n,) from their begin: two arrays (n, 6)."""
        first, second = np.empty((2, len(u), 6))
        spin = self._rate[piece, None] * self._axis[piece]
        around = cross(spin, self._rotated_arm(piece, u))
        first[:, :3] = _evaluate(self._point[1], piece, u) + around
        second[:, :3] = _evaluate(self._point[2], piece, u) + cross(spin, around)
        turn = [_evaluate(turn, piece, u) for turn in self._turn]
        first[:, 3:], second[:, 3:] = angular_rates(*turn)
        return first, second

    def _locate(self, s: ArrayLike) -> tuple[Indices, Array, tuple[int, ...]]:
        """The piece of each parameter, how far into it, and the shape of s."""
        values = as_floats(s, "s")
        slack = TIME_ROUNDING * self.length
        outside = (values < -slack) | (values > self.length + slack)
        if outside.any():
            raise InputError(
                f"s is {float(values[outside].flat[0]):.9g}; the path is from 0 to {self.length:.9g}"
            )
        flat = np.clip(values, 0.0, self.length).ravel()
        piece = np.clip(np.searchsorted(self.breaks, flat, side="right") - 1, 0, len(self.lengths) - 1)
        return piece, flat - self.breaks[piece], values.shape

    def _rotated_arm(self, piece: Indices, u: Array) -> Array:
        return _rotate(self._axis[piece], self._rate[piece] * u, self._arm[piece])


def stay_at(T: Array) -> CartesianPath:
    """A path of no length at a pose (4, 4)."""
    point = np.zeros((DEGREE + 1, 3))
    point[0] = T[:3, 3]
    zero = np.zeros(3)
    axis = np.array([0.0, 0.0, 1.0])
    return CartesianPath([CartesianPiece(0.0, point, 0.0 * point, T[:3, :3], axis, 0.0, zero)])


def _rotate(axis: Array, angle: Array, arm: Array) -> Array:
    """Arms (n, 3) turned about unit axes (n, 3) by angles (n,): Rodrigues' formula."""
    across = cross(axis, arm)
    along = np.sum(axis * arm, axis=1, keepdims=True) * axis
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.asarray(c * (arm - along) + s * across + along)


def _derivatives(coefficients: Array) -> list[Array]:
    """The coefficients (degree + 1, n, 3) of polynomials (n, 6, 3) and of their first two derivatives."""
    used = np.flatnonzero(coefficients.any(axis=(0, 2)))
    rows = [coefficients.transpose(1, 0, 2)[: used[-1] + 1 if len(used) else 1]]
    for _ in range(2):
        last = rows[-1]
        powers = np.arange(1.0, len(last))[:, None, None]
        rows.append(powers * last[1:] if len(last) > 1 else np.zeros_like(last))
    return [np.ascontiguousarray(row) for row in rows]


def _evaluate(coefficients: Array, piece: Indices, u: Array) -> Array:
    """Polynomials (degree + 1, n, 3) of pieces (m,) at u (m,), by Horner's rule (m, 3)."""
    value: Array = coefficients[-1][piece]
    for row in coefficients[-2::-1]:
        value = value * u[:, None] + row[piece]
    return value


def check_cartesian_path(path: object) -> None:
    """Raises InputTypeError for another object, such as an array of poses."""
    if not isinstance(path, CartesianPath):
        raise InputTypeError(
            f"path is a {type(path).__name__}; make a CartesianPath by line_path, arc_path, screw_path or"
            " pose_path"
        )
