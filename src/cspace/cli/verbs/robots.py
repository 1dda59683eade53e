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
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("words", nargs="*", metavar="WORD", help="words as for --search")
    add_option(parser, "--search WORD…", "all words must occur", default=[])
    add_option(parser, "--dof N", "only arms with N joints", int)


def run(args: argparse.Namespace, out: Output) -> int:
    """Print one row per robot; none found is a negative answer."""
    from cspace.robots import search

    found = [row for row in search(" ".join([*args.words, *args.search])) if args.dof in (None, row.dof)]
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
        out.line(f"no robot of the catalogue fits {words!r}{joints}")
    return Exit.DONE if found else Exit.NEGATIVE
