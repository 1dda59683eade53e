"""Output of results: JSON, aligned plain text for pipes, rich tables for terminals; files."""

from __future__ import annotations

import io
import json
import os
import shutil
import sys
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, TextIO

from cspace.arrays import Array
from cspace.cli.exits import UsageError

MOST_COLUMNS: Final = 400
"""The widest table: one that a terminal is too narrow for runs over its edge rather than lose digits."""


DECIMALS: Final = 6
"""Decimals of poses and Jacobians."""

MORE_DECIMALS: Final = 12
"""Decimals of poses that must be typed as they are: arms of fewer than six joints miss one with eight."""

LONGEST_NAME: Final = 22
"""The widest name beside which the values of all facts are aligned."""


STYLES: Final[Mapping[str, int]] = MappingProxyType({"bold": 1, "dim": 2, "yellow": 33, "cyan": 36})
"""The styles of lines and the numbers by which terminals know them (ECMA-48)."""


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

    @property
    def width(self) -> int:
        """The columns of a terminal that it needs."""
        texts = [list(self.columns), *([cell.text for cell in row] for row in self.rows)]
        return sum(max(map(len, column)) for column in zip(*texts, strict=True)) + 2 * (len(self.columns) - 1)

    def add(self, *cells: Cell | str) -> None:
        """Add a row; plain strings are cells without a colour."""
        self.rows.append([cell if isinstance(cell, Cell) else Cell(cell) for cell in cells])


class Output:
    """The output of a verb: rich tables for a terminal, plain text for a pipe, one document for --json."""

    _told = False

    def __init__(self, *, as_json: bool = False, stream: TextIO | None = None) -> None:
        self.stream = stream or sys.stdout or io.StringIO()  # a closed standard output is None: write nowhere
        self.as_json = as_json
        self.at_terminal = not as_json and self.stream.isatty()
        self.colours = self.at_terminal and _knows_colours()
        reconfigure = getattr(self.stream, "reconfigure", None)
        if reconfigure is not None:  # a terminal that cannot show a character shows a question mark instead
            reconfigure(errors="replace")

    def document(self, document: Mapping[str, Any]) -> None:
        """One JSON document: numbers with all their digits, never NaN."""
        json.dump(document, self.stream, default=_plain, allow_nan=False, indent=None, ensure_ascii=False)
        self.stream.write("\n")

    def line(self, text: str = "", style: str = "") -> None:
        """One line of text, at a terminal in a style of STYLES."""
        self.stream.write(self._styled(text, style) + "\n")

    @property
    def width(self) -> int | None:
        """The columns of the terminal; None for a pipe."""
        return shutil.get_terminal_size().columns if self.at_terminal else None

    def sentence(self, text: str, style: str = "") -> None:
        """A text that a terminal breaks between words."""
        for line in textwrap.wrap(text, self.width) if self.width else [text]:
            self.line(line, style)

    def heading(self, text: str) -> None:
        """A heading above a block."""
        self.sentence(text, style="bold")

    def hint(self, text: str) -> None:
        """A remark for people at a terminal, if there is one; pipes stay quiet."""
        if self.at_terminal and text:
            self.sentence(text, style="dim")

    def facts(self, facts: Mapping[str, str]) -> None:
        """Names and values, one pair a line."""
        width = max((len(name) for name in facts if len(name) <= LONGEST_NAME), default=0)
        for name, value in facts.items():
            shown = f"{name:<{width}}  " if value else name
            lines = self._fold(value.rstrip(), len(shown), width + 2)
            self.stream.write(self._styled(shown, "cyan") + "\n".join(lines) + "\n")

    def _fold(self, text: str, first: int, indent: int) -> list[str]:
        """A text of which `first` columns of its first line are taken, as lines of the terminal: those behind
        the first are indented.
        """
        if self.width is None or first + len(text) <= self.width:
            return [text]
        lines = textwrap.wrap(text, self.width, initial_indent=" " * first, subsequent_indent=" " * indent)
        return [lines[0][first:], *lines[1:]] if lines[0][:first].isspace() else ["", *lines]

    def page(self, text: str) -> None:
        """Lines of text, of which a terminal breaks the longer ones; each goes on below its own indent."""
        for line in text.splitlines():
            kept = self.width is None or len(line) <= self.width
            indent = " " * (len(line) - len(line.lstrip()))
            folded = [line] if kept else textwrap.wrap(line, self.width or 0, subsequent_indent=indent)
            for part in folded:
                self.line(part)

    def table(self, table: Table) -> None:
        """A table; a terminal gets lines and colours if rich is there."""
        console = self._console() if self.at_terminal else None
        if console is None:
            self.stream.write(_plain_table(table))
            return
        drawn = _rich_table(table)
        needed = console.measure(drawn, options=console.options.update(max_width=MOST_COLUMNS)).minimum
        if needed > console.width:
            console.width = needed
        console.print(drawn, crop=False)

    def matrix(self, values: Array, name: str, decimals: int = DECIMALS) -> None:
        """A matrix under its name, digits aligned; at a narrow terminal some columns at a time."""
        self.heading(name)
        texts = [[f"{tidy_number(x, decimals): .{decimals}f}" for x in row] for row in values]
        widest = max([10, *(len(text) for row in texts for text in row)])
        columns = values.shape[1]
        stride = columns if self.width is None else max(1, min(columns, self.width // (widest + 2)))
        for k in range(0, columns, stride):
            if stride < columns:
                self.line(f"  columns {k + 1} to {min(k + stride, columns)} of {columns}", style="dim")
            for row in texts:
                self.line("  " + "  ".join(f"{text:>{widest}}" for text in row[k : k + stride]))

    def _styled(self, text: str, style: str) -> str:
        return f"\x1b[{STYLES[style]}m{text}\x1b[0m" if style and text and self.colours else text

    def _console(self) -> Any:
        """The console of rich, whose import takes longer than most verbs; None without rich."""
        try:
            from rich.console import Console
        except ImportError:
            if not self._told:
                self.hint("tables come with lines and colours after: pip install 'cspace[cli]'")
            self._told = True
            return None
        return Console(file=self.stream)


def _knows_colours() -> bool:
    """Whether a terminal takes the codes of ECMA-48 and its user wants them."""
    plain = "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb"
    return not plain and (sys.platform != "win32" or "WT_SESSION" in os.environ)


def tidy_number(x: float, decimals: int = DECIMALS) -> float:
    """A number for print: zero, without a sign, where it would be rounded to zero."""
    return 0.0 if abs(x) < 0.5 * 10.0**-decimals else x


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

    drawn = RichTable(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for j, column in enumerate(table.columns):
        drawn.add_column(column, justify="left" if j in table.left else "right", no_wrap=j not in table.left)
    for row in table.rows:
        drawn.add_row(*(Text(cell.text, style=cell.style) for cell in row))
    return drawn


FORMATS: Final = (".png", ".svg", ".pdf")
"""The endings of pictures."""


def check_writable(path: Path) -> None:
    """Refuse an output path that cannot be written, before any work is done for it."""
    try:
        is_folder, has_folder = path.is_dir(), path.parent.is_dir()
    except OSError as error:  # a name that is too long, a folder that may not be entered
        raise UsageError(f"cannot write {str(path)[:80]!r}: {error.strerror or error}") from None
    if is_folder:
        raise UsageError(f"cannot write {str(path)!r}: it is a folder; give a file name")
    if not has_folder:
        raise UsageError(f"cannot write {str(path)!r}: there is no folder {str(path.parent)!r}")
    if not os.access(path.parent, os.W_OK):
        raise UsageError(f"cannot write {str(path)!r}: the folder {str(path.parent)!r} is not writable")


def check_format(path: Path) -> None:
    """Raise UsageError for a file name without the ending of a picture, before any computation."""
    if path.suffix.lower() not in FORMATS:
        raise UsageError(
            f"unknown picture format {str(path)!r}; its name must end with one of {', '.join(FORMATS)}"
        )
