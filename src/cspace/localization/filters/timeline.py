"""Everything a filter passes, by time: steps of odometry, cut where something was measured, and measurements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.localization.log import Ids, Log
from cspace.localization.sensors import RangeBearing
from cspace.mobile import MotionNoise, Odometry
from cspace.spatial import adjoint_2d, exp_se2

KINDS: Final = ("readings", "headings", "fixes")
"""What landmark filters use of a log, in the order in which equal times are merged."""


@dataclass(frozen=True, eq=False)
class Timeline:
    """Nodes in time with the steps between them, and what was measured at each.

    times (n,) [s]. increments (n − 1, 3): x, y, θ of each node in the one before. A, Q (n − 1, 3, 3): the
    covariance goes from P to A P Aᵀ + Q. node, kind, row (k,): where each measurement belongs, by node. skipped:
    how many lie outside of the odometry.
    """

    times: Array
    increments: Array
    A: Array
    Q: Array
    node: Ids
    kind: Ids
    row: Ids
    skipped: int


def lay_timeline(log: Log, sensor: RangeBearing, noise: MotionNoise) -> Timeline:
    """The timeline of a log; late stamps of readings are moved back by the delay of the sensor."""
    times, kind, row = gather_measurements(log, sensor)
    odometry = log.odometry
    inside = (times >= odometry.times[0]) & (times <= odometry.times[-1])
    times, kind, row = times[inside], kind[inside], row[inside]
    split = odometry.split(times)
    node = np.searchsorted(split.times, times, side="right") - 1
    order = np.lexsort((row, kind, node))
    increments, A = describe_steps(split)
    return Timeline(
        split.times,
        increments,
        A,
        noise.covariance(split.steps, split.durations),
        node[order],
        kind[order],
        row[order],
        int(np.count_nonzero(~inside)),
    )


def gather_measurements(log: Log, sensor: RangeBearing) -> tuple[Array, Ids, Ids]:
    """Times, kinds and rows of all measurements of a log."""
    parts = [getattr(log, kind) for kind in KINDS]
    times = [part.times - (sensor.delay if k == 0 else 0.0) for k, part in enumerate(parts) if part is not None]
    kinds = [np.full(len(part), k) for k, part in enumerate(parts) if part is not None]
    rows = [np.arange(len(part)) for part in parts if part is not None]
    if not times:
        return np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64)
    return np.concatenate(times), np.concatenate(kinds), np.concatenate(rows)


def describe_steps(odometry: Odometry) -> tuple[Array, Array]:
    """Increments (n − 1, 3), θ as turned, and A = Ad(exp(−ξ)) (n − 1, 3, 3)."""
    T = exp_se2(odometry.steps)
    increments = np.stack([T[:, 0, 2], T[:, 1, 2], odometry.steps[:, 2]], axis=-1)
    return increments, adjoint_2d(exp_se2(-odometry.steps))
