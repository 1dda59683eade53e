"""Texts of exports: templates with placeholders $word, and ASCII, which every compiler takes in comments."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from pathlib import Path
from string import Template
from types import MappingProxyType
from typing import Any

WORDS = MappingProxyType(
    {
        **{
            "−": "-",
            "–": "-",
            "·": "*",
            "×": "x",
            "‖": "|",
            "≤": "<=",
            "≥": ">=",
            "≠": "!=",
            "…": "...",
            "½": "1/2",
        },
        **{
            "±": "+-",
            "∓": "-+",
            "√": "sqrt",
            "∥": "||",
            "⊥": "_|_",
            "∂": "d",
            "°": " deg",
            "∞": "inf",
            "↦": "->",
        },
        **{"→": "->", "∈": "in", "∝": "~", "§": "sec. ", "″": "''", "′": "'", "’": "'"},
    }
)
RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻ⁿᵏⁱᵀ", "0123456789-nkiT")


def in_ascii(text: str) -> str:
    """Greek letters by name, superscripts as powers, symbols in ASCII; every other character as ?."""
    text = re.sub("[⁰¹²³⁴-⁹⁻ⁿᵏⁱᵀ]+", lambda found: "^" + found[0].translate(RAISED), text)
    return re.sub(r"[^\x00-\x7f]", lambda found: write_letter(found[0]), text)


def write_letter(sign: str) -> str:
    if sign in WORDS:
        return WORDS[sign]
    name = unicodedata.name(sign, "")
    if name.startswith("GREEK"):
        word = name.split()[-1].lower()
        return word.capitalize() if "CAPITAL" in name else word
    if unicodedata.combining(sign):
        return ""
    return unicodedata.normalize("NFKD", sign).encode("ascii", "ignore").decode() or "?"


def read_template(name: str) -> str:
    """The text of a template."""
    return (Path(__file__).parent / "templates" / name).read_text(encoding="utf-8")


def fill_template(name: str, words: Mapping[str, Any]) -> str:
    """The text of a template with its placeholders replaced."""
    return Template(read_template(name)).substitute(words)
