"""The solutions of `cspace ik`: their order, the table, the document."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.goals import Goal
from cspace.cli.output import Cell, Output, Table
from cspace.cli.robot import FEWER_DECIMALS, joint_headings, joint_texts
from cspace.tolerances import LARGE_RESIDUAL, NEARLY_SINGULAR

if TYPE_CHECKING:
    from cspace.robot import Robot


RADIANS: Final = re.compile(r"(\d[\d.e+-]*) rad\b")
"""An angle in a sentence of the library."""


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
    out: Output, robot: Robot, answer: Any, rows: list[dict[str, Any]], *, degrees: bool, details: bool
) -> None:
    """The solutions as a table, or the reason why there are none."""
    reason = answer.reason.replace("least_squares=True", "--least-squares")
    reason = in_degrees(reason) if degrees else reason
    out.sentence(f"{robot.name}: {reason}", style="bold" if answer else "yellow")
    if not rows:
        return
    out.table(table_of(robot, rows, degrees=degrees, details=details, width=out.width))
    names = ", ".join(
        f"{short} {name}" for short, name in zip(joint_headings(robot), robot.joint_names, strict=True)
    )
    units = f"angles in {'deg' if degrees else 'rad'}" + (", slides in m" if "P" in robot.joint_types else "")
    if details and rows[0]["singularity"] is not None:
        units += "; singularity: distance to the nearest singular configuration"
    out.hint(
        units + ("; residual: of the true pose" if details else "; --details: limits, singularity, residual")
    )
    if joint_headings(robot) != list(robot.joint_names):
        out.hint(names)


def in_degrees(sentence: str) -> str:
    """A sentence of the library with its angles in degrees."""
    return RADIANS.sub(lambda angle: f"{np.degrees(float(angle[1])):.4g} deg", sentence)


def table_of(
    robot: Robot, rows: list[dict[str, Any]], *, degrees: bool, details: bool, width: int | None = None
) -> Table:
    """One row per solution. Joints lose decimals, and the branch is left out, until the table fits the width.

    details: all columns in full. Otherwise limits are a column only if one is exceeded, singularity only if
    a row is nearly singular, and residual only if one is large; the branch is short.
    """
    last = other_columns(robot, rows, degrees=degrees, details=details)
    without_branch = [column for column in last if column[2] != "branch"]
    for columns in (last, without_branch):
        for fewer in range(FEWER_DECIMALS + 1):
            texts = [joint_texts(row["q"], robot, degrees=degrees, fewer=fewer) for row in rows]
            joints = zip(joint_headings(robot), zip(*texts, strict=True), strict=True)
            table = Table(["", *joint_headings(robot), *(heading for heading, _, _ in columns)])
            table.left |= {
                j for j, (_, _, kind) in enumerate(columns, 1 + len(texts[0])) if kind in ("limits", "branch")
            }
            cells = [[f"{k + 1}" for k in range(len(rows))], *(column for _, column in joints)]
            for row in zip(*cells, *(column for _, column, _ in columns), strict=True):
                table.add(*row)
            if width is None or table.width <= width:
                return table
    return table


def other_columns(
    robot: Robot, rows: list[dict[str, Any]], *, degrees: bool, details: bool
) -> list[tuple[str, list[Cell | str], str]]:
    """The columns behind the joints: heading, entries, and what they are."""
    columns: list[tuple[str, list[Cell | str], str]] = []
    least = min((row["singularity"] for row in rows if row["singularity"] is not None), default=None)
    if rows[0]["within_limits"] is not None and (details or any(row["out_of_limits"] for row in rows)):
        cells = [limits_cell(row["out_of_limits"], robot, degrees=degrees, details=details) for row in rows]
        columns.append(("limits" if details else "out of limits", list(cells), "limits"))
    if least is not None and (details or least < NEARLY_SINGULAR):
        columns.append(("singularity", [f"{row['singularity']:.4f}" for row in rows], "singularity"))
    labels = [row["branch"] for row in rows]
    if any(labels):
        heading, texts = ("branch", labels) if details else short_branches(labels)
        columns.append((heading, list(texts), "branch"))
    if details or max(row["residual"] for row in rows) > LARGE_RESIDUAL:
        columns.append(("residual", [f"{row['residual']:.1e}" for row in rows], "residual"))
    if rows[0]["distance"] is not None:
        columns.append(("distance", [f"{row['distance']:.4f}" for row in rows], "distance"))
    return columns


def short_branches(labels: list[str]) -> tuple[str, list[str]]:
    """Heading and entries of labels such as "shoulder left, elbow up": common nouns stand in the heading."""
    parts = [[part.partition(" ") for part in label.split(", ")] for label in labels]
    nouns = [noun for noun, _, _ in parts[0]]
    if any([noun for noun, _, _ in row] != nouns or not all(value for _, _, value in row) for row in parts):
        return "branch", labels
    return ", ".join(nouns), [", ".join(value for _, _, value in row) for row in parts]


def limits_cell(out_by: dict[str, float], robot: Robot, *, degrees: bool, details: bool) -> Cell:
    """The joints of a row that are out of limits; with details also by how much, or that none is."""
    if not out_by:
        return Cell("ok" if details else "", "green")
    texts = []
    short = dict(zip(robot.joint_names, joint_headings(robot), strict=True))
    kinds = dict(zip(robot.joint_names, robot.joint_types, strict=True))
    for name, excess in out_by.items():
        size, unit, digits = excess, "m" if kinds[name] == "P" else "rad", 4
        if degrees and kinds[name] == "R":
            size, unit, digits = float(np.degrees(excess)), "deg", 2
        least = 10.0**-digits
        amount = f"< {least:g}" if size < 0.5 * least else f"{size:.{digits}f}"
        texts.append(f"{short[name]} out by {amount} {unit}" if details else short[name])
    return Cell(", ".join(texts), "red")
