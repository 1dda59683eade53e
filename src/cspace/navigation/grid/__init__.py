"""Searches over the cells of an occupancy grid."""

from cspace.navigation.grid.d_star_lite import DStarLite

__all__ = ["DStarLite"]
