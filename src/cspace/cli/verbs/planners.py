"""`cspace planners`: the planners of the plane and of arms, and the options of some of them."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.arguments import UNITS, read_number, read_unit, unit_of
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Cell, Output, Table
from cspace.errors import suggest

if TYPE_CHECKING:
    from cspace.search import Option, Planner


EXAMPLES: Final = """
cspace planners
cspace planners rrt_star potential_field
cspace planners rrt_connect
cspace planners --json
"""

ARM_WORLD: Final = "arm"
"""What stands for the world of the planners of arms."""

TRUTHS: Final = {"true": True, "false": False}


def read_whole(text: str) -> int:
    """A whole number: 1000, 1e6."""
    value = float(text)
    if value != math.floor(value):
        raise ValueError
    return int(text) if text.lstrip("+-").isdigit() else int(value)


def read_real(text: str) -> float:
    """A number; inf, and nan for the planner to refuse."""
    return float(text) if text.lower().lstrip("+-") in ("inf", "nan") else read_number(text)


def read_list(text: str) -> float | list[float]:
    """One number, or several with commas between them."""
    values = [read_number(word) for word in text.split(",")]
    return values if len(values) > 1 else values[0]


NUMBERS: Final[Mapping[str, tuple[Callable[[str], Any], str]]] = {
    "int": (read_whole, "a whole number"),
    "float": (read_real, "a number"),
    "bool": (lambda text: TRUTHS[text.lower()], "true or false"),
    "str": (str, "a word"),
    "ArrayLike": (read_list, "numbers with commas between them"),
}
"""How the value of an option is read by a type that it takes, the strictest first; and what it must be."""


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("names", nargs="*", metavar="PLANNER", help="print the options of these planners")


def run(args: argparse.Namespace, out: Output) -> int:
    """Print one row per planner, or per option of those that are named."""
    every = list_planners()
    rows = [each for name in args.names for each in planners_named(name, every)] or every
    if out.as_json:
        out.document({"schema": "cspace.planners/1", "planners": [planner_document(row) for row in rows]})
    elif args.names:
        for row in rows:
            show_options(row, out)
    else:
        table = Table(["planner", "world", "sensing", "what it does"], left=frozenset(range(4)))
        for row in rows:
            facts = planner_facts(row)
            table.add(Cell(facts["name"], "bold"), facts["world"], facts["sensing"], facts["summary"])
        out.table(table)
        out.hint(f"{len(rows)} planners; cspace planners NAME shows the options of one")
    return Exit.DONE


def list_planners() -> list[Planner]:
    """The planners of `cspace nav`, then those of `cspace plan`."""
    from cspace import navigation, planning

    return [*navigation.PLANNERS.values(), *planning.PLANNERS.values()]


def planners_named(name: str, every: Sequence[Planner]) -> list[Planner]:
    """The planners of a name: one of the plane, one of arms, or both."""
    found = [each for each in every if each.name == name]
    if not found:
        raise suggest("planner", name, {each.name for each in every})
    return found


def planner_facts(row: Planner) -> dict[str, str]:
    """What a planner is called and does, and for which worlds; one of arms knows its whole scene."""
    world, sensing = getattr(row, "world", ARM_WORLD), getattr(row, "sensing", "map")
    return {"name": row.name, "summary": row.summary, "world": world, "sensing": sensing}


def show_options(row: Planner, out: Output) -> None:
    """A planner and a table of its options."""
    out.heading(f"{row.name}: {row.summary}")
    if not row.options:
        out.line("no options")
        return
    table = Table(["option", "type", "default", "unit", "meaning"], left=frozenset(range(5)))
    for each in row.options.values():
        default = "" if each.default is None else str(typed_value(each.default)).lower()  # as it is typed
        table.add(Cell(each.name, "bold"), each.type, default, each.unit, each.meaning)
    out.table(table)


def typed_value(value: Any) -> Any:
    """A value of an option as JSON holds it: infinity is the text "inf", which can be typed."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def planner_document(row: Planner) -> dict[str, Any]:
    """A planner for machines."""
    names = ("name", "type", "default", "unit", "meaning")
    options = [{name: typed_value(getattr(each, name)) for name in names} for each in row.options.values()]
    return planner_facts(row) | {"options": options}


# --- options as people type them: NAME=VALUE for all that have it, PLANNER.NAME=VALUE for one -------------
def options_given(
    typed: Iterable[tuple[str, str]], seed: int | None, planners: Mapping[str, Planner]
) -> dict[str, dict[str, Any]]:
    """The options of each planner, by name, from pairs of name and value as typed, and a seed for those that
    draw samples. Raises UnknownNameError, or UsageError on a value of the wrong kind or given twice."""
    pairs = [*typed, *([] if seed is None else [("rng", str(seed))])]
    given: dict[str, dict[str, Any]] = {planner: {} for planner in planners}
    for name, text in pairs:
        for planner, option in options_meant(name, planners):
            if option.name in given[planner]:
                raise UsageError(
                    f"option {option.name!r} of planner {planner!r} is given twice; give it once"
                )
            given[planner][option.name] = value_of(option, text)
    return given


def options_meant(name: str, planners: Mapping[str, Planner]) -> list[tuple[str, Option]]:
    """The planners, and their options, that a typed name is about."""
    planner, dot, short = name.rpartition(".")
    if dot:
        if planner not in planners:
            raise suggest("planner", planner, planners, owner="what --planner names")
        if short not in planners[planner].options:
            raise suggest("option", short, planners[planner].options, owner=f"planner {planner!r}")
        return [(planner, planners[planner].options[short])]
    found = [(each, row.options[name]) for each, row in planners.items() if name in row.options]
    if not found:
        known = {option for row in planners.values() for option in row.options}
        who = f"planner {next(iter(planners))!r}" if len(planners) == 1 else "these planners"
        raise suggest("option", name, known, owner=who)
    return found


def value_of(option: Option, text: str) -> Any:
    """The value of an option, as typed; UsageError where it is of another kind."""
    if option.default is None and text.lower() == "none":
        return None
    kinds = option.type.split(" | ")
    read, rule = next(each for kind, each in NUMBERS.items() if kind in kinds)
    units = dict(pair for unit in option.unit.split(" or ") for pair in UNITS.get(unit, {}).items())
    try:
        return read_unit(text, units) if "float" in kinds and unit_of(text, units) else read(text)
    except (ValueError, KeyError, OverflowError, argparse.ArgumentTypeError):
        raise UsageError(f"option {option.name!r} is {text!r}; it must be {rule}") from None
