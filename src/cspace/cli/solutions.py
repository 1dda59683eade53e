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

if TYPE_CHECKING:
    from cspace.robot import Robot


RADIANS: Final = re.compile(r"(\d[\d.e+-]*) rad\b")
"""An angle in a sentence of the library."""

FORMS: Final = {"singularity": "{:.4f}", "branch": "{}", "residual": "{:.1e}", "distance": "{:.4f}"}
"""The columns behind joints and limits, and the form of their entries."""


def solution_rows(
    robot: Robot, answer: Any, near: Array | None, *, check: bool, counting: str | Iterable[str]
) -> list[dict[str, Any]]:
    """The solutions as JSON data [rad, m], in the order of the table: as found, or nearest to `near` first.

    check: each joint is moved into its limits by multiples of 2π, and it is said which ones are out of them,
    by how much. The singularity is that of the rows `counting` of the Jacobian, None where the arm moves in
    none of them; the distance is from `near`, or None.
    """
    from cspace.ik.wrapping import into_limits, short_way
    from cspace.kinematics.manipulability import counting_rows, generic_rank

    q = np.asarray(answer.q, dtype=np.float64)
    if check:  # each joint inside its limits, if a multiple of 2π brings it there
        limits = robot.limits
        q = into_limits(answer._settled(limits), robot.joint_types, limits.lower, limits.upper)[0]
    out = answer.violations() if check else [{}] * len(q)
    rank = generic_rank(robot, rows=counting_rows(robot) if counting == "auto" else counting)
    singularity = robot.singular_values(q, rows=counting)[:, rank - 1] if rank else None
    distance = None if near is None else np.linalg.norm(short_way(q - near, robot.joint_types), axis=1)
    order = range(len(q)) if distance is None else np.argsort(distance, kind="stable")
    return [
        {
            "q": q[k].tolist(),
            "branch": str(answer.branch[k]),
            "within_limits": not out[k] if check else None,
            "out_of_limits": out[k],
            "singularity": None if singularity is None else float(singularity[k]),
            "residual": float(answer.residual[k]),
            "distance": None if distance is None else float(distance[k]),
        }
        for k in order
    ]


def solutions_document(
    robot: Robot, answer: Any, rows: list[dict[str, Any]], goal: Goal, options: dict[str, Any]
) -> dict[str, Any]:
    """The answer as JSON data, [rad] and [m]."""
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
        "solutions": rows,
    }


def print_solutions(
    out: Output, robot: Robot, answer: Any, rows: list[dict[str, Any]], *, degrees: bool
) -> None:
    """The solutions as a table, or the reason why there are none."""
    reason = answer.reason.replace("least_squares=True", "--least-squares")
    reason = in_degrees(reason) if degrees else reason
    out.line(f"{robot.name}: {reason}", style="bold" if answer else "yellow")
    if not rows:
        return
    out.table(table_of(robot, rows, degrees=degrees))
    names = ", ".join(
        f"{short} {name}" for short, name in zip(joint_headings(robot), robot.joint_names, strict=True)
    )
    units = f"angles in {'deg' if degrees else 'rad'}" + (", slides in m" if "P" in robot.joint_types else "")
    if rows[0]["singularity"] is not None:
        units += "; singularity: distance to the nearest singular configuration"
    out.hint(f"{units}; residual: of the true pose")
    if joint_headings(robot) != list(robot.joint_names):
        out.hint(names)


def in_degrees(sentence: str) -> str:
    """A sentence of the library with its angles in degrees."""
    return RADIANS.sub(lambda angle: f"{np.degrees(float(angle[1])):.4g} deg", sentence)


def table_of(robot: Robot, rows: list[dict[str, Any]], *, degrees: bool) -> Table:
    """One row per solution, without empty columns."""
    texts = [joint_texts(row["q"], robot, degrees=degrees) for row in rows]
    columns: list[tuple[str, Iterable[Cell | str]]] = [("", [f"{k + 1}" for k in range(len(rows))])]
    columns += zip(joint_headings(robot), zip(*texts, strict=True), strict=True)
    if rows[0]["within_limits"] is not None:
        columns.append(
            ("limits", [limits_cell(row["out_of_limits"], robot, degrees=degrees) for row in rows])
        )
    for name, form in FORMS.items():
        if any(row[name] not in (None, "") for row in rows):
            columns.append((name, [form.format(row[name]) for row in rows]))
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
