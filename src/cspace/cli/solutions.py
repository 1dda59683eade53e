"""The solutions of `cspace ik`: their order, the table, the document."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.goals import Goal
from cspace.cli.output import Cell, Output, Table
from cspace.cli.robot import joint_headings, joint_texts
from cspace.cli.tasks import singularity_of_rows

if TYPE_CHECKING:
    from cspace.robot import Robot


RADIANS: Final = re.compile(r"(\d[\d.e+-]*) rad\b")
"""An angle in a sentence of the library."""


class Rows:
    """The solutions in the order of the table: as found, or the nearest to `near` first.

    q: (k, dof), each joint moved into its limits by multiples of 2π if they are checked. branch: k labels.
    residual: (k,). out: per row the joints out of limits and by how much. singularity: (k,), of the rows of
    the Jacobian that are `counting`, or None where the arm moves in none of them. distance: (k,) from `near`,
    or None.
    """

    def __init__(
        self, robot: Robot, answer: Any, near: Array | None, *, check: bool, counting: str | Iterable[str]
    ) -> None:
        from cspace.ik.wrapping import into_limits, short_way

        q = np.asarray(answer.q, dtype=np.float64)
        if check:  # each joint inside its limits, if a multiple of 2π brings it there
            limits = robot.limits
            q = into_limits(answer._settled(limits), robot.joint_types, limits.lower, limits.upper)[0]
        self.distance: Array | None = None
        order = np.arange(len(q))
        if near is not None:
            distance = np.linalg.norm(short_way(q - near, robot.joint_types), axis=1)
            order = np.argsort(distance, kind="stable")
            self.distance = distance[order]
        self.q = q[order]
        self.branch = [str(answer.branch[k]) for k in order]
        self.residual = np.asarray(answer.residual)[order]
        out = answer.violations() if check else [{}] * len(q)
        self.out: list[dict[str, float]] = [out[k] for k in order]
        self.checked = check
        self.singularity = singularity_of_rows(robot, self.q, counting)

    def __len__(self) -> int:
        return len(self.q)


def solutions_document(
    robot: Robot, answer: Any, rows: Rows, goal: Goal, options: dict[str, Any]
) -> dict[str, Any]:
    """The solutions as JSON data, [rad] and [m]."""
    solutions = [
        {
            "q": rows.q[k].tolist(),
            "branch": rows.branch[k],
            "within_limits": not rows.out[k] if rows.checked else None,
            "out_of_limits": rows.out[k],
            "singularity": None if rows.singularity is None else float(rows.singularity[k]),
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
        "goal": goal.document(),
        "locked": options.get("locked", {}),
        "swivel": options.get("swivel"),
        "status": answer.status,
        "complete": answer.complete,
        "reason": answer.reason,
        "out_of_reach": float(answer.out_of_reach),
        "freedom": list(answer.freedom),
        "solutions": solutions,
    }


def print_solutions(out: Output, robot: Robot, answer: Any, rows: Rows, *, degrees: bool) -> None:
    """The solutions as a table, or the reason why there are none."""
    reason = answer.reason.replace("least_squares=True", "--least-squares")
    reason = in_degrees(reason) if degrees else reason
    out.line(f"{robot.name}: {reason}", style="bold" if answer else "yellow")
    if not len(rows):
        return
    out.table(table_of(robot, rows, degrees=degrees))
    names = ", ".join(
        f"{short} {name}" for short, name in zip(joint_headings(robot), robot.joint_names, strict=True)
    )
    units = f"angles in {'deg' if degrees else 'rad'}" + (", slides in m" if "P" in robot.joint_types else "")
    if rows.singularity is not None:
        units += "; singularity: distance to the nearest singular configuration"
    out.hint(f"{units}; residual: of the true pose")
    if joint_headings(robot) != list(robot.joint_names):
        out.hint(names)


def in_degrees(sentence: str) -> str:
    """A sentence of the library with its angles in degrees."""
    return RADIANS.sub(lambda angle: f"{np.degrees(float(angle[1])):.4g} deg", sentence)


def table_of(robot: Robot, rows: Rows, *, degrees: bool) -> Table:
    """One row per solution, without empty columns."""
    texts = [joint_texts(q, robot, degrees=degrees) for q in rows.q]
    columns: list[tuple[str, Iterable[Cell | str]]] = [("", [f"{k + 1}" for k in range(len(rows))])]
    columns += zip(joint_headings(robot), zip(*texts, strict=True), strict=True)
    if rows.checked:
        columns.append(("limits", [limits_cell(out, robot, degrees=degrees) for out in rows.out]))
    if rows.singularity is not None:
        columns.append(("singularity", [f"{value:.4f}" for value in rows.singularity]))
    if any(rows.branch):
        columns.append(("branch", rows.branch))
    columns.append(("residual", [f"{value:.1e}" for value in rows.residual]))
    if rows.distance is not None:
        columns.append(("distance", [f"{value:.4f}" for value in rows.distance]))
    left = frozenset(j for j, (name, _) in enumerate(columns) if name in ("limits", "branch"))
    table = Table([name for name, _ in columns], left=left)
    for cells in zip(*(column for _, column in columns), strict=True):
        table.add(*cells)
    return table


def limits_cell(out_by: dict[str, float], robot: Robot, *, degrees: bool) -> Cell:
    """Whether a row is within limits, and which joints are not, by how much."""
    if not out_by:
        return Cell("ok", "green")
    texts = []
    short = dict(zip(robot.joint_names, joint_headings(robot), strict=True))
    kinds = dict(zip(robot.joint_names, robot.joint_types, strict=True))
    for name, excess in out_by.items():
        size, unit, digits = excess, "m" if kinds[name] == "P" else "rad", 4
        if degrees and kinds[name] == "R":
            size, unit, digits = float(np.degrees(excess)), "deg", 2
        least = 10.0**-digits
        amount = f"< {least:g}" if size < 0.5 * least else f"{size:.{digits}f}"
        texts.append(f"{short[name]} out by {amount} {unit}")
    return Cell(", ".join(texts), "red")
