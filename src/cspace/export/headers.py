"""The headers of the core as data: where they are, what they include, and the pieces they consist of."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from cspace.errors import CspaceError

__all__ = ["Piece", "include_folder", "pieces_of", "with_included"]

# Before a name that a piece declares: templates, attributes by macro, storage.
HEAD = re.compile(r"(template\s*<|CSPACE_[A-Z_]+\b|inline\b|constexpr\b|static\b|const\b|\s+)")
TYPE = re.compile(r"(?:struct|class|enum class|enum)\s+(?:alignas\([^)]*\)\s*)?(\w+)")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
STRING = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'')


# Namespaces whose names are used without them too.
TRANSPARENT = frozenset({"", "cspace", "ik", "detail"})


@dataclass
class Piece:
    """A declaration with the comment before it, or a directive of the preprocessor.

    names: what it declares; empty where that is unknown, and then it is always kept. namespace: the opening
    lines around it, from the outside. conditional: it stands between #if and #endif.
    """

    text: str
    namespace: tuple[str, ...]
    directive: bool = False
    conditional: bool = False
    names: tuple[str, ...] = ()
    mentions: frozenset[str] = field(default=frozenset())

    @property
    def scope(self) -> str:
        """The namespace that its name needs in front of it elsewhere, with ::, or nothing."""
        inner = self.namespace[-1].removeprefix("namespace ").split("::")[-1] if self.namespace else ""
        return "" if inner in TRANSPARENT or inner.startswith("inline ") else f"{inner}::"


def include_folder() -> Path:
    """The folder that holds cspace/version.hpp: inside the installed package, or that of the source tree."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "include", package.parents[1] / "include"):
        if (folder / "cspace" / "version.hpp").is_file():
            return folder
    raise CspaceError(f"the C++ headers are not in {package / 'include'}; install cspace again")


def with_included(entries: Iterable[str]) -> list[str]:
    """The headers named by `entries` and all that they include, each once, after what it includes itself."""
    order: list[str] = []
    seen: set[str] = set()

    def visit(name: str) -> None:
        if name in seen:
            return
        seen.add(name)
        for included in re.findall(r'^#include "(cspace/[^"]+)"', read(name), re.M):
            visit(included)
        order.append(name)

    for entry in entries:
        visit(entry)
    return order


@cache
def read(name: str) -> str:
    return (include_folder() / name).read_text(encoding="utf-8")


@cache
def pieces_of(name: str) -> tuple[Piece, ...]:
    """The pieces of a header in their order; its own #include "…" and #pragma once are left out."""
    pieces: list[Piece] = []
    namespace: list[str] = []
    conditions = 0
    comment: list[str] = []
    lines = read(name).splitlines()
    at = 0
    while at < len(lines):
        line = lines[at]
        end = at + 1
        if line.startswith("#"):
            while lines[end - 1].endswith("\\"):
                end += 1
            conditions += line.startswith("#if") - line.startswith("#endif")
            if not re.match(r'#pragma once|#include "', line):
                text = "\n".join([*comment, *lines[at:end]])
                pieces.append(Piece(text, tuple(namespace), True, conditions > 0 or "#endif" in line))
            comment = []
        elif line.startswith("//"):
            comment.append(line)
        elif re.match(r"namespace\b.*\{$", line):
            namespace.append(line.removesuffix("{").strip())
            comment = []
        elif line == "}" or line.startswith("}  // namespace"):
            namespace.pop()
            comment = []
        elif line.strip():
            while not is_whole("\n".join(lines[at:end])):
                end += 1
            text = "\n".join(lines[at:end])
            pieces.append(
                Piece("\n".join([*comment, text]), tuple(namespace), False, conditions > 0, *words_of(text))
            )
            comment = []
        at = end
    if namespace or conditions:
        raise CspaceError(f"{name} does not end where it should")
    return tuple(pieces)


def is_whole(text: str) -> bool:
    """Whether text is a whole declaration: its braces close, and it ends as declarations do."""
    bare = STRING.sub("", COMMENT.sub("", text)).rstrip()
    if bare.count("{") != bare.count("}") or bare.count("(") != bare.count(")"):
        return False
    return bare.endswith((";", "}")) or re.fullmatch(r"CSPACE_[A-Z0-9_]+\(.*\)", bare, re.S) is not None


def words_of(text: str) -> tuple[tuple[str, ...], frozenset[str]]:
    """The names that a declaration declares, and those that it mentions, qualified as it does."""
    bare = STRING.sub('""', COMMENT.sub("", text))
    mentions: set[str] = set()
    for around, name in re.findall(r"(?:\b([A-Za-z_]\w*)::)?\b([A-Za-z_]\w*)", bare):
        mentions |= {around, f"{around}::{name}"} if around not in TRANSPARENT else {name}
    for opened in re.findall(r"using\s+namespace\s+(\w+)", bare):
        mentions |= {f"{opened}::{word}" for word in mentions}
    return declared(bare), frozenset(mentions)


def declared(bare: str) -> tuple[str, ...]:
    rest = bare
    while match := HEAD.match(rest):
        rest = after_angles(rest) if match.group().startswith("template") else rest[match.end() :]
    if match := TYPE.match(rest):
        return (match.group(1),)
    if match := re.match(r"using\s+(\w+)\s*=", rest):
        return (match.group(1),)
    brace = re.search(r"[({=;]", rest)
    if brace is None or "operator" in rest[: brace.start()]:
        return ()
    if brace.group() == "(":
        return tuple(re.findall(r"(\w+)\s*$", rest[: brace.start()]))
    flat = re.sub(r"\{[^{}]*\}", "", rest)
    while flat != (flat := re.sub(r"\{[^{}]*\}", "", flat)):
        pass
    return tuple(re.findall(r"(\w+)(?:\[[^\]]*\])*\s*=", flat)) or tuple(re.findall(r"(\w+)\s*;", flat))


def after_angles(text: str) -> str:
    """What follows the balanced < > that `text` begins with, after the word template."""
    depth = 0
    for at, letter in enumerate(text):
        depth += (letter == "<") - (letter == ">")
        if letter == ">" and depth == 0:
            return text[at + 1 :]
    return ""
