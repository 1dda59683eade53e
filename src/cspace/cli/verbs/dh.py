"""`cspace dh`: the Denavit-Hartenberg table of an arm and its link matrices."""

from __future__ import annotations

import argparse
import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.cli.arguments import add_chain, add_degrees, add_option, add_robot
from cspace.cli.exits import Exit
from cspace.cli.output import Output, Table, tidy_number
from cspace.cli.robot import load_chosen, need_chain
from cspace.tables import markdown_table
from cspace.tolerances import PRINTED_ZERO

if TYPE_CHECKING:
    from cspace.math import TrigMatrix
    from cspace.model import DHTable, LinkMatrices

EXAMPLES: Final = """
cspace dh ur5e
cspace dh puma560 --convention modified --deg
cspace dh scara --latex --products
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    add_robot(parser)
    text = "standard (Denavit, Hartenberg 1955; the default) or modified (Craig 1986)"
    add_option(parser, "--convention", text, choices=("standard", "modified"), default="standard")
    form = parser.add_mutually_exclusive_group()
    add_option(form, "--latex", "print LaTeX")
    add_option(form, "--markdown", "print Markdown")
    add_option(parser, "--products", "also A1 A2, A1 A2 A3 … with symbols such as c12")
    add_degrees(parser)
    add_chain(parser)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print the table and the matrix of every link, as symbols and, with q = 0, as numbers."""
    from cspace.model import link_matrices, to_dh

    robot = load_chosen(args)
    need_chain(robot)
    table = to_dh(robot.chain, convention=args.convention)
    links = link_matrices(table)
    if out.as_json:
        out.document(table_document(robot.name, links, products=args.products))
        return Exit.DONE
    if args.latex or args.markdown:
        formulas = matrix_formulas(links) + (links.product_formulas() if args.products else [])
        table_lines, form = (latex_lines, "{}") if args.latex else (markdown_lines, "\n$${}$$")
        for line in [*table_lines(table, degrees=args.deg), *map(form.format, formulas)]:
            out.line(line)
    else:
        print_table(out, robot.name, links, degrees=args.deg)
        for text in links.product_texts() if args.products else ():
            out.page(f"\n{text}")
    return Exit.DONE


def entry_texts(A: TrigMatrix) -> list[list[str]]:
    """The entries (4, 4) of a link matrix as texts in ASCII."""
    return [
        [text.replace("−", "-") for text in row]
        for row in A.texts(least=PRINTED_ZERO, least_shift=PRINTED_ZERO)
    ]


def table_document(name: str, links: LinkMatrices, *, products: bool) -> dict[str, Any]:
    """The table as JSON data, [rad] and [m]."""
    table = links.table
    columns = zip(
        table.joint_names, table.joint_types, table.alpha, table.a, table.d, table.theta_offset, strict=True
    )
    keys = ("joint", "type", "alpha", "a", "d", "theta")
    rows = [
        dict(zip(keys, (joint, kind, *map(float, numbers)), strict=True)) for joint, kind, *numbers in columns
    ]
    return {
        "schema": "cspace.dh/1",
        "robot": name,
        "convention": table.convention,
        "rows": rows,
        "base": table.T_base.tolist(),
        "tool": table.T_tool.tolist(),
        "deviation": float(table.deviation),
        "matrices": numbers_at_zero(table).tolist(),
        "symbols": [entry_texts(A) for A in links.matrices],
        **({"products": [T.texts() for T in links.products[1:]]} if products else {}),
    }


def numbers_at_zero(table: DHTable) -> Array:
    """The link matrices (rows, 4, 4) with every joint at zero."""
    return table.matrices(np.zeros(len(table) - table.joint_types.count("F")))


def column_headings(convention: str) -> list[str]:
    """Column headings; a modified row has the alpha and a of the link before."""
    before = "(i-1)" if convention == "modified" else "(i)"
    return ["i", f"alpha{before}", f"a{before}", "d(i)", "theta(i)", "joint"]


def row_texts(table: DHTable, i: int, *, degrees: bool) -> list[str]:
    """One row of the table as texts; the variable is written into the column that it moves."""
    turning = table.joint_types[i] == "R"
    theta, d = angle_text(table.theta_offset[i], degrees=degrees), length_text(table.d[i])
    if turning:
        theta = f"q{i + 1}" if theta == "0" else f"q{i + 1} {sign_text(theta)}"
    elif table.joint_types[i] == "P":
        d = f"q{i + 1}" if d == "0" else f"q{i + 1} {sign_text(d)}"
    alpha = angle_text(table.alpha[i], degrees=degrees)
    return [f"{i + 1}", alpha, length_text(table.a[i]), d, theta, table.joint_names[i]]


def length_text(length: float) -> str:
    """A length [m] without rounding noise."""
    return "0" if abs(length) < PRINTED_ZERO else f"{length:.6g}"


def sign_text(text: str) -> str:
    """A number as it follows a sum: + 0.5, - 0.5."""
    return f"- {text[1:]}" if text.startswith("-") else f"+ {text}"


def angle_text(angle: float, *, degrees: bool) -> str:
    """An angle in the selected unit; in radians simple fractions of 2π are written with pi."""
    if abs(angle) < PRINTED_ZERO:
        return "0"
    if degrees:
        return f"{np.degrees(angle):.6g}"
    for divisor in (1, 2, 3, 4, 6):
        times = angle * divisor / np.pi
        if abs(times - round(times)) < PRINTED_ZERO:
            sign, count = "-" if times < 0 else "", abs(round(times))
            return sign + ("pi" if count == 1 else f"{count}pi") + ("" if divisor == 1 else f"/{divisor}")
    return f"{angle:.6g}"


def print_table(out: Output, name: str, links: LinkMatrices, *, degrees: bool) -> None:
    """The table and the matrices for people."""
    table = links.table
    out.heading(
        f"{name}, {table.convention} convention, angles in {'deg' if degrees else 'rad'}, lengths in m"
    )
    drawn = Table(column_headings(table.convention), left=frozenset({5}))
    for i in range(len(table)):
        drawn.add(*row_texts(table, i, degrees=degrees))
    out.table(drawn)
    if table.deviation > PRINTED_ZERO:
        moved = f"the tip moves by up to {table.deviation:.1g} m"
        out.line(f"axes that almost are parallel or meet are taken as such: {moved}")
    for T, text in ((table.T_base, "base: before the first row"), (table.T_tool, "tool: after the last row")):
        if np.abs(T - np.eye(4)).max() > PRINTED_ZERO:
            out.matrix(T, text)
    out.line()
    out.line("ck and sk stand for cos and sin of theta(k)")
    for i, A in enumerate(numbers_at_zero(table)):
        texts = entry_texts(links.matrices[i])
        widths = [max(len(row[j]) for row in texts) for j in range(4)]
        out.heading(f"A{i + 1}")
        for symbols, numbers in zip(texts, A, strict=True):
            left = "  ".join(f"{text:>{width}}" for text, width in zip(symbols, widths, strict=True))
            right = "  ".join(f"{tidy_number(x, 5):9.5f}" for x in numbers)
            out.line(f"  {left}      q = 0: {right}")


def latex_lines(table: DHTable, *, degrees: bool) -> list[str]:
    """The table as a LaTeX array."""
    index = "i-1" if table.convention == "modified" else "i"
    lines = [
        r"\begin{array}{c|cccc}",
        rf"i & \alpha_{{{index}}} & a_{{{index}}} & d_i & \theta_i \\ \hline",
    ]
    for i in range(len(table)):
        texts = (text.replace("pi", r"\pi") for text in row_texts(table, i, degrees=degrees)[:5])
        cells = [re.sub(r"\bq(\d+)", r"q_{\1}", text) for text in texts]  # the variable q3 as q_{3}
        if degrees:
            cells[1] += r"^\circ"
            cells[4] += "" if cells[4].startswith("q_") and " " not in cells[4] else r"^\circ"
        lines.append(" & ".join(cells) + r" \\")
    return [*lines, r"\end{array}"]


def matrix_formulas(links: LinkMatrices) -> list[str]:
    """The link matrices in LaTeX."""
    return [
        rf"{{}}^{{{i}}}A_{{{i + 1}}} = {A.latex(least=PRINTED_ZERO, least_shift=PRINTED_ZERO)}"
        for i, A in enumerate(links.matrices)
    ]


def markdown_lines(table: DHTable, *, degrees: bool) -> list[str]:
    """The table in Markdown."""
    rows = [row_texts(table, i, degrees=degrees) for i in range(len(table))]
    return markdown_table(column_headings(table.convention), rows).splitlines()
