"""The particles of Monte Carlo localisation on their map."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputTypeError, name_type
from cspace.plot import colors
from cspace.plot.axes import draw_lines, draw_polygons, flat_axes, write_title
from cspace.plot.worlds import world

MOST_ARROWS: Final = 400
"""Particles whose headings are drawn."""
ARROW: Final = 0.02
"""Length of a heading over the side of the picture."""
ELLIPSE: Final = 2.4477
"""Standard deviations of the ellipse that holds 95 % of a normal distribution of the plane."""
CORNERS: Final = 48
WIDEST: Final = 1.0
"""Standard deviation of a mode among others [m] beyond which its ellipse says nothing."""


def particles(pf: Any, *, ax: Any | None = None, grid: Any | None = None) -> list[Any]:
    """Draw the particles of a ParticleFilter, or the last ones of a MapLocalization, on their map.

    Points are particles, lines their headings; each mode has its ellipse of 95 % and its share of the weight.
    grid: the map, unless the filter knows it. Returns the artists.
    """
    if not hasattr(pf, "particles") or not hasattr(pf, "modes"):
        raise InputTypeError(f"pf is {name_type(pf)}; give a ParticleFilter or a MapLocalization")
    axes = flat_axes(ax)
    known = grid if grid is not None else getattr(pf, "grid", None)
    artists = draw_map(axes, known)
    poses = np.asarray(pf.particles)
    side = find_side(axes, poses)
    artists += axes.plot(*poses[:, :2].T, ".", ms=2.5, mew=0, color=colors.JOINT, alpha=0.5, zorder=4)
    some = poses[:: max(1, len(poses) // MOST_ARROWS)]
    ahead = ARROW * side * np.stack([np.cos(some[:, 2]), np.sin(some[:, 2])], axis=-1)
    pieces = np.stack([some[:, :2], some[:, :2] + ahead], axis=1)
    artists += draw_lines(axes, pieces, colors=[colors.JOINT], linewidths=0.6, alpha=0.6, zorder=4)
    for k, mode in enumerate(pf.modes):
        if mode.spread[0] < WIDEST or (k == 0 and len(pf.modes) == 1):
            artists += draw_mode(axes, mode, side)
    if known is None:
        axes.set_aspect("equal")
        axes.autoscale_view()
    return artists + write_title(axes, f"{len(poses)} particles: {pf.status}, {pf.reason}")


def draw_map(axes: Any, grid: Any) -> list[Any]:
    """A grid, or landmarks as crosses."""
    if hasattr(grid, "kind"):
        return world(grid, ax=axes)
    if hasattr(grid, "points"):
        return list(axes.plot(*grid.points.T, "+", ms=9, mew=1.6, color=colors.INK, zorder=3))
    return []


def find_side(axes: Any, poses: Array) -> float:
    """The longer side of what is shown [m]."""
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    spread = float(np.ptp(poses[:, :2], axis=0).max()) if len(poses) else 0.0
    return max(float(x1 - x0), float(y1 - y0), spread)


def draw_mode(axes: Any, mode: Any, side: float) -> list[Any]:
    """The ellipse of a mode, its heading, and its share."""
    x, y, theta = mode.pose
    R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    values, vectors = np.linalg.eigh(R @ mode.covariance[:2, :2] @ R.T)
    angles = np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=-1) * np.sqrt(np.maximum(values, 0.0))
    ring = ELLIPSE * around @ vectors.T + mode.pose[:2]
    drawn = draw_polygons(axes, [ring], facecolors="none", edgecolors=[colors.PATH], linewidths=1.6, zorder=6)
    tip = mode.pose[:2] + 2.5 * ARROW * side * np.array([np.cos(theta), np.sin(theta)])
    drawn += axes.plot([x, tip[0]], [y, tip[1]], color=colors.PATH, lw=1.8, zorder=6)
    label = axes.annotate(
        f"{mode.share:.0%}", mode.pose[:2], xytext=(7, 7), textcoords="offset points", fontsize=8,
        color=colors.PATH, zorder=7, bbox={"fc": "white", "ec": "none", "alpha": 0.75, "pad": 1.0},
    )  # fmt: skip
    return [*drawn, label]
