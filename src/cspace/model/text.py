"""Tables as people read them."""

from __future__ import annotations

import math
from collections.abc import Sequence


def shown(value: float) -> str:
    """Six digits, nothing of the rounding around zero, and a dash for what is absent (infinite)."""
    return f"{round(float(value), 12) + 0.0:.6g}" if math.isfinite(value) else "-"


def align_cells(rows: Sequence[Sequence[str]]) -> str:
    """Lines of cells, each column as wide as its widest cell, aligned to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows
    )
