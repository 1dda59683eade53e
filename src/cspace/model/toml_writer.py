"""Robots written as TOML: the whole description, every number with all its digits."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.files import write_text
from cspace.model.description import Description
from cspace.model.joint import Joint, Mimic
from cspace.model.link import Link, Mesh
from cspace.model.toml import FORMAT
from cspace.model.values import IDENTITY

BARE = re.compile(r"[A-Za-z0-9_-]+")


def to_toml(description: Description, path: str | os.PathLike[str] | None = None) -> str:
    """The robot as the text of a TOML file, written to `path` as well if there is one.

    Reading it back gives the same numbers, bit for bit. A file is written whole or not at all.
    Raises InputError for a path that cannot be written.
    """
    about = description.provenance
    head: dict[str, Any] = {"format": FORMAT, "name": description.name}
    head |= {"title": about.title, "vendor": about.vendor} if about.title or about.vendor else {}
    head |= {"aliases": about.aliases} if about.aliases else {}
    head |= {"missing": about.missing} if about.missing else {}
    lines = list(_pairs(head))
    if description.allowed_pairs:
        lines += ["allowed_pairs = [", *(f"  {toml_value(p)}," for p in description.allowed_pairs), "]"]
    for group, source in about.sources.items():
        lines += _section(f"[sources.{_key(group)}]", {"source": source.source, "licence": source.licence})
    for link in description.links:
        lines += _link(link)
    for joint in description.joints:
        lines += _section("[[joints]]", _fields(joint))
    for loop in description.loops:
        lines += _section("[[loops]]", _fields(loop))
    for pose, values in description.poses.items():
        lines += _section(f"[poses.{_key(pose)}]", dict(values))
    text = "\n".join(lines) + "\n"
    if path is not None:
        write_text(path, text)
    return text


def toml_value(value: Any) -> str:
    """A value as TOML writes it: text, numbers, lists and inline tables."""
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))  # an infinity is inf in both languages
    if isinstance(value, Mapping):
        return "{ " + ", ".join(_pairs(value)) + " }"
    items = [toml_value(item) for item in value]
    return "[" + ", ".join(items) + "]"


def _text(value: str) -> str:
    try:
        value.encode()
    except UnicodeEncodeError:
        raise InputError(f"the text {value!r} cannot be written as UTF-8") from None
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(key: str) -> str:
    return key if BARE.fullmatch(key) else _text(key)


def _pairs(values: Mapping[str, Any]) -> Iterator[str]:
    for key, value in values.items():
        yield f"{_key(key)} = {toml_value(value)}"


def _section(header: str, values: Mapping[str, Any]) -> list[str]:
    return ["", header, *_pairs(values)]


def _place(T: Array, key: str = "origin") -> dict[str, Any]:
    """A placement: nothing for the identity, xyz for a translation, else all sixteen numbers."""
    if T is IDENTITY:
        return {}
    if key == "origin" and np.array_equal(T[:3, :3], np.eye(3)):
        return {"xyz": T[:3, 3]}
    return {key: T}


def _link(link: Link) -> Iterable[str]:
    values: dict[str, Any] = {"name": link.name}
    lines = _section("[[links]]", values | ({} if link.inertial is None else _fields(link.inertial)))
    for key, shapes in (("visual", link.visual), ("collision", link.collision)):
        for geometry in shapes:
            lines += _section(f"[[links.{key}]]", _fields(geometry))
    return lines


def _fields(part: Any) -> dict[str, Any]:
    """The fields of a part by the keys of the file, which are their names; what is absent is left out."""
    values: dict[str, Any] = {}
    for field in fields(part):
        value = getattr(part, field.name)
        if field.name in ("origin", "child_origin"):
            values |= _place(value, field.name)
        elif isinstance(value, Mesh):
            values |= {"mesh": value.uri, "scale": value.scale}
        elif isinstance(value, Mimic):
            values[field.name] = _fields(value)
        elif isinstance(value, float) and math.isinf(value):  # no limit
            continue
        elif isinstance(value, np.ndarray) or value not in (None, "", ()):
            values[field.name] = value
    if isinstance(part, Joint) and part.type in ("fixed", "floating"):
        del values["axis"]
    return values
