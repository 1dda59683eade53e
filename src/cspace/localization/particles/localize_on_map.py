"""Localisation along a whole log with a filter that may have several modes."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter
from typing import Any, Protocol

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, TimeLimitError
from cspace.localization.filters.rows import adjoin_rows, carry_covariance, follow_rows, relate_rows
from cspace.localization.filters.timeline import follow_anchors
from cspace.localization.log import Ids, Landmarks, Log
from cspace.localization.particles.answer import MapLocalization, MapLocalizationStats
from cspace.localization.particles.state import FilterEvent, PoseMode
from cspace.localization.sensors import RangeBearing
from cspace.mobile import MotionNoise

ORIGIN = np.zeros(3)


class MapFilter(Protocol):
    """What runs along a log: a ParticleFilter or a HistogramFilter."""

    noise: MotionNoise
    score: float

    def predict(self, increment: Array, dt: float = ..., *, covariance: Array | None = ...) -> None:
        """Moves by odometry."""

    def update(self, scan: Any) -> None:
        """Weighs by a measurement."""

    @property
    def modes(self) -> tuple[PoseMode, ...]:
        """The modes."""

    @property
    def events(self) -> tuple[FilterEvent, ...]:
        """What it did beyond weighing."""

    @property
    def particles(self) -> Array:
        """Poses (m, 3)."""

    @property
    def status(self) -> str:
        """Localised, ambiguous or lost."""

    @property
    def reason(self) -> str:
        """The status as one sentence."""

    def __len__(self) -> int: ...


@dataclass(eq=False)
class Passage:
    """What is kept while a filter runs."""

    poses: Array
    covariances: Array
    lost: Any
    ambiguous: Any
    nodes: list[int] = field(default_factory=list)
    scores: list[float] = field(default_factory=list)
    sizes: list[int] = field(default_factory=list)


def localize_on_map(
    name: str, log: Log, grid: Any, made: MapFilter, sensor: Any, begun: float, limit: float | None
) -> MapLocalization:
    """Runs a filter along the odometry of a log, with its scans, or with its readings on Landmarks; begun:
    when its time limit began, by perf_counter."""
    times, measurements = list_measurements(log, grid, sensor)
    odometry = log.odometry
    inside = (times >= odometry.times[0]) & (times <= odometry.times[-1])
    split = odometry.split(times[inside])
    node = np.searchsorted(split.times, times[inside], side="right") - 1
    anchors = np.unique(np.concatenate([[0], node, [len(split.times) - 1]]))
    Q = np.zeros((len(split.times), 3, 3))
    Q[1:] = made.noise.covariance(split.steps, split.durations)
    steps, noise = follow_anchors(split.dead_reckoning().poses, Q, anchors)
    here: dict[int, tuple[int, ...]] = {int(anchor): () for anchor in anchors}
    for at, which in zip(node, np.flatnonzero(inside), strict=True):
        here[int(at)] = (*here[int(at)], int(which))
    passed = run_filter(made, split.times, steps, noise, here, measurements, begun, limit)
    return report_passage(
        name, split.times, made, passed, int(np.count_nonzero(~inside)), perf_counter() - begun
    )


def list_measurements(log: Log, grid: Any, sensor: Any) -> tuple[Array, Any]:
    """Times (k,) of the measurements that a map has use for, and what gives the k-th."""
    if isinstance(grid, Landmarks):
        readings = log.readings
        if readings is None or not len(readings):
            raise InputError("the log has no readings of landmarks; give a grid for its scans")
        times, first = np.unique(readings.times, return_index=True)
        ends = np.append(first[1:], len(readings))
        delay = sensor.delay if isinstance(sensor, RangeBearing) else 0.0
        return times - delay, lambda k: readings.subset(np.arange(int(first[k]), int(ends[k])))
    scans = log.scans
    if scans is None or not len(scans):
        raise InputError("the log has no scans; give Landmarks for its readings")
    return scans.times, lambda k: scans[k]


def run_filter(
    made: MapFilter,
    times: Array,
    steps: Array,
    noise: Array,
    here: dict[int, tuple[int, ...]],
    measurements: Any,
    begun: float,
    limit: float | None,
) -> Passage:
    """The filter from anchor to anchor; poses between them follow the odometry."""
    n = len(times)
    passed = Passage(np.zeros((n, 3)), np.zeros((n, 3, 3)), np.zeros(n, bool), np.zeros(n, bool))
    last = 0
    for count, (anchor, which) in enumerate(here.items()):
        if limit is not None and perf_counter() - begun > limit:
            raise TimeLimitError(
                f"the filter reached {count} of {len(here)} measurements within its time_limit"
            )
        if anchor:
            between = slice(last + 1, anchor + 1)
            A = adjoin_rows(relate_rows(steps[between], ORIGIN))
            passed.poses[between] = follow_rows(passed.poses[last], steps[between])
            passed.covariances[between] = carry_covariance(A, passed.covariances[last] + noise[between])
            passed.lost[between], passed.ambiguous[between] = passed.lost[last], passed.ambiguous[last]
            made.predict(
                steps[anchor],
                float(times[anchor] - times[last]),
                covariance=carry_covariance(A[-1], noise[anchor]),
            )
        for row in which:
            made.score = float("nan")
            made.update(measurements(row))
            passed.nodes.append(anchor)
            passed.scores.append(made.score)
            passed.sizes.append(len(made))
        mode, status = made.modes[0], made.status
        passed.poses[anchor], passed.covariances[anchor] = mode.pose, mode.covariance
        passed.lost[anchor], passed.ambiguous[anchor] = status == "lost", status == "ambiguous"
        last = anchor
    return passed


def report_passage(
    name: str, times: Array, made: MapFilter, passed: Passage, skipped: int, seconds: float
) -> MapLocalization:
    """The answer."""
    scores, sizes = np.array(passed.scores), np.array(passed.sizes, dtype=np.int64)
    seen = np.isfinite(scores)
    stats = MapLocalizationStats(
        updates=int(seen.sum()),
        blind=int((~seen).sum()),
        skipped=skipped,
        searches=sum(event.kind in ("search", "no place") for event in made.events),
        mean_size=float(sizes.mean()) if len(sizes) else float(len(made)),
        mean_score=float(scores[seen].mean()) if seen.any() else float("nan"),
        seconds=seconds,
    )
    nodes: Ids = np.array(passed.nodes, dtype=np.int64)
    return MapLocalization(
        times=times,
        poses=passed.poses,
        covariances=passed.covariances,
        filter=name,
        status=made.status,
        lost=passed.lost,
        ambiguous=passed.ambiguous,
        modes=made.modes,
        measured=nodes,
        scores=scores,
        sizes=sizes,
        events=made.events,
        particles=made.particles,
        stats=stats,
        _reason=made.reason,
    )
