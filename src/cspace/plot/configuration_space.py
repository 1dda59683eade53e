"""The workspace and the configuration space of a planar arm with two joints, side by side."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, name_type
from cspace.math.wrapping import TURN, turns_within, wrap_above
from cspace.planning import ConfigurationSpace, Projection, Slice
from cspace.plot import colors
from cspace.plot.axes import PLACE, draw_lines, draw_polygons, flat_axes, need_matplotlib, write_title
from cspace.plot.planar import outline_bar, prepare_axes

CELLS: Final = 720
"""Cells of the picture along each joint: two per degree."""
PANEL: Final = 5.0
"""Side of one of the two pictures [inch]."""
PALE: Final = 0.35
"""Share of white in the colour of a region, whose boundary has the colour itself."""
DARK: Final = 0.45
"""Share of ink in the colour of a boundary."""
THIN_LINK: Final = 0.018
"""Least radius at which a link is drawn, over the reach of the arm."""
ARC_STEP: Final = math.pi / 32
"""Angle [rad] between points of a round corner."""
GHOSTS: Final = 7
"""Configurations along a path that are drawn in the workspace, ends left out."""
QUIET: Final = (0.42, 0.46, 0.52)
"""Labels and frames."""


def configuration_space(
    space: ConfigurationSpace,
    *,
    start: ArrayLike | None = None,
    goals: ArrayLike | None = None,
    path: ArrayLike | None = None,
    ax: Any | None = None,
) -> list[Any]:
    """Draw the plane of a planar arm, and beside it its configuration space, coloured by obstacle.

    space: a ConfigurationSpace. start: a configuration (2,) [rad], a circle. goals: one (2,) or several
    (k, 2), such as every IK solution of a position, stars. path: configurations (m, 2), or a Connection of
    `space.path`. In the plane the start is solid, goals and configurations on the path are faint, and a line
    follows the tip. ax: two axes, for the plane and for the configuration space; new ones by default.

    Returns the artists. Raises InputError for one axes instead of two.
    """
    if not hasattr(space, "obstacle_map"):
        raise InputTypeError(
            f"space is {name_type(space)}; configuration_space draws a ConfigurationSpace, that of a"
            " planar arm with two joints. Draw a JointSpace by cs.plot.space_slice(space.slice((0, 1)))"
        )
    plane, joints = two_axes(ax)
    tints = colors.make_palette(len(space.obstacles))
    places = read_rows(start, "start"), read_rows(goals, "goals")
    way = read_rows(getattr(path, "path", path), "path")
    return [
        *draw_plane(plane, space, tints, *places, way),
        *draw_space(joints, space, tints, *places, way),
    ]


def two_axes(ax: Any | None) -> tuple[Any, Any]:
    """The two given axes, or new ones side by side."""
    if ax is None:
        need_matplotlib()
        import matplotlib.pyplot as plt

        figure = plt.figure(figsize=(2.1 * PANEL, PANEL), dpi=120, layout="constrained")
        return figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2)
    pair = np.ravel(np.array(ax, dtype=object))
    if len(pair) != 2:
        raise InputError(f"ax has {len(pair)} axes; give two, such as plt.subplots(1, 2)[1]")
    return flat_axes(pair[0]), flat_axes(pair[1])


def read_rows(value: ArrayLike | None, subject: str) -> Array:
    """Configurations (k, 2) of one or several; none for None."""
    if value is None:
        return np.empty((0, 2))
    return as_floats(value, subject, last=(2,)).reshape(-1, 2)


def draw_plane(
    axes: Any, space: ConfigurationSpace, tints: Array, start: Array, goals: Array, way: Array
) -> list[Any]:
    """The obstacles in the plane, the arm at the start, faintly at the goals and along the path."""
    prepare_axes(axes, space.arm.axes)
    artists = []
    for tint, pieces in zip(tints, space.sections.values(), strict=True):
        outlines = [round_outline(piece.corners, piece.radius) for piece in pieces]
        face = colors.mix_colors(tint, (1.0, 1.0, 1.0), PALE)
        artists += draw_polygons(
            axes, outlines, facecolors=[face], edgecolors=[face], linewidths=0.5, zorder=1
        )
    for k in along_path(way):
        artists += draw_links(axes, space, k, colors.LINK, alpha=0.35, zorder=2)
    for goal in goals:
        artists += draw_links(axes, space, goal, colors.JOINT, alpha=0.35, zorder=3)
    if len(way):
        tips = space.arm.points(fill_path(way))[:, 2]
        artists += axes.plot(*tips.T, color=colors.PATH, linewidth=1.6, zorder=4)
    for q in start:
        artists += draw_links(axes, space, q, colors.LINK, alpha=1.0, zorder=5)
    for q, mark, size in ends_of(start, goals):
        artists += axes.plot(*space.arm.points(q)[2], mark, ms=size, **PLACE)
    view = 1.08 * space.arm.reach + space.link_radius
    x, y = space.arm.base
    axes.set(xlim=(x - view, x + view), ylim=(y - view, y + view))
    axes.set_aspect("equal", adjustable="box")
    return artists + write_title(axes, f"{space.arm.name}: the plane")


def draw_space(
    axes: Any, space: ConfigurationSpace, tints: Array, start: Array, goals: Array, way: Array
) -> list[Any]:
    """Free configurations white, the others in the colours of what blocks them; boundary, path and ends."""
    (x0, y0), (x1, y1) = space.lower, space.upper
    shades = np.vstack([colors.mix_colors(tints, (1.0, 1.0, 1.0), PALE), np.ones((1, 3))])  # −1 is the last
    picture = shades[space.obstacle_map(CELLS).T]
    extent, style = (x0, x1, y0, y1), {"origin": "lower", "interpolation": "nearest", "zorder": 0}
    artists = [axes.imshow(picture, extent=extent, **style)]
    for number, name in enumerate(space.obstacles):
        curves = [curve.points for curve in space.boundaries if curve.obstacle == name]
        color = colors.mix_colors(tints[number], colors.INK, DARK)
        artists += draw_lines(axes, copies_of(space, curves), colors=[color], linewidths=1.1, zorder=2)
    if len(way):
        style = {"colors": [colors.PATH], "linewidths": 2.0, "zorder": 4}
        artists += draw_lines(axes, copies_of(space, [way]), **style)
    for q, mark, size in ends_of(start, goals):
        artists += axes.plot(*wrap_into(space, q), mark, ms=size, **PLACE)
    mark_angles(axes.xaxis, x0, x1)
    mark_angles(axes.yaxis, y0, y1)
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
    names = space.arm.joint_names
    axes.set_xlabel(f"{names[0]} [rad]", fontsize=9, color=QUIET)
    axes.set_ylabel(f"{names[1]} [rad]", fontsize=9, color=QUIET)
    axes.tick_params(labelsize=8.5, labelcolor=QUIET, color=QUIET)
    for side in axes.spines.values():
        side.set_color(QUIET)
    count = len(space.components)
    return artists + write_title(axes, f"configuration space: {count} free component{'s' * (count != 1)}")


def draw_links(
    axes: Any, space: ConfigurationSpace, q: Array, tint: Any, *, alpha: float, zorder: float
) -> list[Any]:
    """The two links at a configuration, and their joints."""
    base, elbow, tip = space.arm.points(q)
    radius = max(space.link_radius, THIN_LINK * space.arm.reach)
    edge = (*colors.mix_colors(tint, colors.INK, 0.5), alpha)
    bars = [outline_bar(p, r, radius, radius) for p, r in ((base, elbow), (elbow, tip))]
    face = (*np.asarray(tint), alpha)
    links = draw_polygons(axes, bars, facecolors=[face], edgecolors=[edge], linewidths=0.9, zorder=zorder)
    style = {"ms": 4.0, "mfc": (*colors.JOINT, alpha), "mec": edge, "mew": 0.8, "zorder": zorder + 0.5}
    return [*links, *axes.plot(*np.array([base, elbow]).T, "o", **style)]


def ends_of(start: Array, goals: Array) -> list[tuple[Array, str, float]]:
    """Configurations with a mark and its size: a circle at the start, stars at the goals."""
    return [*((q, "o", 7.0) for q in start), *((q, "*", 12.0) for q in goals)]


def along_path(way: Array) -> Array:
    """Some configurations evenly spaced along a path, without its ends."""
    if len(way) < 2:
        return np.empty((0, 2))
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    at = length[-1] * np.arange(1, GHOSTS + 1) / (GHOSTS + 1)
    return np.column_stack([np.interp(at, length, way[:, k]) for k in (0, 1)])


def fill_path(way: Array) -> Array:
    """A path with so many points that its tip draws a smooth curve."""
    filled = [way[:1]]
    for a, b in pairwise(way):
        steps = 1 + int(np.abs(b - a).max() / ARC_STEP)
        filled.append(a + (b - a) * np.arange(1, steps + 1)[:, None] / steps)
    return np.vstack(filled)


def round_outline(corners: Array, radius: float) -> Array:
    """The outline (m, 2) of a convex polygon (n, 2) grown by a radius: arcs around its corners."""
    if radius == 0.0 and len(corners) > 2:
        return corners
    sides = np.roll(corners, -1, axis=0) - corners
    leaving = np.arctan2(-sides[:, 0], sides[:, 1])  # of the outward normals
    if len(corners) == 1:
        arcs = [np.arange(0.0, TURN, ARC_STEP)]
    else:
        entering = np.roll(leaving, 1)
        turns = wrap_above(leaving - entering, 0.0)
        arcs = [a + np.linspace(0.0, t, 2 + int(t / ARC_STEP)) for a, t in zip(entering, turns, strict=True)]
    return np.vstack(
        [p + radius * np.column_stack([np.cos(a), np.sin(a)]) for p, a in zip(corners, arcs, strict=True)]
    )


def copies_of(space: ConfigurationSpace | Slice | Projection, curves: list[Array]) -> list[Array]:
    """Curves in the picture, with the copies by multiples of 2π that reach into it where joints wrap."""
    found = []
    for curve in curves:
        low, high = curve.min(axis=0), curve.max(axis=0)
        first, last = np.where(space.wraps, turns_within(high, low, space.lower, space.upper), 0.0)
        for i in np.arange(first[0], last[0] + 1.0):
            for j in np.arange(first[1], last[1] + 1.0):
                found.append(curve + TURN * np.array([i, j]))
    return found


def wrap_into(space: ConfigurationSpace | Slice | Projection, q: Array) -> Array:
    """The copy of a configuration that lies in the picture."""
    return np.where(space.wraps, wrap_above(q, space.lower), q)


def mark_angles(axis: Any, low: float, high: float) -> None:
    """Ticks at multiples of π/2, of π where there are many, of π/4 where there are few."""
    wide = high - low
    step = math.pi / 4 if wide < math.pi else math.pi / 2 if wide < 3.0 * math.pi else math.pi
    ticks = np.arange(math.ceil(low / step - 0.01), math.floor(high / step + 0.01) + 1)
    axis.set_ticks(ticks * step, [write_angle(tick * step) for tick in ticks])


def write_angle(angle: float) -> str:
    """A multiple of π/4 as text."""
    quarters = round(angle / (math.pi / 4))
    if quarters == 0:
        return "0"
    below = 4 // math.gcd(quarters, 4)
    above, sign = abs(quarters) * below // 4, "−" if quarters < 0 else ""
    return f"{sign}{'' if above == 1 else above}π{'' if below == 1 else f'/{below}'}"
