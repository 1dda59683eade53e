"""CartesianPath: the pose of a tip along a path, with its first two derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace._core import cartesian_poses, cartesian_twists
from cspace.arrays import Array, as_floats, one_number
from cspace.errors import InputError, InputTypeError
from cspace.tables import count_things, one_line
from cspace.tolerances import TIME_ROUNDING

DEGREE: Final = 5
"""Of the polynomials of a piece."""

PIECE_FIELDS: Final = ("point", "turn", "R", "axis", "rate", "arm")
"""Of a piece, as the core reads them."""

Indices: TypeAlias = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class CartesianPiece:
    """A stretch of a path over its parameter s from 0 to `length`.

    The point is p(s) = Σ point_k sᵏ + (Rot(axis, rate s) − 1) arm, and the rotation exp(Σ turn_k sᵏ) R:
    polynomials for lines and blends, the rotating arm, from the axis to the point at s = 0, for arcs and
    screws.

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
        self._pieces: Any = tuple(
            np.array([getattr(piece, name) for piece in pieces], dtype=float) for name in PIECE_FIELDS
        )

    @property
    def length(self) -> float:
        """The largest value of s."""
        return float(self.breaks[-1])

    def part(self, end: float) -> CartesianPath:
        """The path up to the parameter `end`, above 0. Raises InputError for one that is not on the path."""
        piece, u, _ = self._locate(one_number(end, "end"))
        if not end > 0.0:
            raise InputError(f"end is {end:g}; a part of a path needs a length")
        last = int(piece[0]) if u[0] > 0.0 else int(piece[0]) - 1
        made = CartesianPath.__new__(CartesianPath)
        made.lengths = self.lengths[: last + 1].copy()
        made.lengths[last] = end - self.breaks[last]
        made.breaks = np.append(self.breaks[: last + 1], end)
        made.stops = self.stops[self.stops < end]
        made._pieces = tuple(rows[: last + 1] for rows in self._pieces)
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
        return cartesian_poses(self._pieces, np.ascontiguousarray(piece, dtype=np.int64), u)

    def twists_on(self, piece: Indices, u: Array) -> tuple[Array, Array]:
        """As twists, of pieces (n,) at u (n,) from their begin: two arrays (n, 6)."""
        return cartesian_twists(self._pieces, np.ascontiguousarray(piece, dtype=np.int64), u)

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


def stay_at(T: Array) -> CartesianPath:
    """A path of no length at a pose (4, 4)."""
    point = np.zeros((DEGREE + 1, 3))
    point[0] = T[:3, 3]
    zero = np.zeros(3)
    axis = np.array([0.0, 0.0, 1.0])
    return CartesianPath([CartesianPiece(0.0, point, 0.0 * point, T[:3, :3], axis, 0.0, zero)])


def check_cartesian_path(path: object) -> None:
    """Raises InputTypeError for another object, such as an array of poses."""
    if not isinstance(path, CartesianPath):
        raise InputTypeError(
            f"path is a {type(path).__name__}; make a CartesianPath by line_path, arc_path, screw_path or"
            " pose_path"
        )
