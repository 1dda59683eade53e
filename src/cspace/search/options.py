"""The options of planners: read from the signature and the docstring of each planner's function, which are
their one source."""

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
"""Names in a docstring, with a shape or a unit, and a colon before what they mean."""

ELSEWHERE: Final = "as for A*."
"""What is said of options that mean what they mean for A*."""


@dataclass(frozen=True)
class Option:
    """One option of a planner."""

    name: str
    type: str
    """As its function declares it: "float", "int", "str", "bool", or what it takes besides."""
    default: Any
    """None where it depends on the world, or the option is off: the meaning says which."""
    unit: str
    """ "m" and the like; empty for words and for numbers without a unit."""
    meaning: str
    """What it does, which values it takes, and what holds where it is not given."""


@cache
def options_of(plan: Callable[..., Any], a_star: Callable[..., Any]) -> Mapping[str, Option]:
    """The options of a planner's function by name, in its order; a_star: the function of A*, to which others
    refer."""
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
    """InputTypeError for an option that is not among those known of the planner, several values where it
    takes one, or others than True and False where it takes these."""
    for name, value in options.items():
        if name not in known:
            raise InputTypeError(str(suggest("option", name, known, owner=f"planner {planner!r}")))
        several = hasattr(value, "__len__") and not isinstance(value, (str, bytes))
        if name not in COMPOSED and getattr(value, "ndim", several):
            raise InputTypeError(f"option {name!r} is a {type(value).__name__}; it must be one value")
        if isinstance(known[name].default, bool) and value not in (True, False):
            raise InputTypeError(f"option {name!r} is {value!r}; it must be True or False")


def _type_of(parameter: inspect.Parameter) -> str:
    """The annotation; without None where that only stands for a default."""
    text = str(parameter.annotation).replace("np.random.", "")
    return text.removesuffix(" | None") if parameter.default is None else text


def _entries(doc: str) -> Iterator[tuple[str, str, str]]:
    """Name, unit and meaning of each entry of a docstring; a paragraph that begins with one has nothing
    else."""
    for paragraph in doc.split("\n\n"):
        text = " ".join(paragraph.split())
        matches = list(ENTRY.finditer(text))
        if not matches or matches[0].start():
            continue
        ends = [match.start() for match in matches[1:]] + [len(text)]
        for match, end in zip(matches, ends, strict=True):
            for name in match[1].split(", "):
                yield name, match[3] or "", text[match.end() : end].strip()
