"""Reading and writing files: whole, checked, and never half written."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, Final

from cspace.errors import (
    DescriptionError,
    InputError,
    InputTypeError,
    LogError,
    MapError,
    MeshError,
    RoadmapError,
    shorten,
)

__all__ = [
    "YamlLine",
    "check_target",
    "name_file",
    "path_of",
    "read_regular",
    "read_text",
    "unquote",
    "whole_file",
    "write_text",
]
__all__ += ["yaml_lines"]

DRAFTS: Final = count()
"""Numbers the drafts of this process, so that two threads never write into one."""

STEM: Final = 40
"""As much of a file's name as its draft repeats, so that the draft's name is no longer than is allowed."""

CONTENT: Final = re.compile(r"""(?:(?<!\S)'(?:[^']|'')*'|(?<!\S)"[^"]*"|[^#]|(?<=\S)#)*""")
"""The content of a line of YAML before its comment: a # that follows a blank and is outside quotes."""

FileError = DescriptionError | LogError | MapError | MeshError | RoadmapError
"""What is raised for a file that cannot be read."""

ENTRY: Final = re.compile(r"( *)(?:(-)|([A-Za-z_][\w.-]*)\s*:)(?:\s+(.*))?")


def path_of(source: Any, subject: str = "a file is given by its path") -> str:
    """`source` as a path. Raises InputTypeError for other objects."""
    try:
        return os.fsdecode(source)
    except TypeError:
        raise InputTypeError(f"{subject}, got {type(source).__name__}") from None


def read_regular(path: str | os.PathLike[str], kind: str, most: int, error: type[FileError]) -> bytes:
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
            raise error(f"the file has {size} bytes; the maximum is {most}", path=name)
        with open(name, "rb") as file:
            return file.read(most)  # a bound for a file that grows
    except (OSError, ValueError) as fault:
        if isinstance(fault, error):
            raise
        raise error(f"cannot be read: {getattr(fault, 'strerror', None) or fault}", path=name) from None


def read_text(path: str | os.PathLike[str], kind: str, most: int, error: type[FileError]) -> str:
    """The text of a file in UTF-8; `error` as from read_regular, or with the line of an invalid byte."""
    data = read_regular(path, kind, most, error)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        line = data.count(b"\n", 0, fault.start) + 1
        text = f"this is no {kind}: the text is not UTF-8"
        raise error(text, path=os.fspath(path), line=line) from None


@contextmanager
def name_file(path: str, line: int | None = None) -> Iterator[None]:
    """An InputError or InputTypeError in the block becomes a DescriptionError with the file, and the line."""
    try:
        yield
    except (InputError, InputTypeError) as error:
        raise DescriptionError(str(error), path=path, line=line) from None


def check_target(path: str | os.PathLike[str]) -> Path:
    """The absolute path of a file to be written.

    Raises InputError for one that cannot be: a folder, a device, a name that is too long or contains a null
    character.
    """
    name = path_of(path)
    if "\0" in name:
        raise InputError(f"{shorten(repr(name))} cannot be written: a path must not contain a null character")
    target = Path(os.path.abspath(name))
    try:
        if stat.S_ISREG(os.stat(target).st_mode):
            return target
    except (FileNotFoundError, NotADirectoryError):
        return target
    except OSError as error:  # a name that is too long, a folder that may not be entered
        raise _not_written(target, error) from None
    raise InputError(
        f"{shorten(str(target))} cannot be written: it is not a regular file; choose another path"
    )


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary file in the folder of `path`, renamed to `path` if the block succeeds, else removed.

    So the file is either complete or untouched. Raises InputError where writing is impossible.
    """
    target = check_target(path)
    draft = target.with_name(f".{target.stem[:STEM]}.{os.getpid()}.{next(DRAFTS)}{target.suffix}")
    try:
        yield draft
        os.replace(draft, target)
    except OSError as error:
        raise _not_written(target, error) from None
    finally:
        with suppress(OSError):
            draft.unlink()


def _not_written(target: Path, error: OSError) -> InputError:
    return InputError(
        f"{shorten(str(target))} cannot be written: {error.strerror or error}; choose another path"
    )


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write `text` as UTF-8 so that the file is either complete or untouched; errors as in whole_file."""
    with whole_file(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


@dataclass(frozen=True)
class YamlLine:
    """An entry of a YAML document: its line, its indent, its key, or "-" for an item of a list, and the value
    behind it. A line that is no entry has the key "", and its content as the value.
    """

    line: int
    indent: int
    key: str
    value: str


def yaml_lines(document: str) -> Iterator[YamlLine]:
    """The lines of a YAML document, without comments and marks: of block mappings and lists alone."""
    for number, row in enumerate(document.splitlines(), 1):
        found = CONTENT.match(row)
        text = found.group().rstrip() if found else ""
        if text.strip() in ("", "---", "...") or text.startswith("%"):
            continue
        if entry := ENTRY.fullmatch(text):
            yield YamlLine(number, len(entry[1]), entry[2] or entry[3], entry[4] or "")
        else:
            yield YamlLine(number, len(text) - len(text.lstrip()), "", text.strip())


def unquote(text: str) -> str:
    """The text of a YAML scalar, with or without quotes."""
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "'\"":
        return text[1:-1].replace("''", "'") if text[0] == "'" else text[1:-1]
    return text
