"""Simulated motions over time, in one panel for each quantity that there is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.dynamics import Simulation
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.plot.axes import need_matplotlib, write_title
from cspace.plot.motion_colors import REST, color_joints
from cspace.robot import Robot
from cspace.tolerances import DRAWN_MOTION

PANELS: Final = (
    "base position",
    "base velocity",
    "base angular velocity",
    "joints",
    "prismatic joints",
    "velocities",
    "prismatic velocities",
    "torques",
    "forces",
    "energy",
)
"""What can be shown, from above."""
BASE_COLORS: Final = {"x": "#d62728", "y": "#2ca02c", "z": "#1f77b4"}
"""Of what a floating base does along x, y and z: those of the axes of a frame."""
ENERGY_COLORS: Final = {"total": "0.15", "kinetic": "#ff7f0e", "potential": "#1f77b4"}
WIDTH, HEIGHT = 8.4, 1.65
"""Of a figure, and of one of its panels [inch]."""


@dataclass(frozen=True)
class Curves:
    """What one panel shows: curves (..., k, m) over time with a name and a colour each.

    unit: of the values. names: empty for curves that share the last entry of the legend. legend: whether the
    panel has one.
    """

    unit: str
    values: Array
    names: list[str]
    colors: list[str]
    legend: bool


def simulation(
    run: Simulation,
    *,
    robot: Robot | None = None,
    degrees: bool = False,
    panels: tuple[str, ...] | list[str] | None = None,
    axes: Any = None,
    title: str = "",
) -> list[Any]:
    """The motion of a simulated robot over time: its base, joints, velocities, torques and energy.

    Each quantity has a panel of its own; one where nothing happens is left out. A joint has one colour in all
    panels. The ten joints that move most are named, the others are grey. Rows of a batch are thin lines of
    the same colour.

    run: q (..., k, n). robot: the robot of the simulation; with it revolute and prismatic joints have panels
    of their own, and kinetic and potential energy are drawn besides their sum. degrees: angles in degrees.
    panels: names from PANELS, in this order, in place of those with something to show. axes: as many 2-D axes
    as panels. title: above them, by default the summary of the simulation. Returns the artists.

    Raises InputTypeError for anything but a Simulation, UnknownNameError for an unknown panel, InputError for
    another robot and another number of axes, and for degrees without a robot.
    """
    if not isinstance(run, Simulation):
        raise InputTypeError(f"run is {name_type(run)}, expected what robot.simulate returns")
    check_robot_of(run, robot, degrees)
    found = find_curves(run, robot, degrees)
    chosen: list[str] = [name for name in PANELS if name in found and shows_motion(name, found[name])]
    if panels is not None:
        chosen = [check_panel(name, found) for name in panels]
    drawn = make_axes(len(chosen)) if axes is None else list(np.ravel(np.asarray(axes, dtype=object)))
    if len(drawn) != len(chosen):
        raise InputError(
            f"{len(chosen)} panels ({', '.join(chosen)}) need as many axes, got {len(drawn)}; panels= chooses"
            " which are drawn"
        )
    artists: list[Any] = []
    for name, panel in zip(chosen, drawn, strict=True):
        artists += draw_curves(panel, run, name, found[name])
    drawn[-1].set_xlabel("time [s]")
    return [*artists, *write_title(drawn[0], title or run.summary)]


def check_robot_of(run: Simulation, robot: Robot | None, degrees: bool) -> None:
    """InputError for a robot with other joints, and for degrees where nobody knows which joints turn."""
    if robot is None:
        if degrees:
            raise InputError("degrees=True needs robot=, which knows which joints are revolute")
    elif tuple(robot.joint_names) != run.joints:
        raise InputError(
            f"robot is {robot.name}, whose joints are not those of the simulation of {run.robot}"
        )


def check_panel(name: str, found: dict[str, Curves]) -> str:
    """The name of a panel that can be drawn; UnknownNameError for others."""
    if name not in found:
        raise suggest("panel", name, tuple(found), owner="this simulation")
    return name


def make_axes(count: int) -> list[Any]:
    """Panels above each other in a new figure, with room for legends at their side."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    size = (WIDTH, HEIGHT * count + 0.6)
    _, made = plt.subplots(count, 1, figsize=size, dpi=120, sharex=True, squeeze=False, layout="constrained")
    return list(made[:, 0])


def find_curves(run: Simulation, robot: Robot | None, degrees: bool) -> dict[str, Curves]:
    """The curves of each panel by its name."""
    first = run.qd.shape[-1] - run.q.shape[-1]
    found: dict[str, Curves] = {}
    if run.T_world_base is not None:
        for name, unit, values in (
            ("base position", "m", run.T_world_base[..., :3, 3]),
            ("base velocity", "m/s", run.qd[..., :3]),
            ("base angular velocity", "deg/s" if degrees else "rad/s", run.qd[..., 3:6]),
        ):
            scale = np.degrees(1.0) if unit == "deg/s" else 1.0
            tints = list(BASE_COLORS.values())
            found[name] = Curves(unit, values * scale, list("xyz"), tints, name == "base position")
    names, colors = color_joints(run.joints, run.q)
    for kind, columns in split_kinds(run, robot).items():
        unit, rate, (effort, effort_unit), scale = units_of(kind, degrees)
        lead = "prismatic " if kind == "P" else ""
        for name, text, values, legend in (
            (lead + "joints", unit, run.q * scale, True),
            (lead + "velocities", rate, run.qd[..., first:] * scale, False),
            (effort, effort_unit, run.tau[..., first:], False),
        ):
            named, colored = ([each[k] for k in columns] for each in (names, colors))
            found[name] = Curves(text, values[..., columns], named, colored, legend)
    found["energy"] = find_energies(run, robot)
    return found


def units_of(kind: str, degrees: bool) -> tuple[str, str, tuple[str, str], float]:
    """The units of positions and velocities of a kind of joints, the name and unit of their torques, and what
    positions are multiplied by."""
    if kind == "R":
        unit, scale = ("deg", float(np.degrees(1.0))) if degrees else ("rad", 1.0)
        return unit, f"{unit}/s", ("torques", "N·m"), scale
    if kind == "P":
        return "m", "m/s", ("forces", "N"), 1.0
    return "rad or m", "rad/s or m/s", ("torques", "N·m or N"), 1.0


def split_kinds(run: Simulation, robot: Robot | None) -> dict[str, list[int]]:
    """The coordinates of revolute and of prismatic joints; all under one word where nobody knows."""
    if robot is None:
        return {"": list(range(len(run.joints)))} if run.joints else {}
    kinds = {kind: [k for k, other in enumerate(robot.joint_types) if other == kind] for kind in "RP"}
    return {kind: columns for kind, columns in kinds.items() if columns}


def find_energies(run: Simulation, robot: Robot | None) -> Curves:
    """The energy over time, with a robot also its parts."""
    parts = [run.energy]
    if robot is not None:
        lost = ~np.isfinite(run.energy)[..., None]
        T = run.T_world_base
        place = None if T is None else np.where(lost[..., None], np.eye(4), T)
        q, qd = (np.where(lost, 0.0, each) for each in (run.q, run.qd))
        kinetic = np.where(lost[..., 0], np.nan, robot.kinetic_energy(q, qd, T_world_base=place))
        parts += [kinetic, run.energy - kinetic]
    names = list(ENERGY_COLORS)[: len(parts)]
    values = np.stack(parts, axis=-1)
    return Curves("J", values, names, [ENERGY_COLORS[name] for name in names], len(parts) > 1)


def shows_motion(name: str, curves: Curves) -> bool:
    """Whether a panel has something to show: joints and energy always, others where they are not zero."""
    if name in ("joints", "prismatic joints", "energy", "base position"):
        return True
    values = curves.values[np.isfinite(curves.values)]
    return bool(np.abs(values).max(initial=0.0) > DRAWN_MOTION)


def draw_curves(panel: Any, run: Simulation, name: str, curves: Curves) -> list[Any]:
    """The curves of one panel and its legend."""
    values = curves.values.reshape(-1, len(run), len(curves.names))
    wide = 1.5 if len(values) == 1 else 0.7
    artists: list[Any] = []
    entries: dict[str, Any] = {}
    order = sorted(range(len(curves.names)), key=lambda k: curves.colors[k] != REST)  # grey ones below
    for k in order:
        faint = curves.colors[k] == REST
        lines = panel.plot(
            run.times,
            values[..., k].T,
            color=curves.colors[k],
            linewidth=0.7 if faint else wide,
            zorder=1.5 if faint else 2,
        )
        entries.setdefault("" if faint else curves.names[k], lines[0])
        artists += lines
    others = sum(color == REST for color in curves.colors)
    panel.set_ylabel(f"{name}\n[{curves.unit}]", fontsize=8)
    panel.tick_params(labelsize=8)
    panel.set_xlim(0.0, max(run.times[-1], np.finfo(float).tiny))
    panel.grid(alpha=0.3)
    if not curves.legend:
        return artists
    ordered = [label for label in curves.names if label] + ([""] if others else [])
    return [
        *artists,
        panel.legend(
            [entries[label] for label in ordered],
            [label or f"and {others} more" for label in ordered],
            fontsize=6.5 if len(ordered) > 6 else 8,
            loc="upper left",
            bbox_to_anchor=(1.0, 1.04),
            frameon=False,
            labelspacing=0.2,
        ),
    ]
