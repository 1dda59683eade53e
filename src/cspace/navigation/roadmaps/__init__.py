"""Networks of ways prepared for every question: between corners that see each other, between walls."""

from cspace.navigation.roadmaps.visibility_graph import VisibilityGraph, visibility_graph
from cspace.navigation.roadmaps.voronoi import VoronoiDiagram, voronoi_diagram

__all__ = ["VisibilityGraph", "VoronoiDiagram", "visibility_graph", "voronoi_diagram"]
