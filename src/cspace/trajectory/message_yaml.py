"""The part of YAML in which messages of ROS are written: mappings, lists, scalars; blocks or brackets."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, NoReturn

from cspace.errors import DescriptionError, shorten
from cspace.files import YAML_CONTENT, YAML_MARKS, YAML_QUOTED

MOST_DEPTH: Final = 40
"""Levels of lists and mappings within each other; messages have six."""

NAME: Final = rf"({YAML_QUOTED}|[^\s\[\]{{}},\"'&*!|>%@`?][^:]*?)\s*:"
KEY: Final = re.compile(rf"{NAME}(?:\s+(.*))?")
"""A key and what follows it on its line."""
PLAIN: Final = re.compile(r"(?:[^\[\]{},:]|:(?=[^\s\[\]{},]))+")
"""A scalar without quotes within brackets."""
STRING: Final = re.compile(YAML_QUOTED)
NUMBERS: Final = re.compile(r"\[[-+0-9.eE,\s]+\]")
"""A list of numbers on one line."""
TOKEN: Final = re.compile(rf"\s+|{YAML_QUOTED}|[\[\]{{}},]|{PLAIN.pattern}|.")
"""A part of a value in brackets: quotes count where a value begins."""
BEFORE: Final = re.compile(rf"(?:-\s+)*(?:{NAME}\s+)?")
"""What stands before a value on its line."""
INTEGER: Final = re.compile(r"[-+]?(?:0|[1-9][0-9]*)")
REAL: Final = re.compile(r"[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+|[1-9][0-9]*(?=[eE]))(?:[eE][-+]?[0-9]+)?")
WORDS: Final = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
    **{sign + word: float(f"{sign}inf") for sign in ("", "+", "-") for word in (".inf", ".Inf", ".INF")},
}
"""Scalars that are neither numbers nor texts."""
UNREAD: Final = {"&": "anchors", "*": "aliases", "!": "tags", "|": "blocks of text", ">": "folded text"}
"""What YAML has besides, by the character that it begins with."""


@dataclass(frozen=True)
class Row:
    """A line with content: its number, its indent, and its text without the comment."""

    line: int
    indent: int
    text: str

    @property
    def is_item(self) -> bool:
        """Whether it is an item of a list."""
        return self.text == "-" or self.text.startswith("- ")


def read_documents(text: str, path: str) -> list[Any]:
    """The documents of a text, as dictionaries, lists, numbers, texts, booleans and None.

    DescriptionError with the line where it is no YAML, or of a kind that messages are not written in
    (anchors, aliases, tags, texts of several lines).
    """
    return [BlockReader(rows, path).read_document() for rows in split_documents(text, path) if rows]


def split_documents(text: str, path: str) -> list[list[Row]]:
    """The rows of each document; lines within brackets are joined."""
    documents: list[list[Row]] = [[]]
    parts: list[str] = []
    first, indent, depth = 0, 0, 0
    for number, line in enumerate(text.splitlines(), 1):
        found = YAML_CONTENT.match(line)
        content = found.group().rstrip() if found else ""
        body = content.strip()
        if not depth and body in YAML_MARKS:
            documents.append([])
        if not body or (not depth and (body in YAML_MARKS or content.startswith("%"))):
            continue
        if not depth:
            first, indent, parts = number, len(content) - len(content.lstrip(" ")), []
            if content[indent] == "\t":
                raise DescriptionError(
                    "the line begins with a tab; indent with blanks", path=path, line=number
                )
            before = BEFORE.match(body)
            value = body[before.end() :] if before else body
            depth += count_brackets(value) if value[:1] in ("[", "{") else 0
        else:
            depth += count_brackets(body)
        parts.append(body)
        if depth < 0:
            raise DescriptionError("a bracket is closed that was not opened", path=path, line=number)
        if not depth:
            documents[-1].append(Row(first, indent, " ".join(parts)))
    if depth:
        raise DescriptionError("a bracket is not closed", path=path, line=first)
    return documents


def count_brackets(text: str) -> int:
    """How many more brackets are opened than closed in a value, or in a part of one."""
    if NUMBERS.fullmatch(text):
        return 0
    tokens = TOKEN.findall(text)
    return sum(map(tokens.count, "[{")) - sum(map(tokens.count, "]}"))


class BlockReader:
    """Reads rows by their indents."""

    def __init__(self, rows: list[Row], path: str) -> None:
        self.rows, self.path, self.at = rows, path, 0

    def read_document(self) -> Any:
        """The value of all rows."""
        value = self.read_block(self.rows[0].indent, 0)
        if self.at < len(self.rows):
            self.fail("the indent fits no line before it")
        return value

    def fail(self, text: str) -> NoReturn:
        """DescriptionError at the present row, or at the last one."""
        row = self.rows[min(self.at, len(self.rows) - 1)]
        raise DescriptionError(f"{text}: {shorten(row.text, 40)!r}", path=self.path, line=row.line)

    def is_at(self, indent: int) -> bool:
        """Whether there is a row with this indent."""
        return self.at < len(self.rows) and self.rows[self.at].indent == indent

    def read_block(self, indent: int, depth: int) -> Any:
        """The list, mapping or scalar that begins at the present row."""
        if depth > MOST_DEPTH:
            self.fail(f"more than {MOST_DEPTH} levels within each other")
        row = self.rows[self.at]
        if row.is_item:
            return self.read_list(indent, depth)
        if KEY.fullmatch(row.text):
            return self.read_mapping(indent, depth)
        return self.read_scalar(row.text, depth)

    def read_scalar(self, text: str, depth: int) -> Any:
        """The value of the rest of a row; the row is done."""
        value = FlowReader(text, depth, self.fail).read_whole()
        self.at += 1
        return value

    def read_list(self, indent: int, depth: int) -> list[Any]:
        """Items with the same indent."""
        values = []
        while self.is_at(indent) and self.rows[self.at].is_item:
            row = self.rows[self.at]
            rest = row.text[1:].lstrip(" ")
            if rest:
                inner = indent + len(row.text) - len(rest)
                self.rows[self.at] = Row(row.line, inner, rest)
                values.append(self.read_block(inner, depth + 1))
            else:
                self.at += 1
                values.append(self.read_inner(indent, depth))
        return values

    def read_mapping(self, indent: int, depth: int) -> dict[str, Any]:
        """Keys with the same indent. A list as a value may have that indent, too."""
        values: dict[str, Any] = {}
        while self.is_at(indent) and not self.rows[self.at].is_item:
            found = KEY.fullmatch(self.rows[self.at].text)
            if not found:
                self.fail("expected 'key: value'")
            key = str(FlowReader(found[1], depth, self.fail).read_text())
            if key in values:
                self.fail(f"the key {shorten(key, 40)!r} appears for the second time")
            if found[2]:
                values[key] = self.read_scalar(found[2], depth + 1)
                continue
            self.at += 1
            is_list = self.is_at(indent) and self.rows[self.at].is_item
            values[key] = self.read_list(indent, depth + 1) if is_list else self.read_inner(indent, depth)
        return values

    def read_inner(self, indent: int, depth: int) -> Any:
        """The block that is indented more, or None."""
        if self.at < len(self.rows) and self.rows[self.at].indent > indent:
            return self.read_block(self.rows[self.at].indent, depth + 1)
        return None


class FlowReader:
    """Reads one scalar, or lists and mappings in brackets."""

    def __init__(self, text: str, depth: int, fail: Callable[[str], NoReturn]) -> None:
        self.text, self.depth, self.fail, self.at = text, depth, fail, 0

    def read_whole(self) -> Any:
        """The value of the text."""
        if NUMBERS.fullmatch(self.text):
            try:
                return [float(word) for word in self.text[1:-1].split(",")]
            except ValueError:
                pass
        if self.text[0] in UNREAD:
            self.fail(f"{UNREAD[self.text[0]]} are not read; write the values themselves")
        if self.text[0] not in "[{\"'":
            return read_plain(self.text)
        value = self.read_value(self.depth)
        if self.text[self.at :].strip():
            self.fail("more follows after the value")
        return value

    def peek(self) -> str:
        """The next character that is no blank, or none at the end."""
        while self.text[self.at : self.at + 1].isspace():
            self.at += 1
        return self.text[self.at : self.at + 1]

    def read_value(self, depth: int) -> Any:
        """The value that begins here."""
        if depth > MOST_DEPTH:
            self.fail(f"more than {MOST_DEPTH} levels within each other")
        match self.peek():
            case "[":
                return self.read_items("]", lambda: self.read_value(depth + 1))
            case "{":
                return self.read_pairs(depth)
            case '"' | "'":
                return self.read_text()
        return read_plain(self.read_text())

    def read_text(self) -> str:
        """A text in quotes, or up to the next bracket, comma or colon."""
        quoted = self.peek() in ('"', "'")
        found = (STRING if quoted else PLAIN).match(self.text, self.at)
        if not found:
            self.fail("the quotes do not match" if quoted else "a value is missing")
        self.at = found.end()
        text = found.group()
        if text[0] == "'" and quoted:
            return text[1:-1].replace("''", "'")
        if not quoted:
            if text[0] in UNREAD:
                self.fail(f"{UNREAD[text[0]]} are not read; write the values themselves")
            return text.strip()
        try:
            return str(json.loads(text, strict=False))
        except ValueError:
            self.fail("the text in quotes has escapes that are not read")

    def read_items(self, end: str, read: Callable[[], Any]) -> list[Any]:
        """What a pair of brackets has between its commas."""
        self.at += 1
        values = []
        while self.peek() != end:
            values.append(read())
            if self.peek() not in (",", end):
                self.fail(f"expected ',' or {end!r} in brackets")
            if self.peek() == ",":
                self.at += 1
        self.at += 1
        return values

    def read_pairs(self, depth: int) -> dict[str, Any]:
        """A mapping in brackets."""

        def read_pair() -> tuple[str, Any]:
            key = self.read_text()
            if self.peek() != ":":
                return key, None
            self.at += 1
            return key, None if self.peek() in (",", "}") else self.read_value(depth + 1)

        pairs = self.read_items("}", read_pair)
        values = dict(pairs)
        if len(values) < len(pairs):
            self.fail("a key appears for the second time")
        return values


def read_plain(text: str) -> Any:
    """The number, truth value, None or text of a scalar without quotes."""
    if text in WORDS:
        return WORDS[text]
    if INTEGER.fullmatch(text):
        return int(text) if len(text) < LONGEST_INTEGER else float(text)
    return float(text) if REAL.fullmatch(text) else text


LONGEST_INTEGER: Final = 300
"""Characters of a number above which it is read as a float: Python refuses longer ones."""
