"""Checks of worlds, end points and numbers."""

from __future__ import annotations

from typing import Any

from cspace import _core
from cspace.arrays import Array, bounded_number
from cspace.errors import InputTypeError, name_type
from cspace.maps import PolygonWorld
from cspace.tolerances import LARGEST_NUMBER


def need_polygons(world: Any) -> None:
    """InputTypeError for anything but a PolygonWorld."""
    if not isinstance(world, PolygonWorld):
        remedy = "give a PolygonWorld; PolygonWorld.from_grid(grid) makes one of a grid"
        raise InputTypeError(f"world is an object of type {type(world).__name__}; {remedy}")


def need_grid(grid: Any, name: str = "grid") -> None:
    """InputTypeError for anything but an OccupancyGrid."""
    if not isinstance(grid, _core.GridBase):
        raise InputTypeError(f"{name} is {name_type(grid)}; give an OccupancyGrid (or world.to_grid())")


def check_ends(world: Any, start: Any, goal: Any) -> tuple[Array, Array]:
    """Start and goal as points (2,) [m] in free space; InputError names the one that is not."""
    return world.check_free(start, "start"), world.check_free(goal, "goal")


def need_number(value: Any, name: str, least: float) -> float:
    """A number not below its smallest useful value, or InputError."""
    return bounded_number(value, name, least, f"give one number, at least {least:g}", LARGEST_NUMBER)
