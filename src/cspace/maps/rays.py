"""Ray casting: how far rays go in a world until they meet an obstacle."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import as_floats, leading_axes, positive_number
from cspace.errors import InputTypeError, name_type
from cspace.maps.polygon_world import PolygonWorld
from cspace.tolerances import LARGEST_NUMBER


def cast_rays(world: Any, points: Any, angles: Any, max_range: float = np.inf) -> Any:
    """How far rays go until they enter a blocked cell or meet a wall, (...) [m]; a float for one ray.

    world: an OccupancyGrid or a PolygonWorld, whose outside is blocked. points (..., 2) [m], angles (...)
    [rad] in the world frame, which broadcast. max_range [m]: what is returned where nothing is nearer. From
    inside an obstacle or outside the range is 0. On grids a ray between two cells is stopped where both are
    blocked, one through a corner by the cell behind it or by both beside it. Among polygons the first wall
    is found by exact decisions; a ray along a wall or through a corner may stop there or go on.

    Raises InputTypeError for a value that is no world, InputError for a value that is not a point or angle,
    or a max_range that is not above zero. Amanatides and Woo 1987.
    """
    if not isinstance(world, (_core.GridBase, PolygonWorld)):
        raise InputTypeError(f"world is {name_type(world)}; give an OccupancyGrid or a PolygonWorld")
    places = as_floats(points, "points", last=(2,), largest=LARGEST_NUMBER)
    turns = as_floats(angles, "angles", largest=LARGEST_NUMBER)
    most = positive_number(max_range, "max_range", "give one length above zero, in metres", largest=np.inf)
    batch = leading_axes(points=places.shape[:-1], angles=turns.shape)
    rows = np.ascontiguousarray(np.broadcast_to(places, (*batch, 2)).reshape(-1, 2))
    flat = np.ascontiguousarray(np.broadcast_to(turns, batch).ravel())
    core = world._core if isinstance(world, PolygonWorld) else world
    ranges = _core._cast_rays(core, rows, flat, most)
    return ranges.reshape(batch) if batch else float(ranges[0])
