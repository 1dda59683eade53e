"""Rasterisation of polygons: a cell is blocked if an obstacle overlaps it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, positive_number
from cspace.errors import InputError
from cspace.maps.outlines import longer_side
from cspace.tolerances import CELL_ROUNDING, DEFAULT_CELLS, MAP_CELLS


def rasterize_world(
    core: _core.PolygonCore, bounds: Array, resolution: float | None
) -> tuple[npt.NDArray[np.bool_], float]:
    """Which cells (rows, columns) are blocked, and their side [m]; (0, 0) is the lower left of the bounds."""
    xmin, ymin, xmax, ymax = map(float, bounds)
    wide = longer_side(bounds)
    if resolution is None:
        side = wide / _choose_parts(min(xmax - xmin, ymax - ymin) / wide)
    else:
        side = positive_number(resolution, "resolution", "it must be a positive length [m], one number")
    if not wide / side <= MAP_CELLS:
        raise InputError(
            f"resolution {side:g} gives more than {MAP_CELLS:g} cells along one side; choose larger cells"
        )
    rows, columns = (
        math.ceil((high - low) / side - CELL_ROUNDING) for low, high in ((ymin, ymax), (xmin, xmax))
    )
    if rows * columns > MAP_CELLS:
        raise InputError(f"resolution {side:g} makes {rows} × {columns} cells; the maximum is {MAP_CELLS:g}")
    return core.rasterize(side, rows, columns).view(np.bool_), side


def _choose_parts(flatness: float) -> int:
    """The number of cells along the longer side of the bounds; `flatness` is the ratio of the shorter side
    to it. It is 200 or up to half as many more, chosen for the smallest remainder of the shorter side; more
    where the shorter side is no longer than a cell."""
    first = max(DEFAULT_CELLS, math.ceil(1 / max(flatness, 1 / MAP_CELLS)))
    rows = flatness * np.arange(first, first + first // 2 + 1)
    left_over = rows + CELL_ROUNDING - np.floor(rows + CELL_ROUNDING)
    return first + int(np.argmax(left_over <= left_over.min() + 10 * CELL_ROUNDING))
