"""Scene files of MoveIt: text with one object after the other."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import CspaceError, DescriptionError
from cspace.shapes import Box, Cylinder, HalfSpace, Mesh, Shape, Sphere
from cspace.spatial import pose

MOST_SHAPES: Final = 1_000_000
"""Largest count of shapes, vertices or triangles that is believed."""


def parse_moveit(text: str, path: str | None, scene: Any) -> Any:
    """A scene with the objects of a MoveIt text file (.scene) of both versions, with and without their poses.

    An object of several shapes becomes several objects, name/0, name/1, …. Colours and subframes are not
    read. A plane a x + b y + c z + d = 0 becomes the half space on its negative side. Raises
    DescriptionError with the line.
    """
    words = Words(text, path)
    words.skip_line()  # the name of the scene
    while (mark := words.next_word("'*' before an object, or '.' at the end")) != ".":
        if mark != "*":
            raise words.fault(f"{mark!r}: expected '*' before an object, or '.' at the end")
        name = words.skip_line().strip()
        new = words.line_has(3)
        T_world_object = words.pose() if new else np.eye(4)
        count = words.whole("the number of shapes", MOST_SHAPES)
        for k in range(count):
            shape = words.checked(partial(read_shape, words))
            T = T_world_object @ words.pose()
            words.floats(4)
            placed = shape.moved(T).renamed(
                name if count == 1 else f"{name}/{k}"
            )  # a plane has its own place
            scene = words.checked(partial(scene.add, placed))
        if new:
            for _ in range(words.whole("the number of subframes", MOST_SHAPES)):
                words.skip_line()
                words.pose()
    return scene


def read_shape(words: Words) -> Shape:
    """The shape that begins with its kind, in its own frame."""
    kind = words.next_word("a kind of shape")
    if kind == "box":
        return Box(words.floats(3))
    if kind == "sphere":
        return Sphere(float(words.floats(1)[0]))
    if kind == "cylinder":
        radius, length = words.floats(2).tolist()
        return Cylinder(radius, length)
    if kind == "plane":
        a, b, c, d = words.floats(4).tolist()
        length = max(float(np.linalg.norm([a, b, c])), np.finfo(float).tiny)
        return HalfSpace([a, b, c], -d / length)
    if kind == "mesh":
        vertices, faces = (
            words.whole(f"the number of {what}", MOST_SHAPES) for what in ("vertices", "triangles")
        )
        points = words.floats(3 * vertices).reshape(-1, 3)
        triangles = words.floats(3 * faces).reshape(-1, 3)
        surface = Mesh(points, triangles, solid=False)
        return Mesh(surface.vertices, surface.faces) if surface.closed else surface
    raise words.fault(f"shape {kind!r} cannot be read; shapes: box, sphere, cylinder, plane, mesh")


class Words:
    """The words of a text, one after the other, with their lines."""

    def __init__(self, text: str, path: str | None) -> None:
        self.text, self.path, self.at = text, path, 0

    def fault(self, message: str) -> DescriptionError:
        """The error at the present line."""
        return DescriptionError(message, path=self.path, line=self.text.count("\n", 0, self.at) + 1)

    def checked(self, make: Callable[[], Any]) -> Any:
        """What `make` returns; its complaint gets the line."""
        try:
            return make()
        except CspaceError as error:
            if isinstance(error, DescriptionError):
                raise
            raise self.fault(str(error)) from None

    def next_word(self, expected: str) -> str:
        """The next word."""
        found = re.compile(r"\S+").search(self.text, self.at)
        if found is None:
            raise self.fault(f"the file ends; expected {expected}")
        self.at = found.end()
        return found[0]

    def skip_line(self) -> str:
        """The rest of the line, or the next one where this one is at its end."""
        found = re.compile(r"[ \t]*\n?[ \t]*([^\n]*)").match(self.text, self.at)
        assert found is not None  # the pattern matches anything
        self.at = found.end()
        return found[1]

    def line_has(self, count: int) -> bool:
        """Whether the next line that is not empty has so many words."""
        found = re.compile(r"\s*([^\n]*)").match(self.text, self.at)
        return found is not None and len(found[1].split()) == count

    def floats(self, count: int) -> Array:
        """The next numbers (count,), all finite."""
        words = [self.next_word(f"{count} numbers") for _ in range(count)]
        try:
            numbers = np.array(words, dtype=object).astype(np.float64)
        except ValueError:
            raise self.fault(f"'{' '.join(words)[:60]}': expected {count} numbers") from None
        if not np.isfinite(numbers).all():
            raise self.fault(f"'{' '.join(words)[:60]}': every number must be finite")
        return numbers

    def whole(self, subject: str, most: int) -> int:
        """The next number as a count."""
        word = self.next_word(subject)
        if not word.isdecimal() or int(word) > most:
            raise self.fault(f"{word[:40]!r}: expected {subject}")
        return int(word)

    def pose(self) -> Array:
        """A position and a quaternion x y z w as a pose (4, 4)."""
        numbers = self.floats(7)
        return np.asarray(self.checked(lambda: pose(numbers[:3], xyzw=numbers[3:])))
