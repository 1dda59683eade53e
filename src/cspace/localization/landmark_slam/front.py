"""SLAM of landmarks over a whole log."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, positive_number
from cspace.errors import InputError, InputTypeError, TimeLimitError, name_type
from cspace.localization.filters.rows import adjoin_rows, carry_covariance, follow_rows, relate_rows
from cspace.localization.filters.timeline import Timeline, lay_timeline
from cspace.localization.landmark_slam.answer import LandmarkSlam, LandmarkSlamStats
from cspace.localization.landmark_slam.doubts import (
    explain_doubt,
    explain_turn,
    find_gained_turn,
    find_missed_share,
    find_rejected_share,
)
from cspace.localization.landmark_slam.filters import EkfSlam, FastSlam, LandmarkFilter
from cspace.localization.landmark_slam.outcomes import ReadingOutcomes, join_outcomes
from cspace.localization.log import UNKNOWN, Log
from cspace.localization.sensors import RangeBearing, read_sensor
from cspace.mobile import MotionNoise
from cspace.mobile.noise import read_noise

ORIGIN: Final = np.zeros(3)


def run_ekf_slam(
    log: Log,
    *,
    start: npt.ArrayLike = (0.0, 0.0, 0.0),
    start_covariance: npt.ArrayLike | None = None,
    sensor: RangeBearing | None = None,
    noise: MotionNoise | None = None,
    linearization: str = "invariant",
    association: str = "joint",
    gate: float = 0.999,
    time_limit: float | None = None,
) -> LandmarkSlam:
    """Poses and landmarks of a log by EKF-SLAM; arguments as of EkfSlam.

    start: (3,) or (3, 3) at the first time of the odometry, the frame of the answer. time_limit [s]:
    TimeLimitError beyond it. Raises InputError for a log without odometry or without readings, or with
    readings of which some have names and some have none.
    """
    model = read_sensor(sensor, RangeBearing)
    slam = EkfSlam(
        start=start,
        start_covariance=start_covariance,
        sensor=model,
        noise=noise,
        linearization=linearization,
        association=association,
        gate=gate,
    )
    return run_filter(slam, "ekf", log, model, read_noise(noise), time_limit)


def run_fast_slam(
    log: Log,
    *,
    version: int = 2,
    n: int = 100,
    start: npt.ArrayLike = (0.0, 0.0, 0.0),
    start_covariance: npt.ArrayLike | None = None,
    sensor: RangeBearing | None = None,
    noise: MotionNoise | None = None,
    gate: float = 0.999,
    rng: int | np.random.Generator | None = None,
    time_limit: float | None = None,
) -> LandmarkSlam:
    """Poses and landmarks of a log by FastSLAM 1 or 2; arguments as of FastSlam and run_ekf_slam.

    start (3,) or (3, 3), start_covariance (3, 3). Raises InputError and TimeLimitError as run_ekf_slam.
    """
    model = read_sensor(sensor, RangeBearing)
    slam = FastSlam(
        n=n,
        version=version,
        start=start,
        start_covariance=start_covariance,
        sensor=model,
        noise=noise,
        gate=gate,
        rng=rng,
    )
    return run_filter(slam, f"fastslam{version}", log, model, read_noise(noise), time_limit)


def run_filter(
    slam: LandmarkFilter,
    method: str,
    log: Log,
    sensor: RangeBearing,
    noise: MotionNoise,
    time_limit: float | None,
) -> LandmarkSlam:
    """A filter along the anchors of a log: the nodes with readings, the first and the last."""
    begun = perf_counter()
    end = np.inf if time_limit is None else begun + positive_number(time_limit, "time_limit")
    rows = read_rows(log)
    line = lay_timeline(replace(log, headings=None, fixes=None), sensor, noise)
    moves = carry_covariance(adjoin_rows(relate_rows(line.poses, ORIGIN)), line.noise)
    n = len(line.times)
    poses, covariances, lost = np.empty((n, 3)), np.empty((n, 3, 3)), np.zeros(n, dtype=bool)
    first = np.searchsorted(line.node, line.anchors)
    last = np.searchsorted(line.node, line.anchors, side="right")
    core: Any = slam._core
    parts = []
    for k, anchor in enumerate(line.anchors):
        if perf_counter() > end:
            raise TimeLimitError(f"SLAM reached {k} of {len(line.anchors)} updates within its time_limit")
        if k:
            before = line.anchors[k - 1]
            core.predict(line.poses[anchor], moves[anchor].ravel())
            lost[before:anchor] = core.is_lost
        if last[k] > first[k]:
            slam.update(rows[line.row[first[k] : last[k]]])
            parts.append(core.outcomes)
        poses[anchor], covariances[anchor], lost[anchor] = core.pose, core.covariance, core.is_lost
    fill_between(line, moves, poses, covariances)
    return report_slam(
        slam,
        method,
        line,
        poses,
        covariances,
        lost,
        join_outcomes(parts),
        is_named=bool((rows[:, 0] >= 0).any()),
        sensor=sensor,
        seconds=perf_counter() - begun,
    )


def read_rows(log: Log) -> Array:
    """The readings of a log as rows name, range, bearing (k, 3)."""
    if not isinstance(log, Log):
        raise InputTypeError(f"log is {name_type(log)}; read one with cspace.read_log, or make a Log")
    if not len(log.odometry.times):
        raise InputError("the log has no odometry; SLAM needs its times, at least one")
    if log.readings is None:
        raise InputError("the log has no readings of landmarks; SLAM of landmarks needs them")
    known = log.readings.landmark != UNKNOWN
    if known.any() and not known.all():
        raise InputError(
            f"{int((~known).sum())} of {len(known)} readings have no name; give all of them"
            " names, or −1 to all"
        )
    return LandmarkFilter._read_rows(log.readings)


def fill_between(line: Timeline, moves: Array, poses: Array, covariances: Array) -> None:
    """Poses and covariances of the nodes without readings, from the anchor before each."""
    nodes = np.arange(len(poses))
    before = line.anchors[np.searchsorted(line.anchors, nodes, side="right") - 1]
    between = np.flatnonzero(before < nodes)
    poses[between] = follow_rows(poses[before[between]], line.poses[between])
    A = adjoin_rows(relate_rows(line.poses[between], ORIGIN))
    covariances[between] = carry_covariance(A, covariances[before[between]]) + moves[between]


def report_slam(
    slam: LandmarkFilter,
    method: str,
    line: Timeline,
    poses: Array,
    covariances: Array,
    lost: npt.NDArray[np.bool_],
    readings: ReadingOutcomes,
    is_named: bool,
    sensor: RangeBearing,
    seconds: float,
) -> LandmarkSlam:
    """The answer of a filter."""
    core: Any = slam._core
    updates, used, rejected, created, skipped, dropped, inflations, capped, resamplings = core.counts
    dof = int(readings.dof[readings.used].sum())
    stats = LandmarkSlamStats(
        updates=updates,
        used=used,
        rejected=rejected,
        created=created,
        skipped=skipped + line.skipped,
        dropped=dropped,
        inflations=inflations,
        capped=capped,
        resamplings=resamplings,
        mean_nis=float(readings.nis[readings.used].sum() / dof) if dof else float("nan"),
        rejected_share=find_rejected_share(readings),
        missed_share=find_missed_share(slam.landmarks, poses, line.node, readings, sensor),
        seconds=seconds,
    )
    is_lost = bool(lost[-1]) or not used + created
    doubt = explain_doubt(
        stats.rejected_share, stats.missed_share, is_named, slam.landmarks, sensor.range_sigma
    )
    if not doubt and method == "ekf":
        doubt = explain_turn(find_gained_turn(covariances))
    return LandmarkSlam(
        times=line.times,
        poses=poses,
        covariances=covariances,
        landmarks=slam.landmarks,
        method=method,
        status="lost" if is_lost else "ambiguous" if doubt else "localised",
        lost=lost,
        readings=readings,
        measured=line.node,
        stats=stats,
        doubt=doubt,
    )
