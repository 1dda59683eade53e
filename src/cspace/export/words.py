"""The texts that stand ready, with words left open as $word."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from string import Template
from typing import Any

__all__ = ["filled", "template"]


def template(name: str) -> str:
    """The text as it stands."""
    return (Path(__file__).parent / "templates" / name).read_text(encoding="utf-8")


def filled(name: str, words: Mapping[str, Any]) -> str:
    """The text with every word put in."""
    return Template(template(name)).substitute(words)
