"""Localisation along a log: the front of the filters."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any, Final, Literal, overload

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, positive_number
from cspace.errors import InputError, InputTypeError, check_known, name_type
from cspace.localization.checks import read_covariance, read_pose, suggest_map
from cspace.localization.filters.forward import Pass, Passed
from cspace.localization.filters.gates import associate_reading
from cspace.localization.filters.measurements import (
    CompassReading,
    LandmarkReading,
    Measurement,
    PositionReading,
)
from cspace.localization.filters.run import Localization, LocalizationStats
from cspace.localization.filters.timeline import KINDS, Timeline, lay_timeline
from cspace.localization.filters.updates import UPDATES
from cspace.localization.log import UNKNOWN, Landmarks, Log
from cspace.localization.sensors import Compass, Gps, LaserScanner, RangeBearing, read_sensor, read_share
from cspace.mobile import MotionNoise
from cspace.mobile.noise import read_noise
from cspace.tables import join_words

if TYPE_CHECKING:
    from cspace.localization.particles import MapLocalization

MAP_FILTERS: Final = ("mcl", "histogram")
"""Those that may have several modes."""
FILTERS = (*UPDATES, *MAP_FILTERS)
GATE: Final = 0.999
"""The share of χ² beyond which a measurement is rejected unless given."""
START_DEVIATIONS = (0.01, 0.01, 0.01)
"""Standard deviations of a start [m, m, rad] unless given: one that somebody measured."""


@overload
def localize(
    log: Log,
    landmarks: Any | None = None,
    *,
    filter: Literal["ekf", "iekf", "ukf", "information"] = "ekf",
    start: npt.ArrayLike | None = None,
    start_covariance: npt.ArrayLike | None = None,
    sensor: RangeBearing | None = None,
    compass: Compass | None = None,
    gps: Gps | None = None,
    noise: MotionNoise | None = None,
    gate: float | None = None,
    time_limit: float | None = None,
) -> Localization: ...
@overload
def localize(
    log: Log,
    landmarks: Any | None = None,
    *,
    filter: Literal["mcl", "histogram"],
    start: npt.ArrayLike | None = None,
    start_covariance: npt.ArrayLike | None = None,
    sensor: RangeBearing | LaserScanner | None = None,
    noise: MotionNoise | None = None,
    n: int | None = None,
    most: int | None = None,
    threads: int = 1,
    rng: int | np.random.Generator | None = None,
    time_limit: float | None = None,
) -> MapLocalization: ...
@overload
def localize(
    log: Log,
    landmarks: Any | None = None,
    *,
    filter: str = "ekf",
    start: npt.ArrayLike | None = None,
    start_covariance: npt.ArrayLike | None = None,
    sensor: RangeBearing | LaserScanner | None = None,
    compass: Compass | None = None,
    gps: Gps | None = None,
    noise: MotionNoise | None = None,
    gate: float | None = None,
    n: int | None = None,
    most: int | None = None,
    threads: int = 1,
    rng: int | np.random.Generator | None = None,
    time_limit: float | None = None,
) -> Localization | MapLocalization: ...
def localize(
    log: Log,
    landmarks: Any | None = None,
    *,
    filter: str = "ekf",
    start: npt.ArrayLike | None = None,
    start_covariance: npt.ArrayLike | None = None,
    sensor: RangeBearing | LaserScanner | None = None,
    compass: Compass | None = None,
    gps: Gps | None = None,
    noise: MotionNoise | None = None,
    gate: float | None = None,
    n: int | None = None,
    most: int | None = None,
    threads: int = 1,
    rng: int | np.random.Generator | None = None,
    time_limit: float | None = None,
) -> Localization | MapLocalization:
    """Where a robot was during a log, on a map.

    landmarks: the map; unless given, that of the log. filter: a Kalman filter on Landmarks, "ekf" (extended),
    "iekf" (iterated), "ukf" (unscented) or "information"; or on a grid "mcl" (a ParticleFilter, also on
    Landmarks) or "histogram" (a HistogramFilter), which answer a MapLocalization. start: pose x, y, θ (3,) or
    (3, 3) at the first time of the odometry; unless given, that of log.truth for Kalman filters, and anywhere
    for the others. start_covariance (3, 3) of ξ in T exp ξ; unless given, 1 cm and 0.01 rad, 10 cm and 0.05
    rad for "mcl" and "histogram". sensor, compass, gps: models of readings or scans, headings and fixes.
    noise: of the odometry, a RandomWalk unless given. gate: the share of χ² beyond which a measurement is
    rejected, 0.999 unless given. Readings without a name are associated with the landmark that most likely
    made them. n, most, rng: particles, as of ParticleFilter. threads: at most, for "mcl" and "histogram".
    time_limit [s]: TimeLimitError beyond it. Raises InputError for a log without odometry, a start that is
    unknown, a landmark that is not on the map, and an argument that the filter does not use. Source: Thrun,
    Burgard & Fox 2005, chapters 3, 7 and 8.
    """
    begun = perf_counter()
    if not isinstance(log, Log):
        raise InputTypeError(f"log is {name_type(log)}; read one with cspace.read_log, or make a Log")
    check_known("filter", filter, FILTERS)
    of_particles = {"n": n, "most": most, "rng": rng} if filter != "mcl" else {}
    of_kalman = {"compass": compass, "gps": gps, "gate": gate} if filter in MAP_FILTERS else {}
    for options, users in ((of_particles, "filter='mcl' uses"), (of_kalman, "the Kalman filters use")):
        if idle := [name for name, value in options.items() if value is not None]:
            raise InputError(
                f"filter={filter!r} does not use {join_words(idle)}, which {users}; leave it out"
            )
    known = landmarks if landmarks is not None else log.landmarks
    limit = None if time_limit is None else positive_number(time_limit, "time_limit")
    if not len(log.odometry.times):
        raise InputError("the log has no odometry; a filter needs its times, at least one")
    if filter in MAP_FILTERS:
        from cspace.localization.particles.run import run_map_filter

        shared = {"motion": noise, "sensor": sensor, "start": start, "start_covariance": start_covariance}
        sizes = {"n": n, "most": most, "rng": rng} if filter == "mcl" else {}
        return run_map_filter(filter, log, known, {**shared, **sizes, "threads": threads}, limit)
    model = check_landmarks(known, sensor, filter)
    pose, P = read_start(log, start, start_covariance)
    reader = Reader(log, known, model, read_sensor(compass, Compass, "compass"), read_sensor(gps, Gps, "gps"))
    timeline = lay_timeline(log, model, read_noise(noise))
    reader.timeline = timeline
    run = Pass(timeline, UPDATES[filter], read_share(GATE if gate is None else gate, "gate"), limit)
    passed = run.run(pose, P, reader.read)
    return report_run(filter, timeline, passed, perf_counter() - begun)


def check_landmarks(known: Any, sensor: Any, filter: str) -> RangeBearing:
    """The sensor of a Kalman filter. Raises InputTypeError for a map or a sensor that it has no use for."""
    if known is not None and not isinstance(known, Landmarks):
        remedy = "give filter='mcl'" if hasattr(known, "likelihood_field") else suggest_map(known)
        raise InputTypeError(
            f"the map is {name_type(known)}, and filter={filter!r} needs Landmarks; {remedy}"
        )
    return read_sensor(sensor, RangeBearing)


class Reader:
    """Makes measurements of the rows of a log."""

    timeline: Timeline

    def __init__(
        self, log: Log, landmarks: Landmarks | None, sensor: RangeBearing, compass: Compass, gps: Gps
    ) -> None:
        self.log, self.landmarks, self.sensor, self.compass, self.gps = log, landmarks, sensor, compass, gps
        readings = log.readings
        if readings is None or not len(readings):
            return
        if landmarks is None or not len(landmarks):
            raise InputError(
                "the log has readings of landmarks, and there is no map of them; give landmarks="
            )
        self.rows = landmarks.rows_of(readings.landmark)
        both = np.stack([readings.range - sensor.range_bias, readings.bearing - sensor.bearing_bias], axis=-1)
        self.values = both
        self.kinds = ~np.isnan(both)

    def read(self, number: int, pose: Array, P: Array) -> Measurement | None:
        """The measurement of a number on the timeline."""
        kind, row = KINDS[self.timeline.kind[number]], int(self.timeline.row[number])
        if kind == "headings":
            assert self.log.headings is not None
            value = self.log.headings.angles[row : row + 1] - self.compass.bias
            return CompassReading(value, self.compass.sigma, np.array([True]))
        if kind == "fixes":
            assert self.log.fixes is not None
            return PositionReading(
                self.log.fixes.points[row], self.gps.sigma, self.gps.lever, np.array([False, False])
            )
        return self.read_landmark(row, pose, P)

    def read_landmark(self, row: int, pose: Array, P: Array) -> LandmarkReading | None:
        """A reading of a landmark, associated if it has no name."""
        assert self.landmarks is not None
        used = np.flatnonzero(self.kinds[row])
        value = self.values[row, used]
        at = int(self.rows[row])
        if at == UNKNOWN:
            at = associate_reading(pose, P, value, used, self.landmarks, self.sensor)
            if at == UNKNOWN:
                return None
        spread = None if self.landmarks.covariances is None else self.landmarks.covariances[at]
        return LandmarkReading(value, used == 1, used, self.sensor, self.landmarks.points[at], spread)


def read_start(
    log: Log, start: npt.ArrayLike | None, covariance: npt.ArrayLike | None
) -> tuple[Array, Array]:
    """The first pose (3,) and its covariance (3, 3)."""
    pose = read_pose(start) if start is not None else find_start(log)
    return pose, np.diag(np.square(START_DEVIATIONS)) if covariance is None else read_covariance(covariance)


def find_start(log: Log) -> Array:
    """The true pose at the first time of the odometry, or the first one after it."""
    remedy = "give start=(x, y, θ)"
    if log.truth is None or not len(log.truth):
        raise InputError(f"the start of the robot is unknown, the log has no truth; {remedy}")
    pose = log.truth.at(log.odometry.times[0])
    if np.isnan(pose).any():
        if log.truth.times[0] > log.odometry.times[0] + START_GAP:
            raise InputError(f"the start of the robot is unknown, the truth begins later; {remedy}")
        pose = log.truth.poses[0]
    return pose


START_GAP = 1.0
"""Seconds by which the truth may begin after the odometry and still tell the start."""


def report_run(name: str, timeline: Timeline, passed: Passed, seconds: float) -> Localization:
    """The answer of a filter."""
    used = passed.accepted
    dof = int(passed.dof[used].sum())
    stats = LocalizationStats(
        updates=int(used.sum()),
        rejected=int((~used).sum()),
        skipped=timeline.skipped,
        inflations=len(passed.inflated),
        mean_nis=float(passed.nis[used].sum() / dof) if dof else float("nan"),
        seconds=seconds,
    )
    is_lost = bool(passed.lost[-1]) or not stats.updates
    return Localization(
        times=timeline.times,
        poses=passed.poses,
        covariances=passed.covariances,
        filter=name,
        status="lost" if is_lost else "localised",
        lost=passed.lost,
        nis=passed.nis,
        dof=passed.dof,
        innovations=passed.innovations,
        rejected=~used,
        measured=timeline.node,
        stats=stats,
        _timeline=timeline,
        _passed=passed,
    )
