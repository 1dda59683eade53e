"""`cspace simulate`: the motion of a robot that is released or held, under gravity and friction."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import (
    add_chain,
    add_degrees,
    add_option,
    add_robot,
    read_angle,
    read_length,
    read_number,
    read_radians,
)
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table, check_format, check_writable, tidy_number
from cspace.cli.robot import (
    degrees_note,
    joint_headings,
    joint_texts,
    load_chosen,
    read_configuration,
    read_posed,
)

if TYPE_CHECKING:
    from cspace.dynamics import Simulation
    from cspace.robot import Robot

EXAMPLES: Final = """
cspace simulate puma560 0 0 0 0 0 0 --duration 2
cspace simulate ur5e --pose up --duration 5 --dt 0.002 --method variational --plot fall.png
cspace simulate panda --pose ready --goal 0 0 0 -pi/2 0 pi/2 0 --duration 3
cspace simulate arm.urdf 0.1 0.2 --qd 1 0 --duration 1 --every 10 --json
cspace simulate panda --pose ready --floating --xyz 0 0 1 --rpy 0.3 0 0 --hold
"""

ROWS: Final = 10
"""How many steps of time a table shows."""

STIFFNESS: Final = 10.0
"""How fast each joint alone is to settle [1/s]: far below what steps of a millisecond can follow."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "one value per joint at time zero [rad, m]; pi/2 or 90deg may be typed"
    parser.add_argument("q", metavar="Q", nargs="*", type=read_angle, help=text)
    add_option(parser, "--pose NAME", "a named pose of the robot instead of values, such as home")
    text = "the velocities at time zero [rad/s, m/s], of a floating base [v; ω] first (default: at rest)"
    add_option(parser, "--qd V…", text, read_angle)
    add_option(parser, "--floating", "the base moves freely")
    add_option(parser, "--xyz X Y Z", "where the base is at time zero [m] (default: 0 0 0)", read_length)
    text = "how it is turned, about the fixed x, y and z (default: 0 0 0)"
    add_option(parser, "--rpy ROLL PITCH YAW", text, read_angle)
    group = parser.add_mutually_exclusive_group()
    add_option(group, "--hold", "the joints are held where they start")
    add_option(group, "--goal V…", "the joints are pulled to these values [rad, m]", read_angle)
    add_option(group, "--tau F…", "constant torques and forces of the joints [N·m, N]", read_number)
    text = "gains of --hold and --goal, one or one per joint (default: each joint alone settles at 10/s)"
    add_option(parser, "--kp K…", text, read_number)
    add_option(parser, "--kd K…", "and those of velocity", read_number)
    add_option(parser, "--duration S", "how long [s] (default: 1)", read_number, default=1.0)
    add_option(parser, "--dt S", "the step [s] (default: 0.001)", read_number, default="1e-3")
    text = "how steps are computed (default: rk4, or variational if friction is stiff)"
    add_option(parser, "--method", text, choices=("rk4", "variational", "adaptive"))
    add_option(parser, "--every K", "record every K-th state (default: 1)", int, default=1)
    add_option(parser, "--no-friction", "the joints move without damping and friction")
    add_option(parser, "--stop-at-limits", "end where a joint passes one of its limits")
    add_option(parser, "--plot FILE", "draw the joints over time (.png, .svg, .pdf)", Path)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the states over time, and how the motion ended."""
    if args.plot:
        check_writable(args.plot)
        check_format(args.plot)
    robot = load_chosen(args, floating=args.floating or None)
    q, T = read_posed(args, robot), read_base(args, robot)
    rest = args.qd is None
    qd = np.zeros(robot.dof) if rest else read_velocities(args.qd, robot, degrees=args.deg)
    made = robot.simulate(
        q,
        qd,
        control=read_control(args, robot, q, T),
        duration=args.duration,
        dt=args.dt,
        method=args.method,
        T_world_base=T,
        every=args.every,
        friction=not args.no_friction,
        stop_at_limits=args.stop_at_limits,
    )
    if args.plot:
        from cspace import plot

        plot.save(plot.simulation(made), args.plot)
    if out.as_json:
        out.document(describe_simulation(robot, made) | {"written": [str(args.plot)] if args.plot else []})
    else:
        print_simulation(out, robot, made, degrees=args.deg)
        if args.plot:
            out.line(f"wrote {args.plot}")
        out.hint(degrees_note(args, robot))
    return Exit.DONE if made else Exit.NEGATIVE


def read_base(args: argparse.Namespace, robot: Robot) -> Array | None:
    """The pose of the base at time zero, or None where none is typed."""
    from cspace.spatial import pose

    if args.xyz is None and args.rpy is None:
        return None
    rpy = [read_radians(angle, degrees=args.deg) for angle in args.rpy or (0.0, 0.0, 0.0)]
    return pose(args.xyz or (0.0, 0.0, 0.0), rpy=rpy)


def read_velocities(values: list[float], robot: Robot, *, degrees: bool) -> Array:
    """Typed velocities (dof,), of a floating base its [v; ω] first."""
    first = robot.dof - len(robot.joint_names)
    if first and len(values) != robot.dof:
        raise UsageError(
            f"{robot.name} has {robot.dof} velocities, --qd has {len(values)} values; [v; ω] of the base,"
            f" then those of {', '.join(robot.joint_names) or 'no joint'}"
        )
    turns = [read_radians(value, degrees=degrees) for value in values[3:first]]
    joints = read_configuration(values[first:], robot, "--qd", degrees=degrees)
    return np.array([*values[: min(first, 3)], *turns, *joints])


def read_control(args: argparse.Namespace, robot: Robot, q: Array, T: Array | None) -> Any:
    """The controller that is typed, constant torques, or None."""
    from cspace.dynamics import PD

    first, n = robot.dof - len(robot.joint_names), len(robot.joint_names)
    if args.tau is not None:
        return np.concatenate([np.zeros(first), read_per_joint(args.tau, robot, "--tau")])
    if not args.hold and args.goal is None:
        if args.kp is not None or args.kd is not None:
            raise UsageError("--kp and --kd are gains of --hold or --goal; give one of these too")
        return None
    goal = q if args.hold else read_configuration(args.goal, robot, "--goal", degrees=args.deg)
    inertia = 1.0 / np.diagonal(np.linalg.inv(robot.mass_matrix(q, T_world_base=T)))[first:]
    kp = STIFFNESS**2 * inertia if args.kp is None else read_per_joint(args.kp, robot, "--kp")
    kd = 2.0 * STIFFNESS * inertia if args.kd is None else read_per_joint(args.kd, robot, "--kd")
    gains = np.broadcast_to(kp, n), np.broadcast_to(kd, n)
    return PD(goal, *gains, gravity_compensation=not robot.floating)  # what falls carries no weight


def read_per_joint(values: list[float], robot: Robot, option: str) -> Array:
    """One number for all joints, or one per joint; of torques always one per joint."""
    n = len(robot.joint_names)
    if len(values) != n and (len(values) != 1 or option == "--tau"):
        raise UsageError(
            f"{robot.name} has {n} joints, {option} has {len(values)} values; joints:"
            f" {', '.join(robot.joint_names)}"
        )
    return np.array(values)


def describe_simulation(robot: Robot, made: Simulation) -> dict[str, object]:
    """The answer as JSON data."""
    return {
        "schema": "cspace.simulate/1",
        "robot": robot.name,
        "joints": list(robot.joint_names),
        "method": made.method,
        "times": made.times.tolist(),
        "q": made.q.tolist(),
        "qd": made.qd.tolist(),
        "tau": made.tau.tolist(),
        "T_world_base": None if made.T_world_base is None else made.T_world_base.tolist(),
        "energy": made.energy.tolist(),
        "momentum": made.momentum.tolist(),
        "stopped": float(made.stopped),
        "ended": bool(made.ended),
        "reason": made.reason,
    }


def print_simulation(out: Output, robot: Robot, made: Simulation, *, degrees: bool) -> None:
    """Some states as a table, then the verdict."""
    base = ["x [m]", "y [m]", "z [m]"] if made.T_world_base is not None else []
    table = Table(["time [s]", *base, *joint_headings(robot), "energy [J]"])
    for k in np.unique(np.linspace(0, len(made) - 1, ROWS + 1).round().astype(int)):
        state = joint_texts(made.q[k], robot, degrees=degrees)
        if made.T_world_base is not None:
            state = [f"{tidy_number(x, 5):.5f}" for x in made.T_world_base[k, :3, 3]] + state
        table.add(f"{made.times[k]:.4g}", *state, f"{made.energy[k]:.6g}")
    out.table(table)
    out.line()
    out.facts({"method": made.method, "ended": made.reason})
