"""The roots of many polynomials, each within its own interval."""

from __future__ import annotations

import numpy as np

from cspace._core import find_roots
from cspace.arrays import Array
from cspace.tolerances import ROOT_CONVERGED


def find_piece_roots(coefficients: Array, begin: Array, end: Array) -> Array:
    """The real roots of polynomials Σ cᵢ tⁱ on intervals begin ≤ t ≤ end.

    The roots of the derivative divide an interval into parts with at most one root each (Rolle). Where a
    polynomial touches zero without a change of sign, its root may be missing.

    coefficients (k, n), begin, end (k,). Returns the roots (k, n − 1), ascending, then NaN.
    """
    rows, begins, ends = map(np.ascontiguousarray, (coefficients, begin, end))
    return find_roots(rows, begins, ends, ROOT_CONVERGED)
