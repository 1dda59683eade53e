"""`cspace space`: configuration spaces: exact ones of planar arms with two joints, with a path through them,
and slices, projections and volumes of any others."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.cli.arguments import (
    add_chain,
    add_degrees,
    add_option,
    add_robot,
    read_angle,
    read_length,
    read_number,
)
from cspace.cli.exits import Exit, UsageError
from cspace.cli.joint_space import add_joint_space, refuse_joint_space_options, run_joint_space
from cspace.cli.output import Output, Table, check_format, check_writable
from cspace.cli.robot import (
    degrees_note,
    joint_headings,
    joint_texts,
    load_chosen,
    need_chain,
    read_configuration,
)

if TYPE_CHECKING:
    from cspace.arrays import Array
    from cspace.planning import ConfigurationSpace, Connection
    from cspace.robot import Robot


EXAMPLES: Final = """
cspace space planar_2r --scene cell.toml --plot space.png
cspace space planar_2r --scene walls.txt --link-radius 0.05 --from 0 30 --to -1.2 1.25 --deg --plot way.png
cspace space arm.urdf --scene walls.geojson --from 0 0.5 --to-q 1.8 1.0 --json
cspace space panda --scene cell.toml
cspace space panda --scene cell.toml --joints 2,4 --at ready --plot slice.png
cspace space ur5e --scene cell.toml --joints shoulder_lift_joint,elbow_joint --samples 200 --plot shadow.png
"""

POLYGON_FILES: Final = {".txt", ".geojson"}
"""The endings of files that contain polygons; a file of another kind is a scene."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "a scene (.toml, .json, .scene), cut with the plane of the arm, or polygons (.txt, .geojson)"
    add_option(parser, "--scene FILE", text, Path)
    text = "everything within this distance of its axis belongs to a link [m] (default: 0)"
    add_option(parser, "--link-radius RADIUS", text, read_length)
    text = "the height of the plane in a scene [m] (default: that of the tip)"
    add_option(parser, "--height HEIGHT", text, read_length)
    add_option(parser, "--no-limits", "the joints rotate without limits")
    add_option(parser, "--from Q1 Q2", "a configuration where a path begins [rad]", read_angle, dest="start")
    goal = parser.add_mutually_exclusive_group()
    text = "a position in the plane [m]; each of its IK solutions is a goal"
    add_option(goal, "--to X Y", text, read_number)
    add_option(goal, "--to-q Q1 Q2", "a configuration as the goal [rad]", read_angle)
    add_option(parser, "--plot FILE", "draw the space (.png, .svg, .pdf)", Path)
    add_joint_space(parser)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the space of the robot: exact for a planar arm, unless two joints of it are asked for."""
    if args.plot:
        check_writable(args.plot)
        check_format(args.plot)
    robot = load_chosen(args)
    need_chain(robot)
    if args.joints is None and is_planar(robot):
        refuse_joint_space_options(args)
        return run_exact(args, out, robot)
    refuse_exact_options(args)
    return run_joint_space(args, out, robot)


def is_planar(robot: Robot) -> bool:
    """Whether the exact space of a robot is known."""
    from cspace.planning.two_joints.planar_arm import is_planar_arm

    return is_planar_arm(robot)


def refuse_exact_options(args: argparse.Namespace) -> None:
    """Refuse options of the exact space where another one is asked for."""
    for name in ("link_radius", "height", "start", "to", "to_q"):
        if getattr(args, name) is not None:
            option = "--from" if name == "start" else f"--{name.replace('_', '-')}"
            raise UsageError(
                f"{option} is for planar arms with two joints, without --joints; cspace plan finds paths of"
                " others"
            )


def run_exact(args: argparse.Namespace, out: Output, robot: Robot) -> int:
    """Print the components of the exact space, and the path if one is asked for."""
    from cspace.planning import configuration_space

    if args.scene is None:
        raise UsageError("the exact space of a planar arm needs obstacles: --scene FILE")
    if (args.to or args.to_q) and not args.start:
        raise UsageError("a path needs its start: --from Q1 Q2")
    radius = args.link_radius or 0.0
    space = configuration_space(
        robot,
        load_obstacles(args.scene),
        link_radius=radius,
        limits=not args.no_limits,
        height=args.height,
    )
    start = read_start(args, robot)
    goals, reason = find_goals(args, robot, space)
    way = space.path(start, goals) if start is not None and len(goals) else None
    if args.plot:
        from cspace import plot

        plot.save(plot.configuration_space(space, start=start, goals=goals, path=way), args.plot)
    document = describe_space(space, start, goals, way)
    if reason:
        document |= {"status": "unreachable", "reason": reason}
    if out.as_json:
        written = [str(args.plot)] if args.plot else []
        given = {"robot": robot.name, "scene": str(args.scene), "link_radius": radius}
        out.document({"schema": "cspace.space/1", **given, **document, "written": written})
    else:
        print_space(out, robot, space, document, way, degrees=args.deg)
        if args.plot:
            out.line(f"wrote {args.plot}")
        out.hint(degrees_note(args, robot))
    asked = bool(args.to or args.to_q)
    return Exit.DONE if way or not asked else Exit.NEGATIVE


def load_obstacles(path: Path) -> Any:
    """The scene or the polygons of a file, by its ending."""
    from cspace.collision import Scene
    from cspace.maps import PolygonWorld

    ending = path.suffix.lower()
    if ending not in POLYGON_FILES:
        return Scene.load(path)
    return PolygonWorld.from_text(path) if ending == ".txt" else PolygonWorld.from_geojson(path)


def read_start(args: argparse.Namespace, robot: Robot) -> Array | None:
    """The start as typed, if there is one."""
    if args.start is None:
        return None
    return read_configuration(args.start, robot, "--from", degrees=args.deg)


def find_goals(args: argparse.Namespace, robot: Robot, space: ConfigurationSpace) -> tuple[Array, str]:
    """The goals (k, 2), and why there are none: a configuration, or every solution of a position that is
    within the limits."""
    if args.to_q is not None:
        return read_configuration(args.to_q, robot, "--to-q", degrees=args.deg)[None], ""
    if args.to is None:
        return np.empty((0, 2)), ""
    arm = space.arm
    position = np.asarray(args.to) @ arm.axes + arm.height * arm.normal
    solutions = robot.ik(position=position)
    found = solutions if args.no_limits else solutions.within(robot.limits)
    return np.asarray(found.q).reshape(-1, 2), "" if found else found.reason


def describe_space(
    space: ConfigurationSpace, start: Array | None, goals: Array, way: Connection | None
) -> dict[str, Any]:
    """The answers as JSON data."""
    components = [
        {
            "area": each.area,
            "area_bounds": list(each.area_bounds),
            "point": each.point.tolist(),
            "region": each.region,
            "proved": each.proved,
        }
        for each in space.components
    ]
    return {
        "obstacles": list(space.obstacles),
        "lower": space.lower.tolist(),
        "upper": space.upper.tolist(),
        "wraps": [bool(wrap) for wrap in space.wraps],
        "components": components,
        "boundaries": [
            {"kind": curve.kind, "obstacle": curve.obstacle, "points": curve.points.tolist()}
            for curve in space.boundaries
        ],
        "start": None if start is None else start.tolist(),
        "goals": goals.tolist(),
        "status": None if way is None else way.status,
        "reason": None if way is None else way.reason,
        "path": [] if way is None else way.path.tolist(),
        "length": None if not way else way.length,
    }


def print_space(
    out: Output,
    robot: Robot,
    space: ConfigurationSpace,
    document: dict[str, Any],
    way: Connection | None,
    *,
    degrees: bool,
) -> None:
    """The components as a table, then the path."""
    unit = "deg" if degrees else "rad"
    names = joint_headings(robot)
    table = Table(["component", "area [rad²]", *(f"{name} [{unit}]" for name in names), "proved"])
    for number, each in enumerate(space.components):
        place = joint_texts(each.point, robot, degrees=degrees)
        table.add(str(number), f"{each.area:.4f}", *place, "yes" if each.proved else "no")
    count = len(space.boundaries)
    out.line(f"{len(space.components)} free components, {count} curves on their boundary")
    if space.components:
        out.table(table)
    if document["reason"]:
        out.sentence(document["reason"])
    elif document["start"] is not None:
        component = space.component(document["start"])
        out.line(f"the start lies in component {'-' if component is None else component}")
    if way:
        out.line(f"{len(way.path)} points, {way.length:.4f} rad")
        path = Table(names)
        for row in way.path:
            path.add(*joint_texts(row, robot, degrees=degrees))
        out.table(path)
