"""Scenes: named obstacles, objects attached to a robot, and pairs that may touch."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from types import MappingProxyType
from typing import Final, cast

from cspace.arrays import Array
from cspace.collision.scene_files import read_scene, write_scene
from cspace.errors import InputError, InputTypeError, Renamed, name_type, suggest
from cspace.shapes import HalfSpace, Shape
from cspace.shapes.shape import check_place
from cspace.spatial.checks import PoseLike
from cspace.tables import html_table, one_line, show_fields, shown

VERSIONS: Final = count(1)
"""Numbers the scenes of this process: two different scenes never have the same."""


@show_fields
@dataclass(frozen=True, eq=False)
class Attachment:
    """Where an object is attached to a robot.

    frame: the frame that carries it. T_frame_object (4, 4): the pose of the object there. touch: the links
    and objects that it may touch, besides what moves with the frame.
    """

    frame: str
    T_frame_object: Array
    touch: tuple[str, ...] = ()


class Scene(Renamed):
    """The obstacles around a robot, as an immutable value: every edit returns a new scene.

    objects: shapes, placed in the world. A shape without a name gets one from its kind, such as "box_1".
    allowed: pairs of names that may touch: objects, links of a robot, or one of each.

    len(scene), `for shape in scene`, `"table" in scene`, scene["table"]. names: of the objects, in order.
    attached: name → Attachment, of objects that a robot carries. allowed: the pairs, each sorted. version: a
    number that no other scene of the process has.

    Names of objects and links are one namespace; names of links are checked when a scene is used with a
    robot. Raises InputError for two objects of one name, InputTypeError for an object that is not a shape.
    """

    def __init__(self, objects: Iterable[Shape] = (), *, allowed: Iterable[Sequence[str]] = ()) -> None:
        self._attached: dict[str, Attachment] = {}
        self._tried: dict[str, int] = {}  # numbers that unnamed objects of a kind have taken, at least
        self.version = next(VERSIONS)
        shapes = check_shapes(objects)
        self._objects: dict[str, Shape] = {shape.name: shape for shape in shapes}
        if "" in self._objects or len(self._objects) < len(shapes):
            self._objects = {}
            for shape in shapes:
                self._insert(shape)
        self._allowed = frozenset(check_pair(pair) for pair in allowed)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scene:
        """The scene of a file: TOML or JSON as `save` writes them, or a text file of MoveIt (.scene).

        Raises DescriptionError with the file, and with the table or the line, for one that cannot be read.
        """
        return cast("Scene", read_scene(path, cls()))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene as TOML or JSON, by the suffix of the path; the file is replaced atomically.

        Reading it back gives the same numbers. Raises InputError for another suffix, and for a path that
        cannot be written.
        """
        write_scene(self, path)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the objects, attached ones included, in the order in which they were added."""
        return tuple(self._objects)

    @property
    def attached(self) -> Mapping[str, Attachment]:
        """The objects that a robot carries, by name."""
        return MappingProxyType(self._attached)

    @property
    def obstacles(self) -> tuple[Shape, ...]:
        """The objects that are not attached, in order."""
        if not self._attached:
            return tuple(self._objects.values())
        return tuple(shape for name, shape in self._objects.items() if name not in self._attached)

    @property
    def allowed(self) -> tuple[tuple[str, str], ...]:
        """The pairs of names that may touch, sorted."""
        return tuple(sorted(self._allowed))

    def __len__(self) -> int:
        return len(self._objects)

    def __iter__(self) -> Iterator[Shape]:
        return iter(self._objects.values())

    def __contains__(self, name: object) -> bool:
        return name in self._objects

    def __getitem__(self, name: str) -> Shape:
        if not isinstance(name, str) or name not in self._objects:
            raise suggest("object", name, self._objects, owner="the scene")
        return self._objects[name]

    def add(self, *objects: Shape | Iterable[Shape]) -> Scene:
        """The scene with more objects: shapes, or lists of them. Errors as of Scene."""
        new = self._copy()
        for given in objects:
            for shape in check_shapes([given] if isinstance(given, Shape) else given):
                new._insert(shape)
        return new

    def remove(self, *names: str) -> Scene:
        """The scene without these objects, and without the pairs that name them.

        Raises UnknownNameError for an object that does not exist.
        """
        new = self._copy()
        new._tried = {}
        for name in names:
            del new._objects[new[name].name]
            new._attached.pop(name, None)
            new._allowed = frozenset(pair for pair in new._allowed if name not in pair)
            new._attached = {
                other: Attachment(a.frame, a.T_frame_object, tuple(n for n in a.touch if n != name))
                for other, a in new._attached.items()
            }
        return new

    def move(self, name: str, pose: PoseLike) -> Scene:
        """The scene with an object at another pose (4, 4) of the world, or position (3,).

        Raises UnknownNameError for an object that does not exist, InputError for an attached one.
        """
        shape = self[name]
        if name in self._attached:
            raise InputError(f"{name!r} is attached to {self._attached[name].frame!r}; detach it first")
        new = self._copy()
        new._objects[name] = shape.placed(pose)
        return new

    def attach(self, name: str, frame: str, T_frame_object: PoseLike, *, touch: Iterable[str] = ()) -> Scene:
        """The scene with an object carried by a frame of the robot, as when a gripper holds it.

        T_frame_object (4, 4), or a position (3,): the pose of the object in the frame. touch: names of links
        and objects that it may touch, such as the fingers; what moves with the frame needs no mention.
        Attaching again replaces frame, pose and touch. Raises UnknownNameError for an object that does not
        exist, InputError for a half space.
        """
        shape = self[name]
        if isinstance(shape, HalfSpace):
            raise InputError(f"{name!r} is a half space, which is unbounded; attach a box in its place")
        if isinstance(touch, str):
            raise InputTypeError(f"touch is the string {touch!r}; write a list of names, [{touch!r}]")
        place = check_place(T_frame_object, f"T_frame_object of {name!r}")
        new = self._copy()
        new._attached[shape.name] = Attachment(check_name(frame, "frame"), place, check_names(touch))
        return new

    def detach(self, name: str, pose: PoseLike | None = None) -> Scene:
        """The scene with an attached object as an obstacle again.

        pose (4, 4) or position (3,): where in the world; where it was before unless given. Raises
        UnknownNameError for an object that is not attached.
        """
        if self[name].name not in self._attached:
            raise suggest("attached object", name, self._attached, owner="the scene")
        new = self._copy()
        del new._attached[name]
        return new if pose is None else new.move(name, pose)

    def allow(self, a: str, b: str) -> Scene:
        """The scene in which a and b, objects or links, may touch."""
        new = self._copy()
        new._allowed = self._allowed | {check_pair((a, b))}
        return new

    def forbid(self, a: str, b: str) -> Scene:
        """The scene in which a and b may not touch, the inverse of `allow`.

        Raises UnknownNameError for a pair that is not allowed.
        """
        pair = check_pair((a, b))
        if pair not in self._allowed:
            raise suggest("allowed pair", " and ".join(pair), map(" and ".join, self._allowed))
        new = self._copy()
        new._allowed = self._allowed - {pair}
        return new

    def check_links(self, links: Iterable[str], frames: Collection[str], robot: str) -> None:
        """Check the names that belong to a robot: those of frames that carry objects, and of links.

        Raises UnknownNameError for a frame or link that the robot lacks, InputError for an object that has
        the name of a link.
        """
        for name in self._objects:
            if name in frames:
                raise InputError(f"object {name!r} has the name of a link of {robot}; give it another one")
        if not self._attached and not self._allowed:
            return
        known = {*links, *self._objects}
        for name, attachment in self._attached.items():
            if attachment.frame not in frames:
                raise suggest("frame", attachment.frame, frames, owner=f"{robot} (it carries {name!r})")
            for touched in attachment.touch:
                if touched not in known:
                    raise suggest("link or object", touched, known, owner=f"{robot} and its scene")
        for name in {name for pair in self._allowed for name in pair} - known:
            raise suggest("link or object", name, known, owner=f"{robot} and its scene")

    def _copy(self) -> Scene:
        new = Scene()
        new._objects, new._attached = dict(self._objects), dict(self._attached)
        new._allowed, new._tried = self._allowed, dict(self._tried)
        return new

    def _insert(self, shape: Shape) -> None:
        name = shape.name
        if not name:
            first = self._tried.get(shape.kind, 0) + 1
            number = next(i for i in count(first) if f"{shape.kind}_{i}" not in self._objects)
            self._tried[shape.kind] = number
            name = f"{shape.kind}_{number}"
            shape = shape.renamed(name)
        if name in self._objects:
            raise InputError(f"two objects of the scene have the name {name!r}; names must differ")
        self._objects[name] = shape

    def __repr__(self) -> str:
        many = f"{len(self)} object{'' if len(self) == 1 else 's'}"
        listed = ": " + ", ".join(self._objects) if self._objects else ""
        counts = ((len(self._attached), "attached"), (len(self._allowed), "allowed to touch"))
        parts = [f"{number} {what}" for number, what in counts if number]
        return one_line("Scene", many + ("; " + ", ".join(parts) if parts else "") + listed)

    def _repr_html_(self) -> str:
        rows = [
            (name, type(shape).__name__, shape._sizes(), *self._where(name))
            for name, shape in self._objects.items()
        ]
        pairs = "; may touch: " + ", ".join(f"{a} – {b}" for a, b in self.allowed) if self._allowed else ""
        titles = ("name", "shape", "sizes", "frame", "position [m]")
        return html_table(f"{len(self)} objects{pairs}", titles, rows)

    def _where(self, name: str) -> tuple[str, str]:
        """The frame of an object and its position there, as text."""
        attachment = self._attached.get(name)
        T = self._objects[name].pose if attachment is None else attachment.T_frame_object
        frame = "world" if attachment is None else attachment.frame
        return frame, ", ".join(shown(x) for x in T[:3, 3])


def check_shapes(objects: Iterable[Shape]) -> list[Shape]:
    """The shapes of a list; InputTypeError for anything else in it."""
    if isinstance(objects, Shape):
        raise InputTypeError("objects is one shape; write a list of shapes, in brackets")
    if isinstance(objects, (str, os.PathLike)):
        raise InputTypeError(f"objects is {str(objects)!r}; Scene.load(path) reads a file")
    try:
        found = list(objects)
    except TypeError:
        raise InputTypeError(f"objects is {name_type(objects)}; it must be a list of shapes") from None
    for k, shape in enumerate(found):
        if not isinstance(shape, Shape):
            raise InputTypeError(
                f"object {k} of the scene is {name_type(shape)}; it must be a shape, such as cs.Box"
            )
    return found


def check_name(value: object, subject: str) -> str:
    """A name: a string that is not empty."""
    if not isinstance(value, str) or not value:
        raise InputTypeError(f"{subject} is {value!r}; it must be a name")
    return value


def check_names(values: Iterable[object]) -> tuple[str, ...]:
    """Names of a list, each once."""
    return tuple(dict.fromkeys(check_name(value, "a name in touch") for value in values))


def check_pair(pair: Sequence[str]) -> tuple[str, str]:
    """Two different names, sorted."""
    if isinstance(pair, str) or len(pair) != 2:
        raise InputTypeError(f"an allowed pair is {pair!r}; it must be two names")
    a, b = sorted(check_name(name, "a name of an allowed pair") for name in pair)
    if a == b:
        raise InputError(f"the allowed pair names {a!r} twice; a pair is of two different names")
    return a, b
