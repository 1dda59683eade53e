"""Planar robots drawn in their plane: configurations, workspace, the ellipse of manipulability."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.kinematics import KinematicModel
from cspace.plot import colors
from cspace.plot.axes import flat_axes, write_title
from cspace.plot.legends import list_entries, mark_bold
from cspace.plot.skeleton import Skeleton, make_skeleton, planar_basis, size_of
from cspace.tolerances import DRAWN_LENGTH, LEAST_DIVISOR

WORKSPACE_SAMPLES: Final = 400
"""Cells along the longer side of a workspace picture: about one per pixel."""


GAP_CELLS: Final = 3
"""Half the width of gaps between random samples that are closed: without, some hundred cells stay white."""

EXACT_ENDS: Final = {"shrinkA": 0, "shrinkB": 0}
"""Arrows that end exactly at given points."""


def draw_configurations(
    arm: KinematicModel,
    q: Array,
    basis: Array,
    *,
    ax: Any | None,
    solid: int,
    tints: Sequence[Any],
    names: Sequence[str] = (),
    goal: Any | None = None,
    title: str = "",
) -> list[Any]:
    """Draw configurations q (k, dof) of an arm in the plane of `basis` (2, 3); row `solid` is opaque."""
    axes = flat_axes(ax)
    drawn = [make_skeleton(arm, each) for each in q]
    size = size_of(arm.chain.points, arm.chain.T_zero)
    prepare_axes(axes, basis)
    artists: list[Any] = []
    order = [k for k in range(len(q)) if k != solid] + [solid]
    for place, k in enumerate(order):
        artists += draw_arm(axes, drawn[k], basis, np.asarray(tints[k]), ghost=k != solid, zorder=3 + place)
    artists += draw_base(axes, size, zorder=2)
    T = drawn[solid].T_tip
    if goal is not None and np.shape(goal) != (4, 4):
        given = np.asarray(goal, dtype=np.float64)
        point = given[:2] if len(given) == 2 else basis @ given
        artists += draw_target(axes, point, size, zorder=4 + len(q))
    else:
        T = T if goal is None else np.asarray(goal, dtype=np.float64)
        artists += draw_frame(axes, T, basis, 0.16 * size, zorder=4 + len(q))
    if names:
        artists += draw_legend(axes, names, tints, solid)
    artists += write_title(axes, title, 11)
    corners = np.concatenate([each.points for each in drawn]) @ basis.T
    arrows = basis @ (T[:3, 3:] + 0.20 * size * T[:3, :3])
    frame_view(axes, np.concatenate([corners, arrows.T, np.zeros((1, 2))]))
    return artists


def prepare_axes(ax: Any, basis: Array) -> None:
    """Equal aspect, a quiet grid, axes named after the base frame's."""
    ax.set_aspect("equal", adjustable="datalim")
    ax.grid(True, color=(0.90, 0.915, 0.935), linewidth=0.8)
    ax.set_axisbelow(True)
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    ax.tick_params(length=0, labelsize=8.5, labelcolor=(0.42, 0.46, 0.52))
    for setter, row in ((ax.set_xlabel, basis[0]), (ax.set_ylabel, basis[1])):
        name = "xyz"[int(np.argmax(np.abs(row)))] if np.abs(row).max() > 0.999 else "in the plane"
        setter(f"{name} [m]", fontsize=9, color=(0.42, 0.46, 0.52))


def frame_view(ax: Any, points: Array) -> None:
    """Limits that contain the points (m, 2) and the previous content of the axes."""
    ax.update_datalim(points)
    ax.margins(0.10)
    ax.autoscale_view()


def outline_bar(p: Array, r: Array, radius_p: float, radius_r: float) -> Array:
    """The outline (m, 2) of a tapered bar between two circles."""
    way = r - p
    length = float(np.linalg.norm(way))
    angle = np.linspace(-np.pi, np.pi, 73)
    if length <= abs(radius_p - radius_r) + LEAST_DIVISOR:
        return np.asarray(p + radius_p * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    heading = np.arctan2(way[1], way[0])
    tilt = np.arccos((radius_p - radius_r) / length)
    back = heading + np.linspace(tilt, 2 * np.pi - tilt, 33)
    front = heading + np.linspace(-tilt, tilt, 33)
    start = p + radius_p * np.stack([np.cos(back), np.sin(back)], axis=1)
    stop = r + radius_r * np.stack([np.cos(front), np.sin(front)], axis=1)
    return np.concatenate([start, stop])


def draw_arm(ax: Any, drawn: Skeleton, basis: Array, tint: Array, *, ghost: bool, zorder: float) -> list[Any]:
    """The links and joints of one configuration."""
    from matplotlib.patches import Circle, Polygon

    alpha = 0.30 if ghost else 1.0
    edge = colors.mix_colors(tint, colors.INK, 0.40)
    artists: list[Any] = []
    radii = 0.72 * drawn.radii
    for i, path in enumerate(drawn.paths[1:], start=1):
        ends = np.linspace(radii[i], radii[i + 1], len(path))
        for k in range(len(path) - 1):
            p, r = path[k] @ basis.T, path[k + 1] @ basis.T
            if np.linalg.norm(r - p) > DRAWN_LENGTH:
                face = (*colors.mix_colors(tint, (1.0, 1.0, 1.0), 0.15), alpha)
                bar = Polygon(
                    outline_bar(p, r, ends[k], ends[k + 1]),
                    closed=True, facecolor=face, edgecolor=(*edge, 0.55 if ghost else 1.0),
                    linewidth=1.0 if ghost else 1.3, zorder=zorder,
                )  # fmt: skip
                artists.append(ax.add_patch(bar))
    for rail in drawn.rails:
        ends = rail @ basis.T
        artists += ax.plot(*ends.T, color=edge, linewidth=2.0, alpha=alpha, zorder=zorder)
    for i, place in enumerate(drawn.joints):
        ring = Circle(
            tuple(place @ basis.T), 0.55 * radii[i + 1], facecolor=(1.0, 1.0, 1.0, 0.5 if ghost else 1.0),
            edgecolor=(*edge, 0.6 if ghost else 1.0), linewidth=1.0 if ghost else 1.6, zorder=zorder + 0.5,
        )  # fmt: skip
        artists.append(ax.add_patch(ring))
    return artists


def draw_base(ax: Any, size: float, *, zorder: float) -> list[Any]:
    """The foot of the arm at the origin: a disc with a rim, as seen from above."""
    from matplotlib.patches import Circle

    foot = Circle(
        (0.0, 0.0), 0.048 * size, facecolor=(0.86, 0.88, 0.905), edgecolor=colors.INK, linewidth=1.0
    )
    foot.set_zorder(zorder)
    return [ax.add_patch(foot)]


def draw_frame(ax: Any, T: Array, basis: Array, size: float, *, zorder: float) -> list[Any]:
    """The x and y axes of a pose, as far as they lie in the plane."""
    artists = []
    p = basis @ T[:3, 3]
    for axis in range(3):
        way = size * (basis @ T[:3, axis])
        if np.linalg.norm(way) > 0.3 * size:
            look = {"arrowstyle": "-|>", "color": colors.AXES[axis], "linewidth": 2.2, "mutation_scale": 13}
            arrow = ax.annotate("", xy=p + way, xytext=p, zorder=zorder, arrowprops={**look, **EXACT_ENDS})
            artists.append(arrow)
    return artists


def draw_target(ax: Any, point: Array, size: float, *, zorder: float) -> list[Any]:
    """A point to be reached: a ring with a cross."""
    from matplotlib.patches import Circle

    red = colors.AXES[0]
    ring = Circle(tuple(point), 0.045 * size, fill=False, edgecolor=red, linewidth=1.8, zorder=zorder)
    return [ax.add_patch(ring), *ax.plot(*point, marker="+", markersize=12, color=red, zorder=zorder)]


def draw_legend(ax: Any, names: Sequence[str], tints: Sequence[Any], solid: int) -> list[Any]:
    """The branches and their colours; the solid one is bold."""
    from matplotlib.patches import Patch

    entries = list_entries(names, solid)
    handles = [
        Patch(
            facecolor=(*tints[k], 1.0 if k == solid else 0.35) if k >= 0 else "none",
            edgecolor=tints[k] if k >= 0 else "none",
            label=text,
        )
        for k, text in entries
    ]
    drawn = ax.legend(handles=handles, frameon=False, fontsize=9, loc="best", labelcolor=colors.INK)
    mark_bold(drawn, entries, solid)
    return [drawn]


def tip_points(arm: KinematicModel, q: Array, basis: Array) -> Array:
    """Where the tip is in the plane, (..., 2) [m]."""
    return np.asarray(arm.fk(q)[..., :3, 3] @ basis.T)


def planar_or_refuse(arm: KinematicModel) -> Array:
    """The plane of the arm. Raises InputError for an arm that is not planar."""
    basis = planar_basis(arm.chain)
    if basis is None:
        raise InputError(
            f"{arm.name} is not a planar arm (its revolute axes are not parallel, or a prismatic joint leaves"
            " the plane); this picture needs a planar arm"
        )
    return basis


def workspace(arm: KinematicModel, *, ax: Any | None = None, title: str = "") -> list[Any]:
    """Draw where the tip of a planar arm can be within its limits, and how well it moves there.

    The colour is the manipulability √det(J Jᵀ) of the position, the best of all configurations found there.
    Revolute joints without limits make a full circle; prismatic joints need limits. Returns the artists.
    """
    basis = planar_or_refuse(arm)
    axes = flat_axes(ax)
    q = grid_of(arm)
    points = tip_points(arm, q, basis)
    J = basis @ arm.jacobian(q)[..., :3, :]
    prepare_axes(axes, basis)
    size = size_of(arm.chain.points, arm.chain.T_zero)
    if arm.dof == 1:
        artists: list[Any] = axes.plot(
            *points[np.argsort(q[:, 0])].T, color=colors.JOINT, linewidth=2.5, zorder=2
        )
    else:
        measure = np.sqrt(np.clip(np.linalg.det(J @ np.swapaxes(J, -1, -2)), 0.0, None))
        artists = [best_in_cells(axes, points, measure, gap_cells=0 if arm.dof <= 2 else GAP_CELLS)]
    return artists + draw_base(axes, size, zorder=4) + write_title(axes, title, 11)


def grid_of(arm: KinematicModel) -> Array:
    """Configurations (m, dof) over the whole range of every joint."""
    lower, upper = np.array(arm.limits.lower), np.array(arm.limits.upper)
    turning = np.array([kind == "R" for kind in arm.chain.joint_types])
    lower = np.where(turning, np.maximum(lower, -np.pi), lower)
    upper = np.where(turning, np.minimum(upper, np.pi), upper)
    if not np.isfinite([lower, upper]).all():
        raise InputError(
            f"a prismatic joint of {arm.name} has no limits, so its workspace is unbounded; set limits"
        )
    if arm.dof <= 2:
        values = [np.linspace(a, b, 3 * WORKSPACE_SAMPLES) for a, b in zip(lower, upper, strict=True)]
        return np.stack(np.meshgrid(*values, indexing="ij"), axis=-1).reshape(-1, arm.dof)
    rng = np.random.default_rng(0)
    return np.asarray(rng.uniform(lower, upper, size=(6 * WORKSPACE_SAMPLES**2, arm.dof)))


def close_gaps(image: Array, cells: int) -> Array:
    """The image with values, the greatest nearby, in cells (-inf) that samples within so many cells surround.

    The closing of mathematical morphology (Serra 1982): the region grows by so many cells, then shrinks.
    """

    def spread(values: Array) -> Array:
        wide = np.pad(values, 1, constant_values=-np.inf)
        return np.asarray(np.lib.stride_tricks.sliding_window_view(wide, (3, 3)).max(axis=(2, 3)))

    best = np.pad(image, cells, constant_values=-np.inf)
    for _ in range(cells):
        best = spread(best)
    outside = np.where(np.isfinite(best), -np.inf, 0.0)
    for _ in range(cells):
        outside = spread(outside)
    closed = np.where(np.isfinite(outside), -np.inf, best)
    return np.asarray(closed[cells:-cells, cells:-cells] if cells else image)


def best_in_cells(ax: Any, points: Array, measure: Array, gap_cells: int) -> Any:
    """An image of the greatest measure found in each cell of the plane, or near it within so many cells."""
    low, high = points.min(axis=0), points.max(axis=0)
    room = 0.03 * float((high - low).max())
    low, high = low - room, high + room
    count = np.maximum((WORKSPACE_SAMPLES * (high - low) / (high - low).max()).astype(int), 1)
    cells = np.minimum(((points - low) / (high - low) * count).astype(int), count - 1)
    image = np.full(tuple(count), -np.inf)
    np.maximum.at(image, (cells[:, 0], cells[:, 1]), measure)
    image = close_gaps(image, gap_cells)
    shown = np.ma.masked_invalid(np.where(np.isfinite(image), image, np.nan)).T
    drawn = ax.imshow(
        shown, origin="lower", extent=(low[0], high[0], low[1], high[1]), cmap="YlGnBu", zorder=1,
        interpolation="nearest", vmin=0.0,
    )  # fmt: skip
    ax.figure.colorbar(drawn, ax=ax, shrink=0.7, label="manipulability of the position")
    return drawn


def manipulability(
    arm: KinematicModel, q: Any, *, scale: float | None = None, ax: Any | None = None, title: str = ""
) -> list[Any]:
    """Draw the ellipse of tip velocities that unit joint rates can make: J q̇ with ‖q̇‖ = 1, at a planar arm.

    arm: a planar Robot. q: (dof,). scale: seconds that turn a velocity into a length; by default the ellipse
    is made about a third of the arm. Returns the artists. Source: Yoshikawa 1985.
    """
    from matplotlib.patches import Ellipse

    basis = planar_or_refuse(arm)
    q = as_floats(q, "q", last=(arm.dof,))
    axes = flat_axes(ax)
    artists = draw_configurations(arm, q[None], basis, ax=axes, solid=0, tints=[colors.LINK], title=title)
    J = basis @ arm.jacobian(q)[:3, :]
    u, s, _ = np.linalg.svd(J)
    lengths = np.zeros(2)
    lengths[: len(s)] = s
    size = size_of(arm.chain.points, arm.chain.T_zero)
    factor = 0.30 * size / max(lengths[0], LEAST_DIVISOR) if scale is None else scale
    center = tip_points(arm, q, basis)
    tilt = np.degrees(np.arctan2(u[1, 0], u[0, 0]))
    ellipse = Ellipse(
        tuple(center), 2 * factor * lengths[0], 2 * factor * lengths[1], angle=tilt,
        facecolor=(*colors.JOINT, 0.16), edgecolor=colors.JOINT, linewidth=1.6, zorder=2.5,
    )  # fmt: skip
    artists.append(axes.add_patch(ellipse))
    for k in range(2):
        ends = np.array([center - factor * lengths[k] * u[:, k], center + factor * lengths[k] * u[:, k]])
        artists += axes.plot(*ends.T, color=colors.JOINT, linewidth=1.0, linestyle=(0, (4, 3)), zorder=2.6)
    half = factor * lengths @ np.abs(u.T)
    frame_view(axes, np.array([center - half, center + half]))
    return artists
