"""Attributes of an XML element: numbers, texts, slips of the pen; every error contains file and line."""

from __future__ import annotations

import contextlib
import difflib
import math
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from typing import Final, TypeVar

from cspace.errors import CspaceError, DescriptionError
from cspace.model.xml import Element

T = TypeVar("T")

LIKENESS: Final = 0.65
"""How much of two words must agree (Ratcliff and Metzener 1988) for one to be meant for the other."""


def fault_at(element: Element, message: str) -> DescriptionError:
    """The error that names the file and the line of `element`."""
    return DescriptionError(message, path=element.path, line=element.line)


def complain_at(element: Element, make: Callable[[], T]) -> T:
    """What `make` returns; its complaint gets the file and the line of `element`."""
    try:
        return make()
    except CspaceError as error:
        if isinstance(error, DescriptionError) and error.line is not None:
            raise
        raise fault_at(element, str(error)) from None


def read_floats(
    element: Element, attribute: str, default: Sequence[float] | None, least: int, most: int | None = None
) -> list[float]:
    """The finite numbers of an attribute, from `least` to `most` of them (default: as many)."""
    most = least if most is None else most
    text = element.attributes.get(attribute)
    if text is None:
        if default is None:
            raise fault_at(element, f"<{element.tag}> needs the attribute {attribute!r}")
        return list(default)
    where = f"{attribute}={text[:60]!r} of <{element.tag}>"
    wanted = f"{least}" if least == most else f"{least} to {most}"
    try:
        numbers = [float(word) for word in text.split()]
        if "_" in text:  # Python reads 1_000, no other reader does
            raise ValueError
    except ValueError:
        raise fault_at(element, f"{where}: expected {wanted} number{'s' if most > 1 else ''}") from None
    if not least <= len(numbers) <= most:
        raise fault_at(element, f"{where} holds {len(numbers)} numbers, expected {wanted}")
    if not all(math.isfinite(number) for number in numbers):
        raise fault_at(element, f"{where}: every number must be finite")
    return numbers


def read_number(element: Element, attribute: str, default: float | None = None) -> float:
    """One finite number; the plain case first, since a humanoid has a thousand of them."""
    text = element.attributes.get(attribute, "_")
    if "_" not in text:
        with contextlib.suppress(ValueError):
            value = float(text)
            if math.isfinite(value):
                return value
    return read_floats(element, attribute, None if default is None else [default], 1)[0]


def text_of(element: Element, attribute: str) -> str:
    """The text of an attribute that must be there."""
    value = element.attributes.get(attribute, "").strip()
    if not value:
        raise fault_at(element, f"<{element.tag}> needs the attribute {attribute!r}")
    return value


def slip_in(
    element: Element, known: Set[str], missing: Set[str], attributes: Mapping[str, Set[str]]
) -> tuple[str, Element] | None:
    """A message about a misspelled name in an element or its children, and its place; else None.

    known, missing: the elements that may stand in this one, and those that a name can be meant for.
    attributes: those of the children, by tag. A name that is not known is an extension, unless it is close to
    one that is not there.
    """
    for child in element.children:
        meant = closest_word(child.tag, missing) if known and child.tag not in known else None
        if meant:
            return f"<{element.tag}> has no <{child.tag}>; did you mean <{meant}>?", child
        names = attributes.get(child.tag, child.attributes.keys())
        for name in child.attributes.keys() - names:
            meant = closest_word(name, names - child.attributes.keys())
            if meant:
                return f"<{child.tag}> has no attribute {name!r}; did you mean {meant!r}?", child
    return None


def closest_word(word: str, known: Iterable[str]) -> str | None:
    """The known word that `word` was meant for, if any; names of another namespace are never meant so."""
    if ":" in word:
        return None
    return next(iter(difflib.get_close_matches(word, sorted(known), 1, LIKENESS)), None)
