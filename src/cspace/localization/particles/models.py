"""How particles are weighed by a measurement, and where else a measurement could have been made."""

from __future__ import annotations

from typing import Any, Final, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, one_array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.localization.checks import suggest_map
from cspace.localization.log import UNKNOWN, Landmarks, Readings, Scans
from cspace.localization.particles.beam_model import BeamTable
from cspace.localization.particles.evidence import Evidence, RayJudge, open_unknown
from cspace.localization.particles.thinning import read_ends, thin_ends
from cspace.localization.scans.match import match_scan
from cspace.localization.scans.search import search_pose
from cspace.localization.sensors import LaserScanner, RangeBearing
from cspace.maps import ByteField, OccupancyGrid, cast_rays
from cspace.tolerances import FALSE_READINGS

FEWEST_BEAMS: Final = 5
"""Ends below which a scan tells nothing: fewer fit anywhere."""
SEARCH_BEAMS: Final = 180
"""Beams with which the whole map is searched."""
MOST_PLACES: Final = 3
"""Places found on the map that get particles."""
CANDIDATES: Final = 16
"""Places found by the ends of beams, of which their rays choose."""
CANDIDATE_MARGIN: Final = 0.4
"""By how much their ends may score below those of the best one."""
LEAST_OF_ENDS: Final = 0.35
"""The least score of the ends of beams at a place: most of them may be unknown to the map."""
BEAM_MODEL_PARTICLES: Final = 500
"""The most particles of the beam model: each ray takes a third of a microsecond."""
NEAR_WINDOW: Final = (0.8, 0.26)
"""How far from a mode [m, rad] a scan is matched where it fits worse than usual: wheels slip by half a metre
between two scans."""


class Judgement(NamedTuple):
    """What a bad score says: score (0 … 1) of what the map can judge; unknown, the share of the measurement
    that it cannot; missing, the share that a full measurement has more; whole, the score with what is unknown
    counted by half, which compares places."""

    score: float
    whole: float
    unknown: float = 0.0
    missing: float = 0.0


class CloudModel(Protocol):
    """A sensor on its map."""

    threshold: float
    """The score of the best particle below which another place is looked for, until scores are known."""

    def weigh(self, cloud: _core.ParticleCloud, measurement: Any, share: float, threads: int) -> float | None:
        """Weighs by a share of the evidence; the score of the best particle, None where nothing was seen."""

    def judge(self, measurement: Any, pose: Array, score: float) -> Judgement:
        """The score at a pose, that of the best particle."""

    def match(self, measurement: Any, pose: Array, least: float, above: float) -> Array | None:
        """The pose (3,) near another one that fits best; None if it scores less, or fits on the whole no
        better than a bound."""

    def correct(self, measurement: Any, poses: Array) -> Array | None:
        """What is to be added to the logarithms of the likelihoods of poses (k, 3) by which particles are
        weighed: (k,); None for nothing."""

    def search(self, measurement: Any, least: float, above: float, rng: np.random.Generator) -> Array:
        """Poses (k, 3) of a least score that fit a measurement better than a bound on the whole of it, the
        best first."""


class ScanModel:
    """Scans of a laser on a grid or on a field of scores."""

    threshold = 0.7

    def __init__(self, grid: Any, scanner: LaserScanner) -> None:
        self.scanner = scanner
        # Unknown cells are free here: the far side of a wall is unknown, and beams end there.
        self.known = getattr(grid, "known", None)
        self.walls = None if isinstance(grid, ByteField) else find_walls(grid)
        if isinstance(grid, ByteField):
            self.field = grid
        else:
            assert self.walls is not None
            self.field = make_field(self.walls, scanner.sigma, scanner.floor)
        field = self.field
        self.open = opened = open_unknown(field, self.known)
        self.map = _core.ScoreMap(opened.scores, field.resolution, tuple(field.origin), opened.outside)
        self.free = find_free_cells(grid, field)
        self.rays = RayJudge(field, self.walls, self.known)
        self.nats = -np.log(scanner.floor) / 255.0  # of a unit of a score
        self.table: BeamTable | None = None
        if scanner.model == "beam":
            if isinstance(grid, ByteField):
                raise InputTypeError("the beam model casts rays; give a grid in place of a ByteField")
            self.table, self.grid = BeamTable(scanner), self.walls

    def weigh(self, cloud: _core.ParticleCloud, measurement: Any, share: float, threads: int) -> float | None:
        """Weighs by the field or along the rays; the score is that of the field in both, with unknown
        cells open."""
        ends = self.read_ends(measurement)
        if len(ends) < FEWEST_BEAMS:
            return None
        used, exponent = self.choose_ends(ends)
        by_field = 0.0 if self.table is not None else share * exponent * self.nats
        best = cloud.add_scan(self.map, used, by_field, threads)
        if self.table is not None and share > 0:
            cloud.add_logs(share * self.weigh_rays(cloud.poses(), measurement))
        return best

    def choose_ends(self, ends: Array) -> tuple[Array, float]:
        """The ends (k, 2) that are used, and the exponent of their likelihoods."""
        used = np.ascontiguousarray(ends[thin_ends(ends, self.scanner.beams)])
        return used, self.scanner.independent / max(self.scanner.beams, len(used), self.scanner.independent)

    def weigh_rays(self, poses: Array, scan: Any) -> Array:
        """log p of a scan by the beam model from poses (n, 3): (n,), tempered."""
        if not isinstance(scan, Scans):
            raise InputTypeError("the beam model takes Scans; ends of beams do not tell where none returned")
        assert self.table is not None
        beams = np.unique(np.linspace(0, len(scan.angles) - 1, self.scanner.beams).astype(int))
        T = scan.T_base_laser
        c, s = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
        x, y = poses[:, :1] + c * T[0, 2] - s * T[1, 2], poses[:, 1:2] + s * T[0, 2] + c * T[1, 2]
        angles = poses[:, 2:] + np.arctan2(T[1, 0], T[0, 0]) + scan.angles[beams]
        from_points = np.repeat(np.stack([x, y], axis=-1), len(beams), axis=1)
        walls = cast_rays(self.grid, from_points, angles, self.table.most)
        measured = np.where(scan.returns[0, beams], scan.ranges[0, beams].astype(np.float64), np.nan)
        keep = ~(measured < self.scanner.least_range)
        exponent = self.scanner.independent / max(self.scanner.beams, int(keep.sum()))
        return exponent * np.asarray(self.table.find(measured[keep], walls[:, keep]).sum(axis=1))

    def judge(self, measurement: Any, pose: Array, score: float) -> Judgement:
        """The score along the rays."""
        ends = self.read_ends(measurement)
        full = len(measurement.angles) if isinstance(measurement, Scans) else len(ends)
        missing = max(0.0, 1.0 - len(ends) / min(full, self.scanner.beams))
        seen = self.look(measurement, self.choose_ends(ends)[0], pose[None])
        return Judgement(float(seen.score[0]), float(seen.whole[0]), float(seen.unknown[0]), missing)

    def look(self, measurement: Any, ends: Array, poses: Array) -> Evidence:
        """The evidence of ends (m, 2) of a measurement from poses (k, 3)."""
        is_scan = isinstance(measurement, Scans)
        laser = measurement.T_base_laser[:2, 2] if is_scan else np.zeros(2)
        return self.rays.look(ends, laser, poses)

    def match(self, measurement: Any, pose: Array, least: float, above: float) -> Array | None:
        """The best pose in a window, by correlation."""
        used, _ = self.choose_ends(self.read_ends(measurement))
        found = match_scan(used, self.open, guess=pose, window=NEAR_WINDOW, least_score=0.0)
        seen = self.look(measurement, used, found.pose[None])
        return found.pose if seen.score[0] >= least and seen.whole[0] > above else None

    def correct(self, measurement: Any, poses: Array) -> Array | None:
        """The difference between the rays and their ends."""
        used, exponent = self.choose_ends(self.read_ends(measurement))
        seen = self.look(measurement, used, poses)
        return np.asarray(255.0 * self.nats * exponent * len(used) * (seen.whole - seen.ends))

    def search(self, measurement: Any, least: float, above: float, rng: np.random.Generator) -> Array:
        """The best separate poses on the whole map, by their rays."""
        ends = self.read_ends(measurement)
        if len(ends) < FEWEST_BEAMS:
            return np.empty((0, 3))
        used = np.ascontiguousarray(ends[thin_ends(ends, SEARCH_BEAMS)])
        bound = min(least, LEAST_OF_ENDS if self.known is not None else 1.0)
        poses = search_pose(
            used,
            self.open,
            most=CANDIDATES,
            least_score=bound,
            margin=CANDIDATE_MARGIN,
            free=self.free,
        ).poses
        seen = self.look(measurement, used, poses)
        order = np.argsort(-seen.whole, kind="stable")
        fits = (seen.score >= least) & (seen.whole > above)
        return poses[order[fits[order]][:MOST_PLACES]]

    def read_ends(self, measurement: Any) -> Array:
        """The ends (m, 2) in base of one scan, or the points (m, 2) given."""
        if isinstance(measurement, Scans):
            if len(measurement) != 1:
                raise InputError(f"update takes one scan, and these are {len(measurement)}; give scans[k]")
            return read_ends(measurement, 0, self.scanner.least_range, self.scanner.most_range)[0]
        return one_array(measurement, "scan", (None, 2), "ends of beams in base [m]")


def find_walls(grid: Any) -> OccupancyGrid:
    """The cells that are known to be blocked."""
    walls = grid.to_grid(unknown="free") if hasattr(grid, "known") else grid.to_grid()
    assert isinstance(walls, OccupancyGrid)
    return walls


def make_field(walls: OccupancyGrid, sigma: float, floor: float) -> ByteField:
    """The likelihood field of the blocked cells that touch a free one. Beams end on these, and not inside of
    what is solid, as unknown cells are that count as blocked: there every scan would fit."""
    blocked = walls.blocked
    padded = np.pad(blocked, 1, constant_values=True)
    rows = padded[:-2] & padded[1:-1] & padded[2:]
    inner = rows[:, :-2] & rows[:, 1:-1] & rows[:, 2:]
    surfaces = OccupancyGrid(blocked & ~inner, walls.resolution, walls.origin) if inner.any() else walls
    return surfaces.likelihood_field(sigma, floor)


def find_free_cells(grid: Any, field: ByteField) -> npt.NDArray[np.bool_] | None:
    """The cells in which base may be; None where there is nothing to tell."""
    if isinstance(grid, ByteField):
        return None
    free = ~grid.to_grid().blocked
    return free if free.shape == field.scores.shape else None


class SightingModel:
    """Readings of landmarks on their map."""

    threshold = 0.05

    def __init__(self, landmarks: Landmarks, sensor: RangeBearing) -> None:
        if not len(landmarks):
            raise InputError("the map has no landmarks; give one at least")
        self.landmarks, self.sensor = landmarks, sensor

    def weigh(self, cloud: _core.ParticleCloud, measurement: Any, share: float, threads: int) -> float | None:
        """Weighs by all readings; those of unknown landmarks count for the most likely one."""
        readings = self.read(measurement)
        if not len(readings):
            return None
        sensor = self.sensor
        return cloud.add_sightings(
            readings.range - sensor.range_bias,
            readings.bearing - sensor.bearing_bias,
            self.landmarks.rows_of(readings.landmark).astype(np.int32),
            self.landmarks.points,
            sensor.mount,
            sensor.range_sigma,
            sensor.bearing_sigma,
            FALSE_READINGS,
            share,
            threads,
        )

    def search(self, measurement: Any, least: float, above: float, rng: np.random.Generator) -> Array:
        """Random poses from which a named landmark would be seen so (Lenser & Veloso 2000)."""
        readings = self.read(measurement)
        whole = np.flatnonzero(
            (readings.landmark != UNKNOWN) & ~np.isnan(readings.range) & ~np.isnan(readings.bearing)
        )
        if not len(whole):
            return np.empty((0, 3))
        rows = rng.choice(whole, SIGHTING_POSES)
        away = rng.uniform(-np.pi, np.pi, SIGHTING_POSES)
        points = self.landmarks.points[self.landmarks.rows_of(readings.landmark[rows])]
        r = readings.range[rows] - self.sensor.range_bias
        turn = away - (readings.bearing[rows] - self.sensor.bearing_bias)
        x, y = points[:, 0] - r * np.cos(away), points[:, 1] - r * np.sin(away)
        mx, my, mt = self.sensor.mount
        theta = turn - mt
        c, s = np.cos(theta), np.sin(theta)
        return np.stack([x - c * mx + s * my, y - s * mx - c * my, theta], axis=-1)

    def judge(self, measurement: Any, pose: Array, score: float) -> Judgement:
        """The score itself: a map of landmarks has no unknown parts."""
        return Judgement(score, score)

    def match(self, measurement: Any, pose: Array, least: float, above: float) -> Array | None:
        """None: the circles of a search pass near as well."""
        return None

    def correct(self, measurement: Any, poses: Array) -> Array | None:
        """None: particles are weighed by all that is seen."""
        return None

    def read(self, measurement: Any) -> Readings:
        """The readings, checked."""
        if not isinstance(measurement, Readings):
            raise InputTypeError(f"scan is {name_type(measurement)}; a filter on landmarks takes Readings")
        return measurement


SIGHTING_POSES: Final = 500
"""Random poses on the circles around the landmarks of one measurement."""


def make_model(grid: Any, sensor: LaserScanner | RangeBearing | None) -> ScanModel | SightingModel:
    """The model of a sensor on a map. Raises InputTypeError for a map and a sensor that do not fit."""
    if isinstance(grid, Landmarks):
        if sensor is not None and not isinstance(sensor, RangeBearing):
            raise InputTypeError(
                f"a map of landmarks needs sensor=RangeBearing(…), not {type(sensor).__name__}"
            )
        return SightingModel(grid, sensor or RangeBearing())
    if not isinstance(grid, ByteField) and not hasattr(grid, "likelihood_field"):
        raise InputTypeError(f"grid is {name_type(grid)}, which is no map; {suggest_map(grid)}")
    if sensor is not None and not isinstance(sensor, LaserScanner):
        raise InputTypeError(f"a grid needs sensor=LaserScanner(…), not {type(sensor).__name__}")
    return ScanModel(grid, sensor or LaserScanner())
