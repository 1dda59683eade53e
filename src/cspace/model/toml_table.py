"""One table of a TOML file: its values come out typed, or a complaint says where they stand."""

from __future__ import annotations

import re
import sys
from collections.abc import Collection
from typing import Any

from cspace.errors import DescriptionError, suggest
from cspace.tolerances import TOML_KEY_PARTS


class Document:
    """The text of a file and its name, for messages."""

    def __init__(self, text: str, path: str | None) -> None:
        self.text = text
        self.path = path

    def line_of(self, header: str, index: int | None) -> int | None:
        """The line of the header [a.b], or of the index-th [[a.b]]; None where it is written otherwise."""
        dots = r"\s*\.\s*".join(re.escape(part) for part in header.split("."))
        brackets = (r"\[\[", r"\]\]") if index is not None else (r"\[", r"\]")
        pattern = re.compile(rf"^[ \t]*{brackets[0]}\s*{dots}\s*{brackets[1]}", re.M)
        for i, match in enumerate(pattern.finditer(self.text)):
            if i == (index or 0):
                return self.text.count("\n", 0, match.end()) + 1
        return None

    def fault(self, message: str, line: int | None = None) -> DescriptionError:
        return DescriptionError(message, path=self.path, line=line)


PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
DOTTED = re.compile(rf"(?<![\w-]){PART}(?:[ \t]*\.[ \t]*{PART}){{{TOML_KEY_PARTS}}}")
"""More parts of a dotted key than any robot has."""


def parse_toml(document: Document) -> Table:
    """The top table of a document, or DescriptionError with file and line."""
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    if (long := DOTTED.search(document.text)) is not None:
        line = document.text.count("\n", 0, long.start()) + 1
        raise document.fault(f"malformed TOML: a key has more than {TOML_KEY_PARTS} parts", line)
    try:
        values = tomllib.loads(document.text)
    except tomllib.TOMLDecodeError as error:
        match = re.search(r"at line (\d+)", str(error))
        line = int(match.group(1)) if match else document.text.count("\n") + 1
        raise document.fault(f"malformed TOML: {error}", line) from None
    except RecursionError:
        raise document.fault("malformed TOML: nested too deep; this is no robot") from None
    except ValueError as error:  # a number of thousands of digits
        raise document.fault(f"malformed TOML: {error}") from None
    return Table(values, document, "", None)


class Table:
    """A table with the name of its header; every key must be read or known, else it is a misspelling."""

    def __init__(self, values: dict[str, Any], document: Document, header: str, index: int | None) -> None:
        self.values = values
        self.document = document
        self.header = header
        self.index = index

    @property
    def where(self) -> str:
        """The name of the table for messages."""
        place = self.header or "the file"
        return place if self.index is None else f"{place}[{self.index}]"

    def fault(self, message: str) -> DescriptionError:
        line = self.document.line_of(self.header, self.index) if self.header else None
        return self.document.fault(f"{self.where}: {message}", line)

    def known(self, keys: Collection[str]) -> None:
        """Complain about a key that is not one of `keys`."""
        for key in self.values:
            if key not in keys:
                raise self.fault(str(suggest("key", key, keys)))

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def needed(self, key: str, default: Any = None) -> Any:
        """The value of a key, or else the default; a complaint where there is neither."""
        value = self.values.get(key, default)
        if value is None:
            raise self.fault(f"the key {key!r} is missing")
        return value

    def text(self, key: str, default: str | None = None) -> str:
        value = self.needed(key, default)
        if not isinstance(value, str):
            raise self.fault(f"{key} must be a string, got {_shown(value)}")
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        value = self.values.get(key, [])
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.fault(f"{key} must be a list of strings, got {_shown(value)}")
        return tuple(value)

    def number(self, key: str, default: float | None = None) -> float:
        return self._float(self.needed(key, default), key)

    def numbers(self, key: str, shape: tuple[int, ...], default: Any = None) -> Any:
        """Nested lists of numbers of the given shape."""
        value = self.needed(key, default)
        return self._nested(value, key, shape) if key in self.values else value

    def table(self, key: str) -> Table:
        value = self.values.get(key, {})
        if not isinstance(value, dict):
            raise self.fault(f"{key} must be a table, got {_shown(value)}")
        return Table(value, self.document, f"{self.header}.{key}" if self.header else key, None)

    def tables(self, key: str) -> list[Table]:
        value = self.values.get(key, [])
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.fault(f"{key} must be a list of tables, got {_shown(value)}")
        header = f"{self.header}.{key}" if self.header else key
        return [Table(item, self.document, header, i) for i, item in enumerate(value)]

    def _float(self, value: Any, key: str) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.fault(f"{key} must be a number, got {_shown(value)}")
        try:
            return float(value)
        except OverflowError:
            raise self.fault(f"{key} is beyond the range of numbers") from None

    def _nested(self, value: Any, key: str, shape: tuple[int, ...]) -> Any:
        if not shape:
            return self._float(value, key)
        if not isinstance(value, list) or len(value) != shape[0]:
            size = f"a list of {len(value)}" if isinstance(value, list) else _shown(value)
            raise self.fault(f"{key} must hold {' × '.join(map(str, shape))} numbers, got {size}")
        return [self._nested(item, key, shape[1:]) for item in value]


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:37]}…"
