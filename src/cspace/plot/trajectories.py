"""Trajectories over time: positions to jerks, torques and the speed of the tip, with their limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, one_array, positive_number
from cspace.dynamics import ExcitingTrajectory
from cspace.dynamics.rows import EARTH
from cspace.errors import InputError, InputTypeError, name_type
from cspace.plot.axes import need_matplotlib, write_title
from cspace.robot import Robot
from cspace.tolerances import LIMIT_ROUNDING
from cspace.trajectory import Trajectory, TrajectoryCheck
from cspace.trajectory.limit_check import read_limits

QUANTITIES: Final = ("position", "velocity", "acceleration", "jerk")
"""The panels of every motion, from above."""
UNITS: Final = ("rad, m", "/s", "/s²", "/s³")
"""Behind the name of each panel."""
SAMPLES: Final = 1200
"""Times at which curves are drawn, besides those of the knots."""
BEYOND: Final = "#d62728"
"""The colour of what exceeds a limit."""
NEAR: Final = 3.0
"""Multiple of the largest value up to which a limit is drawn; others would flatten the curves."""
TIP_COLORS: Final = ("#222222", "#888888")
"""Of its speed and its turn rate."""
PANEL_HEIGHT: Final = 2.0
"""[inch]"""


class FourierMotion:
    """An exciting trajectory with the names of its joints, as far as a picture asks for it."""

    def __init__(self, series: ExcitingTrajectory, robot: Robot | None) -> None:
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
    motion: Trajectory | ExcitingTrajectory,
    *,
    limits: Any = None,
    robot: Robot | None = None,
    torque: ArrayLike | None = None,
    speed: float | None = None,
    turn_rate: float | None = None,
    frame: str | None = None,
    gravity: ArrayLike = EARTH,
    axes: Any = None,
    title: str = "",
) -> list[Any]:
    """Positions, velocities, accelerations and jerks over time, one panel each; of a robot also torques and
    the speed of its tip.

    motion: of any number of joints; each has its colour in all panels. limits: Limits or a robot; dashed
    lines in the colours of the joints, and thick red curves where a joint exceeds one. The joints of an
    ExcitingTrajectory have names where it is a robot. robot: whose torques (if it has masses), and speed and
    turn rate of the tip, or of another frame, are drawn too. torque () or (dof,) [N·m or N], speed [m/s],
    turn_rate [rad/s]: their limits; by default the efforts of the robot, and none of the tip. gravity (3,)
    [m/s²]. axes: as many 2-D axes as panels. title: above them. Returns the artists.

    Raises InputTypeError for anything but a Trajectory or an ExcitingTrajectory, and for torque=, speed= and
    turn_rate= without robot=, InputError for another number of axes, of joints or of limits.
    """
    read_frame_limits(robot, torque, speed, turn_rate)
    drawn: Trajectory | FourierMotion
    if isinstance(motion, ExcitingTrajectory):
        title = title or f"{motion.robot}: {motion.duration:.4g} s, condition {motion.condition:.3g}"
        drawn = FourierMotion(motion, limits)
    elif isinstance(motion, Trajectory):
        title = title or describe_motion(motion, None if limits is None else motion.check(limits))
        drawn = motion
    else:
        raise InputTypeError(f"motion is {name_type(motion)}, expected a Trajectory or an ExcitingTrajectory")
    bounds = None if limits is None else read_limits(limits, drawn.dof)
    rates = []
    if robot is not None:
        rates = RobotPanels(robot, drawn, gravity, frame).list(torque, speed, turn_rate)
    return draw_motion(drawn, bounds, rates, axes, title)


def read_frame_limits(robot: Robot | None, torque: Any, speed: Any, turn_rate: Any) -> None:
    """Raises InputTypeError for limits of a robot without one."""
    if robot is not None and not isinstance(robot, Robot):
        raise InputTypeError(f"robot is {name_type(robot)}, expected a cs.Robot")
    given = {"torque": torque, "speed": speed, "turn_rate": turn_rate}
    for name, value in given.items():
        if value is not None and robot is None:
            raise InputTypeError(f"{name}= is of a robot; pass robot=")


@dataclass(frozen=True)
class RatePanel:
    """A panel of what a robot does. label: of its axis. names: of the curves. values: of times. limits: one
    per curve, inf for none. colors: one per curve."""

    label: str
    names: tuple[str, ...]
    values: Callable[[Array], Array]
    limits: Array
    colors: tuple[str, ...]


class RobotPanels:
    """The torques of a motion of a robot, and how fast a frame of it moves."""

    def __init__(
        self, robot: Robot, motion: Trajectory | FourierMotion, gravity: ArrayLike, frame: str | None
    ) -> None:
        if motion.dof != robot.dof:
            raise InputError(f"the trajectory is of {motion.dof} joints, {robot.name} of {robot.dof}")
        self.robot, self.motion, self.frame = robot, motion, frame
        self.gravity = one_array(gravity, "gravity", (3,))

    def list(self, torque: Any, speed: Any, turn_rate: Any) -> list[RatePanel]:
        """The panels, with their limits."""
        panels = []
        inertials = [link.inertial for link in self.robot.description.links]
        if any(each is not None and each.mass > 0.0 for each in inertials):
            most, names = self.read_torque(torque), self.motion.labels
            colors = joint_colors(len(names))
            panels.append(RatePanel("torque\n[N·m, N]", names, self.torques, most, colors))
        bounds = [
            np.inf if value is None else positive_number(value, name)
            for name, value in (("speed", speed), ("turn_rate", turn_rate))
        ]
        names = ("speed [m/s]", "turn rate [rad/s]")
        label = self.frame or "tip"
        panels.append(RatePanel(f"{label}\n[m/s, rad/s]", names, self.speeds, np.array(bounds), TIP_COLORS))
        return panels

    def read_torque(self, torque: Any) -> Array:
        """The limits (dof,) that are given, or the efforts of the robot."""
        efforts: Array = self.robot.limits.effort
        if torque is None:
            return efforts
        given = as_floats(torque, "torque", finite=False)
        if given.shape not in ((), efforts.shape):
            raise InputError(f"torque has shape {given.shape}, expected () or {efforts.shape}")
        return np.broadcast_to(given, efforts.shape)

    def torques(self, times: Array) -> Array:
        """The torques (k, dof) at times (k,)."""
        return np.asarray(
            self.robot.inverse_dynamics(*(self.motion(times, k) for k in range(3)), gravity=self.gravity)
        )

    def speeds(self, times: Array) -> Array:
        """The speed and the turn rate (k, 2) at times (k,)."""
        J = self.robot.jacobian(self.motion(times, 0), self.frame)
        twist = np.einsum("kij,kj->ki", J, self.motion(times, 1))
        return np.stack([np.linalg.norm(twist[:, part], axis=1) for part in (slice(3), slice(3, 6))], axis=1)


def joint_colors(count: int) -> tuple[str, ...]:
    """A colour per joint."""
    return tuple(f"C{j % 10}" for j in range(count))


def draw_motion(
    motion: Trajectory | FourierMotion, bounds: Any, rates: list[RatePanel], axes: Any, title: str
) -> list[Any]:
    """The panels of all derivatives, with limits unless they are None, and those of the robot."""
    panels = trajectory_axes(axes, len(QUANTITIES) + len(rates))
    times = sample_times(motion)
    artists: list[Any] = []
    colors = joint_colors(motion.dof)
    for order, panel in enumerate(panels[: len(QUANTITIES)]):
        values = motion(times, order)
        artists += draw_curves(panel, times, values, motion.labels, colors)
        if bounds is not None:
            high = bounds.upper if order == 0 else getattr(bounds, QUANTITIES[order])
            low = bounds.lower if order == 0 else -high
            artists += draw_limits(panel, times, values, (low, high), colors)
        panel.set_ylabel(f"{QUANTITIES[order]}\n[{UNITS[order]}]", fontsize=8)
    for rate, panel in zip(rates, panels[len(QUANTITIES) :], strict=True):
        values = rate.values(times)
        artists += draw_curves(panel, times, values, rate.names, rate.colors)
        low = -rate.limits if rate.names == motion.labels else np.full(len(rate.limits), -np.inf)
        artists += draw_limits(panel, times, values, (low, rate.limits), rate.colors)
        panel.set_ylabel(rate.label, fontsize=8)
        if rate.names != motion.labels:
            artists.append(panel.legend(fontsize=7, loc="best"))
    for panel in panels:
        panel.grid(alpha=0.3)
    panels[-1].set(xlabel="time [s]", xlim=(0.0, max(motion.duration, np.finfo(float).tiny)))
    artists.append(panels[0].legend(fontsize=7, ncols=min(motion.dof, 4), loc="best"))
    return [*artists, *write_title(panels[0], title)]


def trajectory_axes(axes: Any, count: int) -> list[Any]:
    """So many axes above each other, the given ones or those of a new figure."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if axes is None:
        size = (7.2, PANEL_HEIGHT * count)
        _, made = plt.subplots(count, 1, figsize=size, dpi=120, sharex=True, layout="constrained")
        return list(made)
    panels = list(np.ravel(np.asarray(axes, dtype=object)))
    if len(panels) != count:
        words = "four" if count == len(QUANTITIES) else str(count)
        raise InputError(
            f"a trajectory needs {words} axes, got {len(panels)}; plt.subplots({count}, 1) makes them"
        )
    return panels


def sample_times(motion: Trajectory | FourierMotion) -> Array:
    """Times at which the curves are drawn: equal steps, and both sides of every knot, where jerks jump."""
    knots = motion.knots
    before = np.maximum(np.nextafter(knots, -np.inf), 0.0)
    return np.unique(np.concatenate([np.linspace(0.0, motion.duration, SAMPLES), knots, before]))


def draw_curves(
    panel: Any, times: Array, values: Array, names: tuple[str, ...], colors: tuple[str, ...]
) -> list[Any]:
    """The curves of values (k, n) at times (k,)."""
    return [
        panel.plot(times, values[:, j], color=colors[j], linewidth=1.3, label=names[j])[0]
        for j in range(values.shape[1])
    ]


def draw_limits(
    panel: Any, times: Array, values: Array, bounds: tuple[Array, Array], colors: tuple[str, ...]
) -> list[Any]:
    """Dashed lines at the limits (n,), and what of the values (k, n) exceeds them in red."""
    low, high = bounds
    artists = list[Any]()
    shown = np.abs(values).max(initial=0.0)
    for j in range(values.shape[1]):
        for level in (low[j], high[j]):
            if np.isfinite(level) and abs(level) <= NEAR * shown:
                artists.append(panel.axhline(level, color=colors[j], linestyle="--", linewidth=0.7))
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
