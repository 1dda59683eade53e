"""The Voronoi diagram of free space: points as far from two walls."""

from cspace.navigation.voronoi.voronoi import Voronoi, VoronoiDiagram, voronoi_diagram

__all__ = ["Voronoi", "VoronoiDiagram", "voronoi_diagram"]
