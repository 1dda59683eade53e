"""Plain text: reads and writes polygons, a point per line and an empty line between rings."""

from __future__ import annotations

import os
from typing import Any

from cspace.arrays import Array
from cspace.errors import MapError
from cspace.files import write_text
from cspace.maps.files import check_map_path, read_map_text


def read_polygons(path: str | os.PathLike[str]) -> tuple[list[Any], list[float] | None]:
    """The obstacles, each a list of rings, and the bounds if a line gives them."""
    name, lines = check_map_path(path), read_map_text(path).splitlines()
    obstacles: list[list[list[list[float]]]] = []
    bounds: list[float] | None = None
    ring: list[list[float]] | None = None
    is_hole = False
    for number, line in enumerate(lines, 1):
        words = line.split("#", 1)[0].replace(",", " ").split()
        if not words:
            ring = None if not line.strip() else ring
        elif words[0] == "hole":
            if not obstacles:
                raise MapError(
                    "a hole before the first polygon; a hole must follow its polygon", path=name, line=number
                )
            ring, is_hole = None, True
        elif words[0] == "bounds":
            bounds = _read_numbers(words[1:], 4, name, number)
        else:
            point = _read_numbers(words, 2, name, number)
            if ring is None:
                ring = []
                if is_hole:
                    obstacles[-1].append(ring)
                else:
                    obstacles.append([ring])
                is_hole = False
            ring.append(point)
    return obstacles, bounds


def write_polygons(
    path: str | os.PathLike[str], obstacles: list[list[Array]], bounds: tuple[float, ...]
) -> None:
    """Writes obstacles, each a list of rings (n, 2) [m], and the bounds, with every digit preserved."""
    rings = [
        ("hole\n" if number else "") + "".join(f"{x!r} {y!r}\n" for x, y in ring.tolist())
        for polygon in obstacles
        for number, ring in enumerate(polygon)
    ]
    write_text(path, "\n".join(["bounds " + " ".join(map(repr, bounds)) + "\n", *rings]))


def _read_numbers(words: list[str], count: int, path: str, line: int) -> list[float]:
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        wanted = "a point is two numbers" if count == 2 else "bounds are xmin ymin xmax ymax"
        raise MapError(f"cannot read {' '.join(words)[:60]!r}; {wanted}", path=path, line=line)
    return numbers
