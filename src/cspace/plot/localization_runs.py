"""Answers of localisation and SLAM: the drive on its map, and errors and consistency over time."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.localization import ate
from cspace.plot import colors
from cspace.plot.axes import need_matplotlib, write_title
from cspace.plot.ellipses import SCALE, draw_ellipses, turn_to_map
from cspace.plot.worlds import world as draw_world
from cspace.tables import shown

ELLIPSES: Final = 24
"""Ellipses along a drive."""
TRUTH: Final = (0.62, 0.64, 0.68)
"""The true drive: grey, for it lies below the estimate."""
DRIVE: Final = colors.AXES[2]
LOST: Final = colors.AXES[0]
AMBIGUOUS: Final = (0.93, 0.60, 0.12)
LANDMARK: Final = colors.AXES[1]
SIGMAS: Final = 1.96
"""Standard deviations that hold 95 % of a normal distribution of one number."""
MARGIN: Final = 0.05
"""Room around a drive, over its larger side."""


def run(
    answer: Any,
    *,
    truth: Any = None,
    world: Any = None,
    align: str | None = None,
    axes: Any = None,
    title: str = "",
) -> list[Any]:
    """The drive of a localisation or of SLAM on its map, and over time its errors and its consistency.

    answer: what cs.localize or a SLAM of landmarks returns, or TimedPoses. truth: TimedPoses of the true
    drive; the errors of position and heading are drawn with the bounds of 95 % that the answer claims, else
    the bounds alone. world: a grid, or Landmarks; unless given, the landmarks of the answer. align: "se2"
    moves the answer onto the truth first, for SLAM, whose map has a frame of its own. axes: four 2-D axes,
    the map first. Returns the artists. Raises InputTypeError for other objects, InputError for other axes.
    """
    if not hasattr(answer, "poses") or not hasattr(answer, "times"):
        raise InputTypeError(f"answer is {name_type(answer)}; give what cs.localize returns")
    panels = run_axes(axes)
    errors = None if truth is None else ate(answer, truth, align=align, interpolate=True)
    T = np.eye(3) if errors is None else errors.alignment
    artists = draw_drive(panels[0], answer, truth, world, T)
    artists += draw_errors(panels[1], panels[2], answer, errors)
    artists += draw_consistency(panels[3], answer)
    return artists + write_title(panels[0], title or describe_run(answer, errors))


def run_axes(axes: Any) -> list[Any]:
    """A map and three panels over time, the given ones or those of a new figure."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if axes is not None:
        panels = list(np.ravel(np.asarray(axes, dtype=object)))
        if len(panels) != 4:
            raise InputError(f"a run needs four axes, got {len(panels)}; the map, then three over time")
        return panels
    figure = plt.figure(figsize=(11.0, 5.6), dpi=120, layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1.15, 1.0))
    place, first = figure.add_subplot(grid[:, 0]), figure.add_subplot(grid[0, 1])
    others = [figure.add_subplot(grid[k, 1], sharex=first) for k in (1, 2)]
    for panel in (first, others[0]):
        panel.tick_params(labelbottom=False)
    return [place, first, *others]


def draw_drive(panel: Any, answer: Any, truth: Any, world: Any, T: Array) -> list[Any]:
    """The map, the true drive, the estimated one with ellipses, and where it was lost or ambiguous."""
    poses = move_rows(T, answer.poses)
    found = getattr(answer, "landmarks", None)
    artists = draw_map(panel, world if world is not None else found, T if world is None else np.eye(3))
    if truth is not None:
        artists += panel.plot(*truth.poses[:, :2].T, color=TRUTH, lw=3.0, label="truth", zorder=4)
    artists += panel.plot(*poses[:, :2].T, color=DRIVE, lw=1.3, label=name_of(answer), zorder=6)
    for flag, color in (("ambiguous", AMBIGUOUS), ("lost", LOST)):
        marked = np.asarray(getattr(answer, flag, np.zeros(0, bool)))
        if marked.any():
            there = np.where(marked[:, None], poses[:, :2], np.nan)
            artists += panel.plot(*there.T, color=color, lw=3.5, alpha=0.6, label=flag, zorder=5)
    covariances = getattr(answer, "covariances", None)
    if covariances is not None and len(poses):
        rows = np.unique(np.linspace(0, len(poses) - 1, ELLIPSES).astype(int))
        P = turn_to_map(poses[rows], covariances[rows])
        artists += draw_ellipses(
            panel, poses[rows, :2], P, facecolors=[(*DRIVE, 0.15)], edgecolors=[(*DRIVE, 0.7)]
        )
    if not hasattr(world, "kind"):
        frame_points(
            panel, [poses, *([] if truth is None else [truth.poses])], found if world is None else world
        )
    panel.set(xlabel="x [m]", ylabel="y [m]")
    panel.tick_params(labelsize=8)
    return [*artists, panel.legend(fontsize=7, loc="best", framealpha=0.85)]


def draw_map(panel: Any, world: Any, T: Array) -> list[Any]:
    """A grid, or landmarks with their ellipses."""
    if hasattr(world, "kind"):
        return draw_world(world, ax=panel)
    if not hasattr(world, "points") or not len(world.points):
        return []
    points = world.points @ T[:2, :2].T + T[:2, 2]
    drawn: list[Any] = panel.plot(*points.T, "^", color=LANDMARK, ms=6, mew=0, label="landmarks", zorder=3)
    if world.covariances is not None:
        P = T[:2, :2] @ world.covariances @ T[:2, :2].T
        drawn += draw_ellipses(panel, points, P, facecolors="none", edgecolors=[LANDMARK], zorder=3)
    return drawn


def frame_points(panel: Any, drives: list[Array], landmarks: Any) -> None:
    """Show all that is drawn, with equal scales."""
    points = [rows[:, :2] for rows in drives]
    if hasattr(landmarks, "points"):
        points.append(landmarks.points)
    every = np.concatenate(points)
    low, high = every.min(axis=0), every.max(axis=0)
    room = MARGIN * max(float((high - low).max()), 1.0)
    panel.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room))
    panel.set_aspect("equal")
    panel.grid(alpha=0.25)


def draw_errors(place: Any, heading: Any, answer: Any, errors: Any) -> list[Any]:
    """The errors of positions and headings, and the bounds of 95 % that the covariances claim."""
    artists: list[Any] = []
    covariances = getattr(answer, "covariances", None)
    if covariances is not None and len(covariances):
        spread = SCALE * np.sqrt(np.linalg.eigvalsh(covariances[:, :2, :2])[:, -1].clip(0.0))
        turn = np.degrees(SIGMAS * np.sqrt(covariances[:, 2, 2].clip(0.0)))
        for panel, bound in ((place, spread), (heading, turn)):
            label = "95 % claimed"
            artists.append(
                panel.fill_between(answer.times, bound, color=DRIVE, alpha=0.18, lw=0, label=label, zorder=2)
            )
    if errors is not None:
        style = {"color": colors.INK, "lw": 0.9, "label": "error", "zorder": 3}
        artists += place.plot(errors.times, errors.errors, **style)
        artists += heading.plot(errors.times, np.degrees(errors.turns), **style)
    place.set_ylabel("position [m]", fontsize=8)
    heading.set_ylabel("heading [deg]", fontsize=8)
    for panel in (place, heading):
        panel.tick_params(labelsize=8)
        panel.grid(alpha=0.25)
        panel.set_ylim(bottom=0.0)
    if artists:
        artists.append(place.legend(fontsize=7, loc="upper right", framealpha=0.85))
    return artists


def draw_consistency(panel: Any, answer: Any) -> list[Any]:
    """The NIS of each measurement over its gate; of filters on grids the score of the best particle."""
    panel.set_xlabel("time [s]")
    panel.tick_params(labelsize=8)
    panel.grid(alpha=0.25)
    measured = getattr(answer, "measured", None)
    if measured is None and hasattr(answer, "scores"):
        measured = np.arange(len(answer.times))
    if measured is None or not len(measured):
        panel.set(ylabel="no measurements", yticks=[])
        panel.yaxis.label.set_fontsize(8)
        return []
    times = answer.times[measured]
    if hasattr(answer, "scores"):
        panel.set(ylim=(0.0, 1.02))
        panel.set_ylabel("score", fontsize=8)
        return list(panel.plot(times, answer.scores, ".", color=DRIVE, ms=2.5, zorder=3))
    outcomes = getattr(answer, "readings", answer)
    rejected = np.asarray(
        getattr(outcomes, "rejected", None) if outcomes is answer else outcomes.verdict == "rejected"
    )
    known = np.isfinite(answer.nis) & (outcomes.dof > 0)
    ratio = np.full(len(times), np.nan)
    np.divide(answer.nis, outcomes.dof, out=ratio, where=known)
    kept = panel.plot(times[known & ~rejected], ratio[known & ~rejected], ".", color=DRIVE, ms=2.5, zorder=3)
    kept[0].set_label("used")
    if (known & rejected).any():
        out = known & rejected
        kept += panel.plot(times[out], ratio[out], "x", color=LOST, ms=4, mew=0.8, label="rejected", zorder=4)
    kept.append(panel.axhline(1.0, color=colors.INK, lw=0.8, ls="--", label="expected mean", zorder=2))
    panel.set_yscale("symlog", linthresh=1.0)
    panel.set_ylim(bottom=0.0)
    panel.set_ylabel("NIS per dof", fontsize=8)
    return [*kept, panel.legend(fontsize=7, loc="upper right", framealpha=0.85, ncols=3)]


def move_rows(T: Array, rows: Array) -> Array:
    """Poses (n, 3) moved by T (3, 3)."""
    moved = np.array(rows)
    moved[:, :2] = rows[:, :2] @ T[:2, :2].T + T[:2, 2]
    moved[:, 2] += np.arctan2(T[1, 0], T[0, 0])
    return moved


def name_of(answer: Any) -> str:
    """What the legend calls the drive."""
    fallback = "laser SLAM" if hasattr(answer, "graph") else "poses"
    return str(getattr(answer, "filter", getattr(answer, "method", fallback)))


def describe_run(answer: Any, errors: Any) -> str:
    """The title of a picture."""
    status = getattr(answer, "status", "")
    text = f"{name_of(answer)}: {status}" if status else name_of(answer)
    return text if errors is None else f"{text}, rmse {shown(round(errors.rmse, 4))} m"
