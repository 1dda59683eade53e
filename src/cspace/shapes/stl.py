"""STL files, binary and text."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import MeshError
from cspace.shapes.triangles import Faces

HEADER: Final = 84
"""Bytes before the first triangle of a binary file: 80 of text, and the count."""

RECORD: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

VERTEX: Final = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.I)


def parse_stl(data: bytes) -> tuple[Array, Faces]:
    """Vertices (3 m, 3) and triangles (m, 3) of an STL file; normals are not read.

    A file is binary where its size agrees with its count, whatever its first word is.
    """
    if len(data) >= HEADER:
        count = int.from_bytes(data[80:HEADER], "little")
        if len(data) == HEADER + count * RECORD.itemsize:
            corners = np.frombuffer(data, RECORD, count, HEADER)["corners"]
            return number_corners(corners.astype(np.float64).reshape(-1, 3))
        if b"\0" in data:
            have = (len(data) - HEADER) / RECORD.itemsize
            raise MeshError(
                f"the file announces {count} triangles and has room for {have:.6g}; it is cut off"
            )
    if data.lstrip()[:5].lower() != b"solid":
        raise MeshError("this is no STL file: it has neither the size of a binary file nor the word 'solid'")
    numbers = VERTEX.findall(data)
    if len(numbers) % 3 or not re.search(rb"\bendsolid\b", data, re.I):
        raise MeshError("the text ends inside a facet or without 'endsolid'; it is cut off")
    return number_corners(np.array(numbers).astype(np.float64).reshape(-1, 3))


def number_corners(corners: Array) -> tuple[Array, Faces]:
    """The corners (3 m, 3) of triangles, and their numbers (m, 3)."""
    return corners, np.arange(len(corners), dtype=np.intp).reshape(-1, 3)
