"""Tables and lines as people read them: plain text, Markdown, HTML."""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

__all__ = [
    "align_cells",
    "count_things",
    "html_table",
    "join_words",
    "list_fields",
    "markdown_table",
    "one_line",
    "show_fields",
    "shown",
    "shown_field",
    "tabulate",
]

Record = TypeVar("Record")

LONGEST_LINE = 120
"""Characters of a line that represents an object."""

LONGEST_CELL = 80
"""Characters of a field in a line or in a table."""

SHORT_ARRAY = 8
"""Numbers of an array that are shown one by one."""

MOST_ROWS = 60
"""Rows of a table that a notebook shows; of longer ones it shows the first, and how many follow."""


def shown(value: float) -> str:
    """Six digits, nothing of the rounding around zero, and a dash for what is absent (infinite)."""
    return f"{round(float(value), 12) + 0.0:.6g}" if math.isfinite(value) else "-"


def join_words(words: Sequence[str]) -> str:
    """Words as a list in a sentence: a, b and c."""
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def count_things(number: int, noun: str, plural: str = "") -> str:
    """ "1 cell", "2 cells": a number and what it counts; plural: where it is not the noun and an s."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def one_line(kind: str, text: str) -> str:
    """`<kind text>` as one line of at most LONGEST_LINE characters; a longer text ends with an ellipsis."""
    line = f"<{kind} {' '.join(text.split())}>"
    return line if len(line) <= LONGEST_LINE else line[: LONGEST_LINE - 2].rstrip() + "…>"


def shown_field(value: Any) -> str:
    """The value of a field in a few words: numbers and short arrays themselves, of the rest what it is."""
    if isinstance(value, np.ndarray):
        if value.size > SHORT_ARRAY or value.ndim > 1 or value.dtype.kind not in "biuf":
            return f"{value.shape} array"
        return ", ".join(map(shown, value.ravel()))
    if isinstance(value, (bool, np.bool_)) or value is None:
        return str(value)
    if isinstance(value, (float, np.floating)):
        return shown(float(value))
    if isinstance(value, str):
        return value
    if isinstance(value, (Mapping, Sequence)) and not hasattr(value, "_fields"):
        words = value if all(isinstance(item, (str, int, float)) for item in value) else ()
        listed = ", ".join(map(str, words)) if not isinstance(value, Mapping) else ""
        return listed if 0 < len(listed) <= LONGEST_CELL else count_things(len(value), "entry", "entries")
    line = " ".join(repr(value).split())
    return line if len(line) <= LONGEST_CELL else line[: LONGEST_CELL - 1] + "…"


def list_fields(answer: Any) -> tuple[str, ...]:
    """The names of the public fields of a dataclass or a named tuple."""
    names: Any = getattr(answer, "_fields", None) or getattr(answer, "__dataclass_fields__", ())
    return tuple(name for name in names if not name.startswith("_"))


def tabulate(*names: str) -> Callable[[type[Record]], type[Record]]:
    """A decorator of a class: notebooks show its objects as a table of these attributes, or of its fields."""

    def add_table(record: type[Record]) -> type[Record]:
        def table(answer: Any) -> str:
            rows = [(name, shown_field(getattr(answer, name))) for name in names or list_fields(answer)]
            return html_table(" ".join(repr(answer).strip("<>").split()), ("field", "value"), rows)

        record._repr_html_ = table  # type: ignore[attr-defined]
        return record

    return add_table


def show_fields(record: type[Record]) -> type[Record]:
    """The class, its objects shown as one line: their fields, with shapes in place of arrays. Notebooks show
    them as a table.
    """

    def show(value: Any) -> str:
        if isinstance(value, np.ndarray):
            return str(value.shape)
        line = repr(value)
        return line if len(line) <= LONGEST_CELL else shown_field(value)

    def line(answer: Any) -> str:
        texts = (f"{name} {show(getattr(answer, name))}" for name in list_fields(answer))
        return one_line(type(answer).__name__, ", ".join(texts))

    record.__repr__ = line  # type: ignore[method-assign]
    return tabulate()(record)


def align_cells(rows: Sequence[Sequence[str]]) -> str:
    """Lines of cells, each column as wide as its widest cell, aligned to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows
    )


def markdown_table(titles: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown, without a line break at its end."""
    lines = ["| " + " | ".join(row) + " |" for row in (titles, *rows)]
    return "\n".join([lines[0], "|" + "---|" * len(titles), *lines[1:]])


def html_table(caption: str, titles: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in HTML for notebooks, its caption above it; of many rows the first MOST_ROWS."""

    def line(tag: str, cells: Sequence[str]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    left_out = len(rows) - MOST_ROWS
    more = f"<p>and {left_out} more rows</p>" if left_out > 0 else ""
    lines = [line("th", titles), *(line("td", row) for row in rows[:MOST_ROWS])]
    return f"<p>{html.escape(caption)}</p><table>{''.join(lines)}</table>{more}"
