"""What a particle filter tells of itself: modes of its particles, and events."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cspace.arrays import Array
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True, eq=False)
class PoseMode:
    """A cluster of particles. pose (3,): x, y [m], θ [rad]. covariance (3, 3) of ξ in T exp ξ, in base.
    share: its part of the weight, 0 … 1."""

    pose: Array
    covariance: Array
    share: float

    @property
    def spread(self) -> tuple[float, float]:
        """The standard deviations of its position, along the longest axis [m], and of its heading [rad]."""
        (a, b), (_, d) = self.covariance[:2, :2]
        longest = 0.5 * (a + d) + np.hypot(0.5 * (a - d), b)
        return float(np.sqrt(max(longest, 0.0))), float(np.sqrt(max(self.covariance[2, 2], 0.0)))


@show_fields
@dataclass(frozen=True)
class FilterEvent:
    """What a particle filter did beyond weighing: update, the number of the measurement; kind, "match" where
    it put particles on poses nearby that fit better, "search" where on other places, "no place" where it
    found none better, "lost" or "localised" where its status became that; score, that of the best particle
    (0 … 1); places, how many were found."""

    update: int
    kind: str
    score: float
    places: int = 0
