"""`cspace dynamics`: the torques of a motion, or the motion of torques."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.cli.arguments import add_chain, add_degrees, add_option, add_robot
from cspace.cli.exits import Exit
from cspace.cli.output import Output, Table, check_format, check_writable
from cspace.cli.robot import degrees_note
from cspace.cli.state import (
    Start,
    Units,
    add_acts,
    add_state,
    close_start,
    load_heavy,
    loop_words,
    read_acts,
    read_rates,
    read_start,
    read_torques,
    read_typed,
    show_number,
)

if TYPE_CHECKING:
    from cspace.dynamics import OperationalSpace
    from cspace.mechanisms import Mechanism
    from cspace.robot import Robot

EXAMPLES: Final = """
cspace dynamics panda --pose ready
cspace dynamics ur5e 0 -90 90 0 90 0 --qd shoulder_pan_joint=90 --deg --payload 2@tool0
cspace dynamics panda --qd 0 1 0 0 0 0 0 --qdd q4=2 --wrench panda_link8 0 0 -20 0 0 0
cspace dynamics panda --pose ready --floating --xyz 0 0 1 --frame panda_link8 --what mass coriolis
cspace dynamics planar_2r 0.3 0.4 --tau 0 0 --what mass --json
"""

MATRICES: Final = {"mass": "mass_matrix", "coriolis": "coriolis_matrix", "momentum": "momentum_matrix"}
"""What --what adds to the table, and its key in JSON."""

WIDTH: Final = 100
"""Columns of a table where there is no terminal."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    add_state(parser, "")
    group = parser.add_mutually_exclusive_group()
    text = "accelerations [rad/s², m/s², with --deg deg/s²] (default: 0); their torques are printed"
    add_option(group, "--qdd V…", text, read_typed)
    text = "torques and forces of the joints [N·m, N]; their accelerations are printed"
    add_option(group, "--tau F…", text, read_typed)
    add_acts(parser)
    text = "also print the inertia that forces at this frame feel (operational space)"
    add_option(parser, "--frame LINK", text)
    text = "matrices besides the table, one or several"
    add_option(parser, "--what", text, choices=tuple(MATRICES), nargs="+", action="extend", default=[])
    add_option(parser, "--plot FILE", "draw what the torques are made of (.png, .svg, .pdf)", Path)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print torques, or accelerations, and energies."""
    if args.plot:
        check_writable(args.plot)
        check_format(args.plot)
    robot = load_heavy(args)
    start, mechanism = read_start(args, robot), None
    if robot.description.loops:
        mechanism, start = close_start(args, robot, start)
    numbers = compute_motion(args, robot, start, mechanism)
    felt = None
    if args.frame is not None:
        felt = robot.operational_space(start.q, args.frame, T_world_base=start.T_world_base)
    warnings = list_warnings(robot, is_driven=args.tau is not None)
    if args.plot:
        draw_torques(args, robot, start, numbers)
    if out.as_json:
        out.document(describe_motion(args, robot, start, numbers, felt, warnings))
        return Exit.DONE
    units = Units(robot, args.deg)
    out.table(motion_table(out, units, start, numbers))
    out.line()
    out.facts(list_facts(robot, start, numbers, felt, warnings))
    for what in args.what:
        out.line()
        out.matrix(numbers[MATRICES[what]], MATRICES[what].replace("_", " ") + " [SI units]")
    if felt is not None:
        out.line()
        out.matrix(felt.inertia, f"inertia felt at {felt.frame} [kg, kg·m, kg·m²]")
    if args.plot:
        out.line(f"wrote {args.plot}")
    out.hint(degrees_note(args, robot))
    return Exit.DONE


def compute_motion(
    args: argparse.Namespace, robot: Robot, start: Start, mechanism: Mechanism | None
) -> dict[str, Any]:
    """The numbers of the answer by their keys in JSON."""
    q, qd = start.q, start.qd
    place: dict[str, Any] = {"T_world_base": start.T_world_base}
    acts = read_acts(args)
    down = {"gravity": acts["gravity"]} if "gravity" in acts else {}
    if args.tau is not None:
        tau = read_torques(args.tau, robot, "--tau")
        qdd = (mechanism or robot).forward_dynamics(q, qd, tau, **acts, **place)
    else:
        qdd = read_rates(args.qdd, robot, "--qdd", degrees=args.deg)
        tau = robot.inverse_dynamics(q, qd, qdd, **acts, **place)
    return {
        "q": q,
        "qd": qd,
        "qdd": qdd,
        "tau": tau,
        "gravity_torques": robot.gravity_torques(q, **down, **place),
        "mass_matrix": robot.mass_matrix(q, **place),
        "coriolis_matrix": robot.coriolis_matrix(q, qd, **place),
        "momentum": robot.centroidal_momentum(q, qd, **place),
        "momentum_matrix": robot.centroidal_momentum_matrix(q, **place),
        "center_of_mass": robot.center_of_mass(q, **place),
        "kinetic_energy": robot.kinetic_energy(q, qd, **place),
        "potential_energy": robot.potential_energy(q, **down, **place),
    }


def list_warnings(robot: Robot, *, is_driven: bool) -> list[str]:
    """Bodies that cannot be, and closed loops that do not count."""
    faults = [fault for fault in robot.inertia_report().faults if not fault.hint]
    warnings = [f"{fault.part}: {fault.fault}" for fault in faults]
    if robot.description.loops and not is_driven:
        warnings.append(
            "torques and matrices are those of the tree, with its loops cut; cs.Mechanism(robot) has those of"
            " the mechanism"
        )
    return warnings


def draw_torques(args: argparse.Namespace, robot: Robot, start: Start, numbers: dict[str, Any]) -> None:
    """Write the picture."""
    from cspace import plot

    acts, place = read_acts(args), start.T_world_base
    artists = plot.torques(robot, start.q, start.qd, numbers["qdd"], T_world_base=place, **acts)
    plot.save(artists, args.plot)


def describe_motion(
    args: argparse.Namespace,
    robot: Robot,
    start: Start,
    numbers: dict[str, Any],
    felt: OperationalSpace | None,
    warnings: list[str],
) -> dict[str, Any]:
    """The answer as JSON data, in SI units."""
    return {
        "schema": "cspace.dynamics/1",
        "robot": robot.name,
        "base": robot.base,
        "joints": list(robot.joint_names),
        "mass": robot.mass,
        **{name: np.asarray(value).tolist() for name, value in numbers.items()},
        "T_world_base": start.T_world_base,
        "frame": None if felt is None else felt.frame,
        "operational_inertia": None if felt is None else felt.inertia,
        "loops": loop_words(robot),
        "warnings": warnings,
        "written": [str(args.plot)] if args.plot else [],
    }


def motion_table(out: Output, units: Units, start: Start, numbers: dict[str, Any]) -> Table:
    """A row per joint, those of a floating base first; without rates that are zero where it is too wide."""
    robot, scale = units.robot, units.scale
    first = robot.dof - len(robot.joint_names)
    place = np.zeros(3) if start.T_world_base is None else start.T_world_base[:3, 3]
    q = [*map(show_number, place), "", "", ""][:first]
    q += [show_number(x) for x in numbers["q"] * scale[first:]]
    columns = {f"q [{units.word()}]": q}
    for name, per in (("qd", "/s"), ("qdd", "/s²")):
        columns[f"{name} [{units.word(per)}]"] = [show_number(x) for x in numbers[name] * scale]
    for name, key in (("torque", "tau"), ("gravity torque", "gravity_torques")):
        columns[f"{name} [{units.effort}]"] = [show_number(x) for x in numbers[key]]
    table = make_table(units, columns)
    if table.width > (out.width or WIDTH):
        still = [name for name, cells in columns.items() if name.startswith("qd") and set(cells) == {"0"}]
        table = make_table(units, {name: cells for name, cells in columns.items() if name not in still})
    return table


def make_table(units: Units, columns: dict[str, list[str]]) -> Table:
    """A table of columns by their heads, with the types of the joints where they differ."""
    types = {"R": "revolute", "P": "prismatic"}
    mixed = len(set(units.kinds)) > 1
    lead = ["joint", "type"] if mixed else ["joint"]
    table = Table([*lead, *columns], left=frozenset(range(len(lead))))
    first = len(units.names) - len(units.robot.joint_names)
    for k, (name, kind) in enumerate(zip(units.names, units.kinds, strict=True)):
        word = [types[kind] if k >= first else "floating"] if mixed else []
        table.add(name, *word, *(cells[k] for cells in columns.values()))
    return table


def list_facts(
    robot: Robot,
    start: Start,
    numbers: dict[str, Any],
    felt: OperationalSpace | None,
    warnings: list[str],
) -> dict[str, str]:
    """What the whole robot has, as names and texts."""
    facts = {"configuration": start.words} if start.words else {}
    center = "  ".join(f"{x:.4f}" for x in np.round(numbers["center_of_mass"], 4) + 0.0)
    facts |= {
        "mass": f"{robot.mass:.6g} kg",
        "centre of mass": f"{center} m",
        "kinetic energy": f"{numbers['kinetic_energy']:.6g} J",
        "potential energy": f"{numbers['potential_energy']:.6g} J",
    }
    if felt is not None:
        masses = "  ".join(show_number(felt.effective_mass(axis)) for axis in np.eye(3))
        lost = f"; {len(felt.lost)} of 6 directions lost" if len(felt.lost) else ""
        facts[f"mass felt at {felt.frame}"] = f"{masses} kg along x, y, z{lost}"
    if robot.description.loops:
        facts["closed loops"] = ", ".join(loop_words(robot))
    if warnings:
        facts["warnings"] = "; ".join(warnings)
    return facts
