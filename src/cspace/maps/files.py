"""The bytes of a map file: whole, of a reasonable size, or a clear error."""

from __future__ import annotations

import os
from typing import Any

from cspace.errors import InputTypeError, MapError
from cspace.tolerances import MAP_BYTES

__all__ = ["map_bytes", "map_path"]


def map_path(path: Any) -> str:
    """The path as text; InputTypeError for what is none."""
    try:
        return os.fsdecode(path)
    except TypeError:
        raise InputTypeError(f"a map file is given by its path, got {type(path).__name__}") from None


def map_bytes(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a regular file; MapError names the path of one that is missing, too large or not
    readable."""
    name = map_path(path)
    try:
        if os.path.isdir(name):
            raise MapError("this is a folder; give the map file inside it", path=name)
        if not os.path.exists(name):
            raise MapError(f"no such file (looked in {os.getcwd()})", path=name)
        if not os.path.isfile(name):
            raise MapError("this is no regular file", path=name)
        if (size := os.path.getsize(name)) > MAP_BYTES:
            raise MapError(f"the file holds {size} bytes; more than {MAP_BYTES} are refused", path=name)
        with open(name, "rb") as file:
            return file.read(MAP_BYTES)
    except (OSError, ValueError) as error:
        if isinstance(error, MapError):
            raise
        said = getattr(error, "strerror", None) or error
        raise MapError(f"cannot be read: {said}", path=name) from None
