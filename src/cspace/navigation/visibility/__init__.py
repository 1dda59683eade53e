"""The visibility graph: corners that see each other."""

from cspace.navigation.visibility.visibility_graph import VisibilityGraph, visibility_graph

__all__ = ["VisibilityGraph", "visibility_graph"]
