"""The part of `cspace space` for any robot: slices, projections and volumes of its configuration space."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.arguments import add_option, read_length, read_seed, split_numbers
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table
from cspace.cli.progress import show_progress
from cspace.cli.robot import degrees_note, joint_called, read_configuration

if TYPE_CHECKING:
    from cspace.arrays import Array
    from cspace.planning import JointSpace, Projection, Slice, Volume
    from cspace.robot import Robot

SAMPLES: Final = 100_000
"""Samples of a volume: a standard error below 0.2 %."""
SLICE_SIZE: Final = 256
"""Cells of a slice along each joint, unless another number is given."""
PROJECTION_SIZE: Final = 64
"""The same of a projection."""
OWN: Final = ("at", "size", "samples", "margin", "geometry", "spheres")
"""The options of this part but --joints, as argparse names them."""


def add_joint_space(parser: argparse.ArgumentParser) -> None:
    """The words of slices, projections and volumes."""
    group = parser.add_argument_group("robots of any kind")
    text = "the plane of two joints, by name or place: 1 4 are the first and the fourth"
    add_option(group, "--joints JOINT…", text, str)
    text = "where the other joints are held: a value per joint, or a named pose (default: mid-range)"
    add_option(group, "--at Q…", text, str)
    add_option(group, "--size N", "cells along each joint (default: 256, of projections 64)", int)
    text = "with --joints: project onto them, over N samples of the other joints; without: of the volume"
    add_option(group, "--samples N", text, int)
    add_option(group, "--seed N", "the seed of the samples (default: 0)", read_seed, default=0)
    text = "what stands for the robot: its collision elements (default), or capsules along the arm"
    add_option(group, "--geometry", text, choices=("collision", "skeleton"))
    add_option(group, "--spheres FILE", "spheres for the links (.json, .toml, .urdf) instead", Path)
    add_option(group, "--margin LENGTH", "everything keeps so far away: 0.005, or 5mm", read_length)


def refuse_joint_space_options(args: argparse.Namespace) -> None:
    """Refuse options of this part where the exact space of a planar arm is printed."""
    for name in OWN:
        if getattr(args, name) is not None:
            raise UsageError(
                f"--{name} needs --joints with two joints, since the space of a planar arm is exact"
            )


def run_joint_space(args: argparse.Namespace, out: Output, robot: Robot) -> int:
    """Print a slice, a projection, or the free share of the whole space."""
    space = make_space(args, robot)
    joints = read_joints(args.joints, robot)
    if joints is None:
        for name in ("at", "size", "plot"):
            if getattr(args, name) is not None:
                raise UsageError(f"--{name} needs --joints with two joints")
        with show_progress("sampling the configuration space"):
            volume = space.volume(or_default(args.samples, SAMPLES), rng=args.seed)
        answer = {"volume": describe_volume(volume)}
    else:
        answer = describe_plane(args, space, robot, joints)
    written = [str(args.plot)] if args.plot else []
    if out.as_json:
        out.document(describe_space(args, space, robot) | answer | {"written": written})
        return Exit.DONE
    print_answer(out, answer)
    for path in written:
        out.line(f"wrote {path}")
    if args.at is not None and (values := split_numbers(args.at, "--at")) is not None:
        out.hint(degrees_note(args, robot, values))
    return Exit.DONE


def make_space(args: argparse.Namespace, robot: Robot) -> JointSpace:
    """The space of the robot in the scene of the words."""
    from cspace.collision import Scene
    from cspace.planning import JointSpace

    if args.spheres is not None:
        if args.geometry is not None:
            raise UsageError("--spheres and --geometry both give the geometry of the robot: leave one out")
        robot = robot.with_spheres(args.spheres)
    scene = None if args.scene is None else Scene.load(args.scene)
    with show_progress("covering the robot by spheres"):
        return JointSpace(robot, scene, margin=args.margin or 0.0, limits=not args.no_limits)


def read_joints(typed: list[str] | None, robot: Robot) -> tuple[int, int] | None:
    """Two joints, typed by name, by heading (q4) or by place, which counts from 1; commas separate too."""
    if typed is None:
        return None
    words = [word.strip() for part in typed for word in part.split(",")]
    if len(words) != 2:
        raise UsageError(f"--joints takes two joints, such as 1 4 or two names; {len(words)} are given")
    first, second = (read_joint(word, robot) for word in words)
    if first == second:
        raise UsageError(f"--joints names {robot.joint_names[first]!r} twice; give two different joints")
    return first, second


def read_joint(word: str, robot: Robot) -> int:
    """The number of one typed joint."""
    if not re.fullmatch(r"\d{1,4}", word, re.ASCII):
        return robot.joint_names.index(joint_called(word, robot))
    if not 1 <= int(word) <= len(robot.joint_names):
        raise UsageError(f"--joints has joint {word}; {robot.name} has joints 1 to {len(robot.joint_names)}")
    return int(word) - 1


def read_place(args: argparse.Namespace, robot: Robot) -> Array | None:
    """Where the joints are held, as typed or as a named pose."""
    if args.at is None:
        return None
    values = split_numbers(args.at, "--at")
    if values is None:
        return robot.named_poses[args.at[0].strip()]
    return read_configuration(values, robot, "--at", degrees=args.deg)


def describe_plane(
    args: argparse.Namespace, space: JointSpace, robot: Robot, joints: tuple[int, int]
) -> dict[str, Any]:
    """A slice or a projection as JSON data; its picture is drawn."""
    at = read_place(args, robot)
    if args.samples is None:
        with show_progress("computing a slice"):
            part = space.slice(joints, at=at, size=or_default(args.size, SLICE_SIZE))
        draw_picture(args.plot, "space_slice", part)
        return {"slice": describe_slice(part)}
    with show_progress("computing a projection"):
        size = or_default(args.size, PROJECTION_SIZE)
        shadow = space.project(joints, size=size, samples=args.samples, including=at, rng=args.seed)
    draw_picture(args.plot, "space_projection", shadow, q=at)
    return {"projection": describe_projection(shadow)}


def or_default(given: int | None, otherwise: int) -> int:
    """The number that was typed, or another one."""
    return otherwise if given is None else given


def draw_picture(path: Path | None, kind: str, part: Any, **options: Any) -> None:
    """Draw a slice or a projection into a file, if there is one."""
    if path is not None:
        from cspace import plot

        plot.save(getattr(plot, kind)(part, **options), path)


def describe_space(args: argparse.Namespace, space: JointSpace, robot: Robot) -> dict[str, Any]:
    """What was asked, as JSON data."""
    return {
        "schema": "cspace.joint_space/1",
        "robot": robot.name,
        "scene": None if args.scene is None else str(args.scene),
        "margin": space.margin,
        "joints": list(space.joint_names),
        "lower": space.lower,
        "upper": space.upper,
        "wraps": space.wraps.tolist(),
        "obstacles": list(space.obstacles),
        "seed": args.seed,
        "volume": None,
        "slice": None,
        "projection": None,
    }


def describe_volume(volume: Volume) -> dict[str, Any]:
    """A volume as JSON data."""
    return {
        "share": volume.share,
        "standard_error": volume.standard_error,
        "interval": list(volume.interval),
        "self_share": volume.self_share,
        "obstacle_share": volume.obstacle_share,
        "limit_share": volume.limit_share,
        "size": volume.size,
        "samples": volume.samples,
    }


def describe_slice(part: Slice) -> dict[str, Any]:
    """A slice as JSON data."""
    found = part.obstacle_map
    shares = {name: float((found == k).mean()) for k, name in enumerate(part.obstacles)}
    return {
        "joints": list(part.joint_names),
        "at": part.at,
        "size": list(part.bitmap.shape),
        "free_share": part.free_share,
        "free_bounds": list(part.free_bounds),
        "proved": part.proved,
        "blocked": {name: share for name, share in shares.items() if share},
    }


def describe_projection(part: Projection) -> dict[str, Any]:
    """A projection as JSON data."""
    return {
        "joints": list(part.joint_names),
        "size": list(part.share.shape),
        "samples": part.samples,
        "can_be_free": float(part.is_free.mean()),
        "share": part.share,
    }


def print_answer(out: Output, answer: dict[str, Any]) -> None:
    """The answer in words."""
    if "volume" in answer:
        print_volume(out, answer["volume"])
    elif "slice" in answer:
        print_slice(out, answer["slice"])
    else:
        part = answer["projection"]
        out.line(
            f"{' and '.join(part['joints'])}: {part['can_be_free']:.2%} of the cells can be free, by"
            f" {part['samples']} samples of the other joints"
        )


def print_volume(out: Output, volume: dict[str, Any]) -> None:
    """The free share of the space, and what blocks the rest."""
    low, high = volume["interval"]
    out.facts(
        {
            "free": f"{volume['share']:.2%}, with 95 % confidence {low:.2%} to {high:.2%}",
            "touches itself": f"{volume['self_share']:.2%}",
            "touches obstacles": f"{volume['obstacle_share']:.2%}",
            "left by limits": f"{volume['limit_share']:.2%} of a turn of each joint",
            "samples": f"{volume['samples']}",
        }
    )


def print_slice(out: Output, part: dict[str, Any]) -> None:
    """The free share of a slice, and the share of what blocks."""
    low, high = part["free_bounds"]
    out.line(
        f"{' and '.join(part['joints'])}: {part['free_share']:.2%} free; {part['proved']:.2%} of"
        f" {part['size'][0]} x {part['size'][1]} cells are proved, between {low:.2%} and {high:.2%} is free"
    )
    if part["blocked"]:
        table = Table(["blocked by", "share of the cells"])
        for name, share in part["blocked"].items():
            table.add(name, f"{share:.2%}")
        out.table(table)
