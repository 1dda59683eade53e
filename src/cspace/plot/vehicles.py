"""How vehicles drive: the room they sweep, where they drive backwards, the lines of a coverage."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.plot import colors
from cspace.plot.axes import PLACE, draw_image, draw_lines, draw_polygons, flat_axes, write_title
from cspace.plot.worlds import world

BODIES: Final = 24
"""Outlines of the vehicle between start and goal."""
ROUND: Final = 36
"""Corners of the polygon that approximates the outline of a disc."""
ARCS: Final = 40.0
"""Poses per radius along a curve."""


def drive(drive: Any, *, ax: Any | None = None, bodies: int = BODIES) -> list[Any]:
    """Draw the path of a vehicle: red forwards, blue backwards, with its outline along the path.

    drive: a CarRoute, which also draws its grid, a Run or a Curve. A Curve knows no vehicle: triangles show
    where it heads at start and goal. bodies: at how many poses, evenly along the way, the outline is drawn.
    Returns the artists.
    """
    axes = flat_axes(ax)
    poses = poses_of(drive)
    grid = getattr(drive, "grid", None)
    artists = [] if grid is None else world(grid, ax=axes)
    vehicle = getattr(drive, "vehicle", None)
    ends = np.array([drive.start, drive.goal]) if hasattr(drive, "goal") else poses[[0, -1]]
    if vehicle is not None:
        artists += draw_outlines(axes, vehicle, space_evenly(poses, bodies), linewidths=0.5, alpha=0.12)
        artists += draw_outlines(axes, vehicle, ends, linewidths=1.4, facecolors="none", zorder=5)
    artists += draw_directions(axes, poses)
    for (x, y, theta), size in zip(ends, (8, 12), strict=True):
        pointing = (3, 0, np.degrees(theta) - 90.0)
        artists += axes.plot(x, y, marker=pointing, ms=size, **PLACE | {"mew": 1.2})
    if grid is None:
        axes.set_aspect("equal")
        axes.margins(0.08)
        axes.autoscale_view()
    return artists + write_title(axes, title_of(drive))


def coverage(coverage: Any, *, ax: Any | None = None) -> list[Any]:
    """Draw a coverage path on a grid: regions tinted, the path from dark to light in its order.

    Returns the artists.
    """
    if not hasattr(coverage, "regions"):
        raise InputTypeError(f"coverage is an object of type {type(coverage).__name__}; give a Coverage")
    axes = flat_axes(ax)
    artists = world(coverage.grid, ax=axes)
    xmin, ymin, xmax, ymax = coverage.grid.bounds
    tints = colors.mix_colors(colors.make_palette(max(len(coverage.order), 1)), (1.0, 1.0, 1.0), 0.72)
    shade = np.zeros((*coverage.regions.shape, 4))
    inside = coverage.regions >= 0
    shade[inside, :3] = tints[coverage.regions[inside] % len(tints)]
    shade[inside, 3] = 1.0
    artists += draw_image(axes, coverage.grid, shade)
    pieces = np.stack([coverage.path[:-1], coverage.path[1:]], axis=1)
    when = np.linspace(0.0, 0.85, len(pieces))
    artists += draw_lines(axes, pieces, array=when, cmap="viridis", clim=(0.0, 1.0), linewidths=1.4, zorder=4)
    artists += axes.plot(*coverage.path[0], "o", ms=7, **PLACE)
    axes.set(xlim=(xmin, xmax), ylim=(ymin, ymax))
    said = f"coverage: {coverage.length:.5g} m, overlap {coverage.overlap:.2g}"
    return artists + write_title(axes, said)


def poses_of(drive: Any) -> Array:
    """The poses (n, 3) along a path, none without a path."""
    if hasattr(drive, "poses"):
        return np.asarray(drive.poses)
    if hasattr(drive, "sample"):
        return np.asarray(drive.sample(drive.radius / ARCS))
    raise InputTypeError(f"drive is {name_type(drive)}; give a CarRoute, a Run or a Curve")


def title_of(drive: Any) -> str:
    if hasattr(drive, "controller"):
        return f"{drive.controller}: {drive.status}"
    if hasattr(drive, "word"):
        return f"{drive.word}, {drive.length:.5g} m"
    return f"hybrid_a_star: {drive.reason.split(',')[0] if not drive else format(drive.length, '.5g') + ' m'}"


def space_evenly(poses: Array, count: int) -> Array:
    """Poses spaced evenly along the path, at most `count`."""
    if count < 0:
        raise InputError(f"bodies is {count}; it must be a number of outlines, zero or more")
    if not len(poses):
        return poses
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))])
    rows = np.searchsorted(along, np.linspace(0.0, along[-1], count))
    return np.asarray(poses[np.unique(rows)])


def draw_outlines(axes: Any, vehicle: Any, poses: Array, **style: Any) -> list[Any]:
    """The outline of a vehicle at poses (k, 3)."""
    behind, ahead, aside, disc = vehicle._footprint
    angles = np.linspace(0.0, 2 * np.pi, ROUND, endpoint=False)
    around = disc * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    box = np.array([[-behind, -aside], [ahead, -aside], [ahead, aside], [-behind, aside]])
    body = around if disc else box
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    turned = np.einsum("kij,mj->kmi", np.array([[c, -s], [s, c]]).transpose(2, 0, 1), body)
    drawn = {"facecolors": [colors.JOINT], "edgecolors": [colors.INK], "zorder": 2, **style}
    return draw_polygons(axes, turned + poses[:, None, :2], **drawn)


def draw_directions(axes: Any, poses: Array) -> list[Any]:
    """The path of a vehicle, each step in the colour of its direction."""
    pieces = np.stack([poses[:-1, :2], poses[1:, :2]], axis=1)
    steps = np.diff(poses[:, :2], axis=0)
    heading = np.stack([np.cos(poses[:-1, 2]), np.sin(poses[:-1, 2])], axis=1)
    tints = np.where(np.sum(steps * heading, axis=1)[:, None] >= 0, colors.PATH, colors.AXES[2])
    return draw_lines(axes, pieces, colors=tints, linewidths=2.0, zorder=6, capstyle="round")
