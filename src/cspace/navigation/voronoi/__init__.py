"""The Voronoi diagram of free space: points as far from two walls."""

from cspace.navigation.voronoi.voronoi import VoronoiDiagram, voronoi_diagram

__all__ = ["VoronoiDiagram", "voronoi_diagram"]
