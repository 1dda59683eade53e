"""`cspace simulate`: the motion of a robot that is released or held, under gravity and friction."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_option, add_robot, read_number
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table, check_format, check_writable, tidy_number
from cspace.cli.robot import degrees_note, joint_texts, read_configuration
from cspace.cli.state import (
    Start,
    Units,
    add_acts,
    add_state,
    close_start,
    is_by_name,
    load_heavy,
    loop_words,
    read_acts,
    read_start,
    read_torques,
    read_typed,
    set_by_name,
)

if TYPE_CHECKING:
    from cspace.dynamics import Simulation
    from cspace.mechanisms import Mechanism
    from cspace.robot import Robot

EXAMPLES: Final = """
cspace simulate puma560 0 0 0 0 0 0 --duration 2
cspace simulate ur5e --pose up --duration 5 --dt 0.002 --method variational --plot fall.png
cspace simulate panda --pose ready --goal 0 0 0 -pi/2 0 pi/2 0 --duration 3 --payload 2
cspace simulate panda --pose ready --goal q4=-90 --qd q1=20 --deg
cspace simulate arm.urdf 0.1 0.2 --qd 1 0 --duration 1 --every 10 --json
cspace simulate panda --pose ready --floating --xyz 0 0 1 --rpy 0.3 0 0 --hold
"""

ROWS: Final = 10
"""How many steps of time a table shows."""

FEWEST: Final = 2
"""How many steps it shows where it is narrow."""

WIDTH: Final = 100
"""Columns of a table where there is no terminal."""

STIFFNESS: Final = 10.0
"""How fast each joint alone is to settle [1/s]: far below what steps of a millisecond can follow."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    add_state(parser, " at time zero")
    group = parser.add_mutually_exclusive_group()
    add_option(group, "--hold", "the joints are held where they start")
    text = "the joints are pulled to these values [rad, m, with --deg deg]; with JOINT=VALUE others are held"
    add_option(group, "--goal V…", text, read_typed)
    add_option(group, "--tau F…", "constant torques and forces of the joints [N·m, N]", read_typed)
    text = (
        "gains of --hold and --goal, one or one per joint [N·m/rad, N/m] (default: each joint alone settles"
        " at 10/s)"
    )
    add_option(parser, "--kp K…", text, read_number)
    add_option(parser, "--kd K…", "and those of velocity [N·m·s/rad, N·s/m]", read_number)
    add_option(parser, "--duration S", "how long [s] (default: 1)", read_number, default=1.0)
    add_option(parser, "--dt S", "the step [s] (default: 0.001)", read_number, default="1e-3")
    text = "how steps are computed (default: rk4, or variational if friction is stiff)"
    add_option(parser, "--method", text, choices=("rk4", "variational", "adaptive"))
    add_option(parser, "--every K", "record every K-th state (default: 1)", int, default=1)
    add_option(parser, "--stop-at-limits", "end where a joint passes one of its limits")
    add_acts(parser)
    text = "draw joints, velocities, torques and energies over time (.png, .svg, .pdf)"
    add_option(parser, "--plot FILE", text, Path)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the states over time, and how the motion ended."""
    if args.plot:
        check_writable(args.plot)
        check_format(args.plot)
    robot = load_heavy(args)
    start = read_start(args, robot)
    mechanism = None
    if robot.description.loops:
        refuse_for_loops(args, robot)
        mechanism, start = close_start(args, robot, start)
    made = run_motion(args, robot, start, mechanism)
    if args.plot:
        from cspace import plot

        plot.save(plot.simulation(made, robot=robot, degrees=args.deg), args.plot)
    if out.as_json:
        out.document(describe_simulation(robot, made) | {"written": [str(args.plot)] if args.plot else []})
    else:
        print_simulation(out, Units(robot, args.deg), start, made)
        if args.plot:
            out.line(f"wrote {args.plot}")
        out.hint(degrees_note(args, robot))
    return Exit.DONE if made else Exit.NEGATIVE


def refuse_for_loops(args: argparse.Namespace, robot: Robot) -> None:
    """Raise UsageError for options that simulations of closed loops do not know."""
    word = "--stop-at-limits" if args.stop_at_limits else f"--method {args.method}"
    if args.method != "rk4" or args.stop_at_limits:
        raise UsageError(f"{robot.name} has closed loops, which do not go with {word}; leave it out")


def run_motion(
    args: argparse.Namespace, robot: Robot, start: Start, mechanism: Mechanism | None
) -> Simulation:
    """The simulation, with closed loops that of the mechanism."""
    options: dict[str, Any] = {
        "control": read_control(args, robot, start.q, start.T_world_base),
        "duration": args.duration,
        "dt": args.dt,
        "every": args.every,
        "T_world_base": start.T_world_base,
        **read_acts(args),
    }
    if mechanism is not None:
        return mechanism.simulate(start.q, start.qd, **options)
    more = {"method": args.method, "stop_at_limits": args.stop_at_limits}
    return robot.simulate(start.q, start.qd, **options, **more)


def read_control(args: argparse.Namespace, robot: Robot, q: Array, T: Array | None) -> Any:
    """The controller that is typed, constant torques, or None."""
    from cspace.dynamics import PD

    first, n = robot.dof - len(robot.joint_names), len(robot.joint_names)
    if args.tau is not None:
        return read_torques(args.tau, robot, "--tau")
    if not args.hold and args.goal is None:
        if args.kp is not None or args.kd is not None:
            raise UsageError("--kp and --kd are gains of --hold or --goal; give one of these too")
        return None
    goal = q if args.hold else read_goal(args, robot, q)
    inertia = 1.0 / np.diagonal(np.linalg.inv(robot.mass_matrix(q, T_world_base=T)))[first:]
    kp = STIFFNESS**2 * inertia if args.kp is None else read_gains(args.kp, robot, "--kp")
    kd = 2.0 * STIFFNESS * inertia if args.kd is None else read_gains(args.kd, robot, "--kd")
    gains = np.broadcast_to(kp, n), np.broadcast_to(kd, n)
    return PD(goal, *gains, gravity_compensation=not robot.floating)  # what falls carries no weight


def read_goal(args: argparse.Namespace, robot: Robot, q: Array) -> Array:
    """The configuration (n,) of --goal; joints that are not named stay where they start."""
    if not is_by_name(args.goal, "--goal"):
        return read_configuration(args.goal, robot, "--goal", degrees=args.deg)
    goal = q.copy()
    set_by_name(goal, args.goal, robot, degrees=args.deg)
    return goal


def read_gains(values: list[float], robot: Robot, option: str) -> Array:
    """One number for all joints, or one per joint."""
    n = len(robot.joint_names)
    if len(values) not in (1, n):
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
        "loops": loop_words(robot),
    }


def print_simulation(out: Output, units: Units, start: Start, made: Simulation) -> None:
    """Some states as a table, then the verdict."""
    out.table(fit_table(out.width or WIDTH, units, made))
    out.line()
    facts = {"method": made.method}
    if start.words:
        facts["start"] = start.words
    loops = loop_words(units.robot)
    if loops:
        facts["closed loops"] = ", ".join(loops)
    out.facts(facts | {"ended": made.reason})


def fit_table(width: int, units: Units, made: Simulation) -> Table:
    """States as a table with a row per time; where this is too wide, with a column per time, for as many
    times as fit."""
    heads, cells = list_states(units, made, ROWS)
    table = Table(heads)
    for row in cells:
        table.add(*row)
    if table.width <= width:
        return table
    for rows in range(ROWS, FEWEST - 1, -1):
        heads, cells = list_states(units, made, rows)
        columns = list(zip(*cells, strict=True))
        names = [*heads[: len(heads) - 1 - len(units.robot.joint_names)], *long_names(units), heads[-1]]
        table = Table([heads[0], *columns[0]])
        for name, column in zip(names[1:], columns[1:], strict=True):
            table.add(name, *column)
        if table.width <= width:
            break
    return table


def long_names(units: Units) -> list[str]:
    """The names of the joints with their units."""
    kinds = units.robot.joint_types
    return [
        f"{name} [{units.angle if kind == 'R' else 'm'}]"
        for name, kind in zip(units.robot.joint_names, kinds, strict=True)
    ]


def list_states(units: Units, made: Simulation, rows: int) -> tuple[list[str], list[list[str]]]:
    """Headings, and the texts of states at so many steps of time."""
    base = ["base x [m]", "base y [m]", "base z [m]"] if made.T_world_base is not None else []
    cells = []
    for k in np.unique(np.linspace(0, len(made) - 1, rows + 1).round().astype(int)):
        state = joint_texts(made.q[k], units.robot, degrees=units.degrees)
        if made.T_world_base is not None:
            state = [f"{tidy_number(x, 5):.5f}" for x in made.T_world_base[k, :3, 3]] + state
        cells.append([f"{made.times[k]:.4g}", *state, f"{made.energy[k]:.6g}"])
    return ["time [s]", *base, *units.headings(), "energy [J]"], cells
