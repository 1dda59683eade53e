"""Discs approximated by circumscribed polygons."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array, as_floats, one_array, one_number
from cspace.errors import InputError
from cspace.tolerances import FARTHEST_POINT, MOST_SIDES


def circumscribe_discs(centers: Any, radii: Any, sides: int) -> list[Array]:
    """A regular circumscribed polygon (sides, 2) [m] of each disc; its first side faces the x direction."""
    at = one_array(centers, "centers", (None, 2), largest=FARTHEST_POINT)
    reach = as_floats(radii, "radii", largest=FARTHEST_POINT)
    if reach.shape not in {(), (len(at),)}:
        raise InputError(f"radii has shape {reach.shape}, expected () or ({len(at)},): one per disc")
    if not np.all(reach > 0):
        raise InputError(f"radii contains {np.min(reach):g}; the radius of a disc must be above zero [m]")
    if int(number := one_number(sides, "sides")) != number or not 4 <= sides <= MOST_SIDES:
        raise InputError(f"sides is {sides}; it must be 4 to {MOST_SIDES}")
    angles = 2 * np.pi * (np.arange(int(sides)) + 0.5) / sides
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1) / np.cos(np.pi / sides)
    sizes = np.broadcast_to(reach, len(at))
    return [center + radius * around for center, radius in zip(at, sizes, strict=True)]
