"""Reading map files: bytes, text and paths."""

from __future__ import annotations

import os
from typing import Any

from cspace import files
from cspace.errors import MapError
from cspace.tolerances import MAP_BYTES


def check_map_path(path: Any) -> str:
    """The path as text; InputTypeError for any other type."""
    return files.path_of(path, "a map file is given by its path")


def read_map_bytes(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a map file; MapError names the path of one that is missing, too large or not readable."""
    return files.read_regular(check_map_path(path), "map", MAP_BYTES, MapError)


def read_map_text(path: str | os.PathLike[str]) -> str:
    """The text of a map file in UTF-8; MapError as in read_map_bytes, or with the line of an invalid byte."""
    return files.read_text(check_map_path(path), "map", MAP_BYTES, MapError)
