"""Films of localisation: the drive grows, the ellipse breathes, scans are where the robot believes to be."""

from __future__ import annotations

from itertools import chain
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, whole_number
from cspace.errors import InputError
from cspace.plot import colors
from cspace.plot.axes import flat_axes
from cspace.plot.ellipses import find_rings, turn_to_map
from cspace.plot.files import Steps
from cspace.plot.localization_runs import AMBIGUOUS, DRIVE, LOST, TRUTH, draw_map, frame_points, name_of

PICTURES: Final = 120
"""Pictures of a film."""
STILL: Final = 12
"""Pictures that show the end."""
INTERVAL: Final = 60
"""How long a picture is shown [ms]."""
BODY: Final = 0.025
"""Length of the triangle that shows the robot, over the larger side of the picture."""
TRIANGLE: Final = np.array([[1.0, 0.0], [-0.6, 0.55], [-0.6, -0.55]])
TINTS: Final = {"lost": LOST, "ambiguous": AMBIGUOUS}


def animate_run(
    answer: Any,
    *,
    ax: Any = None,
    frames: int = PICTURES,
    truth: Any = None,
    world: Any = None,
    scans: Any = None,
) -> Any:
    """A localisation as it happened: a matplotlib FuncAnimation, which `cs.plot.save` writes as a GIF.

    answer: poses with times. truth: TimedPoses, a grey triangle. world: a grid or Landmarks. scans: those of
    the log, drawn where the answer places them. frames: into how many pictures the time is divided.
    """
    from matplotlib.animation import FuncAnimation

    count = whole_number(frames, "frames", 2, 10_000)
    if not len(answer.poses):
        raise InputError("the answer has no poses, so there is nothing to animate")
    given, axes = ax is not None, flat_axes(ax)
    known = world if world is not None else getattr(answer, "landmarks", None)
    draw_map(axes, known, np.eye(3))
    if not given and not hasattr(known, "kind"):
        frame_points(axes, [answer.poses, *([] if truth is None else [truth.poses])], known)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    stage = Stage(axes, answer, truth, scans, count)

    def show(picture: int) -> tuple[list[Any], list[Any]]:
        return [], stage.show(min(picture, count - 1))

    film: Any = FuncAnimation(
        axes.figure, lambda k: list(chain(*show(k))), frames=count + STILL, interval=INTERVAL, blit=True
    )
    film.steps = Steps(count + STILL, INTERVAL, show)
    return film


class Stage:
    """What moves in a film."""

    def __init__(self, axes: Any, answer: Any, truth: Any, scans: Any, count: int) -> None:
        from matplotlib.patches import Polygon

        self.answer, self.truth, self.scans = answer, truth, scans
        times = np.asarray(answer.times)
        self.times = np.linspace(times[0], times[-1], count)
        self.rows = np.clip(np.searchsorted(times, self.times, side="right") - 1, 0, None)
        covariances = getattr(answer, "covariances", None)
        P = None if covariances is None else turn_to_map(answer.poses[self.rows], covariances[self.rows])
        self.rings = None if P is None else find_rings(answer.poses[self.rows, :2], P)
        size = BODY * max(np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim()))
        self.body = size * TRIANGLE
        nothing: tuple[list[float], list[float]] = ([], [])
        (self.seen,) = axes.plot(*nothing, ".", ms=2.2, mew=0, color=colors.PATH, alpha=0.7, zorder=5)
        (self.true_way,) = axes.plot(*nothing, color=TRUTH, lw=3.0, zorder=4)
        (self.way,) = axes.plot(*nothing, color=DRIVE, lw=1.4, zorder=6)
        corner = np.full((3, 2), np.nan)
        self.ring = axes.add_patch(Polygon(corner, fc=(*DRIVE, 0.15), ec=DRIVE, lw=1.0, zorder=6))
        self.true_robot = axes.add_patch(Polygon(corner, fc=TRUTH, ec="white", lw=0.6, zorder=7))
        self.robot = axes.add_patch(Polygon(corner, fc=DRIVE, ec="white", lw=0.8, zorder=8))
        box = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 2.0}
        self.text = axes.text(
            0.02, 0.98, "", transform=axes.transAxes, fontsize=9, va="top", bbox=box, zorder=9
        )

    def show(self, k: int) -> list[Any]:
        """Move everything to picture k; the artists from below to above."""
        row, time = int(self.rows[k]), float(self.times[k])
        pose = self.answer.poses[row]
        self.way.set_data(*self.answer.poses[: row + 1, :2].T)
        self.robot.set_xy(place_body(self.body, pose))
        if self.rings is not None:
            self.ring.set_xy(self.rings[k])
        if self.truth is not None:
            now = self.truth.at(time)
            before = self.truth.poses[self.truth.times <= time]
            self.true_way.set_data(*before[:, :2].T)
            self.true_robot.set_xy(place_body(self.body, now))
        if self.scans is not None and len(self.scans):
            at = int(np.clip(np.searchsorted(self.scans.times, time, side="right") - 1, 0, None))
            self.seen.set_data(*place_body(self.scans.points(at), pose).T)
        flag = next((name for name in TINTS if self._is_so(name, row)), "")
        self.robot.set_facecolor(TINTS.get(flag, DRIVE))
        self.text.set_text(f"{name_of(self.answer)}  {time:.1f} s" + (f"  {flag}" if flag else ""))
        return [self.true_way, self.seen, self.ring, self.way, self.true_robot, self.robot, self.text]

    def _is_so(self, name: str, row: int) -> bool:
        flags = getattr(self.answer, name, None)
        return flags is not None and bool(flags[row])


def place_body(points: Array, pose: Array) -> Array:
    """Points (m, 2) of base in the map."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.asarray(points @ np.array([[c, s], [-s, c]]) + pose[:2])
