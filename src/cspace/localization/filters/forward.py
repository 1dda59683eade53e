"""The filter: predicts along the odometry, tests each measurement at its gate, and updates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import TimeLimitError
from cspace.localization.filters.gates import chi2_quantile
from cspace.localization.filters.measurements import Measurement
from cspace.localization.filters.timeline import Timeline
from cspace.localization.filters.updates import Innovation, Update, measure_innovation
from cspace.math.wrapping import wrap_angle

REJECTIONS: Final = 10
"""Rejections in a row after which the filter counts as lost, and its covariance is inflated."""
INFLATION: Final = 4.0
"""By how much: twice the standard deviations."""
STEPS_PER_LOOK: Final = 256
"""Steps between two looks at the clock."""


@dataclass(frozen=True, eq=False)
class Passed:
    """What a filter computed. poses (n, 3) and covariances (n, 3, 3) after the measurements of each node, and
    before them; lost (n,); per measurement nis, dof, accepted, and innovations (k, 2), NaN where there is no second
    number; inflated: nodes at which the covariance was inflated."""

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
"""The measurement of a number, given pose and covariance; None where there is nothing to associate it with."""


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
        self.rejected = 0

    def run(self, pose: Array, P: Array, read: Read) -> Passed:
        """The filter from a pose (3,) with covariance (3, 3)."""
        line = self.timeline
        first = np.searchsorted(line.node, np.arange(len(line.times) + 1))
        for node in range(len(line.times)):
            if node % STEPS_PER_LOOK == 0 and perf_counter() > self.end:
                raise TimeLimitError(f"the filter reached {node} of {len(line.times)} steps within its time_limit")
            if node:
                pose, P = self.predict(node - 1, pose, P)
            self.before[node], self.covariances_before[node] = pose, P
            for number in range(first[node], first[node + 1]):
                pose, P = self.measure(number, node, pose, P, read)
            self.poses[node], self.covariances[node] = pose, P
            self.lost[node] = self.rejected >= REJECTIONS
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

    def predict(self, step: int, pose: Array, P: Array) -> tuple[Array, Array]:
        """T ← T D, P ← A P Aᵀ + Q: exact in ξ, as poses are a group (Barrau & Bonnabel 2017)."""
        dx, dy, turn = self.timeline.increments[step]
        c, s = np.cos(pose[2]), np.sin(pose[2])
        moved = np.array([pose[0] + c * dx - s * dy, pose[1] + s * dx + c * dy, wrap_angle(pose[2] + turn)])
        A = self.timeline.A[step]
        return moved, A @ P @ A.T + self.timeline.Q[step]

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
        self.rejected = 0
        return self.update(pose, P, measurement)

    def record(self, number: int, innovation: Innovation) -> None:
        """Keeps ν, its NIS and its degrees of freedom."""
        self.dof[number] = len(innovation.value)
        self.nis[number] = innovation.nis
        self.innovations[number, : len(innovation.value)] = innovation.value

    def reject(self, node: int, pose: Array, P: Array) -> tuple[Array, Array]:
        """Counts a rejection; each tenth in a row inflates the covariance."""
        self.rejected += 1
        if self.rejected % REJECTIONS:
            return pose, P
        self.inflated.append(node)
        return pose, INFLATION * P
