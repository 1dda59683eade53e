"""The filter: predicts along the odometry, tests each measurement at its gate, and updates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Final

import numpy as np

from cspace._core import RejectionSum
from cspace.arrays import Array
from cspace.errors import TimeLimitError
from cspace.localization.filters.gates import chi2_quantile
from cspace.localization.filters.measurements import Measurement
from cspace.localization.filters.rows import adjoin_rows, carry_covariance, follow_rows, relate_rows
from cspace.localization.filters.timeline import Timeline
from cspace.localization.filters.updates import Innovation, Update, measure_innovation

REJECTIONS: Final = 10
"""Rejections in a row after which the covariance is inflated, and sum of them from which a filter is lost."""
INFLATION: Final = 4.0
"""By how much: twice the standard deviations."""
ANCHORS_PER_LOOK: Final = 64
"""Nodes with measurements between two looks at the clock."""
ORIGIN: Final = np.zeros(3)


@dataclass(frozen=True, eq=False)
class Passed:
    """What a filter computed. poses (n, 3) and covariances (n, 3, 3) after the measurements of each node, and
    before them; lost (n,); per measurement nis, dof, accepted, and innovations (k, 2), NaN where there is no
    second number; inflated: nodes at which the covariance was inflated."""

    poses: Array
    covariances: Array
    poses_before: Array
    covariances_before: Array
    lost: np.ndarray[tuple[int], np.dtype[np.bool_]]
    nis: Array
    dof: np.ndarray[tuple[int], np.dtype[np.int64]]
    accepted: np.ndarray[tuple[int], np.dtype[np.bool_]]
    innovations: Array
    inflated: list[int]


Read = Callable[[int, Array, Array], Measurement | None]
"""The measurement of a number, given pose and covariance; None where there is nothing to associate it
with."""


class Pass:
    """One run of a filter along a timeline."""

    def __init__(self, timeline: Timeline, update: Update, gate: float, limit: float | None) -> None:
        self.timeline, self.update, self.gate = timeline, update, gate
        self.end = np.inf if limit is None else perf_counter() + limit
        n, k = len(timeline.times), len(timeline.node)
        self.poses, self.before = np.empty((n, 3)), np.empty((n, 3))
        self.covariances, self.covariances_before = np.empty((n, 3, 3)), np.empty((n, 3, 3))
        self.lost = np.zeros(n, dtype=bool)
        self.nis, self.innovations = np.full(k, np.nan), np.full((k, 2), np.nan)
        self.dof, self.accepted = np.zeros(k, dtype=np.int64), np.zeros(k, dtype=bool)
        self.inflated: list[int] = []
        self.rejections = RejectionSum(REJECTIONS)

    def run(self, pose: Array, P: Array, read: Read) -> Passed:
        """The filter from a pose (3,) with covariance (3, 3)."""
        anchors = self.timeline.anchors
        first = np.searchsorted(self.timeline.node, anchors)
        last = np.searchsorted(self.timeline.node, anchors, side="right")
        for k, anchor in enumerate(anchors):
            if k % ANCHORS_PER_LOOK == 0 and perf_counter() > self.end:
                raise TimeLimitError(
                    f"the filter reached {k} of {len(anchors)} measurements within its time_limit"
                )
            begin = anchors[k - 1] + 1 if k else 0
            if k:
                pose, P = self.predict(begin, anchor + 1, pose, P)
            else:
                self.poses[0], self.covariances[0] = self.before[0], self.covariances_before[0] = pose, P
            self.lost[begin : anchor + 1] = self.rejections.is_lost
            for number in range(first[k], last[k]):
                pose, P = self.measure(number, anchor, pose, P, read)
            self.poses[anchor], self.covariances[anchor] = pose, P
            self.lost[anchor] = self.rejections.is_lost
        return Passed(
            self.poses,
            self.covariances,
            self.before,
            self.covariances_before,
            self.lost,
            self.nis,
            self.dof,
            self.accepted,
            self.innovations,
            self.inflated,
        )

    def predict(self, begin: int, end: int, pose: Array, P: Array) -> tuple[Array, Array]:
        """All nodes up to the next anchor: T ← T D, P ← A (P + Q) Aᵀ with A = Ad(D⁻¹) and Q in axes of the
        start.

        That is exact in ξ, as poses are a group (Barrau & Bonnabel 2017), so that the sigma points of an
        unscented prediction would give the same.
        """
        D = self.timeline.poses[begin:end]
        A = adjoin_rows(relate_rows(D, ORIGIN))
        self.before[begin:end] = self.poses[begin:end] = follow_rows(pose, D)
        covariances = carry_covariance(A, P + self.timeline.noise[begin:end])
        self.covariances_before[begin:end] = self.covariances[begin:end] = covariances
        return self.poses[end - 1], covariances[-1]

    def measure(self, number: int, node: int, pose: Array, P: Array, read: Read) -> tuple[Array, Array]:
        """The update by a measurement that passes its gate."""
        measurement = read(number, pose, P)
        if measurement is None:
            return self.reject(node, pose, P)
        innovation = measure_innovation(pose, P, measurement)
        self.record(number, innovation)
        if self.nis[number] > chi2_quantile(self.gate, int(self.dof[number])):
            return self.reject(node, pose, P)
        self.accepted[number] = True
        self.rejections.accept()
        return self.update(pose, P, measurement)

    def record(self, number: int, innovation: Innovation) -> None:
        """Keeps ν, its NIS and its degrees of freedom."""
        self.dof[number] = len(innovation.value)
        self.nis[number] = innovation.nis
        self.innovations[number, : len(innovation.value)] = innovation.value

    def reject(self, node: int, pose: Array, P: Array) -> tuple[Array, Array]:
        """Counts a rejection; each tenth in a row inflates the covariance."""
        if not self.rejections.reject():
            return pose, P
        self.inflated.append(node)
        return pose, INFLATION * P
