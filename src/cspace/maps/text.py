"""Polygons from plain text: a point per line, an empty line between rings."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from cspace.errors import DescriptionError

__all__ = ["read_text"]


def read_text(path: str | os.PathLike[str]) -> tuple[list[Any], list[float] | None]:
    """The obstacles, each a list of rings, and the bounds if a line gives them."""
    name = os.fspath(path)
    try:
        lines = Path(name).read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise DescriptionError(f"cannot be read: {error.strerror or error}", path=name) from None
    except UnicodeDecodeError:
        raise DescriptionError("is no text", path=name) from None
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
                raise DescriptionError("a hole before any polygon", path=name, line=number)
            ring, is_hole = None, True
        elif words[0] == "bounds":
            bounds = _numbers(words[1:], 4, name, number)
        else:
            point = _numbers(words, 2, name, number)
            if ring is None:
                ring = []
                if is_hole:
                    obstacles[-1].append(ring)
                else:
                    obstacles.append([ring])
                is_hole = False
            ring.append(point)
    return obstacles, bounds


def _numbers(words: list[str], count: int, path: str, line: int) -> list[float]:
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        wanted = "a point is two numbers" if count == 2 else "bounds are xmin ymin xmax ymax"
        raise DescriptionError(f"cannot read {' '.join(words)[:60]!r}; {wanted}", path=path, line=line)
    return numbers
