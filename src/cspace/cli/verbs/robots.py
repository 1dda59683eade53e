"""`cspace robots`: the robots of the catalogue."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import Final

from cspace.cli.arguments import add_option
from cspace.cli.exits import Exit
from cspace.cli.output import Cell, Output, Table

EXAMPLES: Final = """
cspace robots
cspace robots --search universal
cspace robots --dof 7 --json
cspace robots --has inertia effort
"""

FIELDS: Final = (
    "inertia", "effort", "velocity", "acceleration", "jerk", "poses", "link frames", "collision", "visual"
)  # fmt: skip
"""Groups of numbers that are published for some robots and missing for others."""


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("words", nargs="*", metavar="WORD", help="words as for --search")
    add_option(parser, "--search WORD…", "all words must occur", default=[])
    add_option(parser, "--dof N", "only arms with N joints", int)
    words = tuple(field.replace(" ", "_") for field in FIELDS)
    text = f"only robots with all of these numbers: {', '.join(words)}; inertia: masses, for dynamics"
    add_option(
        parser, "--has", text, choices=words, nargs="+", action="extend", default=[], metavar="NUMBERS"
    )


def run(args: argparse.Namespace, out: Output) -> int:
    """Print one row per robot; none found is a negative answer."""
    from cspace.robots import search

    needed = {word.replace("_", " ") for word in args.has}
    found = [
        row
        for row in search(" ".join([*args.words, *args.search]))
        if args.dof in (None, row.dof) and not needed & set(row.missing)
    ]
    if out.as_json:
        out.document({"schema": "cspace.robots/1", "robots": [asdict(row) for row in found]})
    elif found:
        table = Table(["name", "joints", "what it is", "maker"], left=frozenset({0, 1, 2, 3}))
        for row in found:
            table.add(Cell(row.name, "bold"), row.joints, row.title, row.vendor)
        out.table(table)
        out.hint(f"{len(found)} robots; cspace info NAME tells more about one")
    else:
        words = " ".join([*args.words, *args.search])
        joints = "" if args.dof is None else f" with {args.dof} joints"
        numbers = f" with {', '.join(args.has)}" if args.has else ""
        out.line(f"no robot of the catalogue fits {words!r}{joints}{numbers}")
    return Exit.DONE if found else Exit.NEGATIVE
