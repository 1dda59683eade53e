"""The beam model: how likely a range is along a ray whose wall is known."""

from __future__ import annotations

from math import erf, sqrt
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.localization.sensors import LaserScanner
from cspace.tolerances import LEAST_LIKELIHOOD

CELL: Final = 0.05
"""Between two tabulated ranges [m], the side of the cells of usual maps."""


class BeamTable:
    """log p(z | z*) of measured ranges z and ranges z* of the wall, a mixture of four parts.

    A normal distribution about the wall, cut off at 0 and most_range; ends before it, exponentially; no
    return; anything. Each part is normalised exactly. Source: Thrun, Burgard & Fox 2005, section 6.3.
    """

    def __init__(self, scanner: LaserScanner) -> None:
        self.most = scanner.most_range
        self.count = int(np.ceil(self.most / CELL)) + 1
        walls: Array = CELL * np.arange(self.count + 1, dtype=np.float64)
        z = walls[: self.count]
        hit, short, none, rand = scanner.shares
        density = np.full((len(walls), self.count + 1), rand / self.most)
        density[:, :-1] += hit * density_of_hits(z, walls, scanner) + short * density_of_shorts(
            z, walls, scanner
        )
        density[:, -1] = none
        density[walls >= self.most, -1] += hit
        self.logs = np.log(np.maximum(density, LEAST_LIKELIHOOD))

    def find(self, measured: Array, walls: Array) -> Array:
        """log p of ranges (b,), NaN for no return, along rays to walls (n, b): (n, b)."""
        none = np.isnan(measured) | (measured >= self.most)
        columns = np.where(none, self.count, np.round(np.where(none, 0.0, measured) / CELL))
        rows = np.minimum(np.round(walls / CELL), self.count)
        found: Array = self.logs[rows.astype(np.int64), columns.astype(np.int64)]
        return found


def density_of_hits(z: Array, walls: Array, scanner: LaserScanner) -> Array:
    """Densities [1/m] of ends on the wall (w, z); none where the wall is out of reach."""
    sigma, most = scanner.range_sigma, scanner.most_range
    share = np.array(
        [0.5 * (erf((most - w) / (sigma * sqrt(2))) + erf(w / (sigma * sqrt(2)))) for w in walls]
    )
    normal = np.exp(-0.5 * ((z - walls[:, None]) / sigma) ** 2) / (sigma * sqrt(2 * np.pi))
    return np.where(walls[:, None] < most, normal / np.maximum(share, LEAST_LIKELIHOOD)[:, None], 0.0)


def density_of_shorts(z: Array, walls: Array, scanner: LaserScanner) -> Array:
    """Densities [1/m] of ends before the wall (w, z), λ exp(−λ z) / (1 − exp(−λ z*))."""
    rate = scanner.short_rate
    share = -np.expm1(-rate * np.maximum(walls, CELL))
    return np.where(z <= walls[:, None], rate * np.exp(-rate * z) / share[:, None], 0.0)
