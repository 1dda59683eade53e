"""LandmarkSlam: where the robot was and where the landmarks are, with covariances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import check_known
from cspace.localization.filters.rows import find_twist
from cspace.localization.filters.run import FRAMES, turn_covariances
from cspace.localization.landmark_slam.outcomes import ReadingOutcomes
from cspace.localization.log import Ids, Landmarks, Mask
from cspace.mobile import TimedPoses
from cspace.tables import count_things, one_line, show_fields, tabulate


@show_fields
@dataclass(frozen=True)
class LandmarkSlamStats:
    """What a filter did: updates; readings used, rejected, that created a landmark, and skipped (a landmark
    cannot be made of them, or they lie outside of the odometry); landmarks removed again; how often the
    covariance was inflated, the search for pairings reached its most nodes, and particles were drawn anew;
    the mean NIS per degree of freedom of what was used; the largest share of rejected ones among fifty
    readings in a row; the share of the landmarks within range that were not seen, 0 without a range; seconds
    of wall time."""

    updates: int
    used: int
    rejected: int
    created: int
    skipped: int
    dropped: int
    inflations: int
    capped: int
    resamplings: int
    mean_nis: float
    rejected_share: float
    missed_share: float
    seconds: float


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class LandmarkSlam:
    """A drive with the landmarks that it found; truthy if the robot is localised on them at the end.

    times (n,) [s], those of the odometry and of the readings. poses (n, 3): x, y [m], θ [rad], in the frame
    of the start; each from the readings up to its time. covariances (n, 3, 3) of ξ in T exp ξ, in base.
    landmarks: a map with covariances. method: the name of what made it. status: "localised", "lost" where
    most of the last readings were rejected or without any reading, or "ambiguous" where the readings
    contradict the map; doubt: how, in words. lost (n,): where the robot was lost. readings: what became of
    each one, with NIS; measured (k,): the row of each in `times`.
    """

    times: Array
    poses: Array
    covariances: Array
    landmarks: Landmarks
    method: str
    status: str
    lost: Mask
    readings: ReadingOutcomes
    measured: Ids
    stats: LandmarkSlamStats
    doubt: str = ""

    def __bool__(self) -> bool:
        return self.status == "localised"

    def __len__(self) -> int:
        """How many poses there are."""
        return len(self.times)

    def __repr__(self) -> str:
        found = f"{count_things(len(self), 'pose')} and {count_things(len(self.landmarks), 'landmark')}"
        return one_line("LandmarkSlam", f"{self.method}, {found}: {self.status}, {self.reason}")

    @property
    def reason(self) -> str:
        """The status as one sentence."""
        s = self.stats
        if self.status == "lost":
            if not s.used + s.created:
                return "no reading was used; the poses are dead reckoning"
            return "most of the last readings contradict the landmarks"
        if self.status == "ambiguous":
            return self.doubt
        return f"{s.used} readings used, {s.rejected} rejected, mean NIS per dof {s.mean_nis:.2f}"

    @property
    def nis(self) -> Array:
        """νᵀ S⁻¹ ν of each reading (k,), χ² with readings.dof degrees of freedom; NaN where none."""
        return self.readings.nis

    def at(self, times: npt.ArrayLike) -> Array:
        """The poses at times, interpolated: (...) [s] → (..., 3); NaN outside of the log."""
        return TimedPoses(self.times, self.poses).at(times)

    def covariance(self, *, frame: str = "base") -> Array:
        """The covariances (n, 3, 3) in axes of base or of map, blkdiag(R, 1) P blkdiag(R, 1)ᵀ. Raises
        UnknownNameError for another frame."""
        check_known("frame", frame, FRAMES)
        return self.covariances if frame == "base" else turn_covariances(self.poses, self.covariances)

    def nees(self, truth: TimedPoses) -> Array:
        """ξᵀ P⁻¹ ξ with T exp ξ the true pose in the frame of the start: (n,), NaN where it is unknown."""
        error = find_twist(self.poses, truth.at(self.times))
        inverse = np.linalg.pinv(self.covariances, hermitian=True)
        return np.asarray(np.einsum("ni,nij,nj->n", error, inverse, error))
