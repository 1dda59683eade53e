"""Output files are refused early; what writes them writes them whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from cspace.cli.exits import UsageError

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
