"""Ray casting: how far rays go in a world until they meet an obstacle."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import as_floats, leading_axes, positive_number
from cspace.errors import InputTypeError
from cspace.tolerances import LARGEST_NUMBER


def cast_rays(world: Any, points: Any, angles: Any, max_range: float = np.inf) -> Any:
    """How far rays go until they enter a blocked cell, (...) [m]; a float for one ray.

    world: an OccupancyGrid, whose outside is blocked. points (..., 2) [m], angles (...) [rad] in the world
    frame, which broadcast. max_range [m]: what is returned where nothing is nearer. From inside a blocked
    cell or outside the range is 0. A ray between two cells is stopped where both are blocked, one through a
    corner by the cell behind it or by both beside it.

    Raises InputTypeError for a value that is not an OccupancyGrid, InputError for a value that is not a
    point or angle, or a max_range that is not above zero. Amanatides and Woo 1987.
    """
    if not isinstance(world, _core.GridBase):
        raise InputTypeError(f"world is a {type(world).__name__}; give an OccupancyGrid (or world.to_grid())")
    places = as_floats(points, "points", last=(2,), largest=LARGEST_NUMBER)
    turns = as_floats(angles, "angles", largest=LARGEST_NUMBER)
    most = positive_number(max_range, "max_range", "give one length above zero, in metres", largest=np.inf)
    batch = leading_axes(points=places.shape[:-1], angles=turns.shape)
    rows = np.ascontiguousarray(np.broadcast_to(places, (*batch, 2)).reshape(-1, 2))
    flat = np.ascontiguousarray(np.broadcast_to(turns, batch).ravel())
    ranges = _core._cast_rays(world, rows, flat, most)
    return ranges.reshape(batch) if batch else float(ranges[0])
