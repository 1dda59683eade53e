"""Poses as frames in space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.plot import colors
from cspace.plot.axes import space_axes
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.scene import Group, scene_of
from cspace.spatial import as_pose


def frames(
    poses: Any,
    *,
    names: Sequence[str] | None = None,
    size: float | None = None,
    ax: Any | None = None,
    title: str = "",
) -> list[Any]:
    """Draw poses as frames: red x, green y, blue z arrows, over a floor.

    poses: (..., 4, 4) or anything that reads as such. names: one text per pose. size: length of the arrows
    [m]; by default it suits the distances. ax: 3-D axes. Returns the artists.
    Raises InputError for a matrix that is not a pose, MissingExtraError without matplotlib.
    """
    T = as_pose(poses, "poses").reshape(-1, 4, 4)
    if names is not None and len(names) != len(T):
        raise InputError(f"{len(names)} names for {len(T)} poses; give one each")
    if not len(T):
        raise InputError("nothing to draw: there is no pose")
    points = T[:, :3, 3]
    extent = float(np.ptp(points, axis=0).max())
    length = size if size is not None else (0.28 * extent or 1.0)
    axes = space_axes(ax)
    ends = points[:, None] + length * np.swapaxes(T[:, :3, :3], 1, 2)
    everything = np.concatenate([points, ends.reshape(-1, 3)])
    if ax is None:
        center = 0.5 * (everything.min(axis=0) + everything.max(axis=0))
        radius = 0.62 * float(np.linalg.norm(np.ptp(everything, axis=0)[:2])) + 0.2 * length
        floor = stage.floor_under(center, radius, min(0.0, float(everything[:, 2].min())))
        elevation, azimuth = stage.choose_view(everything, everything)
        stage.set_up(axes, everything, floor, elevation=elevation, azimuth=azimuth)
    artist = scene_of(axes)
    artist.scene.groups.append(Group(stage.make_triads(T, length)))
    artists: list[Any] = [artist]
    artists += [write_name(axes, name, T[k], length) for k, name in enumerate(names or ())]
    return artists + stage.write_title(axes, title)


def write_name(axes: Any, name: str, T: Array, length: float) -> Any:
    """A name next to the origin of a frame, away from its arrows, legible on any background."""
    from matplotlib.patheffects import withStroke

    place = T[:3, 3] - 0.15 * length * T[:3, :3].sum(axis=1)
    halo = [withStroke(linewidth=3, foreground="white")]
    return axes.text(
        *place, name, fontsize=10, color=colors.INK, ha="center", va="top", zorder=40, path_effects=halo
    )
