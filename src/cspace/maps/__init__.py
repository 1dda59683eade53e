"""Worlds of the plane: polygons and occupancy grids."""

__all__: list[str] = []
