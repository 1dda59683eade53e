"""Likelihood fields: how likely a laser beam ends in each cell of a grid, as bytes."""

from __future__ import annotations

from typing import Final

from cspace.arrays import one_number, positive_number
from cspace.errors import InputError
from cspace.tolerances import WIDEST_SIGMA

SIGMA: Final = 0.1
"""The usual standard deviation of the distance from the end of a beam to its wall [m]: the noise of a laser,
the rounding of cells of 5 cm and small errors of the map."""
LIKELIHOOD_FLOOR: Final = 0.1
"""The usual likelihood of a beam that ends anywhere, over that of one that ends on a wall."""


def check_hit_model(sigma: float, floor: float, resolution: float) -> tuple[float, float]:
    """sigma [m] and floor; InputError for a sigma that is not positive, or more than
    tolerances.WIDEST_SIGMA cells, and for a floor that is not between 0 and 1."""
    wide = positive_number(sigma, "sigma", "give one standard deviation above zero, in metres")
    if wide > WIDEST_SIGMA * resolution:
        raise InputError(
            f"sigma is {wide:g} m, {wide / resolution:.3g} cells; it must be at most {WIDEST_SIGMA} cells:"
            " give metres, or take a coarser grid"
        )
    least = one_number(floor, "floor")
    if not 0 < least < 1:
        raise InputError(
            f"floor is {least:g}; it must be above 0 and below 1, a likelihood relative to a wall"
        )
    return wide, least
