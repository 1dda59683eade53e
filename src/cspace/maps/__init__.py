"""Worlds of the plane: polygons and occupancy grids."""

from cspace.maps.movingai import Scenarios, read_scenarios
from cspace.maps.occupancy_grid import OccupancyGrid

__all__ = ["OccupancyGrid", "Scenarios", "read_scenarios"]
