"""The stage of a picture in space: the floor, the point of view, the frame around it all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot import colors
from cspace.plot.raytrace.canvas import Floor
from cspace.plot.raytrace.scene import scene_of
from cspace.plot.raytrace.solids import Solid, make_arrow
from cspace.plot.raytrace.view import look_along, project_points
from cspace.tolerances import LEAST_DIVISOR

ROOM: Final = 0.0925
"""Half the height of matplotlib's 3-D view in its projected units."""

GRID_STEPS: Final = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
"""Distances between the lines of a floor [m]; the one that gives about eight lines is taken."""


def choose_view(
    points: Array, focus: Array, hidden: Callable[[Array, Array], float] | None = None
) -> tuple[float, float]:
    """Elevation and azimuth [deg] from where the points (m, 3) spread widest.

    `focus` (k, 3): what should not be hidden (the tip); it pulls the view to its side of the arm. `hidden`:
    the share of points that obstacles hide from an eye in a direction (3,); views from higher up count too.
    """
    spread = points - points.mean(axis=0)
    outward = focus.mean(axis=0) - points.mean(axis=0)
    best, best_score = (24.0, -60.0), -np.inf
    for elevation in (18.0, 24.0, 30.0) if hidden is None else (18.0, 24.0, 30.0, 38.0, 48.0):
        for azimuth in np.arange(-165.0, 181.0, 15.0):
            right, up, eye = look_along(elevation, azimuth)
            seen = spread @ np.stack([right, up], axis=1)
            area = np.sqrt(max(np.linalg.det(seen.T @ seen / len(seen)), 0.0))
            toward = outward @ eye / (np.linalg.norm(outward) + LEAST_DIVISOR)
            score = area * (1.0 + 0.35 * toward - 0.10 * abs(elevation - 24.0) / 6.0)
            score *= 1.0 + 0.08 * np.cos(np.radians(azimuth + 55.0))
            score *= 1.0 if hidden is None else (1.0 - hidden(points, eye)) ** 2
            if score > best_score:
                best, best_score = (elevation, float(azimuth)), score
    return best


def fit_axes(ax: Any, points: Array, *, margin: float = 1.10) -> None:
    """Equal aspect, and limits and zoom such that the points (m, 3) fill the axes whatever the view."""
    center = 0.5 * (points.min(axis=0) + points.max(axis=0))
    half = 0.5 * float(np.ptp(points, axis=0).max()) or 1.0
    zoom = 1.0
    for _ in range(4):  # the projection depends on the limits a little: a few rounds settle
        for axis, c in zip("xyz", center, strict=True):
            getattr(ax, f"set_{axis}lim")(c - half, c + half)
        ax.set_box_aspect((1, 1, 1), zoom=zoom)
        x, y, _ = project_points(points, ax.get_proj()).T
        width, height = np.ptp(x) / 2, np.ptp(y) / 2
        box = ax.get_window_extent()
        shape = min(box.width, box.height)
        room_x, room_y = ROOM * box.width / shape / margin, ROOM * box.height / shape / margin
        grow = min(room_x / max(width, LEAST_DIVISOR), room_y / max(height, LEAST_DIVISOR))
        right, up, _ = look_along(ax.elev, ax.azim)
        per_unit = (np.ptp(points @ right) or 1.0) / max(np.ptp(x), LEAST_DIVISOR)
        center = center + per_unit * (0.5 * (x.min() + x.max()) * right + 0.5 * (y.min() + y.max()) * up)
        zoom *= grow


def floor_under(center: Array, radius: float, height: float) -> Floor:
    """A round floor at a height [m] whose lines have a handy distance."""
    step = min(GRID_STEPS, key=lambda s: abs(2 * radius / s - 9))
    return Floor(np.array([center[0], center[1], height]), radius, step)


def set_up(ax: Any, points: Array, floor: Floor, *, elevation: float, azimuth: float) -> Any:
    """An empty stage with its floor, seen from a direction [deg] such that the points (m, 3) fill it."""
    ax.set_axis_off()
    ax.computed_zorder = False
    ax.set_proj_type("persp", focal_length=1.6)
    ax.view_init(elev=elevation, azim=azimuth)
    fit_axes(ax, np.concatenate([points, floor.rim(33)]))
    return scene_of(ax, floor)


def make_triads(poses: Array, size: float, *, thickness: float = 0.035) -> list[Solid]:
    """Frames as red x, green y and blue z arrows of length `size` [m] at the poses (k, 4, 4)."""
    return [
        piece
        for T in poses
        for axis in range(3)
        for piece in make_arrow(T[:3, 3], size * T[:3, axis], thickness * size, np.array(colors.AXES[axis]))
    ]


def goal_pose(goal: Any, T_tip: Array) -> Array:
    """The pose to draw for a goal: a pose as it is, a point (3,) with the orientation of the tip."""
    given = np.asarray(goal, dtype=np.float64)
    if given.shape == (4, 4):
        return given
    T = T_tip.copy()
    T[: len(given), 3] = given
    return T


def write_title(ax: Any, title: str) -> list[Any]:
    """The title in the upper left corner."""
    if not title:
        return []
    own_figure = len(ax.figure.axes) == 1
    place = ax.figure.transFigure if own_figure else ax.transAxes
    return [ax.text2D(0.03, 0.97, title, transform=place, fontsize=12.5, color=colors.INK, va="top")]
