"""Fields that planners go down: bands of equal height in the plane, or a surface in space; their minima."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.maps.outlines import longer_side
from cspace.plot import colors
from cspace.plot.axes import PLACE, space_axes, write_title
from cspace.tolerances import SAME_MINIMUM

PLACES: Final = 160
"""Places along a side of the world at which a field is evaluated for its picture."""
TOP: Final = 0.85
"""The share of free places shown with different heights: beyond it, next to walls, fields are unbounded."""
BANDS: Final = 24
"""Bands of equal height."""

Height = Callable[[Array], Array]


def surface(route: Any, *, ax: Any | None = None) -> list[Any]:
    """The field that a route went down as a surface in space, the path on it, and its minima.

    route: of the planner "potential_field", "rimon_koditschek" or "harmonic". The height is the potential; of
    navigation functions exp(V / kappa), which grows with φ and does not flatten; of harmonic potentials −log
    of the chance. Obstacles are plateaus at the top; minima are marked by dots, the goal by a star. ax: 3-D
    axes. Returns the artists. InputError for other planners, and where there was no field.
    """
    height = height_of(route)
    axes = space_axes(ax)
    at, where = raster_points(route.world)
    level, top = cap_heights(height(at))
    solid = np.isnan(level)
    low = float(np.nanmin(level))
    shown = np.where(solid, top, level)
    paint = tint_places(shown, solid, low, top)
    style = dict(rstride=1, cstride=1, linewidth=0, antialiased=False, shade=True)
    artists = [axes.plot_surface(*np.meshgrid(*where), shown, facecolors=paint, **style)]
    axes.computed_zorder = False
    lift = 0.01 * (top - low)
    path = interpolate_path(route.path)
    if len(path):
        artists += axes.plot(
            *path.T, np.minimum(height(path), top) + lift, color=colors.PATH, linewidth=2, zorder=6
        )
    for points, marker, size in ((find_minima(route), "o", 6), (route.goal[None], "*", 13)):
        z = np.clip(height(points), low, top) + lift
        artists += axes.plot(*points.T, z, marker, ms=size, **PLACE)
    xmin, ymin, xmax, ymax = route.world.bounds
    wide = longer_side(route.world.bounds)
    axes.set_box_aspect(((xmax - xmin) / wide, (ymax - ymin) / wide, 0.45))
    axes.view_init(elev=58, azim=-72)
    axes.tick_params(labelsize=7, colors=colors.INK)
    axes.set_zticks([])
    said = route.planner if route else f"{route.planner}: {route.status}"
    write_title(axes, said)
    return artists


def draw_bands(axes: Any, route: Any) -> list[Any]:
    """The field as bands of equal height, and its minima other than the goal (dots)."""
    try:
        height = height_of(route)
    except InputError:
        return []
    at, where = raster_points(route.world)
    level, _ = cap_heights(height(at))
    artists: list[Any] = []
    if np.nanmax(level) > np.nanmin(level):
        artists.append(axes.contourf(*where, level, levels=BANDS, cmap="Blues", zorder=1, alpha=0.85))
    low = find_minima(route)
    if len(low):
        artists += axes.plot(*low.T, "o", ms=5, **PLACE | {"mew": 1.2, "zorder": 5})
    return artists


def height_of(route: Any) -> Height:
    """The field of a route: points (..., 2) [m] → (...), infinite or NaN where there is none."""
    makers = {
        "potential_field": potential_height,
        "rimon_koditschek": navigation_height,
        "harmonic": harmonic_height,
    }
    maker = makers.get(getattr(route, "planner", ""))
    if maker is None:
        raise InputError(f"a surface needs a route of one of {', '.join(makers)}; this one is {route!r}")
    return maker(route)


def potential_height(route: Any) -> Height:
    from cspace.navigation.fields.potential_field import potential

    gains = {name: value for name, value in route.evidence.gains.items() if name != "step"}
    return partial(potential, route.world, route.goal, **gains)


def navigation_height(route: Any) -> Height:
    function = route.evidence.function
    if function is None:
        raise InputError(f"there is no navigation function to draw: {route.reason}")

    def height(points: Array) -> Array:
        return np.asarray(np.exp(np.asarray(function.log_odds(points)) / function.kappa))

    return height


def harmonic_height(route: Any) -> Height:
    from cspace.navigation.fields.harmonic import harmonic

    grid = route.world
    field = harmonic(grid, route.goal)

    def height(points: Array) -> Array:
        column, row = np.moveaxis(np.floor((points - grid.origin) / grid.resolution).astype(int), -1, 0)
        return np.asarray(field[np.clip(row, 0, grid.rows - 1), np.clip(column, 0, grid.columns - 1)])

    return height


def find_minima(route: Any) -> Array:
    """Where the field of a route rests but at its goal: (k, 2) [m]. Of potential fields what descents from
    the lowest places of a raster come to; other fields have none."""
    if route.planner != "potential_field":
        return np.empty((0, 2))
    from cspace.navigation import navigate

    at, _ = raster_points(route.world)
    level = height_of(route)(at)
    middle = level[1:-1, 1:-1]
    n = PLACES - 2
    lower = [level[i : i + n, j : j + n] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    side = longer_side(route.world.bounds)
    kept: list[Array] = []
    for start in at[1:-1, 1:-1][np.isfinite(middle) & np.all([middle < x for x in lower], axis=0)]:
        rest = navigate(route.world, start, route.goal, "potential_field", **route.evidence.gains)
        end = rest.path[-1]
        if not rest and all(np.hypot(*(end - other)) > SAME_MINIMUM * side for other in kept):
            kept.append(end)
    return np.array(kept).reshape(-1, 2)


def raster_points(world: Any) -> tuple[Array, tuple[Array, Array]]:
    """A raster over the bounds, of centres of cells where they are few: its points (rows, columns, 2), and x
    of its columns and y of its rows."""
    xmin, ymin, xmax, ymax = world.bounds
    columns = min(PLACES, world.columns) if world.kind == "grid" else PLACES
    rows = min(PLACES, world.rows) if world.kind == "grid" else PLACES
    x = xmin + (np.arange(columns) + 0.5) * (xmax - xmin) / columns
    y = ymin + (np.arange(rows) + 0.5) * (ymax - ymin) / rows
    return np.stack(np.meshgrid(x, y), axis=-1), (x, y)


def cap_heights(height: Array) -> tuple[Array, float]:
    """Heights up to a top, NaN where there is none; and the top."""
    level = np.where(np.isfinite(height), height, np.nan)
    if np.isnan(level).all():
        return np.zeros_like(level), 1.0
    top = float(np.nanquantile(level, TOP))
    return np.minimum(level, top), top


def tint_places(level: Array, solid: Any, low: float, top: float) -> Array:
    """A colour for every place (n, n, 4): blue by height, obstacles dark."""
    from matplotlib import colormaps

    share = np.floor(BANDS * (level - low) / max(top - low, np.finfo(np.float64).tiny)) / BANDS
    paint: Array = colormaps["Blues"](0.15 + 0.75 * share)
    paint[solid] = (*colors.WALL, 1.0)
    return paint


def interpolate_path(path: Array) -> Array:
    """A path with points in between, so that it lies on a surface: (m, 2)."""
    if len(path) < 2:
        return path
    along = np.concatenate(([0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    where = np.linspace(0, along[-1], 4 * PLACES)
    return np.stack([np.interp(where, along, path[:, k]) for k in (0, 1)], axis=1)
