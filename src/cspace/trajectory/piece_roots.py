"""The roots of many polynomials, each within its own interval."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.tolerances import ROOT_CONVERGED

MOST_STEPS: Final = 100
"""Of Newton's method with bisection; bisection alone needs half of them."""


def find_piece_roots(coefficients: Array, begin: Array, end: Array) -> Array:
    """The real roots of polynomials Σ cᵢ tⁱ on intervals begin ≤ t ≤ end.

    The roots of the derivative divide an interval into parts with at most one root each (Rolle). Where a
    polynomial touches zero without a change of sign, its root may be missing.

    coefficients (k, n), begin, end (k,). Returns the roots (k, n − 1), NaN where there are fewer.
    """
    length = np.maximum(np.abs(begin), np.abs(end))
    scale = np.where(length > 0.0, length, 1.0)
    unit = coefficients * scale[:, None] ** np.arange(coefficients.shape[1])
    return _roots_by_rolle(unit, begin / scale, end / scale) * scale[:, None]


def _roots_by_rolle(c: Array, a: Array, b: Array) -> Array:
    n = c.shape[1] - 1
    if n == 0:
        return np.full((len(c), 0), np.nan)
    turns = _roots_by_rolle(c[:, 1:] * np.arange(1.0, n + 1.0), a, b)
    points = np.sort(
        np.concatenate([a[:, None], np.where(np.isnan(turns), b[:, None], turns), b[:, None]], axis=1)
    )
    low, high = points[:, :-1], points[:, 1:]
    rows = np.broadcast_to(c[:, None, :], (*low.shape, n + 1))
    at_low, at_high = _evaluate(rows, low)[0], _evaluate(rows, high)[0]
    roots = np.where((at_low == 0.0) & (high > low), low, np.nan)
    roots = np.where((at_high == 0.0) & (high > low), high, roots)
    crosses = at_low * at_high < 0.0
    if crosses.any():
        roots[crosses] = _find_bracketed(rows[crosses], low[crosses], high[crosses], at_high[crosses] > 0.0)
    return roots


def _evaluate(c: Array, t: Array) -> tuple[Array, Array]:
    """Values and slopes of polynomials (..., n) at t (...)."""
    value, slope = c[..., -1], np.zeros_like(t)
    for i in range(c.shape[-1] - 2, -1, -1):
        slope = slope * t + value
        value = value * t + c[..., i]
    return value, slope


def _find_bracketed(c: Array, low: Array, high: Array, rises: npt.NDArray[np.bool_]) -> Array:
    """The roots between low and high by Newton's method, by bisection where a step leaves the bracket."""
    x = 0.5 * (low + high)
    for _ in range(MOST_STEPS):
        value, slope = _evaluate(c, x)
        left = (value < 0.0) == rises
        low, high = np.where(left & (value != 0.0), x, low), np.where(left | (value == 0.0), high, x)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = x - value / slope
        inside = (newton > low) & (newton < high)
        after = np.where(value == 0.0, x, np.where(inside, newton, 0.5 * (low + high)))
        moved = np.abs(after - x)
        x = after
        if (moved <= ROOT_CONVERGED).all():
            break
    return x
