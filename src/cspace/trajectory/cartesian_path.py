"""CartesianPath: the pose of a tip along a path, with its first two derivatives."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace._core import cartesian_poses, cartesian_twists
from cspace.arrays import Array, as_floats, one_array, one_number
from cspace.errors import InputError, InputTypeError, check_kind, name_type
from cspace.spatial import as_rotation
from cspace.tables import count_things, one_line, show_fields, tabulate
from cspace.tolerances import FARTHEST, TIME_ROUNDING

DEGREE: Final = 5
"""Of the polynomials of a piece."""

PIECE_FIELDS: Final = {
    "point": (DEGREE + 1, 3),
    "turn": (DEGREE + 1, 3),
    "R": (3, 3),
    "axis": (3,),
    "rate": (),
    "arm": (3,),
}
"""Of a piece, as the core reads them, and their shapes."""

Indices: TypeAlias = NDArray[np.intp]


@show_fields
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


@tabulate("lengths", "length")
class CartesianPath:
    """The pose of a tip along a path, in the base; a call gives poses.

    s is the way of the point [m], or where the tip turns faster, its angle [rad]: per unit of s the point
    moves by at most 1 m and the tip turns by at most 1 rad, in blends up to 1.4 times as much. length: of the
    whole path, in units of s. breaks (k + 1,): where pieces meet. stops: values of s at which the direction
    of the path jumps, so that a motion has to stop there; the ends are not among them.

    Raises InputError for no pieces, for fields of pieces that are not finite or have other shapes, and for
    stops that are not on the path.
    """

    def __init__(self, pieces: Sequence[CartesianPiece], stops: ArrayLike = ()) -> None:
        pieces = _read_pieces(pieces)
        self.lengths: Array = _read_field(pieces, "length", ())
        if (self.lengths < 0.0).any():
            raise InputError(f"length of a piece is {self.lengths.min():g}; it must not be negative")
        self.breaks: Array = np.concatenate([[0.0], np.cumsum(self.lengths)])
        self.stops: Array = one_array(stops, "stops", (None,), "values of s", largest=FARTHEST)
        beyond = (self.stops < 0.0) | (self.stops > self.length)
        if beyond.any():
            raise InputError(
                f"stops contains {self.stops[beyond][0]:.9g}; the path is from 0 to {self.length:.9g}"
            )
        self._pieces: Any = tuple(_read_field(pieces, *field) for field in PIECE_FIELDS.items())
        as_rotation(self._pieces[2], "R of the pieces")

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


def _read_pieces(pieces: Sequence[CartesianPiece]) -> tuple[CartesianPiece, ...]:
    """At least one piece; InputTypeError for other objects."""
    rule = "give a sequence of CartesianPiece, or make a path by line_path, arc_path, screw_path or pose_path"
    if not isinstance(pieces, Iterable):
        raise InputTypeError(f"pieces is {name_type(pieces)}; {rule}")
    read = tuple(pieces)
    for k, piece in enumerate(read):
        check_kind(f"piece {k} of the path", piece, CartesianPiece, rule)
    if not read:
        raise InputError(f"pieces is empty; a path has one or more: {rule}")
    return read


def _read_field(pieces: tuple[CartesianPiece, ...], name: str, shape: tuple[int, ...]) -> Array:
    """A field of all pieces as one array (k, *shape); InputError names the piece that does not fit."""
    rows = np.empty((len(pieces), *shape))
    for k, piece in enumerate(pieces):
        value = getattr(piece, name)
        plain = type(value) is np.ndarray and value.dtype == np.float64 and value.shape == shape
        rows[k] = value if plain else one_array(value, f"{name} of piece {k}", shape).reshape(shape)
    return as_floats(rows, f"{name} of the pieces", largest=FARTHEST)


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
            f"path is {name_type(path)}; make a CartesianPath by line_path, arc_path, screw_path or pose_path"
        )
