"""Whether something is the kind of world that is needed."""

from __future__ import annotations

from typing import Any

from cspace.errors import InputTypeError
from cspace.maps import PolygonWorld

__all__ = ["need_polygons"]


def need_polygons(world: Any) -> None:
    """InputTypeError for anything but a PolygonWorld."""
    if not isinstance(world, PolygonWorld):
        remedy = "give a PolygonWorld; PolygonWorld.from_grid(grid) makes one of a grid"
        raise InputTypeError(f"world is an object of type {type(world).__name__}; {remedy}")
