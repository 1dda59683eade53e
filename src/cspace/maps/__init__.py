"""Worlds of the plane: polygonal obstacles and occupancy grids."""

from cspace.maps.movingai import Scenarios, read_scenarios
from cspace.maps.occupancy_grid import OccupancyGrid
from cspace.maps.offset import Offset, OffsetCurve
from cspace.maps.polygon_world import PolygonWorld
from cspace.maps.repair import GeometryError

__all__ = [
    "GeometryError",
    "OccupancyGrid",
    "Offset",
    "OffsetCurve",
    "PolygonWorld",
    "Scenarios",
    "read_scenarios",
]
