"""Cell decompositions of free space: convex polygons, trapezoids, squares."""

from cspace.navigation.cells.approximate_cells import ApproximateCells, CellEvidence, approximate_cells

__all__ = ["ApproximateCells", "CellEvidence", "approximate_cells"]
