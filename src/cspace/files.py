"""Reading and writing files: whole, checked, and never half written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Any, Final

from cspace.errors import DescriptionError, InputError, InputTypeError, MapError

__all__ = ["path_of", "read_regular", "whole_file", "write_text"]

DRAFTS: Final = count()
"""Numbers the drafts of this process, so that two threads never write into one."""

STEM: Final = 40
"""As much of a file's name as its draft repeats, so that the draft's name is no longer than is allowed."""


def path_of(source: Any, subject: str = "a file is given by its path") -> str:
    """`source` as a path. Raises InputTypeError for other objects."""
    try:
        return os.fsdecode(source)
    except TypeError:
        raise InputTypeError(f"{subject}, got {type(source).__name__}") from None


def read_regular(
    path: str | os.PathLike[str], kind: str, most: int, error: type[DescriptionError] | type[MapError]
) -> bytes:
    """The bytes of a regular file of reasonable size.

    kind: what it should be ("robot", "map"); most: the largest size that is read (bytes). Raises `error`
    with the path for a missing file, a folder, a device, one that is larger and one that may not be read.
    """
    name = os.fspath(path)
    try:
        if os.path.isdir(name):
            raise error(f"this is a folder; give the {kind} file inside it", path=name)
        if not os.path.exists(name):
            raise error(f"no such file (looked in {os.getcwd()})", path=name)
        if not os.path.isfile(name):
            raise error("this is no regular file", path=name)
        if (size := os.path.getsize(name)) > most:
            raise error(f"the file holds {size} bytes; more than {most} are refused", path=name)
        with open(name, "rb") as file:
            return file.read(most)  # a bound for a file that grows
    except (OSError, ValueError) as fault:
        if isinstance(fault, error):
            raise
        raise error(f"cannot be read: {getattr(fault, 'strerror', None) or fault}", path=name) from None


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary file in the folder of `path`, renamed to `path` if the block succeeds, else removed.

    So the file is either complete or untouched. Raises InputError where writing is impossible.
    """
    name = path_of(path)
    if "\0" in name:
        raise InputError(f"{name!r} cannot be written: a path must not contain a null character")
    target = Path(os.path.abspath(name))
    if target.exists() and not target.is_file():
        raise InputError(f"{target} cannot be written: it is not a regular file; choose another path")
    draft = target.with_name(f".{target.stem[:STEM]}.{os.getpid()}.{next(DRAFTS)}{target.suffix}")
    try:
        yield draft
        os.replace(draft, target)
    except OSError as error:
        raise InputError(f"{target} cannot be written: {error.strerror or error}") from None
    finally:
        with suppress(OSError):
            draft.unlink()


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write `text` as UTF-8 so that the file is either complete or untouched; errors as in whole_file."""
    with whole_file(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")
