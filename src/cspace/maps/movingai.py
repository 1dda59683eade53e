"""Reads MovingAI maps and scenarios (N. Sturtevant, "Benchmarks for Grid-Based Pathfinding", 2012)."""

from __future__ import annotations

import math
import os
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError, MapError
from cspace.maps.files import check_map_path, read_map_bytes
from cspace.tables import show_fields
from cspace.tolerances import MAP_CELLS

FREE: Final = b".GS"
"""Ground and swamp."""

BLOCKED: Final = b"@OTW"
"""Out of bounds, trees and water. Water can only be entered from water."""


VERSIONS: Final = (["version", "1"], ["version", "1.0"])
"""First lines of a scenario file."""


@show_fields
class Scenarios(NamedTuple):
    """The queries of a scenario file, one row each."""

    start: npt.NDArray[np.int64]
    """(k, 2): x and y of the start, the column and the row of its cell."""
    goal: npt.NDArray[np.int64]
    """(k, 2): x and y of the goal."""
    length: Array
    """(k,): the length of the shortest path by eight moves without cutting corners [cells], as printed."""

    def ends(self, line: int, grid: Any) -> tuple[Array, Array]:
        """Start and goal of a query, 0 to k − 1, as points (2,) [m]: the centres of their cells in grid,
        the OccupancyGrid of the file's map. InputError for a query that does not exist, and for cells
        outside the grid."""
        count = len(self.length)
        if not (isinstance(line, (int, np.integer)) and 0 <= line < count):
            raise InputError(f"line is {line!r}; the file has {count} lines, numbered from 0")
        rows = np.array([self.start[line][::-1], self.goal[line][::-1]])
        if (rows >= grid.shape).any():
            sizes = " × ".join(map(str, grid.shape))
            raise InputError(
                f"line {line} has cells outside this grid of {sizes}; give the map of the scenario"
            )
        start, goal = grid.center_of(rows)
        return start, goal


def read_movingai(path: str | os.PathLike[str]) -> npt.NDArray[np.bool_]:
    """Which cells of a `.map` file are blocked, (rows, columns); the first line of the file is row 0."""
    name = check_map_path(path)
    lines = read_map_bytes(path).split(b"\n")
    if lines[0].split() != [b"type", b"octile"]:
        raise MapError("the first line of a MovingAI map must be 'type octile'", path=name, line=1)
    sizes: dict[bytes, int] = {}
    at = 1
    while at < len(lines) and lines[at].strip() != b"map":
        words = lines[at].split()
        if len(words) != 2 or words[0] not in (b"height", b"width") or not words[1].isdigit():
            raise MapError("expected 'height', 'width' and a whole number, or 'map'", path=name, line=at + 1)
        if len(words[1]) > 9 or not 0 < int(words[1]) <= MAP_CELLS:
            raise MapError(f"the number of cells of a side must be 1 … {MAP_CELLS}", path=name, line=at + 1)
        sizes[words[0]] = int(words[1])
        at += 1
    if len(sizes) < 2 or at >= len(lines):
        raise MapError(
            "the lines 'height …', 'width …' and 'map' come before the cells",
            path=name,
            line=min(at + 1, len(lines)),
        )
    return _read_cells(lines[at + 1 :], sizes[b"height"], sizes[b"width"], name, at + 2)


def _read_cells(lines: list[bytes], rows: int, columns: int, name: str, first: int) -> npt.NDArray[np.bool_]:
    """The cells of the lines; first: the number of the first line in the file."""
    rest = [line.rstrip(b"\r") for line in lines]
    while rest and not rest[-1].strip():
        rest.pop()
    for number, line in enumerate(rest[:rows]):
        if len(line) != columns:
            message = f"this row has {len(line)} cells; the width is {columns}"
            raise MapError(message, path=name, line=first + number)
    if len(rest) != rows:
        message = f"{len(rest)} rows of cells; the height is {rows}"
        raise MapError(message, path=name, line=first + min(len(rest), rows))
    cells = np.frombuffer(b"".join(rest), np.uint8).reshape(rows, columns)
    kinds = np.full(256, 2, np.uint8)
    kinds[list(FREE)], kinds[list(BLOCKED)] = 0, 1
    blocked = kinds[cells]
    if (blocked == 2).any():
        row, column = map(int, np.argwhere(blocked == 2)[0])
        said = ascii(chr(cells[row, column]))
        message = f"cell {column} is {said}; cells are . G S (free) or @ O T W (blocked)"
        raise MapError(message, path=name, line=first + row)
    return blocked.view(np.bool_)


def read_scenarios(path: str | os.PathLike[str]) -> Scenarios:
    """The queries of a `.scen` file: start, goal (k, 2), length (k,); MapError names the line at fault."""
    name = check_map_path(path)
    lines = read_map_bytes(path).decode("utf-8", "replace").split("\n")
    if lines[0].split() not in VERSIONS:
        raise MapError("the first line of a scenario file must be 'version 1'", path=name, line=1)
    rows: list[tuple[int, int, int, int]] = []
    lengths: list[float] = []
    for number, line in enumerate(lines[1:], 2):
        if not (words := line.rsplit(maxsplit=7)):
            continue
        try:
            ends, length = words[-5:-1], float(words[-1])
            x0, y0, x1, y1 = (int(word) for word in ends)
            bucket, _ = words[0].split(maxsplit=1)  # and the name of the map, which may contain spaces
            int(bucket)
        except ValueError:
            x0 = y0 = x1 = y1 = -1
            length = math.nan
        if len(words) != 8 or min(x0, y0, x1, y1) < 0 or max(x0, y0, x1, y1) > MAP_CELLS or not length >= 0:
            message = "expected bucket, map, width, height, the columns and rows of start and goal, length"
            raise MapError(message, path=name, line=number)
        rows.append((x0, y0, x1, y1))
        lengths.append(length)
    ends_of = np.array(rows, np.int64).reshape(-1, 4)
    return Scenarios(ends_of[:, :2].copy(), ends_of[:, 2:].copy(), np.array(lengths))
