"""SLAM of landmarks step by step: predict by an increment, update by readings, ask for pose and landmarks."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats, as_generator, bounded_number, whole_number
from cspace.errors import InputError, check_known
from cspace.localization.checks import Running, read_covariance, read_pose
from cspace.localization.landmark_slam.outcomes import ReadingOutcomes, read_outcomes
from cspace.localization.log import LARGEST_NAME, UNKNOWN, Landmarks, Readings
from cspace.localization.sensors import RangeBearing, read_sensor, read_share
from cspace.mobile import MotionNoise, RandomWalk
from cspace.mobile.noise import read_noise
from cspace.spatial import log_se2, pose_2d
from cspace.tables import count_things, one_line, tabulate

LINEARIZATIONS: Final = ("invariant", "first_estimate", "plain")
ASSOCIATIONS: Final = ("joint", "nearest")
PAIR_SHARE: Final = 0.99
"""Share of χ² within which readings without names are paired, each and all at once (Neira & Tardós 2001)."""
NEW_SHARE: Final = 0.9999
"""Share of χ² beyond which a reading without a name makes a landmark; between the two shares it is
ambiguous."""
CONFIRMED_AFTER: Final = 3
"""Updates that must see a landmark without a name before it counts."""
DROPPED_AFTER: Final = 20
"""Updates in a row that should have seen a landmark that does not count yet, after which it is removed."""
LOST_AFTER: Final = 10
"""Sum of rejections from which the filter is lost (each accepted reading takes two away), and rejections in a
row after which the covariance of its pose is inflated."""
MOST_NODES: Final = 20_000
"""Nodes of the search for joint compatibility, a few ten milliseconds; then its best pairings so far
count."""
RESAMPLE_BELOW: Final = 0.5
"""Effective number of particles over their number below which they are drawn anew."""
MOST_PARTICLES: Final = 1_000_000
"""Particles above which a map of each no longer fits into memory."""


@tabulate("status", "pose", "covariance", "landmarks")
class LandmarkFilter(Running):
    """What both filters share. Made by EkfSlam and FastSlam."""

    _core: Any
    _instead = "keep its pose, covariance and landmarks"

    def __init__(self, noise: MotionNoise | None) -> None:
        model = read_noise(noise)
        self._noise = model
        self._walk = (
            [model.distance, model.side, model.drift, model.turn, model.rest, model.rest_turn]
            if type(model) is RandomWalk
            else None
        )

    def predict(self, increment: npt.ArrayLike, dt: float = 0.0) -> None:
        """Moves by an increment: the next pose in the last one, x, y, θ (3,) [m, rad], that took dt [s].

        The noise is that of the filter. Raises InputError for numbers that are not finite.
        """
        try:
            if self._walk is not None and 0.0 <= dt < np.inf:
                self._core.predict_walk(increment, self._walk, dt)
                return
        except (TypeError, ValueError):
            pass  # what follows says what is wrong, or converts it
        step = read_pose(increment, "increment")
        dt = bounded_number(dt, "dt", 0.0, "give the seconds that the step took")
        if self._walk is not None:
            self._core.predict_walk(step, self._walk, dt)
        else:
            Q = self._noise.covariance(log_se2(pose_2d(xytheta=step)), dt)
            self._core.predict(step, np.ascontiguousarray(Q).ravel())

    def update(self, readings: Readings | npt.ArrayLike) -> None:
        """Uses all readings of one time: Readings, or rows name, range [m], bearing [rad] (k, 3).

        NaN where one of the two was not measured, name −1 where it is unknown; one filter takes readings
        with names or without, not both. Raises InputError for readings that cannot be used.
        """
        rows = readings
        if not isinstance(readings, np.ndarray):
            rows = self._read_rows(readings)
        try:
            usable = self._core.update(rows)
        except TypeError:
            usable = self._core.update(self._read_rows(readings))
        except RuntimeError as error:
            raise InputError(f"this filter cannot go on, {error}; make a new one") from None
        if not usable:
            explain_rows(self._read_rows(readings))

    @staticmethod
    def _read_rows(readings: Readings | npt.ArrayLike) -> Array:
        """Rows name, range, bearing, NaN allowed (k, 3)."""
        if isinstance(readings, Readings):
            return np.stack([readings.landmark.astype(float), readings.range, readings.bearing], axis=-1)
        rows = np.ascontiguousarray(as_floats(readings, "readings", finite=False))
        if rows.size == 0:
            return np.empty((0, 3))
        if rows.ndim == 1:
            rows = rows[None]
        if rows.ndim != 2 or rows.shape[1] != 3:
            raise InputError(f"readings has shape {rows.shape}; expected rows name, range, bearing, (k, 3)")
        return rows

    @property
    def pose(self) -> Array:
        """The pose x, y, θ (3,) [m, rad]."""
        return np.asarray(self._core.pose)

    @property
    def covariance(self) -> Array:
        """The covariance (3, 3) of ξ in T exp ξ, in base."""
        return np.asarray(self._core.covariance)

    @property
    def landmarks(self) -> Landmarks:
        """The landmarks with their covariances; without names those that three updates saw."""
        names, points, covariances, _, confirmed = self._core.landmarks
        keep = confirmed.astype(bool)
        return Landmarks(names[keep], points[keep], covariances[keep])

    @property
    def outcomes(self) -> ReadingOutcomes:
        """What became of the readings of the last update, a row each."""
        return read_outcomes(self._core.outcomes)

    @property
    def status(self) -> str:
        """ "localised", or "lost" where most of the last readings were rejected."""
        return "lost" if self._core.is_lost else "localised"

    def __bool__(self) -> bool:
        return not self._core.is_lost

    def __repr__(self) -> str:
        known = count_things(len(self._core.landmarks[0]), "landmark")
        x, y, theta = self.pose
        text = f"{known}, at ({x:.3g}, {y:.3g}, {theta:.3g}): {self.status}"
        return one_line(type(self).__name__, text)


class EkfSlam(LandmarkFilter):
    """SLAM of landmarks by an extended Kalman filter on a pose and all landmarks at once.

    start: the first pose (3,) or (3, 3), the origin unless given; start_covariance (3, 3) of ξ in T exp ξ,
    zero unless given. sensor: a RangeBearing. noise: of the odometry, a RandomWalk unless given.
    linearization: "invariant" (Barrau & Bonnabel 2015), "first_estimate" (Huang, Mourikis & Roumeliotis
    2010) or "plain", which grows too sure of its heading. association: of readings without names, "joint"
    compatibility (Neira & Tardós 2001) or the "nearest" compatible one in turn. gate: share of χ² beyond
    which a reading with a name is rejected. Raises UnknownNameError for another name, InputError for a
    covariance that is none.
    """

    def __init__(
        self,
        *,
        start: npt.ArrayLike = (0.0, 0.0, 0.0),
        start_covariance: npt.ArrayLike | None = None,
        sensor: RangeBearing | None = None,
        noise: MotionNoise | None = None,
        linearization: str = "invariant",
        association: str = "joint",
        gate: float = 0.999,
    ) -> None:
        super().__init__(noise)
        check_known("linearization", linearization, LINEARIZATIONS)
        check_known("association", association, ASSOCIATIONS)
        self._core = _core.make_ekf_slam(
            list_sensor(read_sensor(sensor, RangeBearing)),
            list_rule(gate),
            LINEARIZATIONS.index(linearization),
            association == "joint",
            MOST_NODES,
            *read_start_rows(start, start_covariance),
        )

    @property
    def joint_covariance(self) -> Array:
        """The covariance of x, y, θ and of the points of all landmarks in axes of the map, (3 + 2m, 3 +
        2m)."""
        return np.asarray(self._core.joint_covariance)


class FastSlam(LandmarkFilter):
    """SLAM of landmarks by particles, each with a pose and a Kalman filter per landmark.

    n: particles. version 1 draws poses from the odometry (Montemerlo et al. 2002), version 2 from odometry
    and readings (Montemerlo et al. 2003). rng: int, Generator or None; the same seed gives the same
    particles. Other arguments as of EkfSlam; readings without names are paired by each particle on its own.
    Raises InputError for another version or number.
    """

    def __init__(
        self,
        *,
        n: int = 100,
        version: int = 2,
        start: npt.ArrayLike = (0.0, 0.0, 0.0),
        start_covariance: npt.ArrayLike | None = None,
        sensor: RangeBearing | None = None,
        noise: MotionNoise | None = None,
        gate: float = 0.999,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        super().__init__(noise)
        whole_number(version, "version", 1, 2)
        self._core = _core.make_fast_slam(
            list_sensor(read_sensor(sensor, RangeBearing)),
            list_rule(gate),
            version,
            whole_number(n, "n", 1, MOST_PARTICLES),
            int(as_generator(rng).integers(2**63)),
            RESAMPLE_BELOW,
            *read_start_rows(start, start_covariance),
        )

    @property
    def particles(self) -> Array:
        """The poses of the particles, x, y, θ (n, 3) [m, rad]."""
        return np.asarray(self._core.particles[:, :3])

    @property
    def weights(self) -> Array:
        """The weights of the particles (n,), which sum to 1."""
        return np.asarray(self._core.particles[:, 3])


def list_sensor(sensor: RangeBearing) -> list[float]:
    """A sensor as the core takes it."""
    numbers = [
        sensor.range_sigma,
        sensor.bearing_sigma,
        sensor.range_bias,
        sensor.bearing_bias,
        *sensor.mount,
    ]
    most = sensor.most_range if np.isfinite(sensor.most_range) else np.finfo(float).max
    return [*numbers, float(most), 0.5 * sensor.field_of_view]


def list_rule(gate: float) -> list[float]:
    """Gates and counts as the core takes them."""
    return [read_share(gate, "gate"), PAIR_SHARE, NEW_SHARE, CONFIRMED_AFTER, DROPPED_AFTER, LOST_AFTER]


def read_start_rows(start: npt.ArrayLike, covariance: npt.ArrayLike | None) -> tuple[Array, Array]:
    """The first pose (3,) and its covariance as nine numbers."""
    P = np.zeros((3, 3)) if covariance is None else read_covariance(covariance)
    return read_pose(start), P.ravel()


def explain_rows(rows: Array) -> None:
    """InputError for the first reading that cannot be used."""
    names, ranges, bearings = rows.T
    is_name = (names == np.round(names)) & (names >= UNKNOWN) & (names <= LARGEST_NAME)
    if not is_name.all():
        raise InputError("names of landmarks must be whole numbers from 0 to 2⁵³, or −1 where unknown")
    Readings(np.zeros(len(rows)), names, ranges, bearings)
    if (names < 0).any() and (names >= 0).any():
        raise InputError("some readings have names and some have none; give all of them names, or −1 to all")
    wide = np.flatnonzero(np.abs(bearings) > 2 * np.pi)
    if len(wide):
        raise InputError(f"bearing is {bearings[wide[0]]:g} at row {wide[0]}, beyond ±2π; give radians")
    raise InputError("readings cannot be used; names are below 2⁵³")
