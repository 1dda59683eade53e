"""The clearance of cells, cached with a grid."""

from __future__ import annotations

from typing import Any

from cspace import _core
from cspace.navigation.cache import keep_with


def clearance_field(grid: Any) -> Any:
    """The ClearanceField of a grid: the distances of its cells from walls."""
    return keep_with(grid, "_clearance", None, lambda: _core.ClearanceField(grid))
