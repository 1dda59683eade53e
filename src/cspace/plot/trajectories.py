"""Trajectories over time: positions, velocities, accelerations and jerks with their limits."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError
from cspace.plot.axes import need_matplotlib, write_title
from cspace.tolerances import LIMIT_ROUNDING
from cspace.trajectory import Trajectory, TrajectoryCheck

QUANTITIES: Final = ("position", "velocity", "acceleration", "jerk")
"""The panels, from above."""
UNITS: Final = ("rad, m", "/s", "/s²", "/s³")
"""Behind the name of each panel."""
SAMPLES: Final = 1200
"""Times at which curves are drawn, besides those of the knots."""
BEYOND: Final = "#d62728"
"""The colour of what exceeds a limit."""


def trajectory(motion: Trajectory, *, limits: Any = None, axes: Any = None, title: str = "") -> list[Any]:
    """Positions, velocities, accelerations and jerks over time, one panel each.

    motion: of any number of joints; each has its colour in all panels. limits: Limits or a robot; dashed
    lines in the colours of the joints, and thick red curves where a joint exceeds one. axes: four 2-D axes.
    title: above them. Returns the artists.

    Raises InputTypeError for anything but a Trajectory, InputError for another number of axes or of limits.
    """
    if not isinstance(motion, Trajectory):
        raise InputTypeError(f"motion is a {type(motion).__name__}, expected a Trajectory")
    check = None if limits is None else motion.check(limits)
    panels = trajectory_axes(axes)
    times = sample_times(motion)
    artists: list[Any] = []
    for order, panel in enumerate(panels):
        artists += draw_order(panel, motion, times, order)
        if check is not None:
            artists += draw_limits(panel, motion, times, order, getattr(limits, "limits", limits))
        panel.set_ylabel(f"{QUANTITIES[order]}\n[{UNITS[order]}]", fontsize=8)
        panel.grid(alpha=0.3)
    panels[-1].set(xlabel="time [s]", xlim=(0.0, max(motion.duration, np.finfo(float).tiny)))
    artists.append(panels[0].legend(fontsize=7, ncols=min(motion.dof, 4), loc="best"))
    return [*artists, *write_title(panels[0], title or describe_motion(motion, check))]


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


def sample_times(motion: Trajectory) -> Array:
    """Times at which the curves are drawn: equal steps, and both sides of every knot, where jerks jump."""
    knots = motion.knots
    before = np.maximum(np.nextafter(knots, -np.inf), 0.0)
    return np.unique(np.concatenate([np.linspace(0.0, motion.duration, SAMPLES), knots, before]))


def draw_order(panel: Any, motion: Trajectory, times: Array, order: int) -> list[Any]:
    """The curves of one derivative."""
    values = motion(times, order)
    return [
        panel.plot(times, values[:, j], color=f"C{j % 10}", linewidth=1.3, label=motion.labels[j])[0]
        for j in range(motion.dof)
    ]


def draw_limits(panel: Any, motion: Trajectory, times: Array, order: int, limits: Any) -> list[Any]:
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
