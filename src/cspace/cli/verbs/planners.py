"""`cspace planners`: the planners of the plane, and the options of some of them."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.exits import Exit
from cspace.cli.output import Cell, Output, Table

if TYPE_CHECKING:
    from cspace.navigation import Option, PlanePlanner


EXAMPLES: Final = """
cspace planners
cspace planners rrt_star potential_field
cspace planners --json
"""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("names", nargs="*", metavar="PLANNER", help="print the options of these planners")


def run(args: argparse.Namespace, out: Output) -> int:
    """Print one row per planner, or per option of those that are named."""
    from cspace.navigation import PLANNERS
    from cspace.navigation.planners import find_planner

    rows = [find_planner(name) for name in args.names] or list(PLANNERS.values())
    if out.as_json:
        out.document({"schema": "cspace.planners/1", "planners": [planner_document(row) for row in rows]})
    elif args.names:
        for row in rows:
            show_options(row, out)
    else:
        table = Table(["planner", "world", "sensing", "what it does"], left=frozenset(range(4)))
        for row in rows:
            table.add(Cell(row.name, "bold"), row.world, row.sensing, row.summary)
        out.table(table)
        out.hint(f"{len(rows)} planners; cspace planners NAME shows the options of one")
    return Exit.DONE


def show_options(row: PlanePlanner, out: Output) -> None:
    """A planner and a table of its options."""
    out.heading(f"{row.name}: {row.summary}")
    if not row.options:
        out.line("no options")
        return
    table = Table(["option", "type", "default", "unit", "meaning"], left=frozenset(range(5)))
    for each in row.options.values():
        table.add(Cell(each.name, "bold"), each.type, default_of(each), each.unit, each.meaning)
    out.table(table)


def default_of(option: Option) -> str:
    """The default as it would be typed; empty where there is none that can be."""
    return "" if option.default is None else str(typed_value(option.default)).lower()


def typed_value(value: Any) -> Any:
    """A value of an option as JSON holds it: infinity is the text "inf", which can be typed."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def planner_document(row: PlanePlanner) -> dict[str, Any]:
    """A planner for machines."""
    options = [
        {
            "name": each.name,
            "type": each.type,
            "default": typed_value(each.default),
            "unit": each.unit,
            "meaning": each.meaning,
        }
        for each in row.options.values()
    ]
    return {
        "name": row.name,
        "summary": row.summary,
        "world": row.world,
        "sensing": row.sensing,
        "options": options,
    }
