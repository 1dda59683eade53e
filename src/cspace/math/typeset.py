"""How numbers, symbols, cosines and sines are written, in plain text and in LaTeX."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

GREEK: Final = {"ca": ("cα", r"c_{\alpha_{%s}}"), "sa": ("sα", r"s_{\alpha_{%s}}")}
"""Cosine and sine of a twist: ca_2 is cα2."""
DIGITS: Final = 6
"""Significant digits of a printed number."""

Combination = tuple[tuple[int, int], ...]
"""A sum of angles: pairs of an angle's number and how often it is taken."""


def number_text(value: float) -> str:
    """A number with six digits, an exact one with as few as it needs."""
    return f"{value:.{DIGITS}g}"


def write_symbol(name: str, *, latex: bool) -> str:
    r"""p_x as px, ca_2 as cα2; in LaTeX p_{x}, c_{\alpha_{2}}."""
    base, _, index = name.partition("_")
    if base in GREEK:
        return GREEK[base][1] % index if latex else GREEK[base][0] + index
    return f"{base}_{{{index}}}" if latex and index else base + index


def write_turn(kind: str, angle: Combination, *, latex: bool) -> str:
    """c1, s23, and cos(2 t3 − t2) for other sums of angles."""
    before, behind = ("_{", "}") if latex else ("", "")
    if all(times == 1 and index < 10 for index, times in angle):
        return kind + before + "".join(str(index) for index, _ in angle) + behind
    function = "\\" * latex + ("cos" if kind == "c" else "sin")
    return f"{function}({sum_of_angles(angle, 't' + before, behind)})"


def sum_of_angles(angle: Combination, before: str, behind: str) -> str:
    """t2 + 2 t3 − t4."""
    terms = [
        (float(times), f"{before}{index}{behind}") for index, times in sorted(angle, key=lambda a: -a[1])
    ]
    return sum_of_terms(terms)


def sum_of_terms(terms: Sequence[tuple[float, str]]) -> str:
    """Factors and what they multiply, as a sum: 0.5 c1 − s2 + 3; nothing is 0."""
    out = ""
    for factor, text in terms:
        size = abs(factor)
        unit = number_text(size) == "1" and text
        shown = text if unit else f"{number_text(size)} {text}".rstrip()
        sign = "−" if factor < 0 else "+" if out else ""
        out += f" {sign} {shown}" if out else f"{sign}{shown}"
    return out or "0"
