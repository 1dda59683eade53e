"""Worlds of the plane: polygonal obstacles and occupancy grids."""

from cspace.maps.byte_field import ByteField
from cspace.maps.evidence_grid import EvidenceGrid
from cspace.maps.movingai import Scenarios, read_scenarios
from cspace.maps.occupancy_grid import OccupancyGrid
from cspace.maps.offset import Offset, OffsetCurve
from cspace.maps.outlines import GeometryError
from cspace.maps.polygon_world import PolygonWorld
from cspace.maps.rays import cast_rays

__all__ = [
    "ByteField",
    "EvidenceGrid",
    "GeometryError",
    "OccupancyGrid",
    "Offset",
    "OffsetCurve",
    "PolygonWorld",
    "Scenarios",
    "cast_rays",
    "read_scenarios",
]
