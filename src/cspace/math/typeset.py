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


def symbol_text(name: str) -> str:
    """p_x as px, ca_2 as cα2."""
    base, _, index = name.partition("_")
    return GREEK[base][0] + index if base in GREEK else base + index


def symbol_latex(name: str) -> str:
    r"""p_x as p_x, r_13 as r_{13}, ca_2 as c_{\alpha_2}."""
    base, _, index = name.partition("_")
    if base in GREEK:
        return GREEK[base][1] % index
    return f"{base}_{{{index}}}" if index else base


def turn_text(kind: str, angle: Combination) -> str:
    """c1, s23, and cos(2 t3 − t2) for other sums of angles."""
    if all(times == 1 and index < 10 for index, times in angle):
        return kind + "".join(str(index) for index, _ in angle)
    return f"{'cos' if kind == 'c' else 'sin'}({sum_of_angles(angle, 't', '')})"


def turn_latex(kind: str, angle: Combination) -> str:
    """The same in LaTeX."""
    if all(times == 1 and index < 10 for index, times in angle):
        return kind + "_{" + "".join(str(index) for index, _ in angle) + "}"
    return rf"\{'cos' if kind == 'c' else 'sin'}({sum_of_angles(angle, 't_{', '}')})"


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
