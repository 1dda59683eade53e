"""Many headers of the core as one text: every `#include "cspace/…"` is replaced by its file."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from cspace.errors import CspaceError


def include_folder() -> Path:
    """The folder that contains cspace/version.hpp: in the installed package or in the source tree."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "include", package.parents[1] / "include"):
        if (folder / "cspace" / "version.hpp").is_file():
            return folder
    raise CspaceError(f"the C++ headers are not in {package / 'include'}; install cspace again")


def amalgamate_headers(entries: Iterable[str]) -> str:
    """The headers in `entries` and everything that they include, each once, after its own includes."""
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
