"""The calibration of one UR arm as the package ur_calibration of ROS writes it.

The file is YAML, of which it needs a corner: keys and values, two levels deep. A reader of that corner tells
the line of every fault and needs no package; whatever else YAML could say is refused.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Final

from cspace.arrays import Array
from cspace.errors import DescriptionError, suggest
from cspace.files import YamlLine, read_text, unquote, yaml_lines
from cspace.model.files import path_of
from cspace.model.values import freeze_array, from_rpy
from cspace.tolerances import CALIBRATION_BYTES, LARGEST_NUMBER

PARTS: Final = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
"""The links of the arm, in order; each entry places the joint that carries one."""

NUMBERS: Final = ("x", "y", "z", "roll", "pitch", "yaw")


@dataclass(frozen=True, eq=False)
class Calibration:
    """Where the joints of one UR arm were measured.

    path: of the file. origins: part → the frame (4, 4) of its joint in the link before. hash: the checksum of
    the controller, "" where the file has none.
    """

    path: str
    origins: Mapping[str, Array]
    hash: str


@dataclass(frozen=True)
class Entry:
    """A key of the file: its value as text, its line, and the entries below it."""

    value: str
    line: int
    below: dict[str, Entry]


def read_calibration(path: str | os.PathLike[str]) -> Calibration:
    """The calibration in a YAML file: below `kinematics`, x, y, z [m] and roll, pitch, yaw [rad] per link.

    Raises DescriptionError with file and line for a missing, unknown or non-numeric entry, or a missing file.
    """
    name = path_of(path)
    rows = list(yaml_lines(read_text(name, "calibration", CALIBRATION_BYTES, DescriptionError)))
    fault = partial(DescriptionError, path=name)
    first = rows[0] if rows else YamlLine(1, 0, "", "")
    if (first.indent, first.key, first.value) != (0, "kinematics", ""):
        raise fault(
            "a calibration begins with the key kinematics: (see ur_calibration of ROS)", line=first.line
        )
    entries = read_entries(rows[1:], fault)
    for part in PARTS:
        if part not in entries:
            raise fault(f"the calibration has no {part!r}; it holds {', '.join(PARTS)}", line=first.line)
    origins = {part: read_origin(part, entries[part], fault) for part in PARTS}
    checksum = entries["hash"].value if "hash" in entries else ""
    return Calibration(name, MappingProxyType(origins), checksum)


def read_entries(rows: Sequence[YamlLine], fault: Callable[..., DescriptionError]) -> dict[str, Entry]:
    """The entries below `kinematics`: the parts of the arm, each with its numbers, and the checksum."""
    parts: dict[str, Entry] = {}
    indents: list[int] = []  # of parts and of numbers, once they are seen
    part = ""
    for row in rows:
        line, indent, key = row.line, row.indent, row.key
        if key in ("", "-"):
            raise fault(f"{row.value[:60]!r}: expected a key and a value, like x: 0.1", line=line)
        if indent == 0:
            raise fault(f"{key!r} stands beside kinematics; it belongs below it, indented", line=line)
        if not indents or (len(indents) == 1 and indent > indents[0]):
            indents.append(indent)
        if indent not in indents:
            raise fault(f"{key!r} is indented by {indent}; the lines before are by {indents}", line=line)
        outer = indent == indents[0]
        if not outer and part == "hash":
            raise fault(f"{key!r} stands below no link", line=line)
        kind, known, owner = (
            ("link", (*PARTS, "hash"), "a calibration") if outer else ("number", NUMBERS, part)
        )
        if key not in known:
            raise fault(str(suggest(kind, key, known, owner=owner)), line=line)
        entries = parts if outer else parts[part].below
        if key in entries:
            raise fault(f"{key!r}{'' if outer else f' of {part}'} is there twice", line=line)
        entries[key] = Entry(unquote(row.value), line, {})
        part = key if outer else part
    return parts


def read_origin(part: str, entry: Entry, fault: Callable[..., DescriptionError]) -> Array:
    """The frame (4, 4) of one part, none of its numbers missing."""
    if entry.value:
        rule = "expected x, y, z, roll, pitch, yaw below"
        raise fault(f"{part!r} has the value {entry.value[:60]!r}; {rule}", line=entry.line)
    if missing := [key for key in NUMBERS if key not in entry.below]:
        raise fault(f"{part!r} has no {', '.join(missing)}", line=entry.line)
    numbers = []
    for key in NUMBERS:
        value = entry.below[key].value
        try:
            numbers.append(float(value))
            if "_" in value or not math.isfinite(numbers[-1]) or abs(numbers[-1]) > LARGEST_NUMBER:
                raise ValueError
        except ValueError:
            text = f"{key!r} of {part} is {value[:60]!r}; expected a finite number"
            raise fault(text, line=entry.below[key].line) from None
    x, y, z, roll, pitch, yaw = numbers
    return freeze_array(from_rpy((x, y, z), (roll, pitch, yaw)))
