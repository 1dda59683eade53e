"""Grids of configurations settled by a quadtree: one proof for a square of many cells where it is possible.

A square of cells is a box q ± h of two joints. If every ball of the robot, grown by how far it can move
within the box, touches nothing, all of it is free; if a ball that is smaller by that still touches something,
all of it is blocked. Other squares are cut into four, down to single cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace._core import CollisionChecker
from cspace.arrays import Array, whole_number
from cspace.errors import InputError

Mask = npt.NDArray[np.bool_]
Integers = npt.NDArray[np.int64]

FIRST_SQUARES: Final = 16
"""Squares along the longer side of a grid where its quadtree begins: larger ones are seldom proved."""

ROWS_AT_ONCE: Final = 8192
"""Configurations of one compiled call: some ten milliseconds, between which the clock is read."""

TOUCHES: Final = 1
"""In the verdict on a cell: its middle touches something."""
IS_PROVED: Final = 2
"""In the verdict on a cell: all of it is as its middle."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Equal cells (n1, n2) of two joints, the others held.

    q (dof,) [rad or m]: where the others are held. joints: the two, by number. lower, upper (2,): the range
    of the two. shape: numbers of cells.
    """

    q: Array
    joints: tuple[int, int]
    lower: Array
    upper: Array
    shape: tuple[int, int]

    def coordinates(self, axis: int, place: Any) -> Array:
        """The coordinate at places along an axis, 0 at the lower end and n at the upper one."""
        low, high = float(self.lower[axis]), float(self.upper[axis])
        steps: Array = np.asarray(place, dtype=np.float64)
        return low + (high - low) * steps / self.shape[axis]

    def centers(self) -> tuple[Array, Array]:
        """The coordinates (n1,) and (n2,) of the centres of the cells."""
        first, second = (self.coordinates(axis, np.arange(n) + 0.5) for axis, n in enumerate(self.shape))
        return first, second

    def configurations(self, first: Array, second: Array) -> Array:
        """Configurations (k, dof) with coordinates (k,) of the two joints."""
        rows = np.tile(self.q, (len(first), 1))
        rows[:, self.joints[0]], rows[:, self.joints[1]] = first, second
        return rows

    def half_size(self, size: int) -> Array:
        """Half the side (dof,) of a square of so many cells along each joint: zero for the other joints."""
        half = np.zeros(len(self.q))
        half[list(self.joints)] = 0.5 * size * (self.upper - self.lower) / self.shape
        return half


@dataclass(frozen=True, eq=False)
class JointPair:
    """Two joints of a space, over equal cells: what Slice and Projection have in common; see there."""

    joints: tuple[int, int]
    joint_names: tuple[str, str]
    units: tuple[str, str]
    lower: Array
    upper: Array
    wraps: Mask

    def _grid_of(self, q: Array, shape: tuple[int, ...]) -> Grid:
        """The cells (n1, n2), the other joints held at q (dof,)."""
        return Grid(q, self.joints, self.lower, self.upper, (shape[0], shape[1]))


def count_cells(n: int | Sequence[int], subject: str, most: int) -> tuple[int, int]:
    """The numbers of cells along two joints, from one or two numbers as callers give them."""
    counts: Sequence[int] = (n, n) if np.ndim(n) == 0 else tuple(n)  # type: ignore[arg-type, assignment]
    if len(counts) != 2:
        raise InputError(f"{subject} has {len(counts)} entries; give one number of cells, or two")
    first, second = (whole_number(count, subject, 1, most) for count in counts)
    return first, second


def settle_grid(checker: CollisionChecker, grid: Grid, deadline: float, threads: int) -> tuple[Mask, Mask]:
    """Where a grid is blocked (n1, n2), and where that is proved for the whole cell (n1, n2).

    Cells that are not proved are decided at their centres. After the deadline [s, of perf_counter] no more
    proofs are tried.
    """
    size = first_size(grid.shape)
    padded = tuple(-(-n // size) * size for n in grid.shape)
    blocked, proved = np.zeros(padded, dtype=np.bool_), np.zeros(padded, dtype=np.bool_)
    rows, columns = (index.ravel() for index in np.indices([n // size for n in padded]))
    while len(rows):
        verdicts = check_squares(checker, grid, size, rows, columns, deadline, threads)
        is_proved = verdicts >= IS_PROVED
        is_done = is_proved | (size == 1)
        r, c = rows[is_done], columns[is_done]
        touches = (verdicts[is_done] & TOUCHES).astype(np.bool_)
        squares_of(blocked, size)[r, :, c, :] = touches[:, None, None]
        squares_of(proved, size)[r, :, c, :] = is_proved[is_done][:, None, None]
        size //= 2
        rows, columns = cut_squares(rows[~is_done], columns[~is_done], size, grid.shape)
    n1, n2 = grid.shape
    return np.ascontiguousarray(blocked[:n1, :n2]), np.ascontiguousarray(proved[:n1, :n2])


def first_size(shape: tuple[int, int]) -> int:
    """The side of the first squares, in cells: a power of two."""
    return 1 << max(0, (max(shape) // FIRST_SQUARES).bit_length() - 1)


def squares_of(cells: Mask, size: int) -> Mask:
    """A view of cells as squares: square (r, c) is [r, :, c, :]."""
    rows, columns = cells.shape
    return cells.reshape(rows // size, size, columns // size, size)


def cut_squares(rows: Integers, columns: Integers, size: int, shape: tuple[int, int]) -> tuple[Any, Any]:
    """The quarters of squares, by their places among squares of the new size, that reach into the grid."""
    if not size:
        return rows[:0], columns[:0]
    r = (2 * rows[:, None] + (0, 0, 1, 1)).ravel()
    c = (2 * columns[:, None] + (0, 1, 0, 1)).ravel()
    inside = (r * size < shape[0]) & (c * size < shape[1])
    return r[inside], c[inside]


def check_squares(
    checker: CollisionChecker,
    grid: Grid,
    size: int,
    rows: Integers,
    columns: Integers,
    deadline: float,
    threads: int,
) -> npt.NDArray[np.uint8]:
    """The verdicts on squares of cells, of which those at the end of the grid are cut off there."""
    first, second = (
        grid.coordinates(axis, 0.5 * (place * size + np.minimum((place + 1) * size, grid.shape[axis])))
        for axis, place in enumerate((rows, columns))
    )
    half = grid.half_size(size)
    verdicts = np.zeros(len(rows), dtype=np.uint8)
    for begin in range(0, len(rows), ROWS_AT_ONCE):
        part = slice(begin, begin + ROWS_AT_ONCE)
        q = grid.configurations(first[part], second[part])
        if perf_counter() < deadline:
            verdicts[part] = checker.check_cells(q, half, threads)
        elif size == 1:
            verdicts[part] = checker.check_rows(q, threads)
    return verdicts
