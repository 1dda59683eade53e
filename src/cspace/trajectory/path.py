"""Path: pieces of polynomials in each joint over a common parameter."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import comb
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace._core import evaluate_path, examine_path
from cspace.arrays import Array, as_floats, one_number, whole_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.model.values import freeze_array
from cspace.tables import count_things, one_line, shown, tabulate
from cspace.tolerances import (
    FARTHEST_WAYPOINT,
    PATH_CORNER,
    SAME_WAYPOINT,
    SHORTEST_PIECE,
    STILL_JOINT,
    TIME_ROUNDING,
)
from cspace.trajectory.piece_roots import find_piece_roots

HIGHEST_DEGREE: Final = 5
"""Of the pieces of a path: quintic pieces attain any position, slope and curvature at both ends."""

HIGHEST_ORDER: Final = 3
"""Of the derivatives of a path: a trajectory along it has jerks."""

TURNS: Final = 1 | 1 << 2
"""Of the flags of a break: the slopes beside it vanish and the second derivative jumps."""


@tabulate("dof", "degree", "length", "start", "end", "stops")
class Path:
    """A path of joints: q(s) for 0 ≤ s ≤ length, in pieces of polynomials of degree 5 at most.

    breaks (k + 1,): parameters at which pieces begin and end, from 0 on. control_points (k, degree + 1, dof)
    [rad or m]: Bernstein coefficients of the pieces; their hull contains the piece. stops (m,): breaks inside
    at which the slope jumps, so that a motion has to stand there. remarks: what its maker reports.

    The parameter of the makers of this package is close to the length of the path in joint space.
    Raises InputError for wrong shapes, NaN, breaks that do not increase from 0, and pieces that do not meet.
    """

    def __init__(self, breaks: ArrayLike, control_points: ArrayLike, *, remarks: Sequence[str] = ()) -> None:
        b = as_floats(breaks, "breaks", largest=FARTHEST_WAYPOINT)
        c = as_floats(control_points, "control_points", largest=FARTHEST_WAYPOINT)
        if c.ndim != 3 or not 2 <= c.shape[1] <= HIGHEST_DEGREE + 1 or b.shape != (len(c) + 1,) or not c.size:
            raise InputError(
                f"breaks has shape {b.shape}, control_points {c.shape}; expected (k + 1,) and"
                f" (k, degree + 1, dof) with a degree from 1 to {HIGHEST_DEGREE}"
            )
        self.lengths: Array = freeze_array(np.diff(b))
        """The lengths (k,) of the parameter of the pieces."""
        shortest = float(self.lengths.min())
        if b[0] != 0.0 or not shortest > 0.0:
            raise InputError("breaks must begin at 0 and increase")
        if shortest < SHORTEST_PIECE:
            raise InputError(f"a piece of the path has length {shortest:g}; the least is {SHORTEST_PIECE:g}")
        self.breaks = freeze_array(np.array(b))
        self.control_points = freeze_array(np.array(c, order="C"))
        if isinstance(remarks, str) or not isinstance(remarks, Sequence):
            raise InputTypeError(f"remarks is {name_type(remarks)}; give a list of texts")
        self.remarks = tuple(remarks)
        gap, width, self._events, moving = examine_path(
            self.control_points, self.lengths, SAME_WAYPOINT, PATH_CORNER, STILL_JOINT
        )
        if gap:
            raise InputError(
                f"the path jumps by {width:.3g} at s = {b[gap]:.6g};"
                " each piece must begin where the last one ends"
            )
        self.moving: npt.NDArray[np.bool_] = moving.view(np.bool_)
        """Which joints move on which piece (k, dof)."""

    @classmethod
    def from_coefficients(cls, breaks: ArrayLike, coefficients: ArrayLike) -> Path:
        """The path with powers Σᵢ cᵢ (s − breaks[k])ⁱ on piece k.

        breaks (k + 1,), coefficients (k, degree + 1, dof). Raises InputError as the class does.
        """
        b, c = as_floats(breaks, "breaks"), as_floats(coefficients, "coefficients")
        if c.ndim != 3 or b.shape != (len(c) + 1,):
            raise InputError(
                f"breaks has shape {b.shape}, coefficients {c.shape};"
                " expected (k + 1,) and (k, degree + 1, dof)"
            )
        degree = c.shape[1] - 1
        scaled = c * np.diff(b)[:, None, None] ** np.arange(degree + 1.0)[:, None]
        return cls(b, np.einsum("ji,kin->kjn", _powers_to_bernstein(degree), scaled))

    @property
    def degree(self) -> int:
        """The degree of the pieces."""
        return int(self.control_points.shape[1]) - 1

    @property
    def dof(self) -> int:
        """The number of joints."""
        return int(self.control_points.shape[2])

    @property
    def length(self) -> float:
        """The last value of the parameter."""
        return float(self.breaks[-1])

    @property
    def start(self) -> Array:
        """The first configuration (dof,)."""
        return np.asarray(self.control_points[0, 0])

    @property
    def end(self) -> Array:
        """The last configuration (dof,)."""
        return np.asarray(self.control_points[-1, -1])

    @cached_property
    def coefficients(self) -> Array:
        """Coefficients (k, degree + 1, dof) of powers of s − breaks[k]."""
        scaled = np.einsum(
            "ij,kjn->kin", np.linalg.inv(_powers_to_bernstein(self.degree)), self.control_points
        )
        return freeze_array(scaled / self.lengths[:, None, None] ** np.arange(self.degree + 1.0)[:, None])

    @cached_property
    def _derivatives(self) -> list[Array]:
        """The control points of the derivatives, by order."""
        made = [self.control_points]
        for order in range(HIGHEST_ORDER):
            last = made[-1]
            if last.shape[1] == 1:
                made.append(np.zeros_like(last))
                continue
            scale = (self.degree - order) / self.lengths
            made.append(np.diff(last, axis=1) * scale[:, None, None])
        return made

    @cached_property
    def stops(self) -> Array:
        """Breaks (m,) inside the path at which the slope jumps."""
        return freeze_array(self.breaks[self.stop_flags == 1])

    @cached_property
    def stop_flags(self) -> npt.NDArray[np.int8]:
        """1 at the breaks (k + 1,) that are stops, else 0, as the core reads them."""
        flags = self._events >> 1 & 1
        flags.flags.writeable = False
        return flags

    @cached_property
    def turning_places(self) -> Array:
        """Breaks (m,) inside at which the slope of all joints vanishes and the second derivative jumps."""
        return freeze_array(self.breaks[(self._events & TURNS) == TURNS])

    @cached_property
    def continuity(self) -> int:
        """The highest order up to which no derivative jumps: 0 if slopes do, 1 if second derivatives do."""
        found = int(np.bitwise_or.reduce(self._events))
        return next((order - 1 for order in range(1, HIGHEST_ORDER + 1) if found >> order & 1), 3)

    def jumps(self, order: int) -> npt.NDArray[np.bool_]:
        """At which breaks (k + 1,) derivative `order` jumps."""
        return (self._events & 1 << order) > 0

    def __call__(self, s: ArrayLike, order: int = 0) -> Array:
        """The configurations or a derivative by s (..., dof) at parameters s (...).

        order: 0 to 3. Where a derivative jumps, it is that of the later piece.
        Raises InputError for a parameter outside of 0 … length, and for another order.
        """
        order = whole_number(order, "order", 0, HIGHEST_ORDER)
        given = as_floats(s, "s")
        slack = TIME_ROUNDING * self.length
        outside = (given < -slack) | (given > self.length + slack)
        if outside.any():
            raise InputError(
                f"s is {float(given[outside].flat[0]):.9g}; the path is from 0 to {self.length:.9g}"
            )
        flat = np.clip(given.ravel(), 0.0, self.length)
        piece = np.searchsorted(self.breaks[1:-1], flat, side="right")
        local = (flat - self.breaks[piece]) / self.lengths[piece]
        return self.evaluate_pieces(piece, local, order).reshape((*given.shape, self.dof))

    def evaluate_pieces(self, piece: Any, local: Array, order: int = 0) -> Array:
        """A derivative (m, dof) of pieces (m,) at places (m,) within them, in [0, 1]: Σ Bᵢ(t) cᵢ."""
        control = self._derivatives[order]
        degree = control.shape[1] - 1
        points = control.take(piece, axis=0)
        if degree == 0:
            return np.asarray(points[:, 0])
        rest = 1.0 - local
        weights = np.empty((len(local), degree + 1))
        weights[:, 0] = 1.0
        for i in range(1, degree + 1):  # from those of degree i − 1 to those of degree i
            weights[:, i] = local * weights[:, i - 1]
            for k in range(i - 1, 0, -1):
                weights[:, k] = rest * weights[:, k] + local * weights[:, k - 1]
            weights[:, 0] *= rest
        return np.asarray(np.einsum("mi,mij->mj", weights, points))

    def evaluate_motion(self, piece: Any, local: Array) -> tuple[Array, Array, Array]:
        """Configurations (m, dof) and their first two derivatives, as of evaluate_pieces."""
        pieces = np.ascontiguousarray(piece, dtype=np.int32)
        return evaluate_path(self.control_points, self.lengths, self.stop_flags, pieces, local)

    def slope_controls(self, piece: Any, begin: Array, end: Array) -> Array:
        """Bernstein coefficients (k, degree, dof) of the slope on parts [begin, end] of pieces (k,)."""
        return restrict_pieces(self._derivatives[1][piece], begin, end)

    @cached_property
    def excursion(self) -> Array:
        """How far each joint leaves the range between the ends of a piece, at most (dof,) [rad or m]."""
        c = self.coefficients.transpose(0, 2, 1)
        rates = c[..., 1:] * np.arange(1.0, self.degree + 1.0)
        flat = rates.reshape(-1, self.degree)
        h = np.repeat(self.lengths, self.dof)
        roots = find_piece_roots(flat, np.zeros_like(h), h).reshape(*c.shape[:2], -1)
        ends = self.control_points[:, [0, -1]]
        low, high = ends.min(axis=1), ends.max(axis=1)
        most = np.zeros(self.dof)
        for k in range(roots.shape[-1]):
            s = np.where(np.isnan(roots[..., k]), 0.0, roots[..., k])
            q = sum(c[..., i] * s**i for i in range(self.degree + 1))
            most = np.maximum(most, np.maximum(q - high, low - q).max(axis=0))
        return freeze_array(most)

    @cached_property
    def always_moves(self) -> bool:
        """Whether every joint moves on every piece."""
        return bool(self.moving.all())

    @cached_property
    def _hull(self) -> tuple[Array, Array]:
        """The least and the largest control values (dof,): the path lies between them."""
        return self.control_points.min(axis=(0, 1)), self.control_points.max(axis=(0, 1))

    def first_beyond(self, lower: Array, upper: Array) -> tuple[int, float, float] | None:
        """The joint, the place s and the value where the path is first beyond bounds (dof,), if it is.

        Of the places where a joint is farthest out on a piece, so that none is missed.
        """
        control = self.control_points
        outside = (control.min(axis=1) < lower) | (control.max(axis=1) > upper)
        if not outside.any():
            return None
        piece, joint = np.nonzero(outside)
        c = self.coefficients[piece, :, joint]
        h = self.lengths[piece]
        roots = find_piece_roots(c[:, 1:] * np.arange(1.0, self.degree + 1.0), np.zeros_like(h), h)
        places = np.concatenate([np.zeros((len(h), 1)), h[:, None], roots], axis=1)
        local = np.where(np.isnan(places), 0.0, places)
        values = np.sum(c[:, None, :] * local[..., None] ** np.arange(self.degree + 1.0), axis=2)
        beyond = (values < lower[joint, None]) | (values > upper[joint, None])
        s = np.where(beyond, self.breaks[piece, None] + local, np.inf)
        at = np.unravel_index(int(np.argmin(s)), s.shape)
        return (int(joint[at[0]]), float(s[at]), float(values[at])) if beyond.any() else None

    def part(self, end: float) -> Path:
        """The path up to the parameter `end`. Raises InputError for one that is not above 0 or not on it."""
        end = one_number(end, "end")
        if not 0.0 < end <= self.length:
            raise InputError(f"end is {end:g}; it must be above 0 and at most {self.length:g}")
        last = int(np.searchsorted(self.breaks, end)) - 1
        control = np.array(self.control_points[: last + 1])
        share = np.array([(end - self.breaks[last]) / self.lengths[last]])
        control[last:] = restrict_pieces(control[last:], np.zeros(1), share)
        return Path(np.append(self.breaks[: last + 1], end), control, remarks=self.remarks)

    def reversed(self) -> Path:
        """The same path from its end to its start."""
        breaks = self.length - self.breaks[::-1]
        breaks[0] = 0.0
        return Path(breaks, self.control_points[::-1, ::-1], remarks=self.remarks)

    def __len__(self) -> int:
        """The number of pieces."""
        return len(self.control_points)

    def __repr__(self) -> str:
        pieces = count_things(len(self), "piece")
        text = f"of {count_things(self.dof, 'joint')}, {pieces} of degree {self.degree}"
        text += f", length {shown(self.length)}"
        if self.stops.size:
            text += f", {count_things(self.stops.size, 'stop')}"
        return one_line("Path", text)


def _powers_to_bernstein(degree: int) -> Array:
    """The matrix from coefficients of powers on [0, 1] to those of Bernstein polynomials."""
    return np.array(
        [
            [comb(j, i) / comb(degree, i) if i <= j else 0.0 for i in range(degree + 1)]
            for j in range(degree + 1)
        ]
    )


def raise_degree(control_points: Array, degree: int) -> Array:
    """The same pieces (k, degree + 1, dof) by control points of a higher degree."""
    while (own := control_points.shape[1] - 1) < degree:
        share = np.arange(own + 2.0)[:, None] / (own + 1)
        padded = np.pad(control_points, ((0, 0), (1, 1), (0, 0)))
        control_points = share * padded[:, :-1] + (1.0 - share) * padded[:, 1:]
    return control_points


def restrict_pieces(control_points: Array, begin: Array, end: Array) -> Array:
    """Control points (k, degree + 1, dof) of parts [begin, end] of pieces, by two subdivisions."""
    made = np.array(control_points)
    degree = made.shape[1] - 1
    t = end[:, None, None]
    for level in range(1, degree + 1):
        made[:, level:] = made[:, level - 1 : -1] + t * (made[:, level:] - made[:, level - 1 : -1])
    t = (begin / end)[:, None, None]
    for level in range(1, degree + 1):
        kept = degree + 1 - level
        made[:, :kept] = made[:, :kept] + t * (made[:, 1 : kept + 1] - made[:, :kept])
    return made


def hermite_quintics(h: Array, q: Array, slope: Array, bend: Array) -> Array:
    """Control points (k, 6, dof) of pieces of lengths h (k,) with values (k + 1, dof) at their ends."""
    h = h[:, None]
    a, b = q[:-1], q[1:]
    control = [
        a,
        a + h / 5.0 * slope[:-1],
        a + 2.0 * h / 5.0 * slope[:-1] + h * h / 20.0 * bend[:-1],
        b - 2.0 * h / 5.0 * slope[1:] + h * h / 20.0 * bend[1:],
        b - h / 5.0 * slope[1:],
        b,
    ]
    return np.stack(control, axis=1)
