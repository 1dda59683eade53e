"""PLY files, text and binary."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import MeshError
from cspace.shapes.obj import cut_fan
from cspace.shapes.triangles import Faces

TYPES: Final = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
"""The types of numbers, and numpy's names for them."""

ORDERS: Final = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass
class ElementTable:
    """An element of the header: its name, how many there are, and per property (name, type, type of the count
    of a list or "")."""

    name: str
    count: int
    properties: list[tuple[str, str, str]] = field(default_factory=list)


def parse_ply(data: bytes) -> tuple[Array, Faces]:
    """Vertices (k, 3) and triangles (m, 3) of a PLY file."""
    end = re.search(rb"^end_header\r?\n", data, re.M)
    if not data.startswith(b"ply") or end is None:
        raise MeshError("this is no PLY file: it must begin with 'ply' and have a line 'end_header'", line=1)
    order, tables = read_header(data[: end.start()].decode("ascii", "replace"))
    reader = TextNumbers(data[end.end() :]) if order == "" else BinaryNumbers(data[end.end() :], order)
    vertices, faces = np.empty((0, 3)), []
    for table in tables:
        if table.name == "vertex":
            names = [name for name, *_ in table.properties]
            rows = reader.read_rows(table)
            vertices = rows[:, [names.index(axis) for axis in "xyz"]]
        elif table.name == "face":
            for _ in range(table.count):
                faces += cut_fan(reader.read_face(table))
            break
        else:
            reader.read_rows(table)
    return vertices, np.array(faces, dtype=np.intp).reshape(-1, 3)


def read_header(text: str) -> tuple[str, list[ElementTable]]:
    """The order of bytes ("" for text) and the elements."""
    order, tables = None, []
    for line, row in enumerate(text.splitlines(), 1):
        words = row.split()
        try:
            if words[:1] == ["format"]:
                order = ORDERS[words[1]]
            elif words[:1] == ["element"]:
                tables.append(ElementTable(words[1], int(words[2])))
            elif words[:2] == ["property", "list"]:
                tables[-1].properties.append((words[4], TYPES[words[3]], TYPES[words[2]]))
            elif words[:1] == ["property"]:
                tables[-1].properties.append((words[2], TYPES[words[1]], ""))
        except (KeyError, IndexError, ValueError):
            raise MeshError(f"'{row.strip()[:60]}' is no line of a PLY header", line=line) from None
    if order is None:
        raise MeshError("the PLY header has no format", line=1)
    return order, tables


class TextNumbers:
    """The numbers of the text behind a header, one after the other."""

    def __init__(self, data: bytes) -> None:
        self.numbers = np.array(data.split()).astype(np.float64) if data.strip() else np.empty(0)
        self.at = 0

    def take(self, count: int, kind: str) -> Array:
        """The next numbers; MeshError where there are fewer."""
        self.at += count
        if self.at > len(self.numbers):
            raise MeshError("the PLY file ends before its last element; it is cut off")
        return self.numbers[self.at - count : self.at]

    def read_rows(self, table: ElementTable) -> Array:
        """The properties (n, p) of an element without lists."""
        refuse_lists(table)
        width = len(table.properties)
        return self.take(table.count * width, "").reshape(table.count, width)

    def read_face(self, table: ElementTable) -> list[int]:
        """The vertex numbers of the next face."""
        corners: list[int] = []
        for name, kind, counted in table.properties:
            count = int(self.take(1, counted)[0]) if counted else 1
            numbers = self.take(count, kind)
            if not np.isfinite(numbers).all():
                raise MeshError("a face of the PLY file has a number that is not finite")
            if counted and name in ("vertex_indices", "vertex_index"):
                corners = numbers.astype(np.intp).tolist()
        return corners


class BinaryNumbers(TextNumbers):
    """The numbers of the bytes behind a header."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data, self.order, self.at = data, order, 0

    def take(self, count: int, kind: str) -> Array:
        """The next numbers of a type; MeshError where there are fewer."""
        dtype = np.dtype(self.order + kind)
        start = self.at
        self.at += count * dtype.itemsize
        if self.at > len(self.data):
            raise MeshError("the PLY file ends before its last element; it is cut off")
        return np.frombuffer(self.data, dtype, count, start).astype(np.float64)

    def read_rows(self, table: ElementTable) -> Array:
        """The properties (n, p) of an element without lists."""
        refuse_lists(table)
        row = np.dtype([(f"{i}", self.order + kind) for i, (_, kind, _) in enumerate(table.properties)])
        start, self.at = self.at, self.at + table.count * row.itemsize
        if self.at > len(self.data):
            raise MeshError("the PLY file ends before its last element; it is cut off")
        rows = np.frombuffer(self.data, row, table.count, start)
        with np.errstate(invalid="ignore"):  # a signalling NaN, which the caller refuses
            return np.stack([rows[name].astype(np.float64) for name in row.names or ()], axis=-1)


def refuse_lists(table: ElementTable) -> None:
    """MeshError for an element with lists other than the faces."""
    if any(counted for *_, counted in table.properties):
        raise MeshError(f"the element {table.name!r} has lists; only faces may have them")
