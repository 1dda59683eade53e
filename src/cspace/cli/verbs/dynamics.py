"""`cspace dynamics`: the torques of a motion, or the motion of torques."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_joints, add_option, add_robot, read_number
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table, tidy_number
from cspace.cli.robot import degrees_note, load_posed

if TYPE_CHECKING:
    from cspace.robot import Robot

EXAMPLES: Final = """
cspace dynamics panda --pose ready
cspace dynamics ur5e 0 -pi/2 pi/2 0 pi/2 0 --payload 2@tool0
cspace dynamics panda --pose ready --qd 0 1 0 0 0 0 0 --qdd 0 0 0 2 0 0 0
cspace dynamics planar_2r 0.3 0.4 --tau 0 0 --what mass --json
"""

MATRICES: Final = {"mass": "mass_matrix", "coriolis": "coriolis_matrix", "momentum": "momentum_matrix"}
"""What --what adds to the table, and its key in JSON."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    add_joints(parser)
    add_option(parser, "--qd Q…", "velocities of the joints [rad/s, m/s] (default: 0)", read_number)
    group = parser.add_mutually_exclusive_group()
    text = "accelerations of the joints [rad/s², m/s²] (default: 0); their torques are printed"
    add_option(group, "--qdd Q…", text, read_number)
    text = "torques and forces of the joints [N·m, N]; their accelerations are printed"
    add_option(group, "--tau F…", text, read_number)
    text = "a mass [kg] on a frame, by default the tip: 2 or 2@tool0"
    add_option(parser, "--payload MASS@FRAME", text, read_payload)
    add_option(parser, "--gravity X Y Z", "in the base [m/s²] (default: 0 0 -9.81)", read_number)
    add_option(parser, "--no-friction", "leave damping and dry friction of the joints out")
    add_option(parser, "--what", "a matrix besides the table", choices=tuple(MATRICES))
    add_degrees(parser)
    add_chain(parser)


def read_payload(text: str) -> tuple[float, str | None]:
    """A mass and where it is: 2, 2@tool0."""
    mass, _, frame = text.partition("@")
    return read_number(mass), frame or None


def run(args: argparse.Namespace, out: Output) -> int:
    """Print torques, or accelerations, and energies."""
    robot, q, _ = load_posed(args)
    if args.payload is not None:
        mass, frame = args.payload
        robot = robot.with_payload(mass, frame=frame)
    qd, qdd, tau = (read_row(getattr(args, name), robot, name) for name in ("qd", "qdd", "tau"))
    qd = np.zeros(robot.dof) if qd is None else qd
    laws: dict[str, Any] = {"friction": not args.no_friction}
    gravity = {"gravity": args.gravity} if args.gravity else {}
    if tau is not None:
        qdd = robot.forward_dynamics(q, qd, tau, **laws, **gravity)
    else:
        qdd = np.zeros(robot.dof) if qdd is None else qdd
        tau = robot.inverse_dynamics(q, qd, qdd, **laws, **gravity)
    numbers: dict[str, Any] = {
        "q": q,
        "qd": qd,
        "qdd": qdd,
        "tau": tau,
        "gravity_torques": robot.gravity_torques(q, **gravity),
        "mass_matrix": robot.mass_matrix(q),
        "coriolis_matrix": robot.coriolis_matrix(q, qd),
        "momentum": robot.centroidal_momentum(q, qd),
        "momentum_matrix": robot.centroidal_momentum_matrix(q),
        "center_of_mass": robot.center_of_mass(q),
        "kinetic_energy": robot.kinetic_energy(q, qd),
        "potential_energy": robot.potential_energy(q, **gravity),
    }
    warnings = [f"{fault.part}: {fault.fault}" for fault in robot.inertia_report().faults]
    if out.as_json:
        ends = {"robot": robot.name, "base": robot.base, "joints": list(robot.joint_names)}
        values = {name: np.asarray(value).tolist() for name, value in numbers.items()}
        out.document(
            {"schema": "cspace.dynamics/1", **ends, "mass": robot.mass, **values, "warnings": warnings}
        )
    else:
        print_motion(out, robot, numbers, warnings)
        if args.what:
            out.line()
            out.matrix(numbers[MATRICES[args.what]], MATRICES[args.what].replace("_", " "))
        out.hint(degrees_note(args, robot))
    return Exit.DONE


def read_row(values: list[float] | None, robot: Robot, subject: str) -> Array | None:
    """Typed values, one per joint."""
    if values is not None and len(values) != robot.dof:
        names = ", ".join(robot.joint_names)
        raise UsageError(
            f"{robot.name} has {robot.dof} joints, --{subject} has {len(values)} values; joints: {names}"
        )
    return None if values is None else np.array(values)


def print_motion(out: Output, robot: Robot, numbers: dict[str, Any], warnings: list[str]) -> None:
    """A row per joint, then what the whole robot has."""
    table = Table(["joint", "q", "qd", "qdd", "torque", "of gravity"])
    keys = ("q", "qd", "qdd", "tau", "gravity_torques")
    for name, *row in zip(robot.joint_names, *(numbers[key] for key in keys), strict=True):
        table.add(name, *(f"{tidy_number(x):.5g}" for x in row))
    out.table(table)
    out.line()
    center = "  ".join(f"{tidy_number(x):.4f}" for x in numbers["center_of_mass"])
    facts = {
        "mass": f"{robot.mass:.6g} kg",
        "centre of mass": f"{center} m",
        "kinetic energy": f"{numbers['kinetic_energy']:.6g} J",
        "potential energy": f"{numbers['potential_energy']:.6g} J",
    }
    if warnings:
        facts["inertias in doubt"] = "; ".join(warnings)
    out.facts(facts)
