"""Logs of mobile robots as arrays: odometry, scans, readings of landmarks, reference poses."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, one_array, one_number, positive_number
from cspace.errors import InputError
from cspace.mobile import Odometry, TimedPoses
from cspace.mobile.timed_poses import read_rows, read_times
from cspace.spatial import as_pose_2d
from cspace.tables import count_things, one_line, show_fields, tabulate
from cspace.tolerances import COVARIANCE_SYMMETRY, FARTHEST_POINT

Ids = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

UNKNOWN = -1
"""The landmark of a reading that does not say which one it saw."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Readings:
    """Ranges and bearings of landmarks, a row per reading; NaN where one of the two was not measured.

    times (k,) [s], increasing. landmark (k,): the name of the landmark, or −1 where it is unknown. range (k,)
    [m]. bearing (k,) [rad], in the frame of the sensor, counter-clockwise from its x axis. Raises InputError
    for rows with neither, ranges below zero, and bearings that are all beyond ±2π (degrees).
    """

    times: Array
    landmark: Ids
    range: Array
    bearing: Array

    def __post_init__(self) -> None:
        times = read_times(self.times)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "landmark", read_names(self.landmark, "landmark", len(times)))
        for name in ("range", "bearing"):
            object.__setattr__(self, name, read_column(getattr(self, name), name, len(times)))
        self._check_values()

    def _check_values(self) -> None:
        empty = np.flatnonzero(np.isnan(self.range) & np.isnan(self.bearing))
        if len(empty):
            raise InputError(f"reading {empty[0]} has neither range nor bearing; leave the row out")
        below = np.flatnonzero(self.range < 0)
        if len(below):
            raise InputError(
                f"range is {self.range[below[0]]:g} at row {below[0]}; ranges are not below zero"
            )
        measured = self.bearing[~np.isnan(self.bearing)]
        if len(measured) and (np.abs(measured) > 2 * np.pi).all():
            raise InputError(
                f"bearing is {measured[0]:g} and all lie beyond ±2π; give radians, np.radians(bearing)"
            )

    def __len__(self) -> int:
        """How many readings there are."""
        return len(self.times)

    def __repr__(self) -> str:
        seen = len(np.unique(self.landmark[self.landmark != UNKNOWN]))
        return one_line("Readings", f"{len(self)} of {count_things(seen, 'landmark')}")

    def between(self, first: float, last: float) -> Readings:
        """The readings with times from first to last [s]."""
        keep = (self.times >= first) & (self.times <= last)
        return self.subset(keep)

    def subset(self, keep: Mask | Ids) -> Readings:
        """The readings of a mask, or of increasing row numbers, (k,)."""
        return Readings(self.times[keep], self.landmark[keep], self.range[keep], self.bearing[keep])


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Landmarks:
    """A map of points with names.

    names (m,), whole numbers from 0, each once. points (m, 2): x, y [m] in map. covariances (m, 2, 2) of the
    points [m²], or None for points known exactly.
    """

    names: Ids
    points: Array
    covariances: Array | None = None

    if TYPE_CHECKING:  # it takes lists too

        def __init__(
            self, names: npt.ArrayLike, points: npt.ArrayLike, covariances: npt.ArrayLike | None = None
        ) -> None: ...

    def __post_init__(self) -> None:
        points = one_array(self.points, "points", (None, 2), largest=FARTHEST_POINT)
        names = read_names(self.names, "names", len(points))
        if len(names) and names.min() < 0:
            raise InputError(f"names has {names.min()}; names are whole numbers from 0, and −1 means unknown")
        twice = np.flatnonzero(np.bincount(np.searchsorted(np.unique(names), names)) > 1)
        if len(twice):
            raise InputError(f"landmark {np.unique(names)[twice[0]]} is there twice; give each name once")
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "points", points)
        if self.covariances is not None:
            object.__setattr__(self, "covariances", read_covariances(self.covariances, names))

    def __len__(self) -> int:
        """How many landmarks there are."""
        return len(self.names)

    def __repr__(self) -> str:
        return one_line("Landmarks", count_things(len(self), "landmark"))

    def rows_of(self, names: npt.ArrayLike) -> Ids:
        """The rows of names (k,) → (k,), −1 for unknown ones; InputError for a name not on the map."""
        asked = read_names(names, "landmark", None)
        order = np.argsort(self.names, kind="stable")
        at = np.searchsorted(self.names[order], asked)
        rows = order[np.minimum(at, len(order) - 1)] if len(order) else np.zeros(len(asked), int)
        missing = (asked != UNKNOWN) & ((self.names[rows] != asked) if len(order) else True)
        if missing.any():
            raise InputError(
                f"landmark {asked[missing][0]} is read but not on the map of {len(self)}; add it, or name it"
                f" {UNKNOWN} to have it associated"
            )
        return np.where(asked == UNKNOWN, UNKNOWN, rows)


@show_fields
@dataclass(frozen=True, eq=False, repr=False)
class Headings:
    """Headings of a compass, θ of base in map. times (k,) [s], increasing. angles (k,) [rad]."""

    times: Array
    angles: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", read_times(self.times))
        object.__setattr__(self, "angles", read_rows(self.angles, "angles", self.times, ()))

    def __len__(self) -> int:
        """How many headings there are."""
        return len(self.times)


@show_fields
@dataclass(frozen=True, eq=False, repr=False)
class Fixes:
    """Positions of a satellite receiver in map. times (k,) [s], increasing. points (k, 2): x, y [m]."""

    times: Array
    points: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", read_times(self.times))
        points = as_floats(self.points, "points", largest=FARTHEST_POINT)
        object.__setattr__(self, "points", read_rows(points, "points", self.times, (2,)))

    def __len__(self) -> int:
        """How many fixes there are."""
        return len(self.times)


LARGEST_RANGE = float(np.finfo(np.float32).max)
"""The largest range that float32 holds; a larger one is no return."""


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Scans:
    """Scans of a planar laser range finder.

    times (n,) [s], increasing. ranges (n, b) float32 [m]. angles (b,) [rad] of the beams in the frame of the
    laser. most [m]: a range that is NaN, infinite or not below it is no return. T_base_laser (3, 3).
    time_increment [s]: from one beam to the next, the first one at the time of the scan; 0: all at once.
    """

    times: Array
    ranges: npt.NDArray[np.float32]
    angles: Array
    most: float = 80.0
    T_base_laser: Array = field(default_factory=lambda: np.eye(3))
    time_increment: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", read_times(self.times))
        object.__setattr__(self, "angles", one_array(self.angles, "angles", (None,)))
        numbers = as_floats(self.ranges, "ranges", finite=False)
        ranges = np.ascontiguousarray(np.where(numbers > LARGEST_RANGE, np.inf, numbers), dtype=np.float32)
        if ranges.shape != (len(self.times), len(self.angles)):
            raise InputError(
                f"ranges has shape {ranges.shape}; expected a row per time and a column per angle,"
                f" ({len(self.times)}, {len(self.angles)})"
            )
        object.__setattr__(self, "ranges", ranges)
        object.__setattr__(self, "most", positive_number(self.most, "most"))
        object.__setattr__(self, "T_base_laser", as_pose_2d(self.T_base_laser, "T_base_laser"))
        object.__setattr__(self, "time_increment", one_number(self.time_increment, "time_increment"))

    def __len__(self) -> int:
        """How many scans there are."""
        return len(self.times)

    def __getitem__(self, row: int) -> Scans:
        """One scan, as Scans with a single row."""
        if not -len(self) <= row < len(self):
            raise IndexError(f"scan {row} of {len(self)}")
        at = row % len(self)
        return self.subset(slice(at, at + 1))

    def subset(self, keep: Mask | Ids | slice) -> Scans:
        """The scans of a mask, of a slice, or of increasing row numbers."""
        return replace(self, times=self.times[keep], ranges=self.ranges[keep])

    def points(self, row: int = 0) -> Array:
        """Where the beams of one scan ended, in base, (m, 2) [m]; beams without return are left out."""
        ends = self.returns[row]
        reach, angles = self.ranges[row, ends].astype(np.float64), self.angles[ends]
        in_laser = np.stack([reach * np.cos(angles), reach * np.sin(angles)], axis=-1)
        return in_laser @ self.T_base_laser[:2, :2].T + self.T_base_laser[:2, 2]

    def __repr__(self) -> str:
        return one_line("Scans", f"{len(self)} of {count_things(len(self.angles), 'beam')}")

    @property
    def returns(self) -> Mask:
        """Which beams returned, (n, b)."""
        return np.isfinite(self.ranges) & (self.ranges < self.most)


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Log:
    """A drive of a robot: what it measured, and what is known of where it was.

    odometry; scans, readings, headings and fixes, or None; landmarks: a map that came with the log, or None;
    truth: reference poses, or None; notes: what the reader dropped or mended. Times are seconds from the
    first of the log.
    """

    odometry: Odometry
    scans: Scans | None = None
    readings: Readings | None = None
    headings: Headings | None = None
    fixes: Fixes | None = None
    landmarks: Landmarks | None = None
    truth: TimedPoses | None = None
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        parts = [self.odometry, self.scans, self.readings, self.landmarks, self.truth]
        return one_line("Log", ", ".join(repr(part)[1:-1] for part in parts if part is not None))

    def events(self) -> list[tuple[float, str, int]]:
        """Time, kind ("odometry", "scans", "readings", "headings", "fixes") and row of everything, by time.

        Of equal times odometry comes first, then the kinds in this order.
        """
        kinds = [
            ("odometry", self.odometry.times),
            *((kind, part.times) for kind in SENSED if (part := getattr(self, kind)) is not None),
        ]
        times = np.concatenate([when for _, when in kinds])
        rows = np.concatenate([np.arange(len(when)) for _, when in kinds])
        which = np.repeat(np.arange(len(kinds)), [len(when) for _, when in kinds])
        order = np.argsort(times, kind="stable")
        return [(float(times[k]), kinds[which[k]][0], int(rows[k])) for k in order]


SENSED = ("scans", "readings", "headings", "fixes")
"""The kinds of measurements of a log, in the order in which equal times are merged."""


LARGEST_NAME = 2**53
"""The largest name of a landmark: float64 tells whole numbers apart up to it."""


def read_names(values: npt.ArrayLike, subject: str, count: int | None) -> Ids:
    """Names of landmarks as whole numbers; InputError for others, or another number of them."""
    numbers = one_array(values, subject, (None,))
    if (numbers != np.round(numbers)).any() or (np.abs(numbers) > LARGEST_NAME).any():
        raise InputError(f"{subject} must be whole numbers up to 2⁵³; number the landmarks from 0")
    if count is not None and len(numbers) != count:
        raise InputError(f"{subject} has {len(numbers)} rows; expected {count}, one per row")
    return numbers.astype(np.int64)


def read_covariances(values: npt.ArrayLike, names: Ids) -> Array:
    """Covariances (m, 2, 2) of points; InputError for the first one that is none."""
    largest = FARTHEST_POINT**2
    matrices = read_rows(as_floats(values, "covariances", largest=largest), "covariances", names, (2, 2))
    rounding = COVARIANCE_SYMMETRY * np.abs(matrices).max(axis=(1, 2), initial=0.0)
    across = np.abs(matrices[:, 0, 1] - matrices[:, 1, 0])
    bad = np.flatnonzero((across > rounding) | (np.linalg.eigvalsh(matrices)[:, 0] < -rounding))
    if len(bad):
        raise InputError(
            f"covariances of landmark {names[bad[0]]} is not symmetric and positive semi-definite; give"
            " variances on the diagonal, np.diag(...)"
        )
    return matrices


def read_column(values: npt.ArrayLike, subject: str, count: int) -> Array:
    """A column in which NaN means not measured; InputError for infinity, or another number of rows."""
    column = np.array(as_floats(values, subject, finite=False), ndmin=1)
    as_floats(np.where(np.isfinite(column), column, 0.0), subject, largest=FARTHEST_POINT)
    if column.shape != (count,):
        raise InputError(f"{subject} has shape {column.shape}; expected ({count},), one number per time")
    if np.isinf(column).any():
        raise InputError(
            f"{subject} is infinite at row {int(np.isinf(column).argmax())}; use NaN for no value"
        )
    return column
