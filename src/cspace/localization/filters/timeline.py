"""Everything a filter passes, by time: steps of odometry, cut where something was measured, and
measurements."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.localization.filters.rows import adjoin_rows, carry_covariance, relate_rows
from cspace.localization.log import Ids, Log
from cspace.localization.sensors import RangeBearing
from cspace.mobile import MotionNoise

KINDS: Final = ("readings", "headings", "fixes")
"""What landmark filters use of a log, in the order in which equal times are merged."""


@dataclass(frozen=True, eq=False)
class Timeline:
    """Nodes in time, of which anchors are those with measurements, the first, and the last.

    times (n,) [s]. anchors (r,): their nodes, increasing. node, kind, row (k,): where each measurement
    belongs, by node. Of each node as seen from the anchor before it (of an anchor: the one before that):
    poses (n, 3), and noise (n, 3, 3), the sum of the noise of the steps from there, in axes of the anchor.
    skipped: how many measurements lie outside of the odometry.
    """

    times: Array
    anchors: Ids
    node: Ids
    kind: Ids
    row: Ids
    poses: Array
    noise: Array
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
    anchors = np.unique(np.concatenate([[0], node, [len(split.times) - 1]]))
    Q = np.zeros((len(split.times), 3, 3))
    Q[1:] = noise.covariance(split.steps, split.durations)
    poses, summed = follow_anchors(split.dead_reckoning().poses, Q, anchors)
    return Timeline(
        split.times,
        anchors,
        node[order],
        kind[order],
        row[order],
        poses,
        summed,
        int(np.count_nonzero(~inside)),
    )


def gather_measurements(log: Log, sensor: RangeBearing) -> tuple[Array, Ids, Ids]:
    """Times, kinds and rows of all measurements of a log."""
    parts = [(k, part) for k, kind in enumerate(KINDS) if (part := getattr(log, kind)) is not None]
    if not parts:
        return np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64)
    times = [part.times - (sensor.delay if k == 0 else 0.0) for k, part in parts]
    kinds = [np.full(len(part), k) for k, part in parts]
    rows = [np.arange(len(part)) for _, part in parts]
    return np.concatenate(times), np.concatenate(kinds), np.concatenate(rows)


def follow_anchors(reckoned: Array, Q: Array, anchors: Ids) -> tuple[Array, Array]:
    """Nodes as seen from the anchor before them (n, 3), and the noise up to them in its axes (n, 3, 3).

    In axes that stay, noise adds up: Σ Ad(T) Q Ad(T)ᵀ.
    """
    before = anchors[np.maximum(np.searchsorted(anchors, np.arange(len(reckoned)), side="left") - 1, 0)]
    poses = relate_rows(reckoned[before], reckoned)
    summed = carry_covariance(adjoin_rows(poses), Q)
    for first, last in itertools.pairwise(anchors):
        summed[first + 1 : last + 1] = np.cumsum(summed[first + 1 : last + 1], axis=0)
    return poses, summed
