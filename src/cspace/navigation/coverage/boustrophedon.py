"""Boustrophedon coverage: a path that sweeps every free cell of a grid in parallel lines."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, suggest
from cspace.navigation.checks import need_grid
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import CELL_ROUNDING

ALONG: Final = ("x", "y")

Labels = npt.NDArray[np.int32]


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Coverage:
    """A path that sweeps a grid; truthy if every free cell is swept.

    path (m, 2) [m]: its corners, the start first. regions (rows, cols): the region of each cell, −1 for
    cells that the robot cannot reach. order (k,): the regions in the order of visit. passes (rows, cols):
    how often the bar passed over each cell. along: "x" or "y", the axis of the lines. width [m]: of the
    bar, in whole cells. reached, free: the numbers of swept and free cells. lanes: the number of lines;
    leftover: the number of cells that needed a separate path.
    """

    grid: Any
    path: Array
    regions: Labels
    order: Labels
    passes: npt.NDArray[np.uint32]
    along: str
    width: float
    reached: int
    free: int
    lanes: int
    leftover: int

    def __bool__(self) -> bool:
        return self.reached == self.free

    @property
    def length(self) -> float:
        """Length of the path [m]."""
        return float(np.abs(np.diff(self.path, axis=0)).sum())

    @property
    def overlap(self) -> float:
        """The mean number of passes over a swept cell beyond the first: 0 where each is swept once."""
        return float(self.passes.sum(dtype=np.int64)) / self.reached - 1.0

    @property
    def reason(self) -> str:
        """The verdict as one sentence."""
        regions = count_things(len(self.order), "region")
        how = f"{regions}, {self.length:.6g} m, overlap {self.overlap:.2g}"
        if self:
            return f"every one of {self.free} free cells is swept: {how}"
        return f"{self.free - self.reached} of {self.free} free cells cannot be reached from the start: {how}"

    def __repr__(self) -> str:
        return one_line("Coverage", self.reason)


def coverage(grid: Any, start: Any, width: float | None = None, *, along: str | None = None) -> Coverage:
    """A boustrophedon path that sweeps every reachable free cell.

    Free space is split into regions wherever the free part of a line splits, merges, appears or ends. The
    robot visits the nearest region next, by path length, and sweeps each line by line, one bar width apart.
    The robot carries a bar perpendicular to its lines that ends at walls; cells behind walls are swept
    last. Moves are along and across the lines, so the robot never passes between two cells that touch at a
    corner.

    grid: an OccupancyGrid of the positions of the robot's centre (inflate it for a robot with a size).
    start (2,) [m]: in a free cell, at whose centre the path begins. width [m] of the bar: one cell unless
    given, else the largest odd number of whole cells that fit. along: "x" or "y", the axis of the lines;
    the one with the shorter path unless given.

    Returns Coverage, truthy if every free cell is swept. Raises InputTypeError for a value that is not an
    OccupancyGrid, InputError for a start that is not in a free cell or a width below one cell,
    UnknownNameError for another axis.

    Choset and Pignon 1997.
    """
    need_grid(grid)
    if along is not None and along not in ALONG:
        raise suggest("axis", along, ALONG)
    row, column = grid.cell_of(grid.check_free(start, "start"))
    half = count_half_width(grid, width)
    found = [
        (axis, _core._cover(grid, row, column, half, axis == "x")) for axis in ([along] if along else ALONG)
    ]
    axis, told = min(found, key=lambda one: len(one[1][0]))
    cells, regions, order, passes, reached, free, lanes, leftover = told
    side = float(grid.resolution)
    points = find_corners(cells)[:, ::-1] * side + 0.5 * side + [grid._x, grid._y]
    bar = (2 * half + 1) * side
    return Coverage(grid, points, regions, order, passes, axis, bar, reached, free, lanes, leftover)


def count_half_width(grid: Any, width: float | None) -> int:
    """The number of cells that the bar extends to either side of the robot's cell."""
    if width is None:
        return 0
    bar = as_floats(width, "width")
    cells = float(bar) / grid.resolution if bar.ndim == 0 else 0.0
    if cells < 1 - CELL_ROUNDING:
        raise InputError(f"width is {width!r}; a bar is at least a cell wide, {grid.resolution:g} m")
    half = (cells - 1) / 2 + CELL_ROUNDING
    return floor(min(half, float(max(grid.rows, grid.columns))))


def find_corners(cells: npt.NDArray[np.int32]) -> Array:
    """The cells (n, 2) at which a path turns, including both ends."""
    moves = np.diff(cells, axis=0)
    turns = np.ones(len(cells), np.bool_)
    turns[1:-1] = (moves[1:] != moves[:-1]).any(axis=1)
    return np.asarray(cells[turns], dtype=np.float64)
