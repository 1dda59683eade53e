"""How an answer is shown: JSON for machines, plain aligned text for pipes, rich tables for people."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, TextIO

from cspace.arrays import Array

__all__ = ["Cell", "Output", "Table"]

MOST_COLUMNS: Final = 400
"""The widest table: one that a terminal is too narrow for runs over its edge rather than lose digits."""


@dataclass(frozen=True)
class Cell:
    """A text and the colour it has where there are colours."""

    text: str
    style: str = ""


@dataclass
class Table:
    """Columns with a heading each and rows of cells; numbers are aligned to the right."""

    columns: Sequence[str]
    rows: list[list[Cell]] = field(default_factory=list)
    left: frozenset[int] = frozenset({0})
    title: str = ""

    def add(self, *cells: Cell | str) -> None:
        """Add a row; plain strings are cells without a colour."""
        self.rows.append([cell if isinstance(cell, Cell) else Cell(cell) for cell in cells])


class Output:
    """Where a verb writes its answer; a terminal gets rich tables, a pipe plain text, --json one document."""

    def __init__(self, *, as_json: bool = False, stream: TextIO | None = None) -> None:
        self.stream = stream or sys.stdout or io.StringIO()  # a closed standard output is None: write nowhere
        self.as_json = as_json
        self.rich = not as_json and self.stream.isatty()
        reconfigure = getattr(self.stream, "reconfigure", None)
        if reconfigure is not None:  # a terminal that cannot show a character shows a question mark instead
            reconfigure(errors="replace")
        self._console = self._new_console() if self.rich else None

    def document(self, document: Mapping[str, Any]) -> None:
        """The answer for machines: one JSON document, numbers with all their digits, NaN never."""
        json.dump(document, self.stream, default=_plain, allow_nan=False, indent=None, ensure_ascii=False)
        self.stream.write("\n")

    def line(self, text: str = "", style: str = "") -> None:
        """One line of text."""
        if self._console is not None:
            self._console.print(text, style=style or None, markup=False, highlight=False, soft_wrap=True)
        else:
            self.stream.write(text + "\n")

    def heading(self, text: str) -> None:
        """A heading above a block."""
        self.line(text, style="bold")

    def hint(self, text: str) -> None:
        """A remark for people at a terminal; pipes stay quiet."""
        if self._console is not None:
            self.line(text, style="dim")

    def facts(self, facts: Mapping[str, str]) -> None:
        """Names and values, one pair a line."""
        width = max(map(len, facts), default=0)
        for name, value in facts.items():
            if self._console is not None:
                from rich.text import Text

                pair = Text(f"{name:<{width}}  ", style="cyan")
                self._console.print(pair.append(value, style="default"), soft_wrap=True, highlight=False)
            else:
                self.stream.write(f"{name:<{width}}  {value}".rstrip() + "\n")

    def table(self, table: Table) -> None:
        """A table."""
        if self._console is not None:
            drawn = _rich_table(table)
            wide = self._console.options.update(max_width=MOST_COLUMNS)
            needed = self._console.measure(drawn, options=wide).minimum
            if needed > self._console.width:
                self._console.width = needed
            self._console.print(drawn, crop=False)
        else:
            self.stream.write(_plain_table(table))

    def matrix(self, values: Array, name: str) -> None:
        """A matrix under its name, digits aligned."""
        self.heading(name)
        texts = [[f"{_tidy(x): .6f}" for x in row] for row in values]
        for row in texts:
            self.line("  " + "  ".join(f"{text:>10}" for text in row))

    def _new_console(self) -> Any:
        try:
            from rich.console import Console
        except ImportError:
            from cspace.errors import MissingExtraError

            raise MissingExtraError("cli", "a table at a terminal (a pipe and --json do without)") from None
        return Console(file=self.stream)


def _tidy(x: float) -> float:
    """Rounding noise below the printed digits is shown as zero, without its sign."""
    return 0.0 if abs(x) < 5e-7 else x


def _plain(value: Any) -> Any:
    """NumPy values as JSON knows them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)


def _plain_table(table: Table) -> str:
    texts = [list(table.columns), *([cell.text for cell in row] for row in table.rows)]
    widths = [max(len(row[j]) for row in texts) for j in range(len(table.columns))]
    lines = [
        "  ".join(
            f"{text:<{width}}" if j in table.left else f"{text:>{width}}"
            for j, (text, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in texts
    ]
    return "\n".join(lines) + "\n"


def _rich_table(table: Table) -> Any:
    from rich import box
    from rich.table import Table as RichTable
    from rich.text import Text

    drawn = RichTable(box=box.SIMPLE_HEAD, title=table.title or None, title_justify="left", pad_edge=False)
    for j, column in enumerate(table.columns):
        drawn.add_column(column, justify="left" if j in table.left else "right", no_wrap=j not in table.left)
    for row in table.rows:
        drawn.add_row(*(Text(cell.text, style=cell.style) for cell in row))
    return drawn
