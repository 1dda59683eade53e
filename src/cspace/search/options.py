"""Planner options: parsed from the signature and the docstring of each planner's function, their only
source."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any, Final

from cspace.errors import InputTypeError, suggest

__all__ = ["Option", "check_options", "options_of"]

COMPOSED: Final = {"costs", "rng"}
"""Options that are not one number or word."""

ENTRY: Final = re.compile(r"(?:^|(?<=\. ))(\w+(?:, \w+)*)(?: \(([^)]*)\))?(?: \[([^\]]*)\])?: ")
"""Names in a docstring, with a shape or a unit, followed by a colon and their meaning."""

ELSEWHERE: Final = "as for A*."
"""The text for an option that has the same meaning as for A*."""


@dataclass(frozen=True)
class Option:
    """One option of a planner."""

    name: str
    type: str
    """The annotation in the function's signature: "float", "int", "str", "bool" or another type."""
    default: Any
    """None where the default depends on the world or the option is off; the meaning states which."""
    unit: str
    """ "m" and the like; empty for words and for numbers without a unit."""
    meaning: str
    """What the option does, the values it accepts and its default behaviour."""


@cache
def options_of(plan: Callable[..., Any], a_star: Callable[..., Any]) -> Mapping[str, Option]:
    """The options of a planner's function by name, in signature order; a_star: the function of A*, to which
    other planners refer."""
    parameters = [p for p in inspect.signature(plan).parameters.values() if p.kind is p.KEYWORD_ONLY]
    told = {name: (unit, meaning) for name, unit, meaning in _entries(inspect.getdoc(plan) or "")}
    found = {}
    for p in parameters:
        unit, meaning = told.get(p.name, ("", ""))
        if meaning.startswith(ELSEWHERE) and plan is not a_star:
            meaning = options_of(a_star, a_star)[p.name].meaning
        found[p.name] = Option(p.name, _type_of(p), p.default, unit, meaning)
    return MappingProxyType(found)


def check_options(planner: str, known: Mapping[str, Option], options: dict[str, Any]) -> None:
    """Raises InputTypeError for an unknown option, for several values where one is expected, or for a value
    other than True and False of a boolean option."""
    for name, value in options.items():
        if name not in known:
            raise InputTypeError(str(suggest("option", name, known, owner=f"planner {planner!r}")))
        several = hasattr(value, "__len__") and not isinstance(value, (str, bytes))
        if name not in COMPOSED and getattr(value, "ndim", several):
            raise InputTypeError(f"option {name!r} is a {type(value).__name__}; it must be one value")
        if isinstance(known[name].default, bool) and value not in (True, False):
            raise InputTypeError(f"option {name!r} is {value!r}; it must be True or False")


def _type_of(parameter: inspect.Parameter) -> str:
    """The annotation, without None where None only marks the default."""
    text = str(parameter.annotation).replace("np.random.", "")
    return text.removesuffix(" | None") if parameter.default is None else text


def _entries(doc: str) -> Iterator[tuple[str, str, str]]:
    """Name, unit and meaning of each entry of a docstring. A paragraph that begins with an entry contains
    only entries."""
    for paragraph in doc.split("\n\n"):
        text = " ".join(paragraph.split())
        matches = list(ENTRY.finditer(text))
        if not matches or matches[0].start():
            continue
        ends = [match.start() for match in matches[1:]] + [len(text)]
        for match, end in zip(matches, ends, strict=True):
            for name in match[1].split(", "):
                yield name, match[3] or "", text[match.end() : end].strip()
