"""Free space cut into cells: convex polygons, trapezoids, squares, lanes."""

from cspace.navigation.cells.approximate_cells import ApproximateCells, CellEvidence, approximate_cells
from cspace.navigation.cells.boustrophedon import Coverage, coverage

__all__ = ["ApproximateCells", "CellEvidence", "Coverage", "approximate_cells", "coverage"]
