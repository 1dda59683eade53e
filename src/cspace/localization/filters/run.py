"""What a filter answers: poses with covariances, and how well every measurement fitted."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, positive_number
from cspace.errors import InputError, check_kind, check_known
from cspace.localization.filters.backward import smooth_interval, smooth_lag
from cspace.localization.filters.forward import Passed
from cspace.localization.filters.rows import find_twist
from cspace.localization.filters.timeline import Timeline
from cspace.localization.log import Ids, Mask
from cspace.mobile import TimedPoses
from cspace.mobile.timed_poses import NO_REFERENCE
from cspace.spatial import rotation_2d
from cspace.tables import count_things, one_line, show_fields, tabulate

FRAMES = ("base", "map")


@show_fields
@dataclass(frozen=True)
class LocalizationStats:
    """What a filter did: measurements used, rejected at their gate, and outside of the odometry; how often
    its
    covariance was inflated; the mean NIS per degree of freedom (1 for a consistent filter); seconds of wall
    time."""

    updates: int
    rejected: int
    skipped: int
    inflations: int
    mean_nis: float
    seconds: float


@dataclass(frozen=True, eq=False, repr=False)
class EstimatedPoses:
    """Where a robot was, a row per time; truthy if it is localised at the end.

    times (n,) [s]. poses (n, 3): x, y [m], θ [rad]. covariances (n, 3, 3) of the disturbance ξ of T exp ξ, in
    base. filter: the name of what made it. status: "localised", or what else it is at the end.
    """

    times: Array
    poses: Array
    covariances: Array
    filter: str
    status: str

    def __bool__(self) -> bool:
        return self.status == "localised"

    def __len__(self) -> int:
        """How many poses there are."""
        return len(self.times)

    def __repr__(self) -> str:
        text = f"{self.filter}, {count_things(len(self), 'pose')}: {self.status}, {self.reason}"
        return one_line(type(self).__name__, text)

    @property
    def reason(self) -> str:
        """The status as one sentence."""
        return f"{count_things(len(self), 'pose')} by {self.filter}"

    def at(self, times: npt.ArrayLike) -> Array:
        """The poses at times, interpolated: (...) [s] → (..., 3); NaN outside of the log."""
        return TimedPoses(self.times, self.poses).at(times)

    def covariance(self, *, frame: str = "base") -> Array:
        """The covariances (n, 3, 3) in axes of base or of map, blkdiag(R, 1) P blkdiag(R, 1)ᵀ: the ellipses
        of
        pictures. Raises UnknownNameError for another frame."""
        check_known("frame", frame, FRAMES)
        if frame == "base":
            return self.covariances
        return turn_covariances(self.poses, self.covariances)

    def nees(self, truth: TimedPoses) -> Array:
        """ξᵀ P⁻¹ ξ with T exp ξ the true pose, χ² with 3 degrees of freedom for a consistent filter.

        (n,); NaN where the truth is unknown.
        """
        check_kind("truth", truth, TimedPoses, NO_REFERENCE)
        error = find_twist(self.poses, truth.at(self.times))
        return np.asarray(
            np.einsum("ni,nij,nj->n", error, np.linalg.pinv(self.covariances, hermitian=True), error)
        )


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Localization(EstimatedPoses):
    """Where a robot was, a row per time; truthy if it is localised at the end.

    times (n,) [s], those of the odometry and of the measurements. poses (n, 3): x, y [m], θ [rad].
    covariances (n, 3, 3) of the disturbance ξ of T exp ξ, in base. filter: the name of what made it. status:
    "localised", or "lost" where more than two thirds of the last measurements contradict the filter, or
    without any. lost (n,): where that was so. Per measurement: nis (k,) and its degrees of freedom dof (k,),
    innovations (k, 2) with NaN for a second number that is not there, rejected (k,), measured (k,): the row
    of each in `times`.
    """

    lost: Mask
    nis: Array
    dof: Ids
    innovations: Array
    rejected: Mask
    measured: Ids
    stats: LocalizationStats
    _timeline: Timeline = field(repr=False)
    _passed: Passed = field(repr=False)

    @property
    def reason(self) -> str:
        """The status as one sentence."""
        s = self.stats
        if self.status == "lost":
            if not s.updates:
                return "no measurement was used; the poses are dead reckoning"
            total = s.updates + s.rejected
            return f"most of the last measurements contradict the filter; of all {s.rejected} of {total} do"
        return f"{s.updates} measurements used, {s.rejected} rejected, mean NIS per dof {s.mean_nis:.2f}"

    def smoothed(self, *, lag: float | None = None) -> Localization:
        """The poses given later measurements too: all of them, or those up to a lag [s] after each pose.

        The same object with smoothed poses (n, 3) and covariances (n, 3, 3). Raises InputError if it is
        smoothed already. Source: Rauch, Tung & Striebel 1965.
        """
        if self.filter.endswith(SMOOTHED):
            raise InputError(
                f"this is the result of a smoother already, {self.filter}; smooth that of a filter"
            )
        if lag is None:
            poses, covariances = smooth_interval(self._timeline, self._passed)
            name = self.filter + SMOOTHED
        else:
            poses, covariances = smooth_lag(self._timeline, self._passed, positive_number(lag, "lag"))
            name = f"{self.filter}, lag {lag:g} s" + SMOOTHED
        return replace(self, poses=poses, covariances=covariances, filter=name)


def turn_covariances(poses: Array, covariances: Array) -> Array:
    """Covariances (n, 3, 3) in base turned into axes of the map, at poses (n, 3)."""
    turn = np.zeros_like(covariances)
    turn[:, :2, :2], turn[:, 2, 2] = rotation_2d(poses[:, 2]), 1.0
    return np.asarray(turn @ covariances @ np.swapaxes(turn, -1, -2))


SMOOTHED = ", smoothed"
"""How the name of a filter goes on after its poses were smoothed."""
