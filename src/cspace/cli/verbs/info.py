"""`cspace info`: what a robot is."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.cli.arguments import add_chain, add_degrees, add_option, add_robot
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Output, Table
from cspace.cli.robot import gripper_note, load_chosen
from cspace.cli.state import loop_words

if TYPE_CHECKING:
    from cspace.robot import Robot


EXAMPLES: Final = """
cspace info ur5e
cspace info planar_2r --task position
cspace info arm.urdf --tip tool0 --json
"""
TASKS: Final[Mapping[str, int]] = MappingProxyType(
    {"pose": 6, "position": 3, "direction": 2, "planar": 3, "planar-position": 2}
)
"""A task and its numbers: planar is x, y and a heading; planar-position x and y."""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = f"the numbers a goal has: 1 to 6, or {', '.join(TASKS)} (default: as the arm's shape suggests)"
    add_option(parser, "--task TASK", text)
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the robot's data sheet."""
    robot = load_chosen(args)
    task = task_of(args.task, robot)
    facts = robot_document(robot, task)
    if out.as_json:
        out.document(facts)
    else:
        print_facts(out, robot, facts, gripper_note(args, robot), degrees=args.deg)
    return Exit.DONE


def default_task(robot: Robot) -> str:
    """The task that an arm's shape suggests: a planar arm's is planar, three joints place a point."""
    if robot.tip is None:
        return "pose"
    from cspace.plot.skeleton import planar_basis

    if planar_basis(robot.chain) is not None:
        return "planar" if robot.dof >= 3 else "planar-position"
    return "position" if robot.dof <= 3 else "pose"


def task_of(word: str | None, robot: Robot) -> tuple[str, int]:
    """The name of the task and how many numbers its goal has."""
    if word is None:
        word = default_task(robot)
    if word in TASKS:
        return word, TASKS[word]
    if word in set("123456"):
        return f"{word} numbers", int(word)
    raise UsageError(f"no task {word!r}; give a number from 1 to 6 or one of {', '.join(TASKS)}")


def robot_document(robot: Robot, task: tuple[str, int]) -> dict[str, Any]:
    """The data sheet as JSON data, [rad] and [m]; no limit is null."""
    from cspace.kinematics.manipulability import generic_rank
    from cspace.model import mobility, task_word, tree_freedoms

    known = robot.description.provenance
    sources = {group: {"source": s.source, "licence": s.licence} for group, s in known.sources.items()}
    rank = generic_rank(robot) if robot.tip is not None else None
    return {
        "schema": "cspace.info/1",
        "robot": robot.name,
        "title": known.title,
        "maker": known.vendor,
        "aliases": list(known.aliases),
        "sources": sources,
        "missing": list(known.missing),
        "base": robot.base,
        "tip": robot.tip,
        "leaves": list(robot.leaves),
        "joints": [joint_document(robot, k) for k in range(len(robot.joint_names))],
        "frames": list(robot.frames),
        "loops": loop_words(robot),
        "poses": {name: dict(values) for name, values in robot.description.poses.items()},
        "geometry": geometry_document(robot),
        "freedoms": {
            "dof": robot.dof,
            "description": tree_freedoms(robot.description),
            "mobility": mobility(robot.description),
            "rank": rank,
            "task": task[0],
            "task_numbers": task[1],
            "verdict": task_word(robot.dof, task[1]),
        },
    }


def joint_document(robot: Robot, k: int) -> dict[str, Any]:
    """One coordinate; limits that do not exist are null."""
    limits = robot.limits
    row: dict[str, Any] = {
        "name": robot.joint_names[k],
        "type": {"R": "revolute", "P": "prismatic"}[robot.joint_types[k]],
    }
    for name in ("lower", "upper", "velocity", "effort"):
        value = float(getattr(limits, name)[k])
        row[name] = value if np.isfinite(value) else None
    return row


def geometry_document(robot: Robot) -> dict[str, Any] | None:
    """Which closed form the inverse kinematics has, or which conditions failed; null for a tree."""
    if robot.tip is None:
        return None
    from cspace.ik import geometry

    found = geometry(robot)
    conditions = [
        {"text": c.text, "holds": bool(c.holds), "measured": float(c.measured), "allowed": float(c.allowed)}
        for c in found.conditions
    ]
    return {"family": found.family, "text": str(found), "closed_form": bool(found), "conditions": conditions}


def print_facts(out: Output, robot: Robot, facts: dict[str, Any], note: str, *, degrees: bool) -> None:
    """The data sheet for people."""
    out.heading(f"{robot.name}" + (f" — {facts['title']}" if facts["title"] else ""))
    freedoms, tip = facts["freedoms"], facts["tip"]
    lines = {"maker": facts["maker"], "also called": ", ".join(facts["aliases"])}
    groups: dict[str, list[str]] = {}
    for group, source in facts["sources"].items():
        text = source["source"] + (f" ({source['licence']})" if source["licence"] else "")
        groups.setdefault(text, []).append(group)
    lines |= {f"{', '.join(names)} from": text for text, names in groups.items()}
    lines["not published"] = ", ".join(facts["missing"])
    lines["base"] = facts["base"]
    lines["tip"] = (tip or f"not chosen; one of {', '.join(facts['leaves'])}") + (note and f" ({note})")
    lines["frames"] = ", ".join(facts["frames"])
    if facts["loops"]:
        lines["closed loops"] = (
            f"{', '.join(facts['loops'])}; kinematics and limits here are those of the tree"
        )
    lines["poses"] = ", ".join(facts["poses"])
    lines["geometry"] = facts["geometry"]["text"] if facts["geometry"] else ""
    lines["freedoms"] = freedom_text(freedoms)
    out.facts({name: value for name, value in lines.items() if value})
    out.line()
    out.table(joint_table(facts["joints"], degrees=degrees))


def freedom_text(freedoms: dict[str, Any]) -> str:
    """The degrees of freedom in a sentence."""
    task = f"{freedoms['task']} ({freedoms['task_numbers']} numbers)"
    text = f"{freedoms['dof']}; {freedoms['verdict']} for {task}"
    if freedoms["rank"] is not None and freedoms["rank"] != freedoms["dof"]:
        text += f"; the tip moves in {freedoms['rank']} of 6 dimensions"
    return text


def joint_table(joints: list[dict[str, Any]], *, degrees: bool) -> Table:
    """The joints and their limits."""
    angle = "deg" if degrees else "rad"
    table = Table(
        ["joint", "type", "lower", "upper", "velocity", "effort", "unit"], left=frozenset({0, 1, 6})
    )
    for joint in joints:
        turning = joint["type"] == "revolute"
        scale = float(np.degrees(1.0)) if turning and degrees else 1.0
        numbers = [limit_text(joint[name], scale) for name in ("lower", "upper", "velocity")]
        unit = f"{angle}, {angle}/s, N m" if turning else "m, m/s, N"
        table.add(joint["name"], joint["type"], *numbers, limit_text(joint["effort"], 1.0), unit)
    return table


def limit_text(value: float | None, scale: float) -> str:
    """A limit, or a dash where there is none."""
    return "-" if value is None else f"{value * scale:.6g}"
