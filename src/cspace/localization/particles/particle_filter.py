"""The particle filter: moves particles by odometry, weighs them, and finds a lost robot again."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_generator, bounded_number, truth_value, whole_number
from cspace.errors import InputError
from cspace.localization.checks import Running, read_covariance, read_pose
from cspace.localization.filters.rows import find_twist, follow_rows
from cspace.localization.particles.models import (
    BEAM_MODEL_PARTICLES,
    Judgement,
    ScanModel,
    make_model,
)
from cspace.localization.particles.placing import BLOCK, FreePlaces, lift_share, spread_poses
from cspace.localization.particles.recovery import LEAST_SCORE, MOST_UNKNOWN, ScoreMonitor, add_doubt
from cspace.localization.particles.state import FilterEvent, PoseMode
from cspace.localization.sensors import LaserScanner, RangeBearing
from cspace.mobile import MotionNoise
from cspace.mobile.noise import read_noise
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import STANDING

PARTICLES: Final = 1000
"""The least number of particles unless given."""
MOST_PARTICLES: Final = 4_000_000
"""The most particles: a quarter of a gigabyte."""
GROWTH: Final = 10
"""How many times the least number of particles the most is, unless given."""
GROWN_PARTICLES: Final = 100_000
"""The most particles, unless given or fewer than n."""
SIZE_ERROR: Final = 0.05
"""Divergence of the histogram of the particles from the posterior that their number is made for."""
SIZE_QUANTILE: Final = 2.326
"""The normal quantile of the probability of that, 99 %."""
FULL_STEP: Final = 0.1
"""After this distance [m], or turn [rad], a measurement counts wholly; after less for less: the errors of
measurements from one place are the same."""
LONGEST_STEP: Final = 0.1
"""Length [m] or turn [rad] of odometry that is added to particles at once."""
START_DEVIATIONS: Final = (0.1, 0.1, 0.05)
"""Standard deviations of a start [m, m, rad] unless given."""
PLACE_DEVIATIONS: Final = (0.05, 0.05, 0.02)
"""Standard deviations around places found on the map [m, m, rad]: a cell, and a step of its headings."""
OTHER_SHARE: Final = 0.15
"""Share of the weight of a second mode from which the place is ambiguous."""
LISTED_SHARE: Final = 0.01
"""Share of the weight from which a mode is listed."""
WIDEST: Final = (1.0, 0.5)
"""Standard deviations of the position [m] and heading [rad] beyond which the place is ambiguous."""
LOOK_EVERY: Final = 5
"""Measurements from one look along their rays to the next, while scores are usual: it takes a third of the
time of an update."""
FRESH_UPDATES: Final = 5
"""Measurements after a search that count wholly, even where the robot stands, and with more particles."""
SEARCH_GROWTH: Final = 5
"""How many times the least number of particles there are in these updates, at most: of each place many must
be near the pose that fits best, or places that look alike get weights by chance."""

NEAR_GAIN: Final = 0.05
"""By how much the score of a pose near a mode must exceed that of the best particle to get particles."""
CARRIED: Final = 5.0
"""Logarithm of the odds against having been carried to another place since the last measurement."""
KEPT_SHARE: Final = 0.1
"""The least share of the weight that the particles before a search keep: later scans may agree with them."""


@tabulate("status", "reason", "pose", "covariance", "modes")
class ParticleFilter(Running):
    """Where a robot is, as weighted poses: predict with odometry, update with scans or readings.

    grid: an OccupancyGrid or an EvidenceGrid, a ByteField, or Landmarks. motion: the noise of the odometry
    (RandomWalk unless given), or a vehicle, for which it is that. sensor: a LaserScanner, or a RangeBearing
    for Landmarks. n: the least number of particles; most: the most, 10 n unless given (KLD sampling decides,
    Fox 2003). start: pose x, y, θ (3,) or (3, 3), or None where the robot may be anywhere;
    start_covariance (3, 3) of ξ in T exp ξ, 10 cm and 0.05 rad unless given. recover: whether to search the
    map at the start and where the measurements stop to fit. threads: at most; the answer does not depend on
    them. rng: int, Generator or None; the same seed gives the same particles on every machine.

    Raises InputError for too many particles, a map without free cells, a start off the map or in a wall.
    Source: Thrun, Burgard & Fox 2005, chapter 8.
    """

    _instead = "keep its particles and weights, or make another one with the same rng="

    def __init__(
        self,
        grid: Any,
        *,
        motion: Any | None = None,
        sensor: LaserScanner | RangeBearing | None = None,
        n: int | None = None,
        most: int | None = None,
        start: npt.ArrayLike | None = None,
        start_covariance: npt.ArrayLike | None = None,
        recover: bool = True,
        threads: int = 1,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        self.grid, self.model = grid, make_model(grid, sensor)
        self.noise = read_motion(motion)
        self.least, largest = read_sizes(self.model, n, most)
        self.threads = whole_number(threads, "threads", 0, 1024)
        self.recover = truth_value(recover, "recover")
        self._rng = as_generator(rng)
        reach = sensor.most_range if isinstance(sensor, RangeBearing) else np.inf
        self._places = FreePlaces(grid, reach)
        self._cloud = _core.ParticleCloud(largest, int(self._rng.integers(2**63)))
        self._monitor = ScoreMonitor(self.model.threshold)
        self._pending, self._since, self._seconds, self._path = np.zeros(3), np.zeros(3), 0.0, 0.0
        self._fresh = FRESH_UPDATES if start is None else 1
        self._grown = min(largest, SEARCH_GROWTH * self.least)
        self._found: list[PoseMode] | None = None
        self.updates, self.score = 0, float("nan")
        self._unknown = 0.0  # share of the last measurement that the map cannot judge
        self._events: list[FilterEvent] = []
        self._was = ""
        self.is_searching = start is None
        self._place_first(start, start_covariance)

    def _place_first(self, start: npt.ArrayLike | None, covariance: npt.ArrayLike | None) -> None:
        if start is None:
            self._cloud.place(self._places.draw(self.least, self._rng))
            return
        pose = read_pose(start)
        self._places.check_start(pose)
        P = np.diag(np.square(START_DEVIATIONS))
        if covariance is not None:
            P = read_covariance(covariance)
        self._cloud.place(spread_poses(self._cloud, pose[None], P, self._places, self.least))

    # --- the two steps of the filter --------------------------------------------------------------------

    def predict(
        self, increment: npt.ArrayLike, dt: float = 0.0, *, covariance: npt.ArrayLike | None = None
    ) -> None:
        """Moves the particles by odometry: the pose of the next base in the last one, (3,) x, y [m], θ [rad],
        or (3, 3), that took dt [s], with noise. covariance (3, 3) of w in T D exp w, in the new base; unless
        given, that of the model of the motion. While the robot stands nothing happens.
        """
        step = read_pose(increment, "increment")
        seconds = bounded_number(dt, "dt", 0.0, "give seconds, not below zero")
        Q = None if covariance is None else read_covariance(covariance, "covariance")
        if Q is not None:
            self._move()
        self._pending, self._since = follow_rows(self._pending, step), follow_rows(self._since, step)
        self._path += float(np.hypot(step[0], step[1]) + abs(step[2]))
        self._seconds += seconds
        self._found = None
        if Q is not None or self._path > LONGEST_STEP:
            self._move(Q)

    def _move(self, covariance: Array | None = None) -> None:
        """Applies the odometry that was not yet, unless the robot stands."""
        self._path = 0.0
        if measure_step(self._pending) < STANDING:
            self._seconds = 0.0
            return
        if covariance is None:
            xi = find_twist(np.zeros(3), self._pending)
            covariance = self.noise.covariance(xi, self._seconds)
        self._cloud.move(self._pending, np.ascontiguousarray(covariance).ravel(), self.threads)
        self._pending, self._seconds = np.zeros(3), 0.0
        self._found = None

    def update(self, scan: Any) -> None:
        """Weighs the particles by a measurement: one scan of Scans, ends of beams in base (m, 2), or
        Readings.

        Looks for other places where it fits nowhere, and resamples where few particles have the weight. A
        scan without returns changes nothing.
        """
        self._move()
        share = min(1.0, measure_step(self._since) / FULL_STEP)
        if self._fresh:
            share = 1.0
        share = share if share > STANDING / FULL_STEP else 0.0
        used = share if self._unknown < MOST_UNKNOWN else 0.0
        score = self.model.weigh(self._cloud, scan, used, self.threads)
        if score is None:
            return
        self.updates += 1
        self.score, self._found = score, None
        self._fresh = max(self._fresh - 1, 0)
        if share > 0:
            self._since = np.zeros(3)
        if used > 0 and not self.is_searching:
            self._weigh_modes(scan, used)
        judged = Judgement(score, score)
        if not self.is_searching and self._wants_look(score):
            judged = self.model.judge(scan, self._best(), score)
            if self._monitor.is_unusual(judged.score) and judged.unknown < MOST_UNKNOWN:
                judged = self._match(scan, judged)
        self._unknown = judged.unknown
        says_something = judged.unknown < MOST_UNKNOWN
        if says_something:
            self._monitor.see(judged)
        is_low = says_something and self._monitor.wants_search(judged)
        if self.recover and (self.is_searching or is_low):
            judged = self._search(scan, judged)
        elif share > 0:
            self._resample()
        if says_something:
            self._monitor.add(judged, share > 0 and self.status == "localised")
        self._note_status()

    def _wants_look(self, score: float) -> bool:
        """Whether to look along the rays: ends behind walls may score as usual."""
        monitor = self._monitor
        is_due = self.updates % LOOK_EVERY == 0
        return bool(self._fresh) or is_due or monitor.is_crossing or monitor.is_unusual(score)

    def _resample(self) -> None:
        cloud = self._cloud
        if cloud.effective_count() < 0.5 * len(cloud):
            needs_more = self._fresh or self._was == "ambiguous"
            least = self._grown if needs_more else self.least
            cloud.resample(least, SIZE_ERROR, SIZE_QUANTILE)

    def _match(self, scan: Any, judged: Judgement) -> Judgement:
        """Puts half of the particles on poses near the modes that fit better, if there are some; the new
        judgement.

        Wheels that slip move a robot further than the noise of its odometry says.
        """
        above = judged.whole + NEAR_GAIN + add_doubt(judged)
        found = [
            (self.model.match(scan, mode.pose, self._monitor.least_of_places, above), mode.share)
            for mode in self.modes
            if mode.share >= OTHER_SHARE
        ]
        poses = [pose for pose, share in found for _ in range(round(share / OTHER_SHARE)) if pose is not None]
        if not poses:
            return judged
        self._events.append(FilterEvent(self.updates, "match", judged.score, len(found)))
        self._add_particles(np.array(poses), self.least)
        self.score = self.model.weigh(self._cloud, scan, 1.0, self.threads) or judged.score
        return self.model.judge(scan, self._best(), self.score)

    def _weigh_modes(self, scan: Any, share: float) -> None:
        """Weighs modes against one another by all that the model knows of them: it is too dear for every
        particle."""
        poses = np.array([mode.pose for mode in self.modes])
        if len(poses) < 2:
            return
        logs = self.model.correct(scan, poses)
        if logs is None:
            return
        added = np.empty(len(self._cloud))
        for begin in range(0, len(added), BLOCK):
            block = slice(begin, begin + BLOCK)
            away = find_twist(poses[:, None], self._cloud.poses(block.start, block.stop))
            added[block] = share * logs[np.argmin(np.square(away).sum(axis=-1), axis=0)]
        self._cloud.add_logs(added)
        self._found = None

    def _best(self) -> Array:
        """The heaviest particle (3,)."""
        return np.asarray(self._cloud.heaviest()[0])

    def _search(self, scan: Any, judged: Judgement) -> Judgement:
        """Puts half of the particles on the best other places, at the start all; the new judgement."""
        is_start, self.is_searching = self.is_searching, False
        bounds = (LEAST_SCORE, LEAST_SCORE) if is_start else self._monitor.bound_places(judged)
        poses = self.model.search(scan, *bounds, self._rng)
        self._monitor.note_search(len(poses))
        kind = "search" if len(poses) else "no place"
        self._events.append(FilterEvent(self.updates, kind, judged.score, len(poses)))
        if not len(poses):
            self.is_searching = is_start
            return judged
        cloud = self._cloud
        if is_start:
            P = np.diag(np.square(PLACE_DEVIATIONS))
            cloud.place(spread_poses(cloud, poses, P, self._places, self._grown))
            self.score = self.model.weigh(cloud, scan, 1.0, self.threads) or judged.score
            self._found = None
            self._weigh_modes(scan, 1.0)
        else:
            kept = self._add_particles(poses, self._grown)
            self.score = self.model.weigh(cloud, scan, 1.0, self.threads) or judged.score
            cloud.add_logs(np.where(np.arange(len(cloud)) < kept, 0.0, -CARRIED))
            self._weigh_modes(scan, 1.0)
            lift_share(cloud, kept, KEPT_SHARE)
        self._fresh = FRESH_UPDATES
        self._found = None
        return self.model.judge(scan, self._best(), self.score)

    def _add_particles(self, poses: Array, least: int) -> int:
        """Replaces every other particle by one around poses (k, 3) in turn; how many were kept, which are
        the first ones."""
        cloud = self._cloud
        cloud.resample(least, SIZE_ERROR, SIZE_QUANTILE)
        rows = cloud.poses()
        kept = (len(rows) + 1) // 2
        rows[:kept] = rows[::2]
        P = np.diag(np.square(PLACE_DEVIATIONS))
        rows[kept:] = spread_poses(cloud, poses, P, self._places, len(rows) - kept)
        cloud.place(rows)
        self._found = None
        return kept

    def _note_status(self) -> None:
        status = self.status
        if status != self._was and self._was and status in ("lost", "localised"):
            self._events.append(FilterEvent(self.updates, status, self.score))
        self._was = status

    # --- what it found ----------------------------------------------------------------------------------

    @property
    def modes(self) -> tuple[PoseMode, ...]:
        """The clusters of the particles with at least 1 % of the weight, the heaviest first."""
        if self._found is None:
            poses, covariances, shares = self._cloud.find_modes()
            poses = follow_rows(poses, self._pending)
            P = covariances.reshape(-1, 3, 3)
            listed = [PoseMode(*each) for each in zip(poses, P, map(float, shares), strict=True)]
            self._found = [mode for k, mode in enumerate(listed) if not k or mode.share >= LISTED_SHARE]
        return tuple(self._found)

    @property
    def pose(self) -> Array:
        """The mean of the heaviest mode, x, y [m], θ [rad] (3,)."""
        return self.modes[0].pose

    @property
    def covariance(self) -> Array:
        """The covariance (3, 3) of the heaviest mode, of ξ in T exp ξ, in base."""
        return self.modes[0].covariance

    @property
    def particles(self) -> Array:
        """The particles, (k, 3): x, y [m], θ [rad]."""
        return follow_rows(self._cloud.poses(), self._pending)

    @property
    def weights(self) -> Array:
        """The weights of the particles, (k,), of sum 1."""
        return self._cloud.weights()

    @property
    def events(self) -> tuple[FilterEvent, ...]:
        """Searches of the map and changes of the status, in order."""
        return tuple(self._events)

    @property
    def status(self) -> str:
        """One of "localised"; "ambiguous", with several modes or a wide one; "lost", where measurements do
        not fit."""
        if (self.is_searching and (self.updates or self.recover)) or self._monitor.is_lost:
            return "lost"
        first, *others = self.modes
        far, turned = first.spread
        if any(mode.share >= OTHER_SHARE for mode in others) or far > WIDEST[0] or turned > WIDEST[1]:
            return "ambiguous"
        return "localised"

    @property
    def reason(self) -> str:
        """The status as one sentence."""
        status, first = self.status, self.modes[0]
        if status == "lost":
            if not self.updates:
                return "nothing was measured yet, and the start is unknown"
            return f"the best particle scores {self.score:.2f}, below {self._monitor.threshold:.2f}"
        far, turned = first.spread
        within = f"within {far:.2f} m and {np.degrees(turned):.1f}° (1σ)"
        if status == "ambiguous" and not any(mode.share >= OTHER_SHARE for mode in self.modes[1:]):
            return f"one place, but only {within}"
        if status == "ambiguous":
            return (
                f"{count_things(len(self.modes), 'mode')}, the heaviest with {first.share:.0%} of the weight"
            )
        return within + (f", score {self.score:.2f}" if np.isfinite(self.score) else ", nothing measured yet")

    def __bool__(self) -> bool:
        return self.status == "localised"

    def __len__(self) -> int:
        """How many particles there are."""
        return len(self._cloud)

    def __repr__(self) -> str:
        return one_line("ParticleFilter", f"{len(self)} particles: {self.status}, {self.reason}")


def measure_step(row: Array) -> float:
    """How far a step x, y [m], θ [rad] goes: distance and turn added."""
    return float(np.hypot(row[0], row[1]) + abs(row[2]))


def read_motion(motion: Any | None) -> MotionNoise:
    """A model of noise. Raises InputTypeError for what is neither one nor a vehicle."""
    is_vehicle = not isinstance(motion, type) and callable(getattr(motion, "twist", None))
    return read_noise(None if is_vehicle else motion, "motion")


def read_sizes(model: Any, n: int | None, most: int | None) -> tuple[int, int]:
    """The least and the most number of particles."""
    limit = MOST_PARTICLES
    if isinstance(model, ScanModel) and model.table is not None:
        limit = BEAM_MODEL_PARTICLES
    note = (
        "the beam model casts a ray per beam; model='likelihood_field' takes more"
        if limit < PARTICLES
        else ""
    )
    least = whole_number(min(PARTICLES, limit) if n is None else n, "n", 1, limit, note or "fewer are enough")
    if most is None:
        return least, max(least, min(GROWTH * least, GROWN_PARTICLES, limit))
    largest = whole_number(most, "most", 1, limit, note)
    if largest < least:
        raise InputError(
            f"most is {largest} and n {least}; the most particles cannot be fewer than the least"
        )
    return least, largest
