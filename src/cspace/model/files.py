"""Reading and writing robot files: whole, checked, and never half written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Any, Final

from cspace.errors import DescriptionError, InputError, InputTypeError
from cspace.tolerances import DESCRIPTION_BYTES

__all__ = ["path_of", "read_bytes", "whole_file", "write_text"]

DRAFTS: Final = count()
"""Numbers the drafts of this process, so that two threads never write into one."""

STEM: Final = 40
"""As much of a file's name as its draft repeats, so that the draft's name is no longer than is allowed."""


def path_of(source: Any) -> str:
    """The path that `source` is; InputTypeError for what is none."""
    try:
        return os.fsdecode(source)
    except TypeError:
        message = f"a file is given by its path, a robot also by its text, got {type(source).__name__}"
        raise InputTypeError(message) from None


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a regular file of reasonable size.

    Raises DescriptionError naming the path for a missing file, a folder, a device, a file beyond
    tolerances.DESCRIPTION_BYTES and one that may not be read.
    """
    name = os.fspath(path)
    try:
        if os.path.isdir(name):
            raise DescriptionError("this is a folder; give the robot file inside it", path=name)
        if not os.path.exists(name):
            raise DescriptionError(f"no such file (looked in {os.getcwd()})", path=name)
        if not os.path.isfile(name):
            raise DescriptionError("this is no regular file", path=name)
        size = os.path.getsize(name)
        if size > DESCRIPTION_BYTES:
            message = f"the file holds {size} bytes; more than {DESCRIPTION_BYTES} are refused"
            raise DescriptionError(message, path=name)
        with open(name, "rb") as file:
            return file.read(DESCRIPTION_BYTES)  # no more, should the file be growing
    except OSError as error:
        raise DescriptionError(f"cannot be read: {error.strerror or error}", path=name) from None


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary name beside `path`, moved there when the block ends well, removed when it does not.

    So the file is either complete or untouched. Raises InputError where writing is impossible.
    """
    target = Path(os.path.abspath(path_of(path)))
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
