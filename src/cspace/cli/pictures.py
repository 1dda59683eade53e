"""Pictures that the command line writes."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from cspace.cli.exits import UsageError

FORMATS: Final = (".png", ".svg", ".pdf")
"""The endings of pictures."""


def check_format(path: Path) -> None:
    """Raise UsageError for a file name without the ending of a picture, before any computation."""
    if path.suffix.lower() not in FORMATS:
        raise UsageError(
            f"unknown picture format {str(path)!r}; its name must end with one of {', '.join(FORMATS)}"
        )
