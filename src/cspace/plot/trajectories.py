"""Trajectories over time: positions, velocities, accelerations and jerks with their limits."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.dynamics import ExcitingTrajectory
from cspace.errors import InputError, InputTypeError
from cspace.plot.axes import need_matplotlib, write_title
from cspace.tolerances import LIMIT_ROUNDING
from cspace.trajectory import Trajectory, TrajectoryCheck
from cspace.trajectory.limit_check import read_limits

QUANTITIES: Final = ("position", "velocity", "acceleration", "jerk")
"""The panels, from above."""
UNITS: Final = ("rad, m", "/s", "/s²", "/s³")
"""Behind the name of each panel."""
SAMPLES: Final = 1200
"""Times at which curves are drawn, besides those of the knots."""
BEYOND: Final = "#d62728"
"""The colour of what exceeds a limit."""


class FourierMotion:
    """An exciting trajectory with the names of its joints, as far as a picture asks for it."""

    def __init__(self, series: ExcitingTrajectory, robot: Any) -> None:
        self.series = series
        self.dof, self.duration = len(series.offset), series.duration
        names = tuple(getattr(robot, "joint_names", ()))
        self.labels = names if len(names) == self.dof else tuple(f"joint {j}" for j in range(self.dof))
        self.knots = np.array([0.0, series.duration])

    def __call__(self, times: Array, order: int) -> Array:
        """A derivative (k, dof) at times (k,)."""
        if order < 3:
            return np.asarray(self.series(times)[order])
        omega = 2.0 * np.pi / self.duration * np.arange(1, len(self.series.a) + 1)
        angles = times[:, None] * omega
        a, b = self.series.a, self.series.b
        return np.asarray(-(np.cos(angles) * omega**2) @ a - (np.sin(angles) * omega**2) @ b)


def trajectory(
    motion: Trajectory | ExcitingTrajectory, *, limits: Any = None, axes: Any = None, title: str = ""
) -> list[Any]:
    """Positions, velocities, accelerations and jerks over time, one panel each.

    motion: of any number of joints; each has its colour in all panels. limits: Limits or a robot; dashed
    lines in the colours of the joints, and thick red curves where a joint exceeds one. The joints of an
    ExcitingTrajectory have names where it is a robot. axes: four 2-D axes. title: above them. Returns the
    artists.

    Raises InputTypeError for anything but a Trajectory or an ExcitingTrajectory, InputError for another
    number of axes or of limits.
    """
    if isinstance(motion, ExcitingTrajectory):
        title = title or f"{motion.robot}: {motion.duration:.4g} s, condition {motion.condition:.3g}"
        bounds = None if limits is None else read_limits(limits, len(motion.offset))
        return draw_motion(FourierMotion(motion, limits), bounds, axes, title)
    if not isinstance(motion, Trajectory):
        raise InputTypeError(
            f"motion is a {type(motion).__name__}, expected a Trajectory or an ExcitingTrajectory"
        )
    check = None if limits is None else motion.check(limits)
    bounds = None if limits is None else read_limits(limits, motion.dof)
    return draw_motion(motion, bounds, axes, title or describe_motion(motion, check))


def draw_motion(motion: Trajectory | FourierMotion, bounds: Any, axes: Any, title: str) -> list[Any]:
    """The four panels, with limits unless they are None."""
    panels = trajectory_axes(axes)
    times = sample_times(motion)
    artists: list[Any] = []
    for order, panel in enumerate(panels):
        artists += draw_order(panel, motion, times, order)
        if bounds is not None:
            artists += draw_limits(panel, motion, times, order, bounds)
        panel.set_ylabel(f"{QUANTITIES[order]}\n[{UNITS[order]}]", fontsize=8)
        panel.grid(alpha=0.3)
    panels[-1].set(xlabel="time [s]", xlim=(0.0, max(motion.duration, np.finfo(float).tiny)))
    artists.append(panels[0].legend(fontsize=7, ncols=min(motion.dof, 4), loc="best"))
    return [*artists, *write_title(panels[0], title)]


def trajectory_axes(axes: Any) -> list[Any]:
    """Four axes above each other, the given ones or those of a new figure."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if axes is None:
        _, made = plt.subplots(4, 1, figsize=(7.2, 8.0), dpi=120, sharex=True, layout="constrained")
        return list(made)
    panels = list(np.ravel(np.asarray(axes, dtype=object)))
    if len(panels) != 4:
        raise InputError(f"a trajectory needs four axes, got {len(panels)}; plt.subplots(4, 1) makes them")
    return panels


def sample_times(motion: Trajectory | FourierMotion) -> Array:
    """Times at which the curves are drawn: equal steps, and both sides of every knot, where jerks jump."""
    knots = motion.knots
    before = np.maximum(np.nextafter(knots, -np.inf), 0.0)
    return np.unique(np.concatenate([np.linspace(0.0, motion.duration, SAMPLES), knots, before]))


def draw_order(panel: Any, motion: Trajectory | FourierMotion, times: Array, order: int) -> list[Any]:
    """The curves of one derivative."""
    values = motion(times, order)
    return [
        panel.plot(times, values[:, j], color=f"C{j % 10}", linewidth=1.3, label=motion.labels[j])[0]
        for j in range(motion.dof)
    ]


def draw_limits(
    panel: Any, motion: Trajectory | FourierMotion, times: Array, order: int, limits: Any
) -> list[Any]:
    """Dashed lines at the limits, and what exceeds them in red."""
    high = limits.upper if order == 0 else getattr(limits, QUANTITIES[order])
    low = limits.lower if order == 0 else -high
    values, artists = motion(times, order), list[Any]()
    shown = np.abs(values).max(initial=0.0)
    for j in range(motion.dof):
        for level in (low[j], high[j]):
            if np.isfinite(level) and abs(level) <= 3.0 * shown:  # others would flatten the curves
                artists.append(panel.axhline(level, color=f"C{j % 10}", linestyle="--", linewidth=0.7))
        slack = LIMIT_ROUNDING * max(1.0, abs(high[j])) if np.isfinite(high[j]) else 0.0
        beyond = (values[:, j] > high[j] + slack) | (values[:, j] < low[j] - slack)
        if beyond.any():
            curve = np.where(beyond, values[:, j], np.nan)
            artists += panel.plot(times, curve, color=BEYOND, linewidth=3.2, alpha=0.8, zorder=5)
    return artists


def describe_motion(motion: Trajectory, check: TrajectoryCheck | None) -> str:
    """The title of a picture."""
    text = f"{motion.dof} joints, {motion.duration:.4g} s"
    if motion.reason or (check is not None and not check):
        return f"{text}: {motion.reason or (check.reason if check is not None else '')}"
    return text + ("" if check is None else ", within all limits")
