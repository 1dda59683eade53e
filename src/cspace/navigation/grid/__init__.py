"""Searches over the cells of an occupancy grid."""

from cspace.navigation.grid.best_first import (
    AStar,
    Dijkstra,
    FocalSearch,
    GreedyBestFirst,
    JumpPointSearch,
    ThetaStar,
    Wavefront,
    WeightedAStar,
)
from cspace.navigation.grid.d_star_lite import DStarLite, DStarLiteSearch

__all__ = ["AStar", "DStarLite", "DStarLiteSearch", "Dijkstra", "FocalSearch", "GreedyBestFirst"]
__all__ += ["JumpPointSearch", "ThetaStar", "Wavefront", "WeightedAStar"]
