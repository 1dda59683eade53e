"""Options that resolve redundancy: locked joints, the swivel, samples, the nearest configuration."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.arguments import add_option, named_number, read_angle, read_radians
from cspace.cli.exits import UsageError
from cspace.cli.robot import joint_called

if TYPE_CHECKING:
    from cspace.robot import Robot


FREEDOM_WORDS: Final = ("swivel", "samples", "near", "least_squares")
"""The options of these that do not affect how an arm is solved; locked joints do."""

GOAL_JOINT: Final = "goal_"
"""The beginning of the names of the motions that a partial goal leaves open."""


def add_freedom(parser: argparse.ArgumentParser) -> None:
    """Add the options for redundancy."""
    group = parser.add_argument_group("redundancy", "for redundant arms and partial goals")
    text = "joints locked at values; q7 is the seventh joint, whatever its name"
    add_option(group, "--locked JOINT=VALUE…", text, named_number, action="extend")
    add_option(group, "--swivel A", "angle of the elbow on its circle", read_angle)
    add_option(group, "--samples N", "the number of values of the redundant parameter (default: 16)", int)
    text = "a configuration: nearest solution first, or only it if the goal leaves degrees of freedom"
    add_option(group, "--near Q…", text, read_angle)
    text = "for unreachable goals: the configuration that comes closest"
    add_option(group, "--least-squares", text, default=None)


def options_of(args: argparse.Namespace, robot: Robot) -> dict[str, Any]:
    """The keywords of robot.ik for what was typed, `near` apart."""
    options: dict[str, Any] = {}
    if args.locked is not None:
        options["locked"] = locked_joints(args, robot)
    if args.swivel is not None:
        options["swivel"] = read_radians(args.swivel, degrees=args.deg)
    for name in ("samples", "least_squares"):
        if getattr(args, name) is not None:
            options[name] = getattr(args, name)
    return options


def locked_joints(args: argparse.Namespace, robot: Robot) -> dict[str, float]:
    """The joints of --locked by name, with their values [rad, m]."""
    locked: dict[str, float] = {}
    for word, value in args.locked:
        of_goal = word.startswith(GOAL_JOINT)  # judged by the library, which knows what the goal leaves open
        name = word if of_goal else joint_called(word, robot)
        if name in locked:
            raise UsageError(f"--locked names {name} twice; give each joint one value")
        turns = "turn" in name if of_goal else robot.joint_types[robot.joint_names.index(name)] == "R"
        locked[name] = read_radians(value, degrees=args.deg) if turns else value
    return locked
