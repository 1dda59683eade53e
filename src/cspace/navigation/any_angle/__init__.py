"""Any-angle planning: shortest paths through convex polygons and over cells."""

from cspace.navigation.any_angle.any_angle import AnyAngle

__all__ = ["AnyAngle"]
