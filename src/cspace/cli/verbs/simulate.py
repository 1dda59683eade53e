"""`cspace simulate`: the motion of a robot that is released, under gravity and the friction of its joints."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from cspace.cli.arguments import add_chain, add_degrees, add_option, add_robot, read_angle, read_number
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table, check_format, check_writable
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
cspace simulate arm.urdf 0.1 0.2 --qd 1 0 --duration 1 --every 10 --json
"""

ROWS: Final = 10
"""How many steps of time a table shows."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "one value per joint at time zero [rad, m]; pi/2 or 90deg may be typed"
    parser.add_argument("q", metavar="Q", nargs="*", type=read_angle, help=text)
    add_option(parser, "--pose NAME", "a named pose of the robot instead of values, such as home")
    add_option(parser, "--qd V…", "the velocities at time zero [rad/s, m/s] (default: at rest)", read_angle)
    add_option(parser, "--duration S", "how long [s] (default: 1)", read_number, default=1.0)
    add_option(parser, "--dt S", "the step [s] (default: 0.001)", read_number, default="1e-3")
    text = "how steps are computed (default: rk4)"
    add_option(parser, "--method", text, choices=("rk4", "variational", "adaptive"), default="rk4")
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
    robot = load_chosen(args)
    if robot.floating:
        raise UsageError(f"the base of {robot.name} floats; simulate it from Python: robot.simulate(…)")
    q = read_posed(args, robot)
    rest = args.qd is None
    qd = np.zeros(robot.dof) if rest else read_configuration(args.qd, robot, "--qd", degrees=args.deg)
    made = robot.simulate(
        q,
        qd,
        duration=args.duration,
        dt=args.dt,
        method=args.method,
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
        "energy": made.energy.tolist(),
        "stopped": float(made.stopped),
        "ended": bool(made.ended),
        "reason": made.reason,
    }


def print_simulation(out: Output, robot: Robot, made: Simulation, *, degrees: bool) -> None:
    """Some states as a table, then the verdict."""
    table = Table(["time [s]", *joint_headings(robot), "energy [J]"])
    for k in np.unique(np.linspace(0, len(made) - 1, ROWS + 1).round().astype(int)):
        state = joint_texts(made.q[k], robot, degrees=degrees)
        table.add(f"{made.times[k]:.4g}", *state, f"{made.energy[k]:.6g}")
    out.table(table)
    out.line()
    out.facts({"method": made.method, "ended": made.reason})
