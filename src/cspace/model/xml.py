"""XML as a tree of elements that know their line, read by expat with hostile files in mind."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from cspace.errors import DescriptionError
from cspace.model.files import path_of, read_bytes
from cspace.tolerances import DESCRIPTION_BYTES, DESCRIPTION_DEPTH

BLANKS = "\ufeff \t\r\n"


@dataclass(slots=True, eq=False)
class Element:
    """One XML element: tag, attributes, children, and the file (None: a text) and line where it starts."""

    tag: str
    attributes: dict[str, str]
    line: int
    path: str | None = None
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> Iterator[Element]:
        """The children of that tag."""
        return (child for child in self.children if child.tag == tag)

    def first(self, tag: str) -> Element | None:
        """The first child of that tag, or None."""
        return next(self.all(tag), None)


class _Builder:
    """Builds the tree from the events of one parser."""

    def __init__(self, path: str | None, lines_before: int, depth: int) -> None:
        self.path = path
        self.lines_before = lines_before
        self.depth = depth
        self.root: Element | None = None
        self.stack: list[Element] = []
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.EntityDeclHandler = self.refuse_entity

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self.line(), self.path)
        if self.stack:
            self.stack[-1].children.append(element)
        else:
            self.root = element
        self.stack.append(element)
        if len(self.stack) > self.depth:
            raise self.fault(f"elements are nested more than {self.depth} deep; this is no robot")

    def end(self, tag: str) -> None:
        self.stack.pop()

    def refuse_entity(self, name: str, *_: object) -> None:
        raise self.fault(f"the file declares the entity {name!r}; entity declarations are refused")

    def line(self) -> int:
        return self.parser.CurrentLineNumber + self.lines_before

    def fault(self, message: str) -> DescriptionError:
        return DescriptionError(message, path=self.path, line=self.line())


def parse_document(
    data: bytes, path: str | None = None, lines_before: int = 0, depth: int = DESCRIPTION_DEPTH
) -> Element:
    """The root element of an XML document.

    data: the file. path: its name in messages. lines_before: lines cut off ahead of data. depth: how deep
    elements may be nested.
    Raises DescriptionError with file and line for malformed XML, for entity declarations (which a few lines
    can blow up to gigabytes), for files beyond tolerances.DESCRIPTION_BYTES or nested beyond `depth`.
    """
    if len(data) > DESCRIPTION_BYTES:
        raise DescriptionError(
            f"the file has {len(data)} bytes; the maximum is {DESCRIPTION_BYTES}", path=path
        )
    builder = _Builder(path, lines_before, depth)
    try:
        builder.parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code) or "unknown error"
        raise DescriptionError(
            f"malformed XML: {reason}", path=path, line=error.lineno + lines_before
        ) from None
    except (LookupError, UnicodeError, ValueError) as error:
        if isinstance(error, DescriptionError):
            raise
        raise DescriptionError(f"unreadable XML: {error}", path=path, line=1) from None
    if builder.root is None:
        raise DescriptionError("malformed XML: no element found", path=path, line=1)
    return builder.root


def parse_source(source: str | os.PathLike[str] | bytes, depth: int = DESCRIPTION_DEPTH) -> Element:
    """The root element of `source`: a path, or the text itself (a string that starts with "<", or bytes).

    The root's `path` tells which it was. Errors as in `parse` and files.read_bytes.
    """
    if isinstance(source, str) and source.lstrip(BLANKS).startswith("<"):
        blank = len(source) - len(source.lstrip(BLANKS))
        data = source[blank:].encode("utf-8", "replace")
        return parse_document(data, None, source.count("\n", 0, blank), depth)
    if isinstance(source, bytes):
        return parse_document(source, None, 0, depth)
    path = path_of(source)
    return parse_document(read_bytes(path), path, 0, depth)


class _RootSeen(Exception):
    """Ends the parser once the root's tag is known."""


def root_tag(data: bytes) -> str | None:
    """The tag of the root element, or None where the document is broken before it."""
    parser = expat.ParserCreate()
    found: list[str] = []

    def seen(tag: str, _: dict[str, str]) -> None:
        found.append(tag)
        raise _RootSeen

    parser.StartElementHandler = seen
    with contextlib.suppress(_RootSeen, expat.ExpatError, LookupError, UnicodeError, ValueError):
        parser.Parse(data, True)
    return found[0] if found else None
