"""The bytes and paths of robot files."""

from __future__ import annotations

import os
from typing import Any

from cspace import files
from cspace.errors import DescriptionError
from cspace.tolerances import DESCRIPTION_BYTES


def path_of(source: Any) -> str:
    """`source` as a path. Raises InputTypeError for other objects."""
    return files.path_of(source, "a file is given by its path, a robot also by its text")


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a robot file; DescriptionError names the path of one missing, too large or unreadable."""
    return files.read_regular(path, "robot", DESCRIPTION_BYTES, DescriptionError)
