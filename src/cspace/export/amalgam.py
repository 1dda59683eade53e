"""One text from many headers of the core: every `#include "cspace/…"` in the place of its file."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from cspace.errors import CspaceError

__all__ = ["amalgamate", "include_folder"]


def include_folder() -> Path:
    """The folder that holds cspace/version.hpp: inside the installed package, or that of the source tree."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "include", package.parents[1] / "include"):
        if (folder / "cspace" / "version.hpp").is_file():
            return folder
    raise CspaceError(f"the C++ headers are not in {package / 'include'}; install cspace again")


def amalgamate(entries: Iterable[str]) -> str:
    """The headers named by `entries` and all that they include, each once, after what it includes itself."""
    folder = include_folder()
    parts: list[str] = []
    seen: set[str] = set()

    def append_header(name: str) -> None:
        if name in seen:
            return
        seen.add(name)
        own: list[str] = []
        for line in (folder / name).read_text(encoding="utf-8").splitlines():
            if included := re.match(r'#include "(cspace/[^"]+)"', line):
                append_header(included.group(1))
            elif line != "#pragma once":
                own.append(line)
        parts.append(f"// --- {name.removeprefix('cspace/')} ---\n" + "\n".join(own) + "\n")

    for entry in entries:
        append_header(entry)
    return "\n".join(parts)
