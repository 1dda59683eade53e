"""XML as a tree of elements that know their line, read by expat with hostile files in mind."""

from __future__ import annotations

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

    def walk(self) -> Iterator[Element]:
        """The element and all inside it."""
        stack = [self]
        while stack:
            element = stack.pop()
            yield element
            stack.extend(element.children)


class _Builder:
    """Builds the tree from the events of one parser."""

    def __init__(self, path: str | None, lines_before: int) -> None:
        self.path = path
        self.lines_before = lines_before
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
        if len(self.stack) > DESCRIPTION_DEPTH:
            raise self.fault(f"elements are nested more than {DESCRIPTION_DEPTH} deep; this is no robot")

    def end(self, tag: str) -> None:
        self.stack.pop()

    def refuse_entity(self, name: str, *_: object) -> None:
        raise self.fault(f"the file declares the entity {name!r}; entity declarations are refused")

    def line(self) -> int:
        return self.parser.CurrentLineNumber + self.lines_before

    def fault(self, message: str) -> DescriptionError:
        return DescriptionError(message, path=self.path, line=self.line())


def parse_document(data: bytes, path: str | None = None, lines_before: int = 0) -> Element:
    """The root element of an XML document.

    data: the file. path: its name in messages. lines_before: lines cut off ahead of data.
    Raises DescriptionError with file and line for malformed XML, for entity declarations (which a few lines
    can blow up to gigabytes), for files beyond tolerances.DESCRIPTION_BYTES or DESCRIPTION_DEPTH.
    """
    if len(data) > DESCRIPTION_BYTES:
        raise DescriptionError(
            f"the file has {len(data)} bytes; the maximum is {DESCRIPTION_BYTES}", path=path
        )
    builder = _Builder(path, lines_before)
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


def parse_source(source: str | os.PathLike[str] | bytes) -> Element:
    """The root element of `source`: a path, or the text itself (a string that starts with "<", or bytes).

    The root's `path` tells which it was. Errors as in `parse` and files.read_bytes.
    """
    if isinstance(source, str) and source.lstrip(BLANKS).startswith("<"):
        blank = len(source) - len(source.lstrip(BLANKS))
        data = source[blank:].encode("utf-8", "replace")
        return parse_document(data, None, source.count("\n", 0, blank))
    if isinstance(source, bytes):
        return parse_document(source)
    path = path_of(source)
    return parse_document(read_bytes(path), path)
