"""Pictures that the command line writes."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from cspace.cli.exits import UsageError

__all__ = ["check_format"]

FORMATS: Final = (".png", ".svg", ".pdf")
"""The endings of pictures."""


def check_format(path: Path) -> None:
    """Refuse a file name whose ending is no picture's, before any work is done for it."""
    if path.suffix.lower() not in FORMATS:
        raise UsageError(f"cannot tell the format of {str(path)!r}; end it with one of {', '.join(FORMATS)}")
