"""Wavefront OBJ files: vertices and faces."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from cspace.arrays import Array
from cspace.errors import MeshError
from cspace.shapes.triangles import Faces


def parse_obj(data: bytes) -> tuple[Array, Faces]:
    """Vertices (k, 3) and triangles (m, 3); negative numbers count from the last vertex."""
    vertices: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    text = data.decode("utf-8", "replace").replace("\\\n", " ")
    for line, row in enumerate(text.splitlines(), 1):
        words = row.split()
        if not words or words[0] not in ("v", "f"):
            continue
        try:
            if words[0] == "v":
                vertices.append([float(word) for word in words[1:4]])
                if len(vertices[-1]) != 3:
                    raise ValueError
            else:
                faces += cut_fan([read_number(word, len(vertices)) for word in words[1:]])
        except ValueError:
            what = "three numbers" if words[0] == "v" else "numbers of vertices above"
            raise MeshError(f"'{row.strip()[:60]}': expected {what}", line=line) from None
    return np.array(vertices).reshape(-1, 3), np.array(faces, dtype=np.intp).reshape(-1, 3)


def read_number(word: str, count: int) -> int:
    """The vertex number, from 0, of a corner such as 3, 3/1, 3//2 or -1."""
    number = int(word.split("/")[0])
    index = number - 1 if number > 0 else count + number
    if not 0 <= index < count:
        raise ValueError
    return index


def cut_fan(corners: list[int]) -> list[tuple[int, int, int]]:
    """The triangles between the first corner of a polygon and its other sides."""
    if len(corners) < 3:
        raise ValueError
    return [(corners[0], b, c) for b, c in pairwise(corners[1:])]
