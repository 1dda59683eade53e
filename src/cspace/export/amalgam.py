"""One text from many headers: what an entry needs of them, under a name of its own."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from cspace.export.headers import Piece, pieces_of, with_included, words_of

__all__ = ["amalgamate"]


def amalgamate(
    entries: Iterable[str], needed: str, replaced: Mapping[str, str], unwanted: Iterable[str] = ()
) -> tuple[list[str], str]:
    """The standard headers to include, and the text of all that `needed` mentions, directly or not.

    entries: headers of the core. needed: code that will stand behind the text. replaced: declarations that
    stand in for those of a name, written where the first of these stood. unwanted: names; what declares or
    mentions one is left out.
    """
    headers = with_included(entries)
    refused = set(unwanted)
    wanted = [(name, [p for p in pieces_of(name) if not refused & p.mentions]) for name in headers]
    pieces = [(name, substituted(some, replaced)) for name, some in wanted]
    kept = reachable([piece for _, some in pieces for piece in some], needed)
    standard: set[str] = set()
    parts: list[str] = []
    for name, some in pieces:
        text = laid_out([piece for piece in some if id(piece) in kept], standard)
        if text:
            parts.append(f"// --- {name.removeprefix('cspace/')} ---\n{text}")
    return sorted(standard), "\n".join(parts)


def substituted(pieces: Iterable[Piece], replaced: Mapping[str, str]) -> list[Piece]:
    done: list[Piece] = []
    written: set[str] = set()
    for piece in pieces:
        names = [name for name in piece.names if name in replaced]
        if not names:
            done.append(piece)
        elif names[0] not in written:
            written.add(names[0])
            text = replaced[names[0]]
            declared, mentions = words_of(text)
            done.append(Piece(text, piece.namespace, False, piece.conditional, (*names, *declared), mentions))
    return done


def reachable(pieces: list[Piece], needed: str) -> set[int]:
    """The ids of the pieces that `needed` leads to by name; what has no name is always kept."""
    by_name: dict[str, list[Piece]] = {}
    for piece in pieces:
        for name in piece.names:
            by_name.setdefault(piece.scope + name, []).append(piece)
    always = [p for p in pieces if p.directive or p.conditional or not p.names]
    kept = {id(piece) for piece in always}
    open_words = set(words_of(needed)[1]).union(*map(words_in_scope, always))
    done: set[str] = set()
    while open_words:
        word = open_words.pop()
        done.add(word)
        for piece in by_name.get(word, ()):
            kept.add(id(piece))
            open_words |= words_in_scope(piece) - done
    return kept


def words_in_scope(piece: Piece) -> frozenset[str]:
    """What a piece mentions, also as a name of the namespace that it stands in."""
    return piece.mentions | {piece.scope + word for word in piece.mentions}


def laid_out(pieces: list[Piece], standard: set[str]) -> str:
    """A header's pieces inside their namespaces; the standard headers it includes go to `standard`."""
    lines: list[str] = []
    around: tuple[str, ...] = ()
    body = False
    for piece in pieces:
        found = re.fullmatch(r"#include <(.*)>", piece.text)
        if found and not piece.conditional:
            standard.add(found.group(1))
            continue
        if piece.namespace != around:
            lines += closing(around) + opening(piece.namespace)
            around = piece.namespace
        lines.append(piece.text)
        body = True
    return "\n".join([*lines, *closing(around)]) + "\n" if body else ""


def opening(namespace: tuple[str, ...]) -> list[str]:
    """Nested inline namespaces, which C++17 lacks, are opened one by one."""
    return [line.replace("::inline ", " { inline namespace ") + " {" for line in namespace]


def closing(namespace: tuple[str, ...]) -> list[str]:
    return ["}" * (1 + ("::inline " in line)) + f"  // {line}" for line in reversed(namespace)]
