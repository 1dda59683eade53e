"""The state of a robot and what acts on it, for `cspace dynamics` and `cspace simulate`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import (
    add_option,
    named_number,
    read_angle,
    read_length,
    read_number,
    read_radians,
)
from cspace.cli.exits import UsageError
from cspace.cli.output import tidy_number
from cspace.cli.robot import joint_called, load_chosen, read_configuration

if TYPE_CHECKING:
    from cspace.mechanisms import Mechanism
    from cspace.robot import Robot

Typed = float | tuple[str, float]
"""A number, or a joint and its number."""

HOME: Final = "home"
"""The pose of a robot for which no joints are typed."""

BASE_ROWS: Final = ("base x", "base y", "base z", "base about x", "base about y", "base about z")
"""The velocities [v; ω] of a floating base, and the forces [f; n] on it."""


def add_state(parser: argparse.ArgumentParser, at: str) -> None:
    """The joints, the base and the velocities. at: what follows their names, such as " at time zero"."""
    text = (
        f"the joints{at} [rad, m, with --deg deg]: one value per joint, or JOINT=VALUE for some; pi/2 or"
        " 90deg may be typed (default: the pose home if the robot has it, else 0)"
    )
    parser.add_argument("q", metavar="Q", nargs="*", type=read_typed, help=text)
    add_option(parser, "--pose NAME", "a named pose of the robot in place of the default")
    text = f"velocities{at} [rad/s, m/s, with --deg deg/s], of a floating base [v; ω] first (default: 0)"
    add_option(parser, "--qd V…", text, read_typed)
    add_option(parser, "--floating", "the base moves freely")
    add_option(parser, "--xyz X Y Z", f"where the base is{at} [m] (default: 0 0 0)", read_length)
    text = "how it is turned, about the fixed x, y and z (default: 0 0 0)"
    add_option(parser, "--rpy ROLL PITCH YAW", text, read_angle)


def add_acts(parser: argparse.ArgumentParser) -> None:
    """What acts on the robot besides the torques of its joints."""
    text = "a mass [kg] on a frame, by default the tip: 2 or 2@tool0"
    add_option(parser, "--payload MASS@FRAME", text, read_payload)
    text = "[m/s²], in the axes of the base, or of the world if the base floats (default: 0 0 -9.81)"
    add_option(parser, "--gravity X Y Z", text, read_number)
    text = (
        "a force [N] and a torque [N·m] of the world on the robot, at the origin of a frame, in the axes of"
        " --expressed-in; may be repeated"
    )
    add_option(parser, "--wrench FRAME FX FY FZ NX NY NZ", text, str, action="append", default=[])
    text = "the axes of --wrench: base (of the world if the base floats), or tip for those of its frame"
    add_option(parser, "--expressed-in", text, choices=("base", "tip"), default="base")
    add_option(parser, "--no-friction", "the joints move without damping and friction")


def read_typed(text: str) -> Typed:
    """An angle or a number; with = in it a joint and its value."""
    return named_number(text) if "=" in text else read_angle(text)


def read_payload(text: str) -> tuple[float, str | None]:
    """A mass and where it is: 2, 2@tool0."""
    mass, _, frame = text.partition("@")
    return read_number(mass), frame or None


def load_heavy(args: argparse.Namespace) -> Robot:
    """The robot with its payload. Raises UsageError where nothing of it has a mass."""
    robot = load_chosen(args, floating=args.floating or None)
    if robot.mass == 0.0:
        from cspace.robots import rows

        heavy = sum("inertia" not in row.missing for row in rows())
        raise UsageError(
            f"no link of {robot.name} has a mass; add inertial data to its description, or take one of the"
            f" {heavy} of {len(rows())} robots of the catalogue that have masses: cspace robots --has inertia"
        )
    if args.payload is not None:
        mass, frame = args.payload
        robot = robot.with_payload(mass, frame=frame)
    return robot


@dataclass(frozen=True)
class Start:
    """Where a robot is: q (n,), qd (dof,), and T_world_base (4, 4) or None where no place is typed.

    words: how the configuration was found where it was not typed in full.
    """

    q: Array
    qd: Array
    T_world_base: Array | None
    words: str = ""


def read_start(args: argparse.Namespace, robot: Robot) -> Start:
    """The state that is typed."""
    q, words = read_joints(args, robot)
    qd = read_rates(args.qd, robot, "--qd", degrees=args.deg)
    return Start(q, qd, read_base(args), words)


def read_joints(args: argparse.Namespace, robot: Robot) -> tuple[Array, str]:
    """The configuration (n,): as typed, or the pose that is named, home or zero, with the joints that are
    typed by name; and what of it was not typed."""
    is_named = is_by_name(args.q, "q")
    if args.q and not is_named:
        if args.pose is not None:
            raise UsageError(
                f"give either values of all joints or --pose {args.pose}; with a pose, JOINT=VALUE"
                " changes a joint"
            )
        return read_configuration(args.q, robot, "q", degrees=args.deg), ""
    if args.pose is not None:
        q, words = robot.named_poses[args.pose].copy(), f"pose {args.pose}"
    elif HOME in robot.named_poses:
        q, words = robot.named_poses[HOME].copy(), f"pose {HOME}"
    else:
        q, words = np.zeros(len(robot.joint_names)), "all joints at 0"
    set_by_name(q, args.q, robot, degrees=args.deg)
    return q, f"{words}, but for {', '.join(name for name, _ in args.q)}" if is_named else words


def is_by_name(values: Sequence[Typed], option: str) -> bool:
    """Whether values are typed with the names of their joints. Raises UsageError for a mixture."""
    named = [isinstance(value, tuple) for value in values]
    if any(named) and not all(named):
        raise UsageError(f"{option} has values with names and without; give one kind")
    return any(named)


def set_by_name(
    values: Array, typed: Sequence[Any], robot: Robot, *, degrees: bool, is_effort: bool = False
) -> None:
    """Set the entries of the joints (n,) that are typed by name; efforts have no degrees."""
    for word, value in typed:
        k = robot.joint_names.index(joint_called(word, robot))
        values[k] = read_radians(value, degrees=degrees and not is_effort and robot.joint_types[k] == "R")


def read_rates(values: Sequence[Any] | None, robot: Robot, option: str, *, degrees: bool) -> Array:
    """Velocities or accelerations (dof,) [rad, m per s or s²]; of a floating base its own first."""
    n = len(robot.joint_names)
    first = robot.dof - n
    rates = np.zeros(robot.dof)
    if values is None:
        return rates
    if is_by_name(values, option):
        set_by_name(rates[first:], values, robot, degrees=degrees)
        return rates
    if first and len(values) != robot.dof:
        raise UsageError(
            f"{robot.name} has {robot.dof} velocities, {option} has {len(values)} values; [v; ω] of the base,"
            f" then those of {', '.join(robot.joint_names) or 'no joint'}"
        )
    rates[: min(first, 3)] = values[: min(first, 3)]
    rates[3:first] = [read_radians(value, degrees=degrees) for value in values[3:first]]
    rates[first:] = read_configuration(values[first:], robot, option, degrees=degrees)
    return rates


def read_torques(values: Sequence[Any], robot: Robot, option: str) -> Array:
    """Torques and forces (dof,) [N·m, N] of the joints; nothing drives a floating base."""
    first = robot.dof - len(robot.joint_names)
    tau = np.zeros(robot.dof)
    if is_by_name(values, option):
        set_by_name(tau[first:], values, robot, degrees=False, is_effort=True)
    else:
        tau[first:] = read_configuration(values, robot, option, degrees=False)
    return tau


def read_base(args: argparse.Namespace) -> Array | None:
    """The pose of the base, or None where none is typed."""
    from cspace.spatial import pose

    if args.xyz is None and args.rpy is None:
        return None
    rpy = [read_radians(angle, degrees=args.deg) for angle in args.rpy or (0.0, 0.0, 0.0)]
    return pose(args.xyz or (0.0, 0.0, 0.0), rpy=rpy)


def read_acts(args: argparse.Namespace) -> dict[str, Any]:
    """The keywords of the functions of dynamics: gravity, wrenches and their axes, friction."""
    acts: dict[str, Any] = {"friction": not args.no_friction}
    if args.gravity:
        acts["gravity"] = np.array(args.gravity)
    if args.wrench:
        acts |= {"wrenches": read_wrenches(args.wrench), "expressed_in": args.expressed_in}
    return acts


def read_wrenches(typed: Sequence[Sequence[str]]) -> dict[str, Array]:
    """Wrenches (6,) by frame; those of one frame are added."""
    wrenches: dict[str, Array] = {}
    for frame, *words in typed:
        try:
            wrench = np.array([read_number(word) for word in words])
        except argparse.ArgumentTypeError as error:
            raise UsageError(f"--wrench takes a frame and six numbers: {error}") from None
        wrenches[frame] = wrenches.get(frame, 0.0) + wrench
    return wrenches


@dataclass(frozen=True)
class Units:
    """The units in which the joints of a robot, and its floating base, are printed."""

    robot: Robot
    degrees: bool

    @property
    def kinds(self) -> str:
        """ "R" or "P" of each velocity, those of a floating base first."""
        return ("PPPRRR" if self.robot.floating else "") + "".join(self.robot.joint_types)

    @property
    def names(self) -> tuple[str, ...]:
        """The name of each velocity."""
        return ((*BASE_ROWS,) if self.robot.floating else ()) + tuple(self.robot.joint_names)

    @property
    def angle(self) -> str:
        """The unit of angles."""
        return "deg" if self.degrees else "rad"

    def word(self, per: str = "") -> str:
        """The units of positions, or with /s or /s² of rates, as in the head of a table."""
        kinds = set(self.kinds)
        units = [unit for kind, unit in (("R", self.angle), ("P", "m")) if kind in kinds]
        return ", ".join(unit + per for unit in units or ["rad"])

    @property
    def effort(self) -> str:
        """The units of torques and forces."""
        return ", ".join(unit for kind, unit in (("R", "N·m"), ("P", "N")) if kind in self.kinds) or "N·m"

    @property
    def scale(self) -> Array:
        """What velocities (dof,) are multiplied by for print."""
        return np.array([np.degrees(1.0) if kind == "R" and self.degrees else 1.0 for kind in self.kinds])

    def headings(self) -> list[str]:
        """Column headings of the joints with their units: their names where they are short, else q1, q2, …"""
        names = list(self.robot.joint_names)
        if max(map(len, names), default=0) > 8:
            names = [f"q{k + 1}" for k in range(len(names))]
        units = [self.angle if kind == "R" else "m" for kind in self.robot.joint_types]
        return [f"{name} [{unit}]" for name, unit in zip(names, units, strict=True)]


def show_number(value: float) -> str:
    """Five digits, rounding noise shown as zero."""
    return f"{tidy_number(value):.5g}"


def loop_words(robot: Robot) -> list[str]:
    """The closed loops of the description, one text each."""
    return [f"{loop.name} ({loop.type}: {loop.parent} to {loop.child})" for loop in robot.description.loops]


def close_start(args: argparse.Namespace, robot: Robot, start: Start) -> tuple[Mechanism, Start]:
    """The mechanism of a robot whose description has loops, and the start with closed loops.

    Joints that are typed by name keep their values, and their velocities make those of the others; else the
    closed configuration nearest to the typed one counts. Raises UsageError where the loops cannot be closed.
    """
    from cspace.mechanisms import Mechanism

    mechanism = Mechanism(robot)
    q, qd = start.q, start.qd
    closure = mechanism.close(name_values(args.q, q, robot), near=q)
    if not closure:
        raise UsageError(
            f"the loops of {robot.name} cannot be closed there: {closure.reason}; give other joints"
        )
    driven = name_values(args.qd or [], qd, robot)
    if driven and not robot.floating:
        qd = mechanism.velocities(closure.q, driven)
    words = f"{start.words or 'as typed'}; the loops closed"
    return mechanism, replace(start, q=closure.q, qd=qd, words=words)


def name_values(typed: Sequence[Any], values: Array, robot: Robot) -> dict[str, float]:
    """The values (n,) of the joints that are typed by name."""
    names = [joint_called(each[0], robot) for each in typed if isinstance(each, tuple)]
    return {name: float(values[robot.joint_names.index(name)]) for name in names}
