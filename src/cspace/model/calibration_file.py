"""The calibration of one UR arm as the package ur_calibration of ROS writes it.

The file is YAML, of which it needs a corner: keys and values, two levels deep. A reader of that corner tells
the line of every fault and needs no package; whatever else YAML could say is refused.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from cspace.arrays import Array
from cspace.errors import DescriptionError, suggest
from cspace.files import YamlLine, unquote, yaml_lines
from cspace.model.files import path_of, read_bytes
from cspace.model.transforms import from_rpy
from cspace.model.values import freeze_array
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


def read_calibration(path: str | os.PathLike[str]) -> Calibration:
    """The calibration in a YAML file: below `kinematics`, x, y, z [m] and roll, pitch, yaw [rad] per link.

    Raises DescriptionError with file and line for a missing, unknown or non-numeric entry, or a missing file.
    """
    name = path_of(path)
    data = read_bytes(name)
    if len(data) > CALIBRATION_BYTES:
        raise DescriptionError(
            f"the file has {len(data)} bytes; the maximum is {CALIBRATION_BYTES}", path=name
        )
    return _Reader(name, data).read()


class _Reader:
    """Reads one file line by line."""

    def __init__(self, path: str, data: bytes) -> None:
        self.path = path
        self.data = data
        self.hash = ""
        self.values: dict[str, dict[str, float]] = {}
        self.lines: dict[str, int] = {}

    def fault(self, message: str, line: int) -> DescriptionError:
        return DescriptionError(message, path=self.path, line=line)

    def read(self) -> Calibration:
        try:
            text = self.data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = self.data.count(b"\n", 0, error.start) + 1
            raise self.fault("this is no calibration: not UTF-8 text", line) from None
        rows = list(yaml_lines(text))
        if not rows or (rows[0].indent, rows[0].key, rows[0].value) != (0, "kinematics", ""):
            line = rows[0].line if rows else 1
            raise self.fault(
                "a calibration begins with the key kinematics: (see ur_calibration of ROS)", line
            )
        indents: list[int] = []
        part = ""
        for row in rows[1:]:
            part = self.take(row, indents, part)
        return Calibration(self.path, MappingProxyType(self.origins(rows[0].line)), self.hash)

    def take(self, row: YamlLine, indents: list[int], part: str) -> str:
        """Read one line; `indents` holds the indents of parts and numbers once they are seen."""
        line, indent, key, value = row.line, row.indent, row.key, unquote(row.value)
        if key in ("", "-"):
            raise self.fault(f"{row.value[:60]!r}: expected a key and a value, like x: 0.1", line)
        if indent == 0:
            raise self.fault(f"{key!r} stands beside kinematics; it belongs below it, indented", line)
        if not indents or (len(indents) == 1 and indent > indents[0]):
            indents.append(indent)
        if indent not in indents:
            raise self.fault(f"{key!r} is indented by {indent}; the lines before are by {indents}", line)
        if indent == indents[0]:
            return self.start(key, value, line)
        self.number(part, key, value, line)
        return part

    def start(self, key: str, value: str, line: int) -> str:
        """A key of the first level: a part of the arm, or the checksum."""
        if key == "hash":
            self.hash = value
            return ""
        if key not in PARTS:
            raise self.fault(str(suggest("link", key, (*PARTS, "hash"), owner="a calibration")), line)
        if key in self.values:
            raise self.fault(f"{key!r} is there twice", line)
        if value:
            raise self.fault(
                f"{key!r} has the value {value[:60]!r}; expected x, y, z, roll, pitch, yaw below", line
            )
        self.values[key], self.lines[key] = {}, line
        return key

    def number(self, part: str, key: str, value: str, line: int) -> None:
        """A key of the second level: one number of a part."""
        if not part:
            raise self.fault(f"{key!r} stands below no link", line)
        if key not in NUMBERS:
            raise self.fault(str(suggest("number", key, NUMBERS, owner=part)), line)
        if key in self.values[part]:
            raise self.fault(f"{key!r} of {part} is there twice", line)
        try:
            number = float(value)
            if "_" in value or not math.isfinite(number) or abs(number) > LARGEST_NUMBER:
                raise ValueError
        except ValueError:
            raise self.fault(f"{key!r} of {part} is {value[:60]!r}; expected a finite number", line) from None
        self.values[part][key] = number

    def origins(self, line: int) -> dict[str, Array]:
        """The frames of all parts, none of them missing."""
        found: dict[str, Array] = {}
        for part in PARTS:
            if part not in self.values:
                raise self.fault(f"the calibration has no {part!r}; it holds {', '.join(PARTS)}", line)
            numbers = self.values[part]
            missing = [key for key in NUMBERS if key not in numbers]
            if missing:
                raise self.fault(f"{part!r} has no {', '.join(missing)}", self.lines[part])
            x, y, z, roll, pitch, yaw = (numbers[key] for key in NUMBERS)
            found[part] = freeze_array(from_rpy((x, y, z), (roll, pitch, yaw)))
        return found
