"""cspace.slam: from a log to a trajectory and a map."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from time import perf_counter
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace._core import LaserSlamRun, TimeOver, set_deadline
from cspace.arrays import Array, positive_number, truth_value
from cspace.errors import InputError, InputTypeError, check_known, name_type
from cspace.localization.checks import read_pose
from cspace.localization.filters.rows import follow_rows
from cspace.localization.graph import GraphAnswer, PoseGraph
from cspace.localization.landmark_slam import LandmarkSlam, run_ekf_slam, run_fast_slam
from cspace.localization.laser_slam.answer import LaserSlam, LaserSlamStats, LoopClosure
from cspace.localization.log import Log, Scans
from cspace.localization.scans.match import check_bell
from cspace.localization.scans.points import find_view, place_beams
from cspace.mobile import Odometry, TimedPoses, calibrate
from cspace.spatial import inverse_pose_2d, log_se2, pose_2d

METHODS: Final = ("graph", "ekf", "fastslam")
SLICE: Final = 64
"""Scans between two calls of progress."""
SIGMA: Final = 0.08
"""The bell of a point in the fields that scans are matched against [m]: wider than the scatter of a laser, so
that the peak is found from some centimetres away."""
LOST_AFTER: Final = 10
"""Scans in a row without a match after which the robot is lost."""
CALIBRATION: Final = 0.3
"""The share of the time of the first of two passes over the scans."""
VERDICTS: Final = (
    "accepted",
    "ambiguous: another pose scores nearly as much",
    "inconsistent with the loops that agree with each other",
    "alone: no other loop agrees with it",
    "clipped: the best pose lies at the edge of the search",
)
"""What the core says of loops, by number."""
UNKNOWN_FACTORS: Final = (1.0, 1.0, 0.0)
Progress = Callable[[float], Any]


def slam(
    log: Log,
    *,
    method: str = "graph",
    start: npt.ArrayLike = (0.0, 0.0, 0.0),
    resolution: float = 0.05,
    max_range: float = 20.0,
    loops: bool = True,
    calibrated: bool = True,
    rng: int | np.random.Generator | None = None,
    time_limit: float | None = None,
    progress: Progress | None = None,
) -> LaserSlam | LandmarkSlam:
    """Trajectory and map of a log, without a map given.

    "graph" needs scans and odometry. The odometry is calibrated by its own scan matches. Every scan is
    matched against the last thirty (Olson 2009). Scans of earlier passes within the covariance of the drive
    are tried as loops, and those that agree pairwise (Mangelson et al. 2018) enter a pose graph, which
    rejects what contradicts it (Agarwal et al. 2013). "ekf" and "fastslam" need readings of landmarks, as
    run_ekf_slam and run_fast_slam with their defaults.

    start: (3,) or (3, 3), the pose at which trajectory and map begin: for "graph" at the first scan that is
    used, for the others at the first time of the odometry. The answer is in its frame. resolution: of the
    fields and of the map [m]. max_range [m]: farther beams are not used. loops: whether
    loops are searched. calibrated: False to take the odometry as it is. rng: int, Generator or None, for
    "fastslam" alone. time_limit [s]: the answer is what was done until then. progress: called with the share
    that is done, 0 to 1. Raises InputError for a log without scans or odometry, or without any return.
    """
    if not isinstance(log, Log):
        raise InputTypeError(f"log is {name_type(log)}; read one with cspace.read_log, or make a Log")
    check_known("method", method, METHODS)
    limit = None if time_limit is None else positive_number(time_limit, "time_limit", largest=inf)
    first = read_pose(start)
    if method == "ekf":
        return run_ekf_slam(log, start=first, time_limit=limit)
    if method == "fastslam":
        return run_fast_slam(log, start=first, rng=rng, time_limit=limit)
    drive = read_drive(log, positive_number(max_range, "max_range"))
    cell = positive_number(resolution, "resolution")
    check_bell(cell, SIGMA, f"resolution is {cell:g} m, and the bells of points {SIGMA:g} m; these may have")
    flags = truth_value(loops, "loops"), truth_value(calibrated, "calibrated")
    if not (progress is None or callable(progress)):
        raise InputTypeError(f"progress is {name_type(progress)}; give a function of a share, 0 to 1")
    mapper = Mapper(drive, first, cell, *flags, progress)
    mapper.run(inf if limit is None else limit)
    return mapper.report()


class Drive(NamedTuple):
    """What is used of a log: odometry, scans within its times, and how many are not."""

    odometry: Odometry
    scans: Scans
    skipped: int
    max_range: float


def read_drive(log: Log, max_range: float) -> Drive:
    """The scans that the odometry covers; InputError where there are none, or no beam returned."""
    if log.scans is None or not len(log.scans):
        others = (
            "" if log.readings is None else '; its readings of landmarks are for method="ekf" or "fastslam"'
        )
        raise InputError(f'the log has no scans, and method="graph" needs those of a laser{others}')
    times = log.odometry.times
    if not len(times):
        raise InputError("the log has no odometry; SLAM needs it between the scans")
    inside = (log.scans.times >= times[0]) & (log.scans.times <= times[-1])
    if not inside.any():
        raise InputError(
            f"all scans lie outside of the odometry, which covers {times[0]:g} to {times[-1]:g} s; the clocks"
            " may differ"
        )
    scans = log.scans.subset(inside)
    if not (scans.returns & (scans.ranges <= max_range)).any():
        raise InputError(
            f"no beam returned from within {max_range:g} m; check `most` of the scans, or give max_range="
        )
    return Drive(log.odometry, scans, int((~inside).sum()), max_range)


class Mapper:
    """The stages of laser SLAM, each kept, with the first pose at the origin; the report begins at start."""

    def __init__(
        self,
        drive: Drive,
        start: Array,
        resolution: float,
        loops: bool,
        calibrated: bool,
        progress: Progress | None,
    ) -> None:
        self.drive, self.start, self.resolution = drive, start, resolution
        self.loops, self.calibrated = loops, calibrated
        self.tell = (lambda share: None) if progress is None else progress
        self.begun = perf_counter()
        self.stages: dict[str, TimedPoses] = {}
        self.factors = UNKNOWN_FACTORS
        self.core: LaserSlamRun | None = None
        self.answer: GraphAnswer | None = None
        self.covariances: Array | None = None
        self.is_over = False

    def run(self, limit: float) -> None:
        """All stages, or those that the time limit allows."""
        outer = set_deadline(limit)
        try:
            self.match_and_close()
            self.optimize()
            self.tell(1.0)
        except TimeOver:
            if perf_counter() - self.begun < limit:
                raise  # that of a caller
            self.is_over = True
        finally:
            set_deadline(outer - (perf_counter() - self.begun))

    def match_and_close(self) -> None:
        """The passes over the scans."""
        odometry, times = self.drive.odometry, self.drive.scans.times
        self.stages["odometry"] = sample_odometry(odometry, times)
        if self.calibrated:
            self.pass_scans(odometry, False, 0.0, CALIBRATION)
            corrected = self.calibrate_odometry()
            if corrected is not None:
                odometry = corrected
                self.stages["calibrated"] = sample_odometry(odometry, times)
        self.pass_scans(odometry, self.loops, CALIBRATION if self.calibrated else 0.0, 0.98)

    def pass_scans(self, odometry: Odometry, loops: bool, begin: float, end: float) -> None:
        """Matches all scans once; progress goes from begin to end."""
        points, first = place_beams(self.drive.scans, odometry, self.drive.max_range)
        steps = between_scans(sample_odometry(odometry, self.drive.scans.times))
        view = find_view(self.drive.scans)
        self.core = LaserSlamRun(points, first, steps, *view, self.resolution, SIGMA, loops)
        while self.core.advance(SLICE):
            self.tell(begin + (end - begin) * self.core.done / max(len(first) - 1, 1))

    def calibrate_odometry(self) -> Odometry | None:
        """The odometry with the factors that its own scan matches give, if they help where they were not
        fitted; else None."""
        assert self.core is not None
        matched = TimedPoses(self.drive.scans.times, self.core.poses)
        try:
            raw, corrected = calibrate(self.drive.odometry, matched).held_out
            if not corrected < raw:
                return None
            fit = calibrate(self.drive.odometry, matched, part=1.0)
        except InputError:  # too short, or straight ahead
            return None
        self.factors = (fit.distance, fit.turn, fit.drift)
        return fit.odometry

    def optimize(self) -> None:
        """The pose graph of the edges and the accepted loops."""
        graph, _ = self.make_graph()
        robust = "dcs" if len(graph.edges) >= len(graph.poses) else None
        self.answer = graph.optimize(start="given", robust=robust)
        self.covariances = self.answer.marginals

    def make_graph(self) -> tuple[PoseGraph, npt.NDArray[np.intp]]:
        """The graph of what is done, and the rows of the loops in it."""
        assert self.core is not None
        poses = self.core.poses
        ends, motions, covariances, _, _ = self.core.edges
        loop_ends, loop_motions, loop_covariances, _, verdicts = self.core.loops
        used = np.flatnonzero(verdicts == 0)
        information = np.linalg.inv(np.concatenate([covariances, loop_covariances[used]]).reshape(-1, 3, 3))
        graph = PoseGraph(
            poses,
            np.concatenate([ends, loop_ends[used]]),
            np.concatenate([motions, loop_motions[used]]),
            0.5 * (information + np.swapaxes(information, 1, 2)),
        )
        return graph, used

    def report(self) -> LaserSlam:
        """The answer, as far as the stages were done."""
        if self.core is None:  # not one scan within the time limit
            one = self.drive.scans.subset(slice(0, 1))
            points, first = place_beams(one, self.drive.odometry, self.drive.max_range)
            no_steps = np.zeros((0, 3))
            self.core = LaserSlamRun(points, first, no_steps, *find_view(one), self.resolution, SIGMA, False)
        scans = self.drive.scans.subset(slice(0, self.core.done))
        graph, used = self.make_graph()
        self.stages["matched"] = TimedPoses(scans.times, self.core.matched)
        poses, covariances = graph.poses, np.full((len(graph.poses), 3, 3), np.nan)
        if self.answer is not None:
            poses = self.answer.poses
            covariances = covariances if self.covariances is None else self.covariances
            self.stages["closed"] = TimedPoses(scans.times, poses, covariances)
        poses = self.place(poses)
        placed = {
            name: TimedPoses(stage.times, self.place(stage.poses), stage.covariances)
            for name, stage in self.stages.items()
        }
        closures = self.list_loops(used, len(graph.poses) - 1)
        scores = self.core.edges[3][:, 0]
        accepted = sum(loop.accepted for loop in closures)
        stats = LaserSlamStats(
            len(scans),
            self.drive.skipped,
            int((scores == 0).sum()),
            self.core.tried,
            accepted,
            len(closures) - accepted,
            self.core.optimizations,
            self.factors,
            perf_counter() - self.begun,
        )
        status, reason = self.judge(scores, stats)
        return LaserSlam(
            times=scans.times,
            poses=poses,
            covariances=covariances,
            graph=graph.with_poses(poses),
            loops=closures,
            stages=placed,
            scans=scans,
            scores=np.concatenate([[np.nan], scores]),
            status=status,
            reason=reason,
            stats=stats,
            resolution=self.resolution,
            max_range=self.drive.max_range,
        )

    def place(self, poses: Array) -> Array:
        """Poses (n, 3) as they are if the first one is at start. Covariances and edges stay, as those of
        poses are in base and those of edges between two."""
        return follow_rows(self.start, poses) if self.start.any() else poses

    def judge(self, scores: Array, stats: LaserSlamStats) -> tuple[str, str]:
        """The status, and the same in words."""
        if self.is_over:
            done = f"{stats.scans} of {len(self.drive.scans)} scans"
            return "time_limit", f"the time limit was over after {done}; the poses are the best until then"
        if len(scores) >= LOST_AFTER and not scores[-LOST_AFTER:].any():
            return "lost", f"the last {LOST_AFTER} scans or more match nothing; their poses are odometry"
        loops = f"{stats.accepted} loops accepted, {stats.rejected} rejected"
        return "mapped", f"{stats.scans - stats.unmatched} scans matched, {loops}"

    def list_loops(self, used: npt.NDArray[np.intp], edges: int) -> tuple[LoopClosure, ...]:
        """All loops that were found; edges: of the graph that come before the accepted ones."""
        assert self.core is not None
        ends, motions, covariances, scores, verdicts = self.core.loops
        reasons = [VERDICTS[verdict] for verdict in verdicts]
        for edge in self.answer.rejected if self.answer is not None else ():
            reasons[used[edge.edge - edges]] = (
                f"contradicts the graph: χ² {edge.chi2:.3g} is above {edge.limit:.3g}"
            )
        return tuple(
            LoopClosure(
                int(ends[k, 0]),
                int(ends[k, 1]),
                motions[k],
                covariances[k].reshape(3, 3),
                float(scores[k, 0]),
                reason == VERDICTS[0],
                reason,
            )
            for k, reason in enumerate(reasons)
        )


def sample_odometry(odometry: Odometry, times: Array) -> TimedPoses:
    """The poses of dead reckoning at times within it, the first one at the origin."""
    reckoned = odometry.split(times).dead_reckoning()
    rows = np.searchsorted(reckoned.times, times)  # of equal stamps of a mended clock the first
    T = pose_2d(xytheta=reckoned.poses[rows])
    moved = inverse_pose_2d(T[:1]) @ T
    headings = np.arctan2(moved[:, 1, 0], moved[:, 0, 0])
    return TimedPoses(times, np.stack([moved[:, 0, 2], moved[:, 1, 2], headings], axis=-1))


def between_scans(poses: TimedPoses) -> Array:
    """The twists (n − 1, 3) from each pose to the next."""
    T = pose_2d(xytheta=poses.poses)
    return np.ascontiguousarray(log_se2(inverse_pose_2d(T[:-1]) @ T[1:]))
