"""Any curve as a path of quintic pieces within a tolerance."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Final

import numpy as np

from cspace.arrays import Array, as_floats, positive_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.tolerances import CURVE_FITTED
from cspace.trajectory.path import Path, hermite_quintics

FIRST_PIECES: Final = 8
"""Of a curve about which nothing is known."""

SHORTEST_PIECE: Final = 2.0**-16
"""Of the length of a curve: at a corner no piece is short enough."""

LOOKED_AT: Final = (0.25, 0.5, 0.75)
"""Where in a piece it is compared with the curve; the error of quintic Hermite pieces is largest in the
middle."""


def fit_path(curve: Callable[[Array, int], Array], length: float, *, tolerance: float = CURVE_FITTED) -> Path:
    """A curve as quintic pieces that attain its position, slope and bend at their ends.

    curve(s, order) → (..., dof) for s (...) from 0 to length and order 0, 1 and 2: the configuration [rad or
    m] and its derivatives by s. length: of the parameter. tolerance: the largest distance [rad or m, L2 norm]
    of the path from the curve at a quarter, the middle and three quarters of each piece, which are halved
    until it is attained; the error falls with the sixth power of their length.

    Returns a Path, whose `remarks` state the error. Raises InputError where the curve is not finite, and
    where halving does not attain the tolerance, such as at a corner.
    """
    _check_curve(curve)
    length = positive_number(length, "length")
    tolerance = positive_number(tolerance, "tolerance")
    breaks = np.linspace(0.0, length, FIRST_PIECES + 1)
    while True:
        path, errors = _fit_pieces(curve, breaks)
        coarse = np.flatnonzero(errors > tolerance)
        if not coarse.size:
            return Path(path.breaks, path.control_points, remarks=[f"fitted within {errors.max():.1e}"])
        if np.diff(breaks)[coarse].min() <= SHORTEST_PIECE * length:
            worst = coarse[np.argmin(np.diff(breaks)[coarse])]
            raise InputError(
                f"the curve is not smooth at s = {breaks[worst]:.6g}: short pieces are off by"
                f" {errors[worst]:.1e}, more than the tolerance of {tolerance:.1e}; make it in parts"
            )
        middle = 0.5 * (breaks[:-1] + breaks[1:])[coarse]
        breaks = np.sort(np.concatenate([breaks, middle]))


def _fit_pieces(curve: Callable[[Array, int], Array], breaks: Array) -> tuple[Path, Array]:
    """The path through a curve at breaks, and the largest distance of each piece (k,)."""
    q, slope, bend = (_read_curve(curve, breaks, order) for order in range(3))
    path = Path(breaks, hermite_quintics(np.diff(breaks), q, slope, bend))
    errors = np.zeros(len(path))
    pieces = np.arange(len(path))
    for share in LOOKED_AT:
        s = breaks[:-1] + share * np.diff(breaks)
        gap = path.evaluate_pieces(pieces, np.full(len(path), share)) - _read_curve(curve, s, 0)
        errors = np.maximum(errors, np.linalg.norm(gap, axis=1))
    return path, errors


def _check_curve(curve: Callable[[Array, int], Array]) -> None:
    """InputTypeError for an object that cannot be called with s and order."""
    rule = "it must accept (s, order) and return the configuration (order 0) and its derivatives by s (1, 2)"
    if not callable(curve):
        raise InputTypeError(f"curve is {name_type(curve)}; {rule}")
    try:
        given = inspect.signature(curve)
    except (TypeError, ValueError):  # a compiled function without one
        return
    try:
        given.bind(np.zeros(1), 0)
    except TypeError as error:
        raise InputTypeError(f"curve has the arguments {given}: {error}; {rule}") from None


def _read_curve(curve: Callable[[Array, int], Array], s: Array, order: int) -> Array:
    values = as_floats(curve(s, order), f"curve(s, {order})", last=(None,))
    if values.ndim != 2 or len(values) != len(s):
        raise InputError(
            f"curve(s, {order}) has shape {values.shape} for s ({len(s)},); expected ({len(s)}, dof)"
        )
    return values
