"""Options of planners as people type them: NAME=VALUE for all that have it, PLANNER.NAME=VALUE for one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.exits import UsageError
from cspace.errors import suggest

if TYPE_CHECKING:
    from cspace.navigation import Option


TRUTHS: Final = {"true": True, "false": False}
NUMBERS: Final[Mapping[str, tuple[Callable[[str], Any], str]]] = {
    "int": (int, "a whole number"),
    "float": (float, "a number"),
    "bool": (lambda text: TRUTHS[text.lower()], "true or false"),
    "str": (str, "a word"),
}
"""How the value of an option is read by a type that it takes, the strictest first; and what it must be."""


def options_given(
    typed: Iterable[tuple[str, str]], seed: int | None, planners: Sequence[str]
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


def options_meant(name: str, planners: Sequence[str]) -> list[tuple[str, Option]]:
    """The planners, and their options, that a typed name is about."""
    from cspace.navigation import PLANNERS

    planner, dot, short = name.rpartition(".")
    if dot:
        if planner not in planners:
            raise suggest("planner", planner, planners, owner="what --planner names")
        if short not in PLANNERS[planner].options:
            raise suggest("option", short, PLANNERS[planner].options, owner=f"planner {planner!r}")
        return [(planner, PLANNERS[planner].options[short])]
    found = [(each, PLANNERS[each].options[name]) for each in planners if name in PLANNERS[each].options]
    if not found:
        known = {option for each in planners for option in PLANNERS[each].options}
        who = f"planner {planners[0]!r}" if len(planners) == 1 else "these planners"
        raise suggest("option", name, known, owner=who)
    return found


def value_of(option: Option, text: str) -> Any:
    """The value of an option, as typed; UsageError where it is of another kind."""
    if option.default is None and text.lower() == "none":
        return None
    for kind, (read, rule) in NUMBERS.items():
        if kind in option.type.split(" | "):
            try:
                return read(text)
            except (ValueError, KeyError):
                raise UsageError(f"option {option.name!r} is {text!r}; it must be {rule}") from None
    raise UsageError(
        f"option {option.name!r} is an array, which the command line cannot take; use cs.navigate in Python"
    )
