"""Evidence grid: how certain each cell of a plane is occupied, as log-odds that scans add to."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, guard_memory, one_array, one_number, positive_number, whole_number
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.maps.byte_field import ByteField
from cspace.maps.likelihood_field import LIKELIHOOD_FLOOR, SIGMA, check_hit_model
from cspace.maps.occupancy_grid import OccupancyGrid
from cspace.maps.points import as_point
from cspace.tables import tabulate
from cspace.tolerances import FARTHEST_CELL, FINEST_CELL, MAP_CELLS

LIMIT: Final = 1000
"""Largest evidence that is shown, in hundredths: a probability of 0.99995. Sums go on beyond it, so that the
order of scans does not matter."""
HIT: Final = 0.7
MISS: Final = 0.45
"""Probabilities of a cell in which a beam of a scan ends, or through which one passes. Four misses outweigh
a hit: beams that graze a wall pass through cells in which others end."""
THRESHOLD: Final = 0.65
"""The probability above which a cell is blocked, that of ROS maps."""
HUNDRED: Final = 100.0
UNKNOWN_GREY: Final = 205
"""The grey of unknown cells in trinary maps, between the thresholds of map_server."""
FARTHEST_ROW: Final = 1 << 30
"""Farthest row or column from the anchor: its number fits into 32 bits."""
MOST_THREADS: Final = 4096

Sums = npt.NDArray[np.int32]


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class EvidenceGrid:
    """Square cells with log-odds of being occupied; zero means unknown.

    sums (rows, columns) int32: log-odds log(p / (1 − p)) in hundredths, not limited. resolution [m]: the side
    of a cell. anchor (2,) [m]: a corner of a cell. corner: row and column of cell (0, 0), counted from the
    anchor. Row i spans y in origin_y + resolution · [i, i + 1], column j spans x likewise, with origin =
    anchor + resolution · (column, row) of the corner.

    `from_scans`, `from_ros` and `from_probability` make grids, and `add` adds scans. Raises InputError for
    other sums, an empty grid, more than tolerances.MAP_CELLS cells, or a resolution that is not positive.
    """

    sums: Sums
    resolution: float
    anchor: Array
    corner: tuple[int, int] = (0, 0)

    kind: ClassVar[str] = "evidence"

    def __post_init__(self) -> None:
        sums = np.ascontiguousarray(self.sums)
        if sums.ndim != 2 or not sums.size or sums.dtype != np.int32:
            raise InputError(
                f"sums is {sums.dtype} of shape {sums.shape}; give log-odds in hundredths (rows, columns), at"
                " least one, dtype int32"
            )
        if sums.size > MAP_CELLS:
            raise InputError(f"sums has {sums.size} cells; the maximum is {MAP_CELLS}")
        object.__setattr__(self, "sums", sums)
        object.__setattr__(self, "resolution", _read_resolution(self.resolution))
        object.__setattr__(self, "anchor", np.array(as_point(self.anchor, "anchor")))
        least = -int(FARTHEST_CELL)
        place = tuple(whole_number(k, "corner", least, -least) for k in self.corner)
        object.__setattr__(self, "corner", place)

    @classmethod
    def from_scans(
        cls,
        scans: Any,
        poses: Any,
        resolution: float = 0.05,
        *,
        max_range: float = np.inf,
        clear_range: float = 0.0,
        hit: float = HIT,
        miss: float = MISS,
        threads: int = 1,
    ) -> EvidenceGrid:
        """The map of scans of a laser from known poses of base.

        In each scan a cell counts once: as hit if a beam ends in it, else as missed if one passes through
        it. The grid is as large as what the beams reach, and its cells are those of the endless grid through
        the origin of map.

        scans: as `log.scans`, with `ranges` (n, b), `angles` (b,), `most` and `T_base_laser`. poses (n, 3):
        x, y [m], θ [rad] of base in map; or timed poses such as `log.truth`, which are interpolated, and
        scans outside of their times left out. max_range [m]: beams that returned from farther away only
        clear the cells up to it. clear_range [m]: so far beams without return clear cells; 0 for glass.
        hit, miss: probabilities of a cell that was hit or missed. threads: 0 for all processors; the result
        does not depend on it.

        Raises InputTypeError and InputError for other values, and InputError for a map of more than
        tolerances.MAP_CELLS cells. Moravec and Elfes 1985.
        """
        empty = _Endless(_read_resolution(resolution), np.zeros(2))
        numbers = _read_rule(empty, max_range, clear_range, hit, miss)
        return _add_scans(empty, _read_scans(scans, poses), numbers, threads)

    def add(
        self,
        scans: Any,
        poses: Any,
        *,
        max_range: float = np.inf,
        clear_range: float = 0.0,
        hit: float = HIT,
        miss: float = MISS,
        threads: int = 1,
    ) -> EvidenceGrid:
        """The grid with more scans, grown where they reach beyond it; arguments as of `from_scans`.

        Scans can be added in any order and any parts: the sums are the same, bit for bit.
        """
        numbers = _read_rule(self, max_range, clear_range, hit, miss)
        return _add_scans(self, _read_scans(scans, poses), numbers, threads)

    @classmethod
    def from_probability(
        cls, probability: ArrayLike, resolution: float = 1.0, origin: ArrayLike = (0.0, 0.0)
    ) -> EvidenceGrid:
        """A grid of probabilities (rows, columns) from 0 to 1, NaN and ½ where unknown; origin (2,) [m]."""
        given = as_floats(probability, "probability", finite=False)
        if given.ndim != 2 or not given.size:
            raise InputError(f"probability has shape {given.shape}; expected (rows, columns), at least one")
        bad = given[~((given >= 0) & (given <= 1)) & ~np.isnan(given)]
        if len(bad):
            raise InputError(f"probability contains {bad[0]:g}; it must be 0 to 1, or NaN for unknown")
        with np.errstate(divide="ignore"):
            odds = HUNDRED * np.log(given / (1 - given))
        odds = np.rint(np.clip(np.nan_to_num(odds, nan=0.0), -LIMIT, LIMIT))
        return cls(odds.astype(np.int32), resolution, np.array(as_point(origin, "origin")))

    @classmethod
    def from_ros(cls, path: str | os.PathLike[str]) -> EvidenceGrid:
        """A ROS map of mode "trinary", "scale" or "raw": a YAML file with a PGM or PNG image.

        Occupied and free cells get the largest evidence. MapError for a file that cannot be read.
        """
        from cspace.maps.ros_map import MODES, read_ros

        read = read_ros(path, MODES)
        return cls.from_probability(read.cells, read.resolution, read.origin)

    def save_ros(
        self, path: str | os.PathLike[str], *, mode: str = "trinary", threshold: float = THRESHOLD
    ) -> None:
        """Writes a ROS map: a YAML file at the path, which ends in .yaml, and a PGM image next to it.

        mode: "trinary" writes blocked, free and unknown cells, "raw" probabilities in per cent. threshold:
        the probability above which cells are blocked.
        """
        from cspace.maps.ros_map import write_ros

        if mode not in ("trinary", "raw"):
            raise suggest("choice of mode=", mode, ("trinary", "raw"))
        if mode == "raw":
            grey = np.rint(HUNDRED * self.probability)
        else:
            grey = np.where(self._find_walls(threshold), 0.0, 254.0)
        grey[~self.known] = 255 if mode == "raw" else UNKNOWN_GREY
        x, y = self.origin.tolist()
        write_ros(path, grey.astype(np.uint8), self.resolution, x, y, mode)

    @property
    def evidence(self) -> npt.NDArray[np.int16]:
        """Log-odds in hundredths, (rows, columns), from −1000 to 1000."""
        return np.clip(self.sums, -LIMIT, LIMIT).astype(np.int16)

    @property
    def probability(self) -> Array:
        """The probability that each cell is occupied, (rows, columns); ½ where it is unknown."""
        return 1 / (1 + np.exp(self.evidence / -HUNDRED))

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """Which cells are known, (rows, columns): those whose evidence is not zero."""
        return np.asarray(self.sums != 0)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = self.sums.shape
        return rows, columns

    @property
    def origin(self) -> Array:
        """The corner of cell (0, 0) of least x and y, (2,) [m]."""
        return self.anchor + self.resolution * np.array(self.corner[::-1])

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """xmin, ymin, xmax, ymax [m]."""
        x, y = map(float, self.origin)
        return x, y, x + self.resolution * self.shape[1], y + self.resolution * self.shape[0]

    def to_grid(self, threshold: float = THRESHOLD, *, unknown: str = "blocked") -> OccupancyGrid:
        """The cells with a probability above a threshold as an OccupancyGrid.

        unknown: how unknown cells are treated, "blocked" or "free".
        """
        if unknown not in ("blocked", "free"):
            raise suggest("choice of unknown=", unknown, ("blocked", "free"))
        blocked = self._find_walls(threshold)
        if unknown == "blocked":
            blocked |= ~self.known
        return OccupancyGrid(blocked, self.resolution, self.origin)

    def likelihood_field(
        self, sigma: float = SIGMA, floor: float = LIKELIHOOD_FLOOR, *, threshold: float = THRESHOLD
    ) -> ByteField:
        """How likely a laser beam ends in each cell, by the distance to the nearest cell with a probability
        above a threshold.

        As OccupancyGrid.likelihood_field: 255 in such cells, 0 far from all of them, outside the grid, and
        in unknown cells.
        """
        wide, least = check_hit_model(sigma, floor, self.resolution)
        walls, known = self._find_walls(threshold).view(np.uint8), self.known.view(np.uint8)
        with guard_memory("shape", self.shape, 1.125 * self.sums.size, "take coarser cells"):
            scores = _core._likelihood_field(walls, known, self.resolution, wide, least)
        return ByteField(scores, self.resolution, self.origin)

    def _find_walls(self, threshold: float) -> npt.NDArray[np.bool_]:
        p = one_number(threshold, "threshold")
        if not 0.5 <= p < 1:
            raise InputError(f"threshold is {p:g}; a probability of blocked cells is from 0.5 to below 1")
        return np.asarray(self.sums > np.rint(HUNDRED * np.log(p / (1 - p))))

    def __repr__(self) -> str:
        rows, columns = self.shape
        cells = f"{rows} × {columns} cells of {self.resolution:g} m"
        x, y = self.origin
        return f"<EvidenceGrid {cells}, {self.known.mean():.1%} known, origin ({x:g}, {y:g})>"


@dataclass(frozen=True)
class _Endless:
    """A grid without any cell yet."""

    resolution: float
    anchor: Array


@dataclass(frozen=True)
class _Scans:
    """Scans as the core takes them: poses of the laser (n, 3), ranges (n, b) float32, angles (b,)."""

    lasers: Array
    ranges: npt.NDArray[np.float32]
    angles: Array
    most: float


def _read_resolution(resolution: float) -> float:
    side = positive_number(resolution, "resolution", "it must be one positive number [m]")
    if side < FINEST_CELL:
        raise InputError(f"resolution is {side:g}; the sides of cells must be at least {FINEST_CELL:g} m")
    return side


def _read_rule(
    grid: EvidenceGrid | _Endless, max_range: float, clear_range: float, hit: float, miss: float
) -> tuple[float, ...]:
    farthest = positive_number(max_range, "max_range", "give one length above zero [m]", largest=np.inf)
    clear = one_number(clear_range, "clear_range")
    if clear < 0:
        raise InputError(f"clear_range is {clear:g}; it must be zero or more [m]")
    p, q = one_number(hit, "hit"), one_number(miss, "miss")
    if not (0.5 < p < 1 and 0 < q < 0.5):
        raise InputError(f"hit is {p:g} and miss {q:g}; they must be 0 < miss < 0.5 < hit < 1")
    odds = [float(np.rint(HUNDRED * np.log(each / (1 - each)))) for each in (p, q)]
    if 0 in odds:
        raise InputError(f"hit is {p:g} and miss {q:g}; one of them changes nothing: move it away from 0.5")
    limit = FARTHEST_CELL * grid.resolution
    return (grid.resolution, *grid.anchor.tolist(), *odds, min(farthest, limit), min(clear, limit))


def _read_scans(scans: Any, poses: Any) -> _Scans:
    for name in ("ranges", "angles", "most", "T_base_laser", "times"):
        if not hasattr(scans, name):
            raise InputTypeError(f"scans is {name_type(scans)}; give Scans, as of log.scans")
    ranges = np.ascontiguousarray(scans.ranges, np.float32)
    angles = as_floats(scans.angles, "angles")
    if ranges.ndim != 2 or ranges.shape != (len(ranges), len(angles)):
        raise InputError(f"ranges has shape {ranges.shape}; expected a row per scan, a column per angle")
    rows = np.asarray(poses.at(scans.times)) if hasattr(poses, "at") else None
    if rows is not None:
        inside = ~np.isnan(rows).any(axis=1)
        rows, ranges = np.ascontiguousarray(rows[inside]), np.ascontiguousarray(ranges[inside])
    else:
        rows = one_array(poses, "poses", (None, 3), "x, y [m], θ [rad]")
    if len(rows) != len(ranges):
        raise InputError(f"poses has {len(rows)} rows and scans {len(ranges)}; give one pose per scan")
    if not len(rows):
        raise InputError("there are no scans with poses; a map needs one at least")
    return _Scans(_place_lasers(rows, np.asarray(scans.T_base_laser)), ranges, angles, float(scans.most))


def _place_lasers(poses: Array, T_base_laser: Array) -> Array:
    """Poses (n, 3) of the laser from those of base."""
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    x, y = T_base_laser[:2, 2]
    turn = np.arctan2(T_base_laser[1, 0], T_base_laser[0, 0])
    columns = [poses[:, 0] + c * x - s * y, poses[:, 1] + s * x + c * y, poses[:, 2] + turn]
    return np.ascontiguousarray(np.stack(columns, axis=-1))


def _check_sums(sums: Sums, scans: int, change: float) -> None:
    """InputError for sums that so many scans could carry beyond 32 bits."""
    largest = int(np.abs(sums.astype(np.int64)).max())
    if largest + scans * change > np.iinfo(np.int32).max:
        raise InputError(f"sums has {largest}, and {scans} scans more may exceed 32 bits; clip it first")


def _add_scans(
    grid: EvidenceGrid | _Endless, scans: _Scans, numbers: tuple[float, ...], threads: int
) -> EvidenceGrid:
    count = whole_number(threads, "threads", 0, MOST_THREADS, "0 for every processor")
    if (far := np.abs(scans.lasers[:, :2] - grid.anchor).max()) > FARTHEST_CELL * grid.resolution:
        raise InputError(f"poses lie {far:.3g} m away, too far for cells of {grid.resolution:g} m")
    arrays = (scans.lasers, scans.ranges.ravel(), scans.angles, scans.most)
    low_row, low_column, high_row, high_column = _core._reached_cells(*arrays, numbers)
    if isinstance(grid, EvidenceGrid):
        (row, column), (rows, columns) = grid.corner, grid.shape
        low_row, low_column = min(low_row, row), min(low_column, column)
        high_row, high_column = max(high_row, row + rows - 1), max(high_column, column + columns - 1)
    wide, high = high_column - low_column + 1, high_row - low_row + 1
    farthest = max(map(abs, (low_row, low_column, high_row, high_column)))
    if wide * high > MAP_CELLS or farthest > FARTHEST_ROW:
        raise InputError(
            f"the scans reach over {wide * grid.resolution:.4g} × {high * grid.resolution:.4g} m,"
            f" {wide * high:.3g} cells; the maximum is {MAP_CELLS}: take coarser cells or a smaller max_range"
        )
    with guard_memory("resolution", grid.resolution, 0.5 * wide * high * (count + 1), "take a coarser one"):
        sums = np.zeros((int(high), int(wide)), np.int32)
        corner = int(low_row), int(low_column)
        if isinstance(grid, EvidenceGrid):
            _check_sums(grid.sums, len(scans.lasers), max(map(abs, numbers[3:5])))
            down, along = grid.corner[0] - corner[0], grid.corner[1] - corner[1]
            sums[down : down + grid.shape[0], along : along + grid.shape[1]] = grid.sums
        _core._add_evidence(sums.ravel(), sums.shape[1], *corner, *arrays, numbers, count)
    if isinstance(grid, EvidenceGrid):
        return replace(grid, sums=sums, corner=corner)
    return EvidenceGrid(sums, grid.resolution, grid.anchor, corner)
