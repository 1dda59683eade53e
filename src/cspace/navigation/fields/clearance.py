"""The clearance of cells, cached with a grid."""

from __future__ import annotations

from typing import Any

from cspace import _core


def clearance_field(grid: Any) -> Any:
    """The ClearanceField of a grid: the distances of its cells from walls."""
    kept = vars(grid)
    if "_clearance" not in kept:
        kept["_clearance"] = _core.ClearanceField(grid)
    return kept["_clearance"]
