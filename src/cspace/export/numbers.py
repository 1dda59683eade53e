"""Numbers and names as literals of C++."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any

from cspace.errors import InputError

ENUMS = {"family": "ik::Family", "kind": "ik::FirstThree"}
INFINITY = "std::numeric_limits<double>::infinity()"


def write_initialiser(value: Mapping[str, Any]) -> str:
    """An aggregate, one field per paragraph, each with its name as comment."""
    lines = ["{"]
    for name, entry in value.items():
        text = textwrap.wrap(write_literal(entry, name) + ",", 96, break_on_hyphens=False)
        lines += [f"    {text[0]}  // {name}"] if len(text) == 1 else [f"    // {name}"]
        lines += [f"    {line}" for line in text] if len(text) > 1 else []
    return "\n".join([*lines, "}"])


def write_literal(value: Any, name: str = "") -> str:
    """A number, a list or a nested aggregate; text is unchanged."""
    if isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return "{" + ", ".join(write_literal(entry, key) for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "{" + ", ".join(write_literal(entry, name) for entry in value) + "}"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return f"{ENUMS[name]}({value})" if name in ENUMS else str(value)
    if not math.isfinite(value):
        raise InputError(f"{name} of the arm's plan is {value}; an export can contain only finite numbers")
    return repr(float(value))


def write_bounds(values: Iterable[float]) -> str:
    """Limits one after another; infinities where there are none."""
    return ", ".join(repr(v) if math.isfinite(v) else "-" * (v < 0) + INFINITY for v in values)


def quote_text(text: str) -> str:
    """A string literal in plain ASCII: everything else as the octal numbers of its UTF-8."""
    plain = {c: c for c in map(chr, range(32, 127)) if c not in '"\\?'}
    return '"' + "".join(plain.get(c) or "".join(f"\\{b:03o}" for b in c.encode()) for c in text) + '"'
