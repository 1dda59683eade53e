"""Statistics that the benchmarks of planning share."""

from __future__ import annotations

import numpy as np


def summarize(values: list[float]) -> dict[str, float]:
    """Median, mean, p95 and the largest."""
    rows = np.array(values)
    return {
        "median": float(np.median(rows)),
        "mean": float(rows.mean()),
        "p95": float(np.quantile(rows, 0.95)),
        "worst": float(rows.max()),
    }
