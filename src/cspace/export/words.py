"""Templates: texts with placeholders $word."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from string import Template
from typing import Any


def read_template(name: str) -> str:
    """The text of a template."""
    return (Path(__file__).parent / "templates" / name).read_text(encoding="utf-8")


def fill_template(name: str, words: Mapping[str, Any]) -> str:
    """The text of a template with its placeholders replaced."""
    return Template(read_template(name)).substitute(words)
