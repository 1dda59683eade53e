"""Slices and projections of configuration spaces: two joints of a robot in the plane."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, name_type
from cspace.planning import Projection, Slice
from cspace.plot import colors
from cspace.plot.axes import PLACE, draw_lines, flat_axes, need_matplotlib, write_title
from cspace.plot.configuration_space import DARK, PALE, QUIET, copies_of, mark_angles, wrap_into

RIM: Final = 0.12
"""Share of ink in the colour of free cells that are not proved."""
NEVER: Final = colors.STAND
"""Cells where no sample is free."""
LONGER: Final = 5.2
"""The longer side of a new picture [inch]."""
SHORTEST: Final = 0.35
"""The shorter side of a new picture, as a share of the longer one."""
ASIDE: Final = 2.2
"""Room for a legend or a bar of colours beside it [inch]."""
MOST_NAMES: Final = 12
"""Names in the legend: more would be longer than the picture."""


def space_slice(
    part: Slice,
    *,
    q: ArrayLike | None = None,
    path: ArrayLike | None = None,
    ax: Any | None = None,
    title: str | None = None,
) -> list[Any]:
    """Draw a slice of a configuration space: free cells white, the others in the colours of what blocks them.

    part: a Slice. Cells that are not proved are darker: the rim. A circle marks where the slice was made. q:
    configurations (dof,) or (k, dof) as dots, path: configurations (m, dof), or a Plan, as a line; both are
    drawn by their two joints alone, whatever the others are. ax: 2-D axes. title: of the picture.

    Returns the artists. Raises InputTypeError for what is not a Slice, MissingExtraError without matplotlib.
    """
    if not hasattr(part, "obstacle_map"):
        raise InputTypeError(f"part is {name_type(part)}; space_slice draws what space.slice gives")
    axes = part_axes(ax, part)
    found = part.obstacle_map
    tints = colors.make_palette(len(part.obstacles))
    artists = draw_cells(axes, part, paint_cells(found, part.is_proved, tints))
    blocks = [k for k in range(len(part.obstacles)) if (found == k).any()]
    artists += draw_names(axes, [(part.obstacles[k], tints[k]) for k in blocks])
    artists += draw_ways(axes, part, part.at[None], q, path, len(part.at))
    free, proved = f"{part.free_share:.1%}", f"{part.proved:.1%}"
    return artists + write_title(
        axes, f"slice: {free} free, {proved} of the cells proved" if title is None else title
    )


def space_projection(
    part: Projection,
    *,
    q: ArrayLike | None = None,
    path: ArrayLike | None = None,
    ax: Any | None = None,
    title: str | None = None,
) -> list[Any]:
    """Draw a projection of a configuration space: the share of free samples, grey where none is free.

    part: a Projection. q (dof,) or (k, dof), path (m, dof), ax, title: as of space_slice. Returns the
    artists, the last of them a bar of colours. Raises InputTypeError for what is not a Projection,
    MissingExtraError without matplotlib.
    """
    if not hasattr(part, "is_free"):
        raise InputTypeError(f"part is {name_type(part)}; space_projection draws what space.project gives")
    axes = part_axes(ax, part)
    shares = np.ma.masked_where(~part.is_free, part.share)
    artists = draw_cells(axes, part, shares)
    axes.set_facecolor(NEVER)
    artists[0].set(cmap="Blues_r", clim=(0.0, max(float(part.share.max()), 1.0 / part.samples)))
    artists += draw_ways(axes, part, np.empty((0, 0)), q, path, None)
    text = f"projection: {part.is_free.mean():.1%} can be free, {part.samples} samples of the other joints"
    artists += write_title(axes, text if title is None else title)
    bar = axes.figure.colorbar(artists[0], ax=axes, shrink=0.85)
    bar.outline.set_edgecolor(QUIET)
    bar.set_label("share of free samples", fontsize=9, color=QUIET)
    bar.ax.tick_params(labelsize=8, colors=QUIET)
    return [*artists, bar]


def part_axes(ax: Any | None, part: Slice | Projection) -> Any:
    """The given axes, or new ones in a figure of the shape of a slice or a projection."""
    if ax is not None:
        return flat_axes(ax)
    need_matplotlib()
    import matplotlib.pyplot as plt

    sides = part.upper - part.lower if part.units == ("rad", "rad") else np.ones(2)
    width, height = LONGER * np.maximum(sides / sides.max(), SHORTEST)
    figure = plt.figure(figsize=(width + ASIDE, height + 0.8), dpi=120, layout="constrained")
    return figure.add_subplot()


def paint_cells(found: Any, is_proved: Any, tints: Array) -> Array:
    """The colours (n1, n2, 3) of cells: white or a tint, darker on the rim."""
    shades = np.vstack([colors.mix_colors(tints, (1.0, 1.0, 1.0), PALE), np.ones((1, 3))])  # −1 is the last
    rims = np.vstack(
        [colors.mix_colors(tints, colors.INK, DARK), colors.mix_colors((1.0, 1.0, 1.0), colors.INK, RIM)]
    )
    painted: Array = np.where(is_proved[..., None], shades[found], rims[found])
    return painted


def draw_cells(axes: Any, part: Slice | Projection, picture: Any) -> list[Any]:
    """The picture (n1, n2, …) of the cells of two joints, the first along x; names, units and ticks."""
    (x0, y0), (x1, y1) = part.lower, part.upper
    across = np.ma.swapaxes(picture, 0, 1) if np.ma.isMaskedArray(picture) else np.swapaxes(picture, 0, 1)
    style = {"origin": "lower", "interpolation": "nearest", "zorder": 0, "extent": (x0, x1, y0, y1)}
    artists = [axes.imshow(across, **style)]
    ends = ((axes.xaxis, x0, x1), (axes.yaxis, y0, y1))
    for (axis, low, high), unit in zip(ends, part.units, strict=True):
        if unit == "rad":
            mark_angles(axis, low, high)
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal" if part.units == ("rad", "rad") else "auto")
    labels = [f"{name} [{unit}]" for name, unit in zip(part.joint_names, part.units, strict=True)]
    axes.set_xlabel(labels[0], fontsize=9, color=QUIET)
    axes.set_ylabel(labels[1], fontsize=9, color=QUIET)
    axes.tick_params(labelsize=8.5, labelcolor=QUIET, color=QUIET)
    for side in axes.spines.values():
        side.set_color(QUIET)
    return artists


def draw_names(axes: Any, entries: list[tuple[str, Array]]) -> list[Any]:
    """The names of what blocks, beside their colours."""
    from matplotlib.patches import Patch

    if not entries:
        return []
    marks = [
        Patch(fc=colors.mix_colors(tint, (1.0, 1.0, 1.0), PALE), ec=colors.mix_colors(tint, colors.INK, DARK))
        for _, tint in entries[:MOST_NAMES]
    ]
    names = [name for name, _ in entries[:MOST_NAMES]]
    place = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), "frameon": False, "fontsize": 8.5}
    return [axes.legend(marks, names, labelcolor=QUIET, **place)]


def draw_ways(
    axes: Any,
    part: Slice | Projection,
    at: Array,
    q: ArrayLike | None,
    path: ArrayLike | None,
    dof: int | None,
) -> list[Any]:
    """Marks at configurations and a path, by the two joints of a picture."""
    artists: list[Any] = []
    way = read_rows(getattr(path, "path", path), "path", dof, part.joints)
    if len(way):
        style = {"colors": [colors.PATH], "linewidths": 2.0, "zorder": 4}
        artists += draw_lines(axes, copies_of(part, [way]), **style)
    for each in read_rows(q, "q", dof, part.joints):
        artists += axes.plot(*wrap_into(part, each), "o", ms=5.0, **PLACE)
    for each in at:
        artists += axes.plot(*wrap_into(part, each[list(part.joints)]), "o", ms=8.0, **PLACE)
    return artists


def read_rows(value: ArrayLike | None, subject: str, dof: int | None, joints: tuple[int, int]) -> Array:
    """The two joints (k, 2) of one configuration or several; none for None."""
    if value is None:
        return np.empty((0, 2))
    rows = np.atleast_2d(as_floats(value, subject))
    if rows.ndim != 2 or rows.shape[1] <= max(joints) or (dof is not None and rows.shape[1] != dof):
        wanted = f"(k, {dof})" if dof is not None else "(k, dof)"
        raise InputError(f"{subject} has shape {rows.shape}; it must be configurations {wanted}")
    return rows[:, list(joints)]
