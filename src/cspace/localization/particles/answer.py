"""What Monte Carlo localisation and the histogram filter answer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cspace.arrays import Array
from cspace.localization.filters.run import EstimatedPoses
from cspace.localization.log import Ids, Mask
from cspace.localization.particles.state import FilterEvent, PoseMode
from cspace.tables import show_fields, tabulate


@show_fields
@dataclass(frozen=True)
class MapLocalizationStats:
    """What a filter did: measurements used, those without returns, and those outside of the odometry;
    searches of the map; the mean number of particles (or cells) and the mean score of the best; seconds."""

    updates: int
    blind: int
    skipped: int
    searches: int
    mean_size: float
    mean_score: float
    seconds: float


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class MapLocalization(EstimatedPoses):
    """Where a robot was on a map, a row per time, by a filter that may have several modes; truthy if it is
    localised at the end.

    times (n,) [s]. poses (n, 3): x, y [m], θ [rad], the mean of the heaviest mode. covariances (n, 3, 3) of ξ
    in T exp ξ, in base, of that mode. status at the end: "localised", "ambiguous" or "lost"; lost, ambiguous
    (n,): where that was so. modes: those at the end, the heaviest first. Per measurement: measured (k,), its
    row in `times`; scores (k,), that of the best particle, NaN where nothing was seen; sizes (k,), the number
    of particles. events: searches of the map, and where the status changed. particles (m, 3): the last ones.
    """

    lost: Mask
    ambiguous: Mask
    modes: tuple[PoseMode, ...]
    measured: Ids
    scores: Array
    sizes: Ids
    events: tuple[FilterEvent, ...]
    particles: Array
    stats: MapLocalizationStats
    _reason: str

    @property
    def reason(self) -> str:
        """The status as one sentence."""
        return self._reason

    @property
    def statuses(self) -> list[str]:
        """The status at each time, (n,)."""
        words = np.where(self.lost, "lost", np.where(self.ambiguous, "ambiguous", "localised"))
        return [str(word) for word in words]
