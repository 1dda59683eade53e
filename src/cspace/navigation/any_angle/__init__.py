"""Shortest paths at any angle through convex polygons and over cells."""
