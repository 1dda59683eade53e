"""Cell decompositions of free space: convex polygons, trapezoids, squares."""

from cspace.navigation.cells.approximate_cells import (
    ApproximateCells,
    ApproximateCellsSearch,
    CellEvidence,
    approximate_cells,
)
from cspace.navigation.cells.exact_cells import ExactCells

__all__ = ["ApproximateCells", "ApproximateCellsSearch", "CellEvidence", "ExactCells", "approximate_cells"]
