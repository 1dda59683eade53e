"""Checks obstacles as users give them, converts them to rings of points, names and repairs invalid ones."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, one_array, one_number
from cspace.errors import InputError, InputTypeError
from cspace.tolerances import FARTHEST_POINT, MOST_SIDES, ON_ONE_LINE

Outline = list[Array]
"""One obstacle: its outline (n, 2) [m], then holes."""


def read_outlines(obstacles: Iterable[Any]) -> list[Outline]:
    """The rings of each obstacle: an (n, 2) array is one ring, a list of such arrays several."""
    if isinstance(obstacles, (str, bytes, dict)) or not isinstance(obstacles, Iterable):
        raise InputTypeError(
            f"obstacles must be a list of (n, 2) arrays, got an object of type {type(obstacles).__name__}"
        )
    listed = list(obstacles)
    if listed and all(map(_is_point, listed)):
        raise InputError(
            f"obstacles is a list of {len(listed)} points, expected a list of polygons (n, 2); put a single"
            " polygon into a list: [polygon]"
        )
    return [_read_rings(obstacle, f"obstacle {k}") for k, obstacle in enumerate(listed)]


def _is_point(obstacle: Any) -> bool:
    """Whether it is two numbers."""
    try:
        return bool(np.shape(obstacle) == (2,))
    except ValueError:
        return False


def _read_rings(obstacle: Any, subject: str) -> Outline:
    if not isinstance(obstacle, np.ndarray) and _is_list_of_rings(obstacle):
        return [_read_ring(ring, f"{subject}, ring {i}") for i, ring in enumerate(obstacle)]
    return [_read_ring(obstacle, subject)]


def _is_list_of_rings(obstacle: Any) -> bool:
    """Whether the entries are themselves lists of points."""
    try:
        return len(obstacle) > 0 and np.ndim(obstacle[0]) == 2
    except (TypeError, ValueError, KeyError, IndexError):
        return False


def _read_ring(points: Any, subject: str) -> Array:
    ring = one_array(points, subject, (None, 2), "a row of x and y per corner", largest=FARTHEST_POINT)
    if len(ring) > 1 and np.array_equal(ring[0], ring[-1]):
        ring = ring[:-1]
    kept = ring[np.any(ring != np.roll(ring, 1, axis=0), axis=1)] if len(ring) > 1 else ring
    if len(kept) < 2:
        count = "no corners" if not len(ring) else "one corner only"
        raise InputError(f"{subject} has {count}; a polygon needs at least three")
    return np.ascontiguousarray(kept, dtype=np.float64)


def circumscribe_discs(centers: Any, radii: Any, sides: int) -> list[Array]:
    """A regular circumscribed polygon (sides, 2) [m] of each disc; its first side faces the x direction."""
    at = one_array(centers, "centers", (None, 2), largest=FARTHEST_POINT)
    reach = as_floats(radii, "radii", largest=FARTHEST_POINT)
    if reach.shape not in {(), (len(at),)}:
        raise InputError(f"radii has shape {reach.shape}, expected () or ({len(at)},): one per disc")
    if not np.all(reach > 0):
        raise InputError(f"radii contains {np.min(reach):g}; the radius of a disc must be above zero [m]")
    if int(number := one_number(sides, "sides")) != number or not 4 <= sides <= MOST_SIDES:
        raise InputError(f"sides is {sides}; it must be 4 to {MOST_SIDES}")
    angles = 2 * np.pi * (np.arange(int(sides)) + 0.5) / sides
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1) / np.cos(np.pi / sides)
    sizes = np.broadcast_to(reach, len(at))
    return [center + radius * around for center, radius in zip(at, sizes, strict=True)]


def check_bounds(bounds: Any) -> Array:
    """(xmin, ymin, xmax, ymax) as an array (4,); InputError if the rectangle is empty."""
    given = as_floats(bounds, "bounds", last=(4,), largest=FARTHEST_POINT)
    if given.shape != (4,):
        raise InputError(f"bounds has shape {given.shape}, expected (4,): xmin, ymin, xmax, ymax")
    xmin, ymin, xmax, ymax = map(float, given)
    if not (xmin < xmax and ymin < ymax):
        raise InputError(
            f"bounds ({xmin:g}, {ymin:g}, {xmax:g}, {ymax:g}) enclose no area; expected xmin, ymin, xmax, "
            "ymax with xmin < xmax and ymin < ymax"
        )
    return np.array(given)


def longer_side(bounds: Sequence[float] | Array) -> float:
    """The longer side [m] of a rectangle (xmin, ymin, xmax, ymax)."""
    xmin, ymin, xmax, ymax = map(float, bounds)
    return max(xmax - xmin, ymax - ymin)


def find_bounds(outlines: list[Outline]) -> Array:
    """The box around all points plus a quarter of its longer side (4,); the unit square without points."""
    if not outlines:
        return np.array([0.0, 0.0, 1.0, 1.0])
    points = np.vstack([ring for rings in outlines for ring in rings])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = float(np.max(high - low)) / 4
    return np.array([*(low - margin), *(high + margin)])


class GeometryError(InputError):
    """An invalid polygon: it crosses itself, or has no area. The message names it and the remedy."""


def check_area(outlines: Sequence[Sequence[Array]], repair: bool) -> list[str]:
    """Polygons without area, which repair keeps as walls without thickness; GeometryError without it."""
    said = []
    for k, rings in enumerate(outlines):
        for ring in rings:
            if not _is_on_one_line(ring):
                continue
            what = f"obstacle {k} has no area: its {len(ring)} corners lie on one line"
            if not repair:
                raise GeometryError(f"{what}; correct its corners, or keep it as a wall with repair=True")
            said.append(f"{what}; kept as a wall without thickness")
    return said


def _is_on_one_line(ring: Array) -> bool:
    """Whether all corners (n, 2) lie on one line, within rounding."""
    away = ring - ring[0]
    far = away[np.argmax(np.sum(away**2, axis=1))]
    distance = np.abs(far[0] * away[:, 1] - far[1] * away[:, 0])
    return bool(np.all(distance <= ON_ONE_LINE * float(far @ far)))


def describe_crossings(core: _core.PolygonCore, repair: bool) -> list[str]:
    """Polygons that cross themselves, which repair reads by the even-odd rule; GeometryError without it."""
    points, pairs = core.crossings()
    own: dict[int, list[Array]] = {}
    for point, (one, other) in zip(points, pairs, strict=True):
        if one == other:
            own.setdefault(one, []).append(point)
    said = []
    for obstacle, places in sorted(own.items()):
        x, y = places[0]
        more = f" and {len(places) - 1} more places" if len(places) > 1 else ""
        what = f"obstacle {obstacle} crosses itself at ({x:g}, {y:g}){more}"
        if not repair:
            raise GeometryError(f"{what}; order its corners, or apply the even-odd rule with repair=True")
        said.append(f"{what}; read by the even-odd rule: what its outline surrounds twice is free")
    return said
