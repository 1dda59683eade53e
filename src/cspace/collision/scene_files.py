"""Scenes as files: our TOML and JSON, written and read, and the text files of MoveIt, read."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import partial
from typing import Any, Final, TypeVar

import numpy as np

from cspace.collision.moveit import parse_moveit
from cspace.errors import CspaceError, DescriptionError, InputError, shown, suggest
from cspace.files import path_of, read_text, write_text
from cspace.model.toml_table import Document, Table, parse_toml
from cspace.model.toml_writer import toml_value
from cspace.model.values import from_rpy
from cspace.shapes import (
    Box,
    Capsule,
    Cylinder,
    HalfSpace,
    HeightField,
    Hull,
    Mesh,
    PointCloud,
    Shape,
    Sphere,
)
from cspace.tolerances import DESCRIPTION_BYTES

T = TypeVar("T")

FORMAT: Final = 1
"""The version of the file format that is written and read."""

KINDS: Final[dict[str, Any]] = {
    kind.kind: kind
    for kind in (Box, Sphere, Capsule, Cylinder, HalfSpace, Hull, Mesh, HeightField, PointCloud)
}
"""The shapes by their names in files."""

PLACE: Final = ("origin", "xyz", "rpy")
SUFFIXES: Final = (".toml", ".json", ".scene")


def read_scene(path: str | os.PathLike[str], empty: Any) -> Any:
    """The scene of a file, made from an empty one; see Scene.load."""
    name = path_of(path, "a scene file is given by its path")
    suffix = os.path.splitext(name)[1].lower()
    if suffix not in SUFFIXES:
        text = f"no scene of the suffix {suffix!r} can be read; the formats are {', '.join(SUFFIXES)}"
        raise DescriptionError(text, path=name)
    text = read_text(name, "scene", DESCRIPTION_BYTES, DescriptionError).replace("\r\n", "\n")
    if suffix == ".scene":
        return parse_moveit(text, name, empty)
    document = Document(text, name)
    top = parse_toml(document) if suffix == ".toml" else parse_json(document)
    return SceneReader(document).read(top, empty)


def parse_json(document: Document) -> Table:
    """The top table of a JSON document, or DescriptionError with file and line."""
    try:
        values = json.loads(document.text)
    except json.JSONDecodeError as error:
        raise document.fault(f"malformed JSON: {error.msg}", error.lineno) from None
    except (RecursionError, ValueError) as error:
        raise document.fault(f"malformed JSON: {error}") from None
    if not isinstance(values, dict):
        raise document.fault(f"the file must be an object in braces, got {type(values).__name__}")
    return Table(values, document, "", None)


class SceneReader:
    """Reads one document."""

    def __init__(self, document: Document) -> None:
        self.beside = os.path.dirname(os.path.abspath(document.path or ""))

    def read(self, top: Table, scene: Any) -> Any:
        """The scene with the objects of the top table."""
        top.known(("format", "objects", "attached", "allowed"))
        if top.number("format", FORMAT) != FORMAT:
            raise top.fault(f"format is {top.values['format']!r}; this version reads format {FORMAT}")
        for table in top.tables("objects"):
            scene = at_table(table, partial(self.add_object, scene, table))
        pairs = top.values.get("allowed", [])
        if not isinstance(pairs, list) or not all(isinstance(p, list) and len(p) == 2 for p in pairs):
            raise top.fault(f"allowed must be a list of pairs of names, got {shown(str(pairs))}")
        for pair in pairs:
            scene = at_table(top, partial(scene.allow, *pair))
        for table in top.tables("attached"):
            table.known(("object", "frame", "touch", *PLACE))
            name, frame, origin = table.text("object"), table.text("frame"), read_origin(table)
            attach = partial(scene.attach, name, frame, origin, touch=table.texts("touch"))
            scene = at_table(table, attach)
        return scene

    def add_object(self, scene: Any, table: Table) -> Any:
        """The scene with the object of one table."""
        return scene.add(self.shape(table))

    def shape(self, table: Table) -> Shape:
        """The shape of one object."""
        kind = table.text("shape")
        if kind not in KINDS:
            raise table.fault(str(suggest("shape", kind, KINDS)))
        names = [field.name for field in fields(KINDS[kind]) if field.init]
        sizes = [name for name in names if name not in ("pose", "name")]
        table.known(("shape", "name", *PLACE, *sizes, *(("file", "scale") if kind == "mesh" else ())))
        name, origin = table.text("name", ""), read_origin(table)
        if "file" in table:
            return self.mesh(table, name, origin)
        given = {key: table.values[key] for key in sizes if key in table}
        try:
            shape: Shape = KINDS[kind](pose=origin, name=name, **given)
            return shape
        except TypeError as error:
            if isinstance(error, CspaceError):
                raise
            missing = ", ".join(str(error).rpartition("argument")[2].lstrip("s: ").split(" and "))
            raise table.fault(f"a {kind} needs {missing}") from None

    def mesh(self, table: Table, name: str, origin: Any) -> Mesh:
        """A mesh by its file, beside the scene file unless the path is absolute."""
        path = os.path.join(self.beside, table.text("file"))
        scale, solid = table.values.get("scale", 1.0), table.values.get("solid")
        return Mesh.from_file(path, scale=scale, pose=origin, name=name, solid=solid)


def at_table(table: Table, make: Callable[[], T]) -> T:
    """What `make` returns; its complaint gets the place of the table."""
    try:
        return make()
    except CspaceError as error:
        if isinstance(error, DescriptionError):
            raise
        raise table.fault(str(error)) from None


def read_origin(table: Table) -> Any:
    """The pose (4, 4) under origin, or xyz and rpy."""
    if "origin" in table:
        if "xyz" in table or "rpy" in table:
            raise table.fault("give either origin or xyz and rpy, not both")
        return np.array(table.numbers("origin", (4, 4)))
    xyz, rpy = (table.numbers(key, (3,), (0.0, 0.0, 0.0)) for key in ("xyz", "rpy"))
    if not np.isfinite([*xyz, *rpy]).all():
        raise table.fault(f"xyz is {xyz}, rpy is {rpy}; every number must be finite")
    return from_rpy(tuple(xyz), tuple(rpy))


def write_scene(scene: Any, path: str | os.PathLike[str]) -> None:
    """The scene as a file; see Scene.save."""
    suffix = os.path.splitext(path_of(path, "a scene file is given by its path"))[1].lower()
    if suffix == ".toml":
        write_text(path, scene_toml(scene_values(scene)))
    elif suffix == ".json":
        write_text(path, json.dumps(scene_values(scene), indent=1, ensure_ascii=False) + "\n")
    else:
        raise InputError(f"the suffix of a scene file is {suffix!r}; it must be .toml or .json")


def scene_values(scene: Any) -> dict[str, Any]:
    """The scene as lists, texts and numbers."""
    values: dict[str, Any] = {"format": FORMAT}
    if scene.allowed:
        values["allowed"] = [list(pair) for pair in scene.allowed]
    values["objects"] = [shape_values(shape) for shape in scene]
    values["attached"] = [
        {"object": name, "frame": a.frame, "touch": list(a.touch), **place_values(a.T_frame_object)}
        for name, a in scene.attached.items()
    ]
    return values


def shape_values(shape: Shape) -> dict[str, Any]:
    """A shape as a table: its kind, name, sizes and place."""
    values: dict[str, Any] = {"name": shape.name, "shape": shape.kind}
    for field in fields(shape):  # type: ignore[arg-type]
        value = getattr(shape, field.name)
        if field.init and field.name not in ("pose", "name"):
            values[field.name] = value.tolist() if isinstance(value, np.ndarray) else value
    return values | place_values(shape.pose)


def place_values(T: Any) -> dict[str, Any]:
    """A pose as xyz, or as origin where it is turned."""
    if np.array_equal(T[:3, :3], np.eye(3)):
        return {"xyz": T[:3, 3].tolist()}
    return {"origin": T.tolist()}


def scene_toml(values: Mapping[str, Any]) -> str:
    """The values of a scene as TOML."""
    lines = []
    for key, value in values.items():
        if key in ("objects", "attached"):
            for table in value:
                lines += ["", f"[[{key}]]", *(f"{k} = {toml_value(v)}" for k, v in table.items())]
        else:
            lines.append(f"{key} = {toml_value(value)}")
    return "\n".join(lines) + "\n"
