"""The catalogue: robots that come with the library, one TOML file each, found by any of their names."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from cspace.errors import InputTypeError, UnknownNameError, suggest
from cspace.model import Description, from_toml
from cspace.tables import show_fields

FOLDER: Final = Path(__file__).parent / "catalogue"
INDEX: Final = Path(__file__).parent / "index.json"
"""The rows of the catalogue, made from its files by tools/catalogue.py; change those."""
SEPARATORS: Final = r"[\s._-]"
"""Separators that are allowed anywhere in the name of a robot."""


@show_fields
@dataclass(frozen=True)
class CatalogueRow:
    """The entry of a robot in the catalogue, available without opening its file.

    name: as in load_robot. dof: joints that move. joints: their word, "6R" or "RRPRRR". title, vendor: in
    plain words. source, licence: of the joint frames. aliases: other names. missing: what nobody published.
    """

    name: str
    dof: int
    joints: str
    title: str
    vendor: str
    source: str
    licence: str
    aliases: tuple[str, ...]
    missing: tuple[str, ...]


class CatalogueRows(tuple[CatalogueRow, ...]):
    """Entries of the catalogue, printed as one line per robot: its name, joints, title and maker."""

    __slots__ = ()

    def __repr__(self) -> str:
        cells = [(row.name, row.joints, row.title, row.vendor) for row in self]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = ("  ".join(map(str.ljust, row, widths)).rstrip() for row in cells)
        return "\n".join(lines) or "no robots"


@cache
def rows() -> CatalogueRows:
    """Every robot of the catalogue, by name."""
    read = json.loads(INDEX.read_text(encoding="utf-8"))
    return CatalogueRows(CatalogueRow(*row[:-2], *map(tuple, row[-2:])) for row in read)


@cache
def names() -> tuple[str, ...]:
    """The names of the robots in the catalogue, in order, without aliases."""
    return tuple(row.name for row in rows())


def find(name: str) -> str:
    """The catalogue name of a robot called by any of its names.

    Capitals count as small letters; blanks, dashes, underscores and full stops do not count: "UR-5e" is ur5e.
    Every other character counts: "ur@5e" is not a name. The maker may come first: "KUKA KR 6 R900".
    Raises UnknownNameError with the nearest names.
    """
    _check_text(name, "a robot of the catalogue")
    key = _key(name)
    found = _plain_names().get(key) or _after_its_maker(key)
    if found is not None:
        return found
    known = [known for row in rows() for known in (row.name, *row.aliases)]
    text = str(suggest("robot", name, known, owner="the catalogue"))
    text = text[: text.rindex(f" {len(known)} robots")]
    raise UnknownNameError(
        f"{text} cs.robots.names() lists all {len(rows())}, cs.robots.search() searches them;"
        " the path of a .urdf or .toml file is accepted too"
    )


def catalogue_description(name: str) -> Description:
    """The description of a robot of the catalogue; raises as `find`."""
    return _read(find(name))


@cache
def _read(name: str) -> Description:
    """The description in the file of a robot, which is read once: nothing can change it."""
    return from_toml(FOLDER / f"{name}.toml")


def search(text: str) -> CatalogueRows:
    """The robots for which every word of `text` fits, the best first.

    A word fits where it stands in the name, an alias, the title or the vendor, or equals the number of
    joints ("7") or their word ("7r", "rrprrr"). Whole words count more than parts. An empty text fits all.
    """
    _check_text(text, "a search")
    words = re.findall(r"[^\s,;]+", text.lower())
    scored = [(min((_fit(row, word) for word in words), default=1), row) for row in rows()]
    fitting = [(score, row) for score, row in scored if score > 0]
    return CatalogueRows(row for _, row in sorted(fitting, key=lambda pair: (-pair[0], pair[1].name)))


def plain_text(name: str) -> str:
    """A text as a search compares it: small letters and digits alone."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _key(name: str) -> str:
    """A name without capitals and separators."""
    return re.sub(SEPARATORS, "", name.lower())


@cache
def _plain_names() -> dict[str, str]:
    """The key of every name and alias, with the name that it means."""
    return {_key(known): row.name for row in rows() for known in (row.name, *row.aliases)}


def _after_its_maker(key: str) -> str | None:
    """The robot whose maker, whole or by the first word, and one of whose names make up `key`."""
    for row in rows():
        for maker in {_key(row.vendor), _key(row.vendor.split()[0])}:
            if key.startswith(maker) and _plain_names().get(key[len(maker) :]) == row.name:
                return row.name
    return None


def _check_text(value: object, subject: str) -> None:
    if not isinstance(value, str):
        raise InputTypeError(f"{subject} must be a string, got {type(value).__name__}")


def _fit(row: CatalogueRow, word: str) -> int:
    """How well a word fits: 2 as a whole, 1 as a part, 0 not at all."""
    whole = set(_words(row)) | {str(row.dof), row.joints.lower()}
    if word in whole or plain_text(word) in {plain_text(part) for part in whole} - {""}:
        return 2
    texts = (row.name, *row.aliases, row.title, row.vendor)
    if word.isdecimal():  # a number must be a whole word: 7 fits iiwa7, not kr210_r2700
        return int(any(re.search(rf"(?<!\d){word}(?!\d)", text) for text in texts))
    key = plain_text(word)
    return int(bool(key) and any(key in plain_text(text) for text in texts))


def _words(row: CatalogueRow) -> Iterator[str]:
    yield from (row.name, *row.aliases)
    for text in (row.title, row.vendor):
        yield from re.findall(r"[^\s,;()]+", text.lower())
