"""The visibility graph: corners that are mutually visible."""

from cspace.navigation.visibility.visibility_graph import (
    VisibilityGraph,
    VisibilityGraphSearch,
    visibility_graph,
)

__all__ = ["VisibilityGraph", "VisibilityGraphSearch", "visibility_graph"]
