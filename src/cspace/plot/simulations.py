"""Simulated motions over time."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.dynamics import Simulation
from cspace.errors import InputTypeError
from cspace.plot.axes import flat_axes, write_title

BASE_COLORS: Final = ("0.2", "0.5", "0.7")
"""Of the place of a floating base along x, y and z: greys, for joints have the colours."""


def simulation(run: Simulation, *, ax: Any = None, title: str = "") -> list[Any]:
    """The coordinates of a simulated robot over time, dashed the place of a floating base.

    Rows of a batch have the same colours.

    run: q (..., k, n). ax: 2-D axes. title: above them, by default the summary of the simulation. Returns the
    artists. Raises InputTypeError for anything but a Simulation.
    """
    if not isinstance(run, Simulation):
        raise InputTypeError(f"run is a {type(run).__name__}, expected what robot.simulate returns")
    axes = flat_axes(ax)
    q = run.q.reshape(-1, *run.q.shape[-2:])
    artists: list[Any] = []
    for k in range(q.shape[-1]):
        lines = axes.plot(run.times, q[..., k].T, color=f"C{k % 10}", linewidth=1.4 if len(q) == 1 else 0.7)
        lines[0].set_label(run.joints[k])
        artists += lines
    if run.T_world_base is not None:
        places = run.T_world_base[..., :3, 3].reshape(-1, len(run), 3)
        for k, (name, color) in enumerate(zip("xyz", BASE_COLORS, strict=True)):
            lines = axes.plot(run.times, places[..., k].T, "--", color=color, linewidth=1.0)
            lines[0].set_label(f"base {name}")
            artists += lines
    axes.set(
        xlabel="time [s]", ylabel="coordinates [rad, m]", xlim=(0.0, max(run.times[-1], np.finfo(float).tiny))
    )
    axes.grid(alpha=0.3)
    return [*artists, axes.legend(fontsize=8), *write_title(axes, title or run.summary)]
