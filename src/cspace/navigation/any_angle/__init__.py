"""Shortest paths at any angle through convex polygons and over cells."""

__all__: list[str] = []
