"""The poses from which a scan fits a whole map best, without any guess."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import (
    Array,
    any_array,
    bounded_number,
    guard_memory,
    one_array,
    one_number,
    positive_number,
    whole_number,
)
from cspace.errors import InputError, InputTypeError, TimeLimitError, name_type
from cspace.maps import ByteField
from cspace.tables import count_things, one_line, tabulate

WIDEST_STEP: Final = 0.02
"""Between neighbouring headings [rad]: beams of five metres then end within a cell of 5 cm from where they
should."""
FAR_SHARE: Final = 0.9
"""Of the points: how many lie nearer than the distance by which headings are chosen. Few long beams then do
not make the search long."""
CELLS_PER_STEP: Final = 2.0
"""Cells by which points at that distance move between neighbouring headings: one to either side."""
MOST_HEADINGS: Final = 1 << 16
MOST_POINTS: Final = 2000
"""Points whose reduced scores a sum of 16 bits holds."""
FARTHEST: Final = 1e8
"""Farthest point of a scan, in cells."""


@tabulate()
class PoseModes(NamedTuple):
    """Poses from which a scan fits a map, the best first; falsy if there is none.

    poses (k, 3): x, y [m], θ [rad] of base in map. scores (k,): means of the scores of the points there,
    from 0 to 1.
    """

    poses: Array
    scores: Array

    def __bool__(self) -> bool:
        return len(self.scores) > 0

    def __repr__(self) -> str:
        best = f", the best scores {self.scores[0]:.3f}" if self else ""
        return one_line("PoseModes", count_things(len(self.scores), "pose") + best)


def search_pose(
    scan_points: ArrayLike,
    field: ByteField,
    *,
    most: int = 3,
    least_score: float = 0.5,
    margin: float = 0.25,
    heading_step: float | None = None,
    apart: tuple[float, float] = (1.0, 0.5),
    free: ArrayLike | None = None,
    time_limit: float | None = None,
) -> PoseModes:
    """The best separate poses of a scan on a whole map: global localisation, and recovery when lost.

    A pose is the centre of a cell of the field and one of evenly spaced headings; its score is the mean
    score of the cells in which the points then lie, over 255. The result is that of trying all poses: the
    best one, then the best of those apart from it, and so on. Branch and bound finds it.

    scan_points (m, 2): where beams ended, in base [m], as of `scans.points(k)`; 60 to 200 of them. field:
    as of `grid.likelihood_field()`. most: how many poses. least_score: of each, from 0 to 1. margin: by how
    much the score of a pose may be below that of the best; 1 for all. heading_step [rad]: between
    headings, by default at most 0.02, and so small that points at nine tenths of the scan move by two
    cells at most. apart: poses that differ by no more than this distance [m] and this angle [rad] are one.
    free: truth values (rows, columns), the cells in which base may be; by default all. time_limit
    [s]: TimeLimitError beyond it.

    Raises InputTypeError and InputError for other values, and for a scan without points. Ctrl-C ends the
    search. Olson 2009; Hess, Kohler, Rapp and Andor 2016.
    """
    if not isinstance(field, ByteField):
        raise InputTypeError(f"field is {name_type(field)}; give a ByteField, as of grid.likelihood_field()")
    points = _read_points(scan_points, field.resolution)
    count = whole_number(most, "most", 1, 1000)
    least = one_number(least_score, "least_score")
    if not 0 <= least <= 1:
        raise InputError(f"least_score is {least:g}; scores are from 0 to 1")
    headings = _count_headings(points, field.resolution, heading_step)
    lengths = one_array(apart, "apart", (2,), "a distance [m] and an angle [rad]")
    if (lengths < 0).any():
        raise InputError(f"apart is {tuple(lengths)}; a distance and an angle are zero or more")
    below = bounded_number(margin, "margin", 0.0, "a difference of scores is zero or more")
    rule = (float(count), least, min(below, 1.0), float(headings), *lengths.tolist())
    allowed = _read_cells(free, field)
    limit = math.inf if time_limit is None else positive_number(time_limit, "time_limit", largest=math.inf)
    with (
        guard_memory("field", field, 1.5 * field.scores.size, "give a part of the map"),
        _keep_limit(limit),
    ):
        rows = _core._search_map(
            field.scores, field.resolution, field.origin, field.outside, allowed, points, rule
        )
    return PoseModes(np.ascontiguousarray(rows[:, :3]), np.ascontiguousarray(rows[:, 3]))


@contextmanager
def _keep_limit(limit: float) -> Iterator[None]:
    """TimeLimitError in the block once so many seconds are over; a time limit of the caller stays."""
    outer, begin = _core.set_deadline(limit), perf_counter()
    try:
        yield
    except _core.TimeOver:
        if perf_counter() - begin < limit:
            raise  # that of a caller
        raise TimeLimitError(
            f"the search did not end within its time_limit of {limit:g} s; give the cells in which the robot"
            " may be (free=), fewer headings (heading_step=) or more time"
        ) from None
    finally:
        _core.set_deadline(outer - (perf_counter() - begin))


def _read_points(scan_points: ArrayLike, resolution: float) -> Array:
    points = one_array(scan_points, "scan_points", (None, 2), "ends of beams in base [m]")
    if not len(points):
        raise InputError("scan_points has no points; a scan without returns fits every pose")
    if len(points) > MOST_POINTS:
        raise InputError(f"scan_points has {len(points)} points; give {MOST_POINTS} at most, evenly chosen")
    if np.abs(points).max() > FARTHEST * resolution:
        raise InputError(f"scan_points reach {np.abs(points).max():g} m; leave out beams without return")
    return points


def _count_headings(points: Array, resolution: float, step: float | None) -> int:
    """The number of evenly spaced headings whose step is at most that asked for."""
    if step is None:
        far = float(np.quantile(np.hypot(*points.T), FAR_SHARE))
        step = min(WIDEST_STEP, CELLS_PER_STEP * resolution / max(far, resolution))
        step = max(step, 2 * math.pi / MOST_HEADINGS)
    else:
        step = positive_number(step, "heading_step", "give one angle above zero, in radians")
    count = math.ceil(2 * math.pi / step)
    if count > MOST_HEADINGS:
        raise InputError(f"heading_step is {step:g} rad, {count} headings; at most {MOST_HEADINGS} are tried")
    return count


def _read_cells(free: Any, field: ByteField) -> npt.NDArray[np.uint8]:
    """A byte per cell, or none if all are free."""
    if free is None:
        return np.empty(0, np.uint8)
    cells = any_array(free, "free")
    if cells.dtype != np.bool_ or cells.shape != field.scores.shape:
        raise InputError(
            f"free is {cells.dtype} of shape {cells.shape}; give truth values of the shape of the field,"
            f" {field.scores.shape}"
        )
    return np.ascontiguousarray(cells).view(np.uint8).ravel()
