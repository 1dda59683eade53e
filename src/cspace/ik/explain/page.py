"""A page of headings, sentences, tables and formulas, written as plain text, Markdown or LaTeX.

Sentences are Markdown: `name` for names, $t_1$ for symbols.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from cspace.tables import align_cells, markdown_table, show_fields

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


@show_fields
@dataclass(frozen=True)
class Block:
    """A part of a page: as plain text, as Markdown with formulas between dollar signs, and as LaTeX."""

    plain: str
    markdown: str
    latex: str


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


def lay_out_heading(words: str) -> Block:
    """A heading."""
    text = plain_sentence(words)
    latex = rf"\subsection*{{{latex_sentence(words)}}}"
    return Block(f"{text}\n{'-' * len(text)}", f"### {words}", latex)


def lay_out_paragraph(words: str) -> Block:
    """Some sentences."""
    text = plain_sentence(words)
    filled = textwrap.fill(text, WIDTH, break_long_words=False, break_on_hyphens=False)
    return Block(filled, words, latex_sentence(words))


def lay_out_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> Block:
    """A table. head: its headings; rows: cells as sentences."""
    lines = [head, *rows]
    latex = [" & ".join(map(latex_sentence, row)) + r" \\" for row in lines]
    latex[0] += r" \hline"
    return Block(
        align_cells([[plain_sentence(cell) for cell in row] for row in lines]),
        markdown_table(head, lines[1:]),
        "\n".join([rf"\begin{{tabular}}{{{'r' * len(head)}}}", *latex, r"\end{tabular}"]),
    )


def lay_out_formulas(lines: Sequence[tuple[str, str]]) -> Block:
    """Equations one below the other. lines: plain text and LaTeX, the latter with an & to align by."""
    body = " \\\\\n".join(formula for _, formula in lines)
    return Block(
        "\n".join(f"    {text}" for text, _ in lines),
        f"$$\n\\begin{{aligned}}\n{body}\n\\end{{aligned}}\n$$",
        f"\\begin{{align*}}\n{body}\n\\end{{align*}}",
    )
