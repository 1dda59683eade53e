"""`cspace ik`: every joint configuration that reaches a pose."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_robot, number
from cspace.cli.exits import Exit
from cspace.cli.explain import add_explanation, explain, explanation_asked
from cspace.cli.files import check_writable
from cspace.cli.output import Cell, Output, Table
from cspace.cli.pictures import check_format
from cspace.cli.poses import add_goal, goal_of
from cspace.cli.robot import angle_unit, configuration, headings, joint_texts, load, need_chain

if TYPE_CHECKING:
    from cspace.robot import Robot

__all__ = ["EXAMPLES", "arguments", "run"]

EXAMPLES: Final = """
cspace ik ur5e --xyz 0.4 0.1 0.3 --rpy 0 180 0 --deg
cspace ik puma560 --xyz 0.5 0 0.3 --wxyz 0 1 0 0 --near 0 0 0 0 0 0 --plot puma.png
cspace ik planar_2r --xy 0.6 0.3 --limits drop --json
cspace ik ur5e --explain
cspace ik so101 --explain --asked position direction --tool-axis x --markdown
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_robot(parser)
    add_goal(parser)
    parser.add_argument(
        "--near",
        nargs="+",
        type=number,
        metavar="Q",
        help="a configuration; the nearest solution comes first",
    )
    parser.add_argument(
        "--limits",
        choices=("mark", "drop", "keep"),
        default="mark",
        help="mark what is out of limits (default), drop it, or keep all as they are",
    )
    add_explanation(parser)
    parser.add_argument("--plot", metavar="FILE", type=Path, help="write a picture (png, svg, pdf)")
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print one row per solution; no solution is a negative answer, with its reason."""
    if args.plot is not None:
        check_format(args.plot)
        check_writable(args.plot)
    robot = load(args)
    need_chain(robot)
    if explanation_asked(args):
        return explain(args, robot, out)
    T, point = goal_of(args)
    near = None if args.near is None else configuration(args.near, robot, "--near", degrees=args.deg)
    answer = solve(robot, T, point)
    if args.limits == "drop":
        answer = answer.within()
    counting = "all" if point is None else "linear"
    rows = Rows(robot, answer, near, check=args.limits != "keep", counting=counting)
    if out.as_json:
        out.document(document(robot, answer, rows, T, point))
    else:
        show(out, robot, answer, rows, degrees=args.deg)
    if answer and args.plot is not None:
        goal = point if T is None else T
        draw(args.plot, robot, rows, goal, title=title_of(robot, rows))
        out.hint(f"picture written to {args.plot}")
    return Exit.DONE if answer else Exit.NEGATIVE


def solve(robot: Any, T: Array | None, point: Array | None) -> Any:
    """The library's answer to a pose (4, 4) or to a point (2,) or (3,)."""
    return robot.ik(T) if point is None else robot.ik(position=point)


class Rows:
    """The solutions in the order of the table: as found, or the nearest to `near` first.

    q: (k, dof), each joint moved into its limits by whole turns where they are checked. branch: k labels.
    residual, singularity: (k,). out: per row the joints out of limits and by how much. distance: (k,) from
    `near`, or None.
    """

    def __init__(self, robot: Robot, answer: Any, near: Array | None, *, check: bool, counting: str) -> None:
        from cspace.ik.windings import into_limits
        from cspace.kinematics import distance_to_singularity

        q = np.asarray(answer.q, dtype=np.float64)
        if check:  # each joint where its limits are, if a whole turn brings it there
            limits = robot.limits
            q = into_limits(q, robot.joint_types, limits.lower, limits.upper)[0]
        self.distance: Array | None = None
        order = np.arange(len(q))
        if near is not None:
            turning = np.array([kind == "R" for kind in robot.joint_types])
            gap = q - near
            gap = np.where(turning, np.pi - np.mod(np.pi - gap, 2 * np.pi), gap)
            distance = np.linalg.norm(gap, axis=1)
            order = np.argsort(distance, kind="stable")
            self.distance = distance[order]
        self.q = q[order]
        self.branch = [str(answer.branch[k]) for k in order]
        self.residual = np.asarray(answer.residual)[order]
        out = answer.violations() if check else [{}] * len(q)
        self.out: list[dict[str, float]] = [out[k] for k in order]
        self.checked = check
        self.singularity = distance_to_singularity(robot, self.q, rows=counting)

    def __len__(self) -> int:
        return len(self.q)


def document(robot: Robot, answer: Any, rows: Rows, T: Array | None, point: Array | None) -> dict[str, Any]:
    """The answer as JSON data, [rad] and [m]."""
    solutions = [
        {
            "q": rows.q[k].tolist(),
            "branch": rows.branch[k],
            "within_limits": not rows.out[k] if rows.checked else None,
            "out_of_limits": rows.out[k],
            "singularity": float(rows.singularity[k]),
            "residual": float(rows.residual[k]),
            "distance": None if rows.distance is None else float(rows.distance[k]),
        }
        for k in range(len(rows))
    ]
    return {
        "schema": "cspace.ik/1",
        "robot": robot.name,
        "base": robot.base,
        "tip": robot.tip,
        "joints": list(robot.joint_names),
        "goal": {
            "matrix": None if T is None else T.tolist(),
            "position": None if point is None else point.tolist(),
        },
        "status": answer.status,
        "reason": answer.reason,
        "missing": float(answer.missing),
        "solutions": solutions,
    }


def show(out: Output, robot: Robot, answer: Any, rows: Rows, *, degrees: bool) -> None:
    """The answer for people: a table, or why there is none."""
    out.line(f"{robot.name}: {answer.reason}", style="bold" if answer else "yellow")
    if not len(rows):
        return
    near = [] if rows.distance is None else ["distance"]
    limits = ["limits"] if rows.checked else []
    columns = ["", *headings(robot), *limits, "singularity", "branch", "residual", *near]
    table = Table(columns, left=frozenset({columns.index("branch")} | {columns.index(c) for c in limits}))
    for k in range(len(rows)):
        cells: list[Cell | str] = [f"{k + 1}", *joint_texts(rows.q[k], robot, degrees=degrees)]
        if rows.checked:
            cells.append(limits_cell(rows.out[k], robot, degrees=degrees))
        cells += [f"{rows.singularity[k]:.4f}", rows.branch[k], f"{rows.residual[k]:.1e}"]
        if rows.distance is not None:
            cells.append(f"{rows.distance[k]:.4f}")
        table.add(*cells)
    out.table(table)
    names = ", ".join(
        f"{short} {name}" for short, name in zip(headings(robot), robot.joint_names, strict=True)
    )
    units = f"angles in {angle_unit(degrees)}" + (", slides in m" if "P" in robot.joint_types else "")
    out.hint(
        f"{units}; singularity: distance to the nearest singular configuration; residual: of the true pose"
    )
    if headings(robot) != list(robot.joint_names):
        out.hint(names)


def limits_cell(out_by: dict[str, float], robot: Robot, *, degrees: bool) -> Cell:
    """Whether a row is within limits, and which joints are not, by how much."""
    if not out_by:
        return Cell("ok", "green")
    texts = []
    short = dict(zip(robot.joint_names, headings(robot), strict=True))
    kinds = dict(zip(robot.joint_names, robot.joint_types, strict=True))
    for name, excess in out_by.items():
        size, unit, digits = excess, "m" if kinds[name] == "P" else "rad", 4
        if degrees and kinds[name] == "R":
            size, unit, digits = float(np.degrees(excess)), "deg", 2
        least = 10.0**-digits
        amount = f"< {least:g}" if size < 0.5 * least else f"{size:.{digits}f}"
        texts.append(f"{short[name]} out by {amount} {unit}")
    return Cell(", ".join(texts), "red")


def title_of(robot: Robot, rows: Rows) -> str:
    """The title of the picture."""
    if len(rows) == 1:
        return f"{robot.name}: one configuration reaches the goal"
    return f"{robot.name}: {len(rows)} configurations reach the goal"


def draw(path: Path, robot: Robot, rows: Rows, goal: Array | None, *, title: str) -> None:
    """Write the picture of all solutions, the first row within limits solid."""
    from cspace import plot

    order = sorted(range(len(rows)), key=lambda k: bool(rows.out[k]))
    labels = [f"{k + 1}  {rows.branch[k]}" + (" (out of limits)" if rows.out[k] else "") for k in order]
    within = [not rows.out[k] for k in order]
    plot.save(plot.solutions(robot, rows.q[order], goal, labels=labels, within=within, title=title), path)
