"""A page of headings, sentences, tables and formulas, written as plain text, Markdown or LaTeX.

Sentences are Markdown: `name` for names, $t_1$ for symbols.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from cspace.model.text import aligned

WIDTH: Final = 100
"""Columns of plain text."""
PLAIN: Final = (
    (r"\\alpha", "α"),
    (r"\\times", "×"),
    (r"\\tan", "tan"),
    (r"\\cdot", "·"),
    (r"\\cos", "cos"),
    (r"\\sin", "sin"),
    (r"\\text", ""),
    (r" - ", " − "),
    (r"\^2", "²"),
    (r"\^\+", "⁺"),
    (r"\\ldots", "…"),
    (r"\^T", "ᵀ"),
    (r"\^\{-1\}", "⁻¹"),
)
"""What a LaTeX symbol is in plain text."""
IN_LATEX: Final = (
    ("−", "$-$"),
    ("–", "--"),
    ("≤", r"$\le$"),
    ("°", r"$^\circ$"),
    ("α", r"$\alpha$"),
    ("±", r"$\pm$"),
    ("ᵀ", r"$^T$"),
    ("⁻¹", r"$^{-1}$"),
    ("…", r"\ldots{}"),
)
"""What a character of prose is in LaTeX."""


class Block(Protocol):
    """A part of a page."""

    def plain(self) -> str:
        """As plain text."""

    def markdown(self) -> str:
        """As Markdown with formulas between dollar signs."""

    def latex(self) -> str:
        """As LaTeX."""


def plain_sentence(text: str) -> str:
    """A sentence without marks: t_1 as t1."""

    def symbols(match: re.Match[str]) -> str:
        out = match.group(1)
        for pattern, sign in PLAIN:
            out = re.sub(pattern, sign, out)
        return re.sub(r"[_{}]|\\,", "", out)

    return re.sub(r"\$([^$]*)\$", symbols, text).replace("`", "").replace("**", "")


def latex_sentence(text: str) -> str:
    """A sentence of LaTeX: names in typewriter, characters beyond ASCII by their commands."""
    out = []
    for k, part in enumerate(re.split(r"(\$[^$]*\$|`[^`]*`)", text)):
        if k % 2 and part.startswith("$"):
            out.append(part)
            continue
        inner = re.sub(r"([_&%#])", r"\\\1", part.strip("`") if k % 2 else part)
        inner = re.sub(r"\*\*(.*?)\*\*", r"\\textbf{\1}", inner)
        for sign, command in IN_LATEX:
            inner = inner.replace(sign, command)
        out.append(rf"\texttt{{{inner}}}" if k % 2 else inner)
    return "".join(out)


@dataclass(frozen=True)
class Heading:
    """A heading."""

    words: str

    def plain(self) -> str:
        """See Block."""
        return f"{plain_sentence(self.words)}\n{'-' * len(plain_sentence(self.words))}"

    def markdown(self) -> str:
        """See Block."""
        return f"### {self.words}"

    def latex(self) -> str:
        """See Block."""
        return rf"\subsection*{{{latex_sentence(self.words)}}}"


@dataclass(frozen=True)
class Paragraph:
    """Some sentences."""

    words: str

    def plain(self) -> str:
        """See Block."""
        return textwrap.fill(
            plain_sentence(self.words), WIDTH, break_long_words=False, break_on_hyphens=False
        )

    def markdown(self) -> str:
        """See Block."""
        return self.words

    def latex(self) -> str:
        """See Block."""
        return latex_sentence(self.words)


@dataclass(frozen=True)
class Rows:
    """A table. head: its headings; rows: cells as sentences."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def plain(self) -> str:
        """See Block."""
        return aligned([[plain_sentence(cell) for cell in row] for row in (self.head, *self.rows)])

    def markdown(self) -> str:
        """See Block."""
        lines = [self.head, ["---"] * len(self.head), *self.rows]
        return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)

    def latex(self) -> str:
        """See Block."""
        lines = [" & ".join(map(latex_sentence, row)) + r" \\" for row in (self.head, *self.rows)]
        lines[0] += r" \hline"
        return "\n".join([rf"\begin{{tabular}}{{{'r' * len(self.head)}}}", *lines, r"\end{tabular}"])


@dataclass(frozen=True)
class Formulas:
    """Equations one below the other. lines: plain text and LaTeX, the latter with an & to align by."""

    lines: Sequence[tuple[str, str]]

    def plain(self) -> str:
        """See Block."""
        return "\n".join(f"    {text}" for text, _ in self.lines)

    def markdown(self) -> str:
        """See Block."""
        return "$$\n" + self._aligned("aligned") + "\n$$"

    def latex(self) -> str:
        """See Block."""
        return self._aligned("align*")

    def _aligned(self, name: str) -> str:
        body = " \\\\\n".join(formula for _, formula in self.lines)
        return f"\\begin{{{name}}}\n{body}\n\\end{{{name}}}"


def plain(blocks: Sequence[Block]) -> str:
    """A page as plain text."""
    return "\n\n".join(block.plain() for block in blocks) + "\n"


def markdown(blocks: Sequence[Block]) -> str:
    """A page as Markdown."""
    return "\n\n".join(block.markdown() for block in blocks) + "\n"


def latex(blocks: Sequence[Block]) -> str:
    """A page as LaTeX, to be input between begin and end of a document with amsmath."""
    return "\n\n".join(block.latex() for block in blocks) + "\n"
