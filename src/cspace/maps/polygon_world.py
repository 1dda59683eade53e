"""Polygon world: obstacles inside a rectangle, preprocessed once for all planners."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from math import nan
from os import PathLike
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.maps.grow import grow_outlines
from cspace.maps.occupancy_grid import OccupancyGrid
from cspace.maps.offset import Offset, find_offset
from cspace.maps.outlines import (
    GeometryError,
    Outline,
    check_area,
    check_bounds,
    circumscribe_discs,
    describe_crossings,
    find_bounds,
    longer_side,
    read_outlines,
)
from cspace.maps.points import as_path, as_point, check_inflation
from cspace.maps.polygon_files import read_geojson, read_polygons, write_geojson, write_polygons
from cspace.maps.rasterize import rasterize_world
from cspace.tables import tabulate
from cspace.tolerances import ON_WALL


@tabulate("obstacles", "bounds", "components")
class PolygonWorld:
    """Obstacles in the plane, and the free space between them.

    obstacles: a list of polygons, each an array (n, 2) [m] of its corners in order, in either direction, or
    a list of such rings, the first the outline and the others holes in it. bounds: (xmin, ymin, xmax, ymax)
    [m], a wall around everything; by default the bounding box of the obstacles extended by a quarter on
    each side.

    Obstacles may touch, overlap and lie in the holes of others. Only their union counts. It is closed: a
    path may touch it but cannot pass a point where two obstacles meet. With repair=True a polygon that
    crosses itself is read by the even-odd rule, and one without area remains as a wall without thickness;
    `repairs` lists the changes.

    Raises GeometryError for a polygon that crosses itself or has no area, InputError for coordinates that
    are not finite numbers.
    """

    kind: ClassVar[str] = "polygons"

    def __init__(
        self, obstacles: Iterable[Any], bounds: ArrayLike | None = None, *, repair: bool = False
    ) -> None:
        self._outlines = read_outlines(obstacles)
        self._bounds = check_bounds(bounds) if bounds is not None else find_bounds(self._outlines)
        said = check_area(self._outlines, repair)
        self._core = _build_core(self._outlines, self._bounds)
        self._repairs = (*said, *describe_crossings(self._core, repair))

    @classmethod
    def from_geojson(cls, source: str | PathLike[str] | dict[str, Any], **keywords: Any) -> PolygonWorld:
        """The polygons of a GeoJSON file or object (RFC 7946), read as plane coordinates [m].

        source: a path, or the object itself. Polygons, MultiPolygons, collections and features of them are
        obstacles; a "bbox" of the outermost object is the bounds. keywords: those of PolygonWorld.
        Raises MapError where the file cannot be read.
        """
        obstacles, bounds = read_geojson(source)
        return cls(obstacles, **{"bounds": bounds, **keywords})

    @classmethod
    def from_text(cls, path: str | PathLike[str], **keywords: Any) -> PolygonWorld:
        """The polygons of a text file: a point "x y" [m] per line, an empty line between rings.

        A line "hole" before a ring makes it a hole of the polygon before it, a line "bounds xmin ymin xmax
        ymax" gives the bounds, "#" begins a comment. keywords: those of PolygonWorld. Raises MapError with
        the line that cannot be read.
        """
        obstacles, bounds = read_polygons(path)
        return cls(obstacles, **{"bounds": bounds, **keywords})

    @classmethod
    def from_discs(
        cls, centers: ArrayLike, radii: ArrayLike, bounds: ArrayLike | None = None, *, sides: int = 64
    ) -> PolygonWorld:
        """Discs as obstacles: centers (n, 2) [m], radii (n,) or one for all [m].

        Each disc becomes a regular circumscribed polygon, which exceeds it by at most radius · (1 / cos(π /
        sides) − 1). InputError for a radius that is not positive, and for fewer than four sides.
        """
        return cls(circumscribe_discs(centers, radii, sides), bounds)

    @classmethod
    def from_grid(cls, grid: OccupancyGrid) -> PolygonWorld:
        """The blocked cells of a grid as one obstacle, outlined along their sides; the grid's bounds."""
        made = cls.__new__(cls)
        side, (x, y) = grid.resolution, map(float, grid.origin)
        rows, columns = grid.shape
        made._bounds = np.array([x, y, x + side * columns, y + side * rows])
        cells = np.ascontiguousarray(grid.blocked).view(np.uint8)
        made._core = _core.PolygonCore(cells, side, (x, y), ON_WALL * side * max(rows, columns))
        made._repairs = ()
        return made

    @cached_property
    def _outlines(self) -> list[Outline]:
        """The complement of the free space of a grid, in a box larger than the bounds."""
        xmin, ymin, xmax, ymax = self.bounds
        wide = longer_side(self.bounds)
        low, high = (xmin - wide, ymin - wide), (xmax + wide, ymax + wide)
        return [[np.array([low, (high[0], low[1]), high, (low[0], high[1])]), *self.walls]]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, ymin, xmax, ymax) [m]."""
        xmin, ymin, xmax, ymax = map(float, self._bounds)
        return xmin, ymin, xmax, ymax

    @property
    def obstacles(self) -> list[list[Array]]:
        """Each obstacle as its rings, (n, 2) [m] each: the outline, then holes."""
        return [[ring.copy() for ring in rings] for rings in self._outlines]

    @property
    def repairs(self) -> tuple[str, ...]:
        """What repair=True changed, one sentence for each invalid polygon."""
        return self._repairs

    @property
    def components(self) -> int:
        """The number of connected components of free space."""
        return self._core.components

    @cached_property
    def walls(self) -> list[Array]:
        """The boundary of free space as closed rings (n, 2) [m], with free space on their left."""
        points, following, ring, _ = self._core.walls()
        return [points[_follow_ring(following, first)] for first in np.unique(ring, return_index=True)[1]]

    def save_geojson(self, path: str | PathLike[str]) -> None:
        """Writes obstacles and bounds as GeoJSON; the file is replaced atomically."""
        write_geojson(path, self._outlines, self.bounds)

    def save_text(self, path: str | PathLike[str]) -> None:
        """Writes obstacles and bounds as a text file for from_text; the file is replaced atomically."""
        write_polygons(path, self._outlines, self.bounds)

    def is_free(self, points: ArrayLike) -> Any:
        """Whether points (..., 2) [m] lie in free space or on its walls: (...) of bool."""
        given = as_floats(points, "points", last=(2,))
        free = [bool(self._core.components_at(point)) for point in given.reshape(-1, 2)]
        return np.array(free).reshape(given.shape[:-1]) if given.ndim > 1 else free[0]

    def clearance(self, points: ArrayLike) -> Any:
        """The distance [m] from points (..., 2) [m] to the nearest wall: (...); zero inside obstacles."""
        given = as_floats(points, "points", last=(2,))
        found = [
            self._core.nearest_wall(point)[0] if self._core.components_at(point) else 0.0
            for point in given.reshape(-1, 2)
        ]
        return np.array(found).reshape(given.shape[:-1]) if given.ndim > 1 else found[0]

    def path_clearance(self, path: ArrayLike) -> float:
        """The least distance [m] from a path (m, 2) [m] to a wall: zero if it touches or crosses one.

        Exact up to rounding, over the whole path and not only at its corners; NaN for an empty path.
        """
        points = as_path(path)
        if not len(points):
            return nan
        least: float = self._core.path_clearance(points)
        return least if self._core.components_at(points[0]) else 0.0

    def inflate(self, radius: float, *, sides: int = 32, keep: ArrayLike = ()) -> PolygonWorld:
        """The world of the centre of a disc of a radius [m]: obstacles grown by it, bounds shrunk.

        The exact boundary at the radius from the walls has straight sides and an arc around each corner.
        Each arc is replaced by a circumscribed polygon with `sides` or more sides. A path therefore keeps
        the radius everywhere. The polygons exceed the arcs by at most radius · (1 / cos(π / sides) − 1), by
        nothing along walls, and by nothing in gaps: a gap is open exactly if the disc fits.

        keep: (k, 2) [m], points toward which corner polygons add nothing either, for centres that exceed
        the radius from a corner by less than that amount.
        """
        places = as_floats(keep, "keep", last=(2,)).reshape(-1, 2) if np.size(keep) else np.empty((0, 2))
        if (reach := check_inflation(radius)) <= ON_WALL * longer_side(self._bounds):
            return self  # less than the rounding of its corners
        obstacles, bounds = grow_outlines(self._outlines, self._bounds, reach, sides, places)
        return PolygonWorld(obstacles, bounds, repair=True)

    def offset(self, radius: float) -> Offset:
        """The exact free space of the centre of a disc of a radius [m]: curves of segments and arcs.

        Exact up to rounding, where `inflate` has polygons in place of the arcs. InputError for a radius
        that is not positive.
        """
        return find_offset(self.walls, self.clearance, longer_side(self._bounds), radius)

    def to_grid(self, resolution: float | None = None) -> OccupancyGrid:
        """Cells of a side `resolution` [m], with cell (0, 0) in the lower left corner of the bounds.

        By default there are 200 along the longer side of the bounds, or up to 300 where that leaves a
        smaller remainder of the shorter side. A cell is blocked in three cases: an obstacle overlaps it (by
        more than 1e-12 of the world's side), a wall without thickness touches it, or it extends beyond the
        bounds. A resolution that divides both sides of the bounds loses no free space.
        """
        blocked, side = rasterize_world(self._core, self._bounds, resolution)
        return OccupancyGrid(blocked, side, self._bounds[:2])

    def check_free(self, point: ArrayLike, subject: str) -> Array:
        """The point (2,) [m]; InputError if it is not finite, outside the bounds or inside an obstacle."""
        x, y = as_point(point, subject)
        if self._core.components_at((x, y)):
            return np.array([x, y])
        where = f"{subject} ({x:g}, {y:g})"
        xmin, ymin, xmax, ymax = self.bounds
        if not (xmin <= x <= xmax and ymin <= y <= ymax):
            rule = f"the bounds are x from {xmin:g} to {xmax:g}, y from {ymin:g} to {ymax:g}"
            raise InputError(f"{where} lies outside the world; {rule}")
        deep, wall_x, wall_y = self._core.nearest_wall((x, y))
        if not np.isfinite(deep):
            raise InputError(f"{where} lies inside an obstacle; there is no free space at all")
        raise InputError(
            f"{where} lies inside obstacle {self._core.obstacle_at((x, y))}, {deep:.3g} m deep; "
            f"the nearest free point is ({wall_x:.9g}, {wall_y:.9g})"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Obstacles and bounds: the data that pickle stores."""
        return _make_again, (self._outlines, self._bounds)

    def __repr__(self) -> str:
        corners = sum(len(ring) for rings in self._outlines for ring in rings)
        return f"PolygonWorld({len(self._outlines)} obstacles, {corners} corners, bounds={self.bounds})"


def _build_core(outlines: Sequence[Outline], bounds: Array) -> _core.PolygonCore:
    rings = [(ring, owner) for owner, rings in enumerate(outlines) for ring in rings]
    points = np.vstack([np.empty((0, 2)), *(ring for ring, _ in rings)])
    ends = np.cumsum([len(ring) for ring, _ in rings], dtype=np.int32)
    owners = np.array([owner for _, owner in rings], dtype=np.int32)
    tolerance = ON_WALL * longer_side(bounds)
    core = _core.PolygonCore(points, ends, owners, bounds[:2], bounds[2:], tolerance)
    if not core.complete:
        raise GeometryError("the obstacles cross each other too often to be separated; simplify them")
    return core


def _make_again(outlines: list[Outline], bounds: Array) -> PolygonWorld:
    return PolygonWorld(outlines, bounds, repair=True)


def _follow_ring(following: Any, first: int) -> list[int]:
    """The edges of a ring, starting at a given one."""
    found, at = [first], int(following[first])
    while at != first:
        found.append(at)
        at = int(following[at])
    return found
