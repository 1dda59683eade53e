"""Pose graphs before and after their optimisation."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.plot import colors
from cspace.plot.axes import draw_lines, need_matplotlib, write_title
from cspace.plot.ellipses import draw_ellipses
from cspace.tables import count_things, shown

BEFORE: Final = (0.62, 0.64, 0.68)
AFTER: Final = colors.AXES[2]
LOOP: Final = colors.AXES[1]
REJECTED: Final = colors.AXES[0]
ELLIPSES: Final = 16
"""Poses whose covariance is drawn."""
MOST_POSES: Final = 30_000
"""Graphs up to this size get ellipses: their covariances take about as long as two factorisations."""
MARGIN: Final = 0.05
"""Room around a graph, over its larger side."""
FAINT_LOOPS: Final = 2000
"""From this number of loops on they are drawn fainter."""


def graph(answer: Any, *, axes: Any = None, ellipses: bool = True, truth: Any = None) -> list[Any]:
    """A pose graph before and after its optimisation, with loops, rejected loops, landmarks and ellipses.

    answer: what graph.optimize returns; a PoseGraph alone is drawn as it starts. axes: two of a picture, or
    one, which shows the answer over its start; 3-D axes for graphs in space. ellipses: of 95 %, along planar
    graphs of up to 30,000 poses. truth: true poses (n, 3) or (n, 4, 4), in grey. Returns the artists. Raises
    InputTypeError for other objects.
    """
    arrays = getattr(answer, "graph", answer)
    if not hasattr(arrays, "edges") or not hasattr(arrays, "sightings"):
        raise InputTypeError(f"answer is {name_type(answer)}; give what PoseGraph.optimize returns")
    is_optimized = arrays is not answer
    rejected = tuple(loop.edge for loop in answer.rejected) if is_optimized else ()
    panels = graph_axes(axes, arrays.is_spatial, 2 if is_optimized and arrays.start_given else 1)
    artists: list[Any] = []
    if len(panels) == 2 or not is_optimized:
        artists += draw_state(panels[0], arrays, arrays.poses, arrays.landmarks, rejected, BEFORE)
        artists += write_title(panels[0], f"before: {count_graph(arrays)}")
    if is_optimized:
        after = panels[-1]
        if truth is not None:
            points = points_of(np.asarray(truth))
            artists += after.plot(*points.T, color=BEFORE, lw=2.5, label="truth", zorder=2)
        elif len(panels) == 1 and arrays.start_given:
            artists += after.plot(*points_of(arrays.poses).T, color=BEFORE, lw=0.8, label="start", zorder=2)
        artists += draw_state(after, arrays, answer.poses, answer.landmarks, rejected, AFTER)
        if ellipses and not arrays.is_spatial and len(answer.poses) <= MOST_POSES:
            artists += draw_marginals(after, answer)
        artists += write_title(after, f"after: {describe_answer(answer)}")
    return artists


def graph_axes(axes: Any, is_spatial: bool, count: int) -> list[Any]:
    """The given axes, or those of a new figure."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if axes is None:
        more: dict[str, Any] = {"projection": "3d"} if is_spatial else {}
        size = (5.2 * count + 0.4, 5.0)
        figure = plt.figure(figsize=size, dpi=120, layout="constrained")
        return [figure.add_subplot(1, count, k + 1, **more) for k in range(count)]
    panels = list(np.ravel(np.asarray(axes, dtype=object)))
    if not 1 <= len(panels) <= 2:
        raise InputError(f"a graph is drawn on one or two axes, got {len(panels)}")
    if any(hasattr(panel, "get_proj") != is_spatial for panel in panels):
        kind = "3-D axes, plt.subplot(projection='3d')" if is_spatial else "2-D axes, plt.subplots()"
        raise InputError(f"this graph needs {kind}")
    return panels[-count:]


def draw_state(
    panel: Any, arrays: Any, poses: Array, landmarks: Array, rejected: tuple[int, ...], color: Any
) -> list[Any]:
    """The poses with the edges between neighbours, loops, rejected loops and landmarks."""
    points, edges = points_of(poses), arrays.edges
    is_loop = np.abs(np.diff(edges, axis=1)[:, 0]) != 1
    is_out = np.zeros(len(edges), dtype=bool)
    is_out[list(rejected)] = True
    artists: list[Any] = []
    loops = is_loop & ~is_out
    alpha = 0.55 if loops.sum() < FAINT_LOOPS else 0.2
    for mask, tint, width, label, strength in (
        (loops, LOOP, 0.6, "loops", alpha),
        (~is_loop & ~is_out, color, 1.1, "poses", 1.0),
        (is_out, REJECTED, 0.8, "rejected", 0.45),
    ):
        if mask.any():
            pieces = points[edges[mask]]
            more = {"colors": [tint], "linewidths": width, "alpha": strength, "label": label}
            artists += draw_pieces(panel, pieces, more)
    if len(landmarks):
        artists += panel.plot(*landmarks.T, "^", ms=3.5, mew=0, color=LOOP, label="landmarks", zorder=3)
    if not arrays.is_spatial:
        frame_plane(panel, np.concatenate([points, landmarks]) if len(landmarks) else points)
    else:
        frame_space(panel, points)
    panel.tick_params(labelsize=8)
    if artists:
        artists.append(panel.legend(fontsize=7, loc="best", framealpha=0.85))
    return artists


def draw_pieces(panel: Any, pieces: Array, style: dict[str, Any]) -> list[Any]:
    """Line segments (k, 2, d)."""
    if pieces.shape[-1] == 2:
        return draw_lines(panel, pieces, zorder=4, **style)
    gaps = np.full((len(pieces), 1, 3), np.nan)
    line = np.concatenate([pieces, gaps], axis=1).reshape(-1, 3)
    more = {"color": style["colors"][0], "lw": style["linewidths"]}
    return list(panel.plot(*line.T, alpha=style["alpha"], label=style["label"], **more))


def frame_plane(panel: Any, points: Array) -> None:
    """Equal scales about all points; ellipses may reach beyond."""
    low, high = points.min(axis=0), points.max(axis=0)
    room = MARGIN * (float((high - low).max()) or 1.0)
    panel.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room), aspect="equal")
    panel.set(xlabel="x [m]", ylabel="y [m]")


def frame_space(panel: Any, points: Array) -> None:
    """Equal scales about all points."""
    low, high = points.min(axis=0), points.max(axis=0)
    panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    panel.set_box_aspect(np.maximum(high - low, 0.1 * (float((high - low).max()) or 1.0)))
    panel.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")


def draw_marginals(panel: Any, answer: Any) -> list[Any]:
    """The ellipses of some poses; none where the equations are singular."""
    try:
        marginals = answer.marginals
    except InputError:
        return []
    rows = np.unique(np.linspace(0, len(answer.poses) - 1, ELLIPSES).astype(int))
    c, s = np.cos(answer.poses[rows, 2]), np.sin(answer.poses[rows, 2])
    R = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
    P = R @ marginals[rows, :2, :2] @ np.swapaxes(R, -1, -2)
    style = {"facecolors": [(*AFTER, 0.08)], "edgecolors": [(*AFTER, 0.6)], "linewidths": 0.6}
    return draw_ellipses(panel, answer.poses[rows, :2], P, **style)


def points_of(poses: Array) -> Array:
    """The positions (n, 2) or (n, 3)."""
    return poses[:, :2] if poses.ndim == 2 else poses[:, :3, 3]


def count_graph(arrays: Any) -> str:
    """How much there is."""
    text = f"{count_things(len(arrays.poses), 'pose')}, {count_things(len(arrays.edges), 'edge')}"
    return text + (f", {count_things(len(arrays.landmarks), 'landmark')}" if len(arrays.landmarks) else "")


def describe_answer(answer: Any) -> str:
    """The title of the answer."""
    text = f"{answer.status}, χ² {shown(answer.chi2)}, dof {answer.dof}"
    return text + (f", {count_things(len(answer.rejected), 'edge')} rejected" if answer.rejected else "")
