"""Occupancy grid: a plane of square cells, each free or blocked."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, any_array, as_floats, guard_memory, one_number, positive_number
from cspace.errors import InputError, InputTypeError, shown, suggest
from cspace.maps.byte_field import ByteField
from cspace.maps.likelihood_field import LIKELIHOOD_FLOOR, SIGMA, check_hit_model
from cspace.maps.points import as_path, as_point, check_inflation
from cspace.tables import tabulate
from cspace.tolerances import FARTHEST_CELL, FARTHEST_POINT, FINEST_CELL, MAP_CELLS

RULES: Final = ("cells", "centers")
"""The part of the grid that inflation keeps clear of obstacles."""
FREE: Final = 0
OUTSIDE: Final = 2
"""The kinds of positions: in a free cell, in a blocked cell (1), or outside the grid."""


@tabulate("rows", "columns", "resolution", "origin", "bounds", "blocked_cells")
class OccupancyGrid(_core.GridBase):
    """Square cells, each free or blocked; everything outside the grid is blocked.

    blocked: (rows, columns), truth values, or numbers 0 and 1. resolution [m]: the side of a cell. origin
    (2,) [m]: the corner of cell (0, 0) of least x and y. Row i spans y in origin_y + resolution · [i, i +
    1], column j spans x likewise, so the first row of the array is the lowest. The cells are copied and
    stored as two bit arrays, one by rows and one by columns.

    Raises InputTypeError for values that are not cells, InputError for a wrong shape, an empty grid, more
    than tolerances.MAP_CELLS cells, a resolution that is not positive, or an origin that is not finite.
    """

    kind: Final = "grid"

    def __init__(self, blocked: Any, resolution: float = 1.0, origin: ArrayLike = (0.0, 0.0)) -> None:
        side = positive_number(resolution, "resolution", "it must be one positive number [m]")
        corner = as_point(origin, "origin")
        cells = _read_cells(blocked)
        reach = max(cells.shape) * side + max(map(abs, corner))
        if reach > FARTHEST_CELL * side:
            message = f"origin {corner} is {reach / side:.3g} cells from the farthest cell; "
            raise InputError(message + f"float64 tells cells apart up to {FARTHEST_CELL:g} of them")
        if side < FINEST_CELL or reach > FARTHEST_POINT:
            raise InputError(
                f"resolution is {side:g} and the farthest cell {reach:.3g} m away; the sides of cells must "
                f"be at least {FINEST_CELL:g} m, and all cells must lie within {FARTHEST_POINT:g} m"
            )
        super().__init__(cells, side, corner)

    @classmethod
    def from_movingai(
        cls, path: str | os.PathLike[str], resolution: float = 1.0, origin: ArrayLike = (0.0, 0.0)
    ) -> OccupancyGrid:
        """A map of the MovingAI benchmarks: . G S are free, @ O T W blocked.

        The first line of the file is row 0, the lowest in the plane. So x and y of its scenarios are the
        column and the row of a cell; the point is the centre, origin + resolution · (x + ½, y + ½), origin
        (2,) [m].
        """
        from cspace.maps.movingai import read_movingai

        return cls(read_movingai(path), resolution, origin)

    @classmethod
    def from_ros(cls, path: str | os.PathLike[str], *, unknown: str = "blocked") -> OccupancyGrid:
        """A ROS map: a YAML file with a PGM or PNG image, mode "trinary"; the lowest pixels are row 0.

        unknown: how unknown cells are treated, "blocked" or "free".
        """
        from cspace.maps.ros_map import read_ros

        if unknown not in ("blocked", "free"):
            raise suggest("choice of unknown=", unknown, ("blocked", "free"))
        read = read_ros(path)
        blocked = read.cells != 0 if unknown == "blocked" else read.cells == 1
        return cls(blocked, read.resolution, read.origin)

    @classmethod
    def from_image(
        cls,
        path: str | os.PathLike[str],
        resolution: float = 1.0,
        origin: ArrayLike = (0.0, 0.0),
        *,
        blocked_below: float = 0.5,
    ) -> OccupancyGrid:
        """A PGM or PNG image, one pixel per cell, the lowest pixels being row 0; origin (2,) [m].

        Pixels darker than blocked_below (0 black, 1 white) and transparent pixels are blocked.
        """
        from cspace.maps.images import read_image

        least = float(as_floats(blocked_below, "blocked_below"))
        return cls(~(read_image(path)[::-1] >= least), resolution, origin)

    @property
    def origin(self) -> Array:
        """The corner of cell (0, 0) of least x and y, (2,) [m]."""
        return np.array([self._x, self._y])

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.rows, self.columns

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """xmin, ymin, xmax, ymax [m]."""
        side = self.resolution
        return self._x, self._y, self._x + side * self.columns, self._y + side * self.rows

    @cached_property
    def corners(self) -> int:
        """The number of corners of the outlines of the blocked cells."""
        return self._corners

    @property
    def blocked(self) -> npt.NDArray[np.bool_]:
        """Which cells are blocked, (rows, columns); a copy."""
        return self._unpack().view(np.bool_)

    def cell_of(self, point: ArrayLike) -> tuple[int, int]:
        """Row and column of the cell that contains a point (2,) [m].

        A point on a border belongs to the free one of the adjacent cells; if several are free, to the one
        with the higher coordinates. InputError for a point outside the grid.
        """
        return self._find_cell(point, "point")[3:]

    def center_of(self, cell: ArrayLike) -> Array:
        """The centre of cells (..., 2), given as row and column: points (..., 2) [m]."""
        index = as_floats(cell, "cell", last=(2,))
        return self.origin + self.resolution * (index[..., ::-1] + 0.5)

    def is_free(self, points: ArrayLike) -> Any:
        """Whether points (..., 2) [m] lie in free cells or on their borders: (...) of bool; none outside."""
        given = as_floats(points, "points", last=(2,))
        free = self._free(np.ascontiguousarray(given).reshape(-1, 2))
        return free.view(np.bool_).reshape(given.shape[:-1]) if given.ndim > 1 else bool(free[0])

    def path_clearance(self, path: ArrayLike) -> float:
        """The least distance [m] from a path (m, 2) [m] to the square of a blocked cell, or to the border
        of the grid: zero if it touches or enters one.

        Exact up to rounding, over the whole path and not only at its corners; NaN for an empty path.
        """
        points = as_path(path)
        return self._path_clearance(points) if len(points) else np.nan

    def check_free(self, point: ArrayLike, subject: str) -> Array:
        """The point (2,) [m]; InputError if it is not finite, outside the grid or in a blocked cell."""
        x, y, place, row, column = self._find_cell(point, subject)
        if place != FREE:
            raise InputError(f"{subject} ({x:g}, {y:g}) lies in cell ({row}, {column}), which is blocked")
        return np.array([x, y])

    def _find_cell(self, point: ArrayLike, subject: str) -> tuple[float, float, int, int, int]:
        """x and y of a point (2,) [m], the kind of its position, its row and column; InputError outside."""
        x, y = as_point(point, subject)
        place, row, column = self._locate((x, y))
        if place == OUTSIDE:
            x0, y0, x1, y1 = self.bounds
            spans = f"x {x0:g} … {x1:g}, y {y0:g} … {y1:g} [m]"
            raise InputError(f"{subject} ({x:g}, {y:g}) is outside the grid, which spans {spans}")
        return x, y, place, row, column

    def inflate(self, radius: float, *, clear: str = "cells") -> OccupancyGrid:
        """The grid for the centre of a circular robot of a radius [m]: obstacles, and the outside, are
        grown by it.

        clear="cells": a cell is blocked if any of its points is nearer than the radius to a blocked cell.
        The robot may then be anywhere in the free cells, and a corridor of one cell is closed to every
        robot. clear="centers": a cell is blocked if its centre is nearer than the radius, so the robot may
        be at the centres of free cells. Squared distances are compared as integers in half cells; where the
        square of the radius in half cells is an integer up to rounding, that integer is used.
        """
        grown = check_inflation(radius)
        if clear not in RULES:
            raise suggest("choice of clear=", clear, RULES)
        made = OccupancyGrid.__new__(OccupancyGrid)
        _core.GridBase.__init__(made, self, grown, clear == "centers")
        return made

    def to_grid(self, resolution: float | None = None) -> OccupancyGrid:
        """The grid itself: a grid has its own resolution."""
        if resolution is not None and one_number(resolution, "resolution") != self.resolution:
            raise InputTypeError(f"the grid has cells of {self.resolution:g} m; they cannot be resampled")
        return self

    def likelihood_field(self, sigma: float = SIGMA, floor: float = LIKELIHOOD_FLOOR) -> ByteField:
        """How likely a laser beam ends in each cell, by the distance d from its centre to that of the
        nearest blocked cell.

        The likelihood is p = (1 − floor) exp(−d² / 2 sigma²) + floor, and the score 255 · (1 − log p / log
        floor): 255 on a wall, and 0 far from all of them and outside the grid. sigma [m]: the standard
        deviation of d. floor: the likelihood of a beam that ends anywhere, over that of one that ends on a
        wall. InputError for values that are not above zero, or a floor of 1 or more. Thrun, Burgard and Fox
        2005, section 6.4.
        """
        wide, least = check_hit_model(sigma, floor, self.resolution)
        with guard_memory(
            "the grid",
            f"of {self.rows} × {self.columns} cells",
            float(self.rows * self.columns),
            "make it smaller",
        ):
            return ByteField(_core._likelihood_field(self, wide, least), self.resolution, self.origin)

    def save_ros(self, path: str | os.PathLike[str]) -> None:
        """Writes a ROS map: a YAML file at the path, which ends in .yaml, and a PGM image next to it."""
        from cspace.maps.ros_map import write_ros

        grey = np.where(self.blocked, np.uint8(0), np.uint8(254))
        write_ros(path, grey, self.resolution, self._x, self._y, "trinary")

    def __reduce__(self) -> tuple[Any, ...]:
        """Cells, resolution and origin: the data that pickle stores."""
        return type(self), (self.blocked, self.resolution, (self._x, self._y))

    def __repr__(self) -> str:
        share = self.blocked_cells / (self.rows * self.columns)
        return (
            f"<OccupancyGrid {self.rows} × {self.columns} cells of {self.resolution:g} m, "
            f"{share:.1%} blocked, origin ({self._x:g}, {self._y:g})>"
        )


def _read_cells(blocked: Any) -> npt.NDArray[np.uint8]:
    """The cells as bytes 0 and 1, (rows, columns)."""
    if isinstance(blocked, (str, bytes, os.PathLike)):
        raise InputTypeError(
            f"blocked is {shown(blocked)}, expected an array of cells (rows, columns); to read a file, use"
            " OccupancyGrid.from_image, from_ros or from_movingai"
        )
    cells = any_array(blocked, "blocked")
    if cells.dtype != np.bool_:
        if cells.dtype.kind not in "iuf":
            raise InputTypeError(f"blocked must be boolean, got {type(blocked).__name__} of {cells.dtype}")
        whole = cells.astype(np.bool_)
        if not np.array_equal(whole, cells):
            bad = cells[whole != cells].flat[0]
            raise InputError(
                f"blocked contains {bad}; cells must be 0 (free) or 1 (blocked): compare with a threshold"
            )
        cells = whole
    if cells.ndim != 2 or 0 in cells.shape:
        raise InputError(f"blocked has shape {cells.shape}, expected (rows, columns), at least one of each")
    if cells.size > MAP_CELLS:
        raise InputError(f"blocked has {cells.size} cells; the maximum is {MAP_CELLS}")
    return np.ascontiguousarray(cells).view(np.uint8)
