"""What the torques of a motion are made of: bars of inertia, velocities, gravity, friction and wrenches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.plot.axes import need_matplotlib, write_title
from cspace.plot.colors import INK
from cspace.robot import Robot
from cspace.spatial.checks import PoseLike
from cspace.tolerances import DRAWN_SHARE

PARTS: Final = {
    "inertia": "#1f77b4",
    "Coriolis and centrifugal": "#ff7f0e",
    "gravity": "#2ca02c",
    "friction": "#8c564b",
    "wrenches": "#9467bd",
}
"""The terms of the equation of motion and their colours."""
BASE_ROWS: Final = ("base x", "base y", "base z")
"""Of the force on a floating base, and of the torque."""
ROW: Final = 0.32
"""Height of the bar of a joint with the gap to the next [inch]."""
LIMIT, EFFORT = "effort of the robot", "#d62728"
"""The entry of the legend for the efforts of the robot, and their colour."""
EDGE: Final = 0.05
"""Free space at both ends of an axis, as a share of what is drawn."""


def torques(
    robot: Robot,
    q: ArrayLike,
    qd: ArrayLike | None = None,
    qdd: ArrayLike | None = None,
    *,
    gravity: ArrayLike = (0.0, 0.0, -9.81),
    wrenches: Mapping[str, ArrayLike] | None = None,
    expressed_in: str = "base",
    friction: bool = True,
    T_world_base: PoseLike | None = None,
    axes: Any = None,
    title: str = "",
) -> list[Any]:
    """The torques behind a motion, one bar per joint, split by its causes.

    Bars to the right are positive, to the left negative; the dark mark is their sum, and short lines are the
    efforts of the robot where the bars come near them. Torques and forces have panels of their own, and those
    of a floating base.

    q (n,) [rad or m]. qd, qdd (dof,): zero if None. gravity (3,), wrenches, expressed_in, friction,
    T_world_base (4, 4): as of inverse_dynamics. axes: as many 2-D axes as panels. title: above them, by
    default the name of the robot. Returns the artists.

    Raises InputTypeError for anything but a Robot, InputError for a wrong shape or NaN, where no link has a
    mass, and for another number of axes.
    """
    if not isinstance(robot, Robot):
        raise InputTypeError(f"robot is {name_type(robot)}, expected a cs.Robot")
    rates = [np.zeros(robot.dof) if each is None else each for each in (qd, qdd)]
    state = [
        one_array(each, word, (size,))
        for each, word, size in zip(
            (q, *rates), ("q", "qd", "qdd"), (len(robot.joint_names), robot.dof, robot.dof), strict=True
        )
    ]
    acts = {"wrenches": wrenches, "expressed_in": expressed_in}
    parts = split_torques(robot, state, gravity, acts, friction, T_world_base)
    groups = group_rows(robot)
    panels = (
        make_axes([len(rows) for rows, _, _ in groups]) if axes is None else list(np.ravel(np.array(axes)))
    )
    if len(panels) != len(groups):
        raise InputError(f"{len(groups)} panels need as many axes, got {len(panels)}")
    first = robot.dof - len(robot.joint_names)
    efforts = np.concatenate([np.full(first, np.inf), robot.limits.effort])
    artists: list[Any] = []
    for panel, (rows, names, label) in zip(panels, groups, strict=True):
        artists += draw_bars(panel, {name: part[rows] for name, part in parts.items()}, efforts[rows])
        panel.set_yticks(range(len(rows)), names, fontsize=8)
        panel.set_ylim(len(rows) - 0.5, -0.5)
        panel.set_xlabel(label, fontsize=8)
        panel.tick_params(axis="x", labelsize=8)
        panel.grid(axis="x", alpha=0.3)
    artists.append(write_legend(panels, parts))
    return [*artists, *write_title(panels[0], title or f"{robot.name}: what the torques are made of")]


def split_torques(
    robot: Robot,
    state: list[Array],
    gravity: ArrayLike,
    acts: dict[str, Any],
    friction: bool,
    T: PoseLike | None,
) -> dict[str, Array]:
    """The terms (dof,) of the equation of motion that are not zero, by name; their sum is the torque."""
    q, qd, qdd = state
    rest = np.zeros(robot.dof)
    place: dict[str, Any] = {"T_world_base": T}
    smooth = robot.inverse_dynamics(q, qd, qdd, gravity=gravity, friction=False, **place)
    weight = robot.gravity_torques(q, gravity=gravity, **place)
    moving = robot.inverse_dynamics(q, qd, rest, gravity=gravity, friction=False, **place) - weight
    rubbing = robot.inverse_dynamics(q, qd, qdd, gravity=gravity, friction=friction, **place) - smooth
    pushed = rest
    if acts["wrenches"]:
        pushed = robot.inverse_dynamics(q, qd, qdd, gravity=gravity, friction=False, **acts, **place) - smooth
    terms = (smooth - weight - moving, moving, weight, rubbing, pushed)
    parts = dict(zip(PARTS, terms, strict=True))
    least = DRAWN_SHARE * max(float(np.abs(part).max(initial=0.0)) for part in parts.values())
    shown = {name: part for name, part in parts.items() if np.abs(part).max(initial=0.0) > least}
    return shown or {"gravity": weight}


def group_rows(robot: Robot) -> list[tuple[list[int], list[str], str]]:
    """The rows of each panel, their names, and the label of the axis."""
    first = robot.dof - len(robot.joint_names)
    kinds = {kind: [k for k, other in enumerate(robot.joint_types) if other == kind] for kind in "RP"}
    groups = []
    if first:
        groups.append(([0, 1, 2], list(BASE_ROWS), "force on the base [N]"))
        groups.append(([3, 4, 5], list(BASE_ROWS), "torque on the base [N·m]"))
    for kind, label in (("R", "torque [N·m]"), ("P", "force [N]")):
        if kinds[kind]:
            names = [robot.joint_names[k] for k in kinds[kind]]
            groups.append(([first + k for k in kinds[kind]], names, label))
    return groups


def make_axes(heights: list[int]) -> list[Any]:
    """Panels above each other in a new figure, as high as their bars."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    size = (8.4, ROW * sum(heights) + 0.75 * len(heights) + 0.4)
    _, made = plt.subplots(
        len(heights),
        1,
        figsize=size,
        dpi=120,
        squeeze=False,
        layout="constrained",
        gridspec_kw={"height_ratios": [max(height, 2) for height in heights]},
    )
    return list(made[:, 0])


def draw_bars(panel: Any, parts: dict[str, Array], efforts: Array) -> list[Any]:
    """Stacked bars, positive and negative ones apart, their sums and the efforts nearby."""
    rows = np.arange(len(efforts))
    right, left = np.zeros(len(rows)), np.zeros(len(rows))
    artists: list[Any] = []
    for name, part in parts.items():
        start = np.where(part >= 0.0, right, left)
        artists += panel.barh(rows, part, left=start, height=0.6, color=PARTS[name], zorder=2)
        right, left = right + np.maximum(part, 0.0), left + np.minimum(part, 0.0)
    total = np.sum(list(parts.values()), axis=0)
    artists += panel.plot(total, rows, "D", color=INK, markersize=4, zorder=4)
    low, high = left.min(initial=0.0), right.max(initial=0.0)
    near = np.isfinite(efforts) & (efforts <= 2.0 * max(-low, high))  # others would shrink the bars
    if near.any():
        low, high = min(low, -efforts[near].max()), max(high, efforts[near].max())
        for sign in (-1.0, 1.0):
            marks = {"color": EFFORT, "ms": 12, "mew": 2, "zorder": 3}
            artists += panel.plot(sign * efforts[near], rows[near], "|", label=LIMIT, **marks)
    edge = EDGE * (high - low) or 1.0
    panel.set_xlim(low - edge, high + edge)
    panel.axvline(0.0, color=INK, linewidth=0.8, zorder=3)
    return artists


def write_legend(panels: list[Any], parts: dict[str, Array]) -> Any:
    """The parts, the mark of the sum and that of efforts, at the side."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[Any] = [Patch(color=PARTS[name], label=name) for name in parts]
    entries.append(Line2D([], [], marker="D", color=INK, linestyle="", markersize=4, label="sum"))
    limits = [line for panel in panels for line in panel.lines if line.get_label() == LIMIT]
    return panels[0].legend(
        handles=[*entries, *limits[:1]],
        fontsize=8,
        loc="upper left",
        bbox_to_anchor=(1.0, 1.04),
        frameon=False,
    )
