"""Robots from TOML: as a tree of links and joints, as screws at zero, or as a Denavit–Hartenberg table."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, TypeVar

import numpy as np

from cspace.arrays import Array
from cspace.errors import CspaceError, DescriptionError
from cspace.files import read_text
from cspace.model.description import Description, Provenance, Source
from cspace.model.dh import DHTable, from_dh
from cspace.model.files import check_folders, path_of
from cspace.model.joint import LIMIT_FIELDS, RESISTANCES, Joint, Loop, Mimic
from cspace.model.link import Geometry, Inertial, Link, Mesh
from cspace.model.screws import from_screws
from cspace.model.structure import ElementError
from cspace.model.toml_table import Document, Table, parse_toml
from cspace.model.values import IDENTITY, X_AXIS, from_rpy
from cspace.tolerances import TOML_BYTES

FORMAT: Final = 1
"""The version of the file format that is written and read."""

T = TypeVar("T")
Poses = dict[str, dict[str, float]]

ABOUT = ("format", "name", "title", "vendor", "aliases", "missing", "sources", "poses", "allowed_pairs")
FORMS = {"joints": ("links", "joints", "loops"), "screws": ("screws",), "dh": ("dh",)}
PLACE = ("origin", "xyz", "rpy")
ENDS = ("name", "type", "parent", "child")
JOINT_KEYS = (*ENDS, *PLACE, "axis", *LIMIT_FIELDS, *RESISTANCES, "mimic")
GEOMETRY_KEYS = ("shape", "size", *PLACE, "name", "mesh", "scale", "color")
LETTERS = {"revolute": "R", "continuous": "R", "prismatic": "P", "fixed": "F"}
INERTIAL_KEYS = ("mass", "com", "inertia")
DH_KEYS = ("name", "type", "alpha", "a", "d", "theta", *LIMIT_FIELDS, *RESISTANCES, *INERTIAL_KEYS)


def from_toml(source: str | os.PathLike[str], *, package_paths: Sequence[Any] = ()) -> Description:
    """A robot from TOML.

    source: a path, or the text itself (a string with a line break). package_paths: folders where package://
    names of meshes are looked for first.
    The file holds name = …, and one of: [[links]] and [[joints]] (a tree), [screws] with [[screws.joints]]
    (axis and point of each joint at zero, T_zero), or [dh] with [[dh.rows]]. allowed_pairs = [[link, link,
    reason], …] names the links that may touch; the reason may be left out. A link, and a row for its own, may
    have mass, com and inertia. Unknown keys are refused.
    Raises DescriptionError with the file, the table and, for syntax, the line.
    """
    if isinstance(source, str) and "\n" in source:
        return _Reader(Document(source, None), package_paths).read()
    path = path_of(source)
    text = read_text(path, "robot in TOML", TOML_BYTES, DescriptionError)
    return _Reader(Document(text.replace("\r\n", "\n"), path), package_paths).read()


class _Reader:
    """Reads one document."""

    def __init__(self, document: Document, package_paths: Sequence[Any]) -> None:
        self.document = document
        path = document.path
        self.beside = None if path is None else os.path.dirname(os.path.abspath(path))
        self.package_paths = check_folders(package_paths)

    def at(self, table: Table, make: Callable[[], T]) -> T:
        """What `make` returns; its complaint gets the place of `table`."""
        try:
            return make()
        except CspaceError as error:
            if isinstance(error, DescriptionError) and (error.path or error.line or not self.document.path):
                raise
            raise table.fault(str(error)) from None

    def read(self) -> Description:
        top = parse_toml(self.document)
        forms = [form for form in ("screws", "dh") if form in top]
        forms += ["joints"] if "joints" in top or "links" in top else []
        if len(forms) != 1:
            found = " and ".join(forms) or "none of them"
            raise self.document.fault(
                f"this is not a robot: it must contain one of [[joints]], [screws] and [dh], but has {found}"
            )
        top.known((*ABOUT, *FORMS[forms[0]]))
        if top.number("format", FORMAT) != FORMAT:
            raise top.fault(f"format is {top.values['format']!r}; this version reads format {FORMAT}")
        name = top.text("name")
        poses = {pose: self.pose(top.table("poses"), pose) for pose in top.table("poses").values}
        about, pairs = self.provenance(top), self.allowed_pairs(top)
        if forms[0] == "joints":
            plain = self.at(top, lambda: self.tree(top, name, poses, about))
            return self.at(top, lambda: replace(plain, allowed_pairs=pairs)) if pairs else plain
        read = self.screws if forms[0] == "screws" else self.dh
        plain = self.at(top, lambda: read(top, name))
        return self.at(top, lambda: replace(plain, poses=poses, provenance=about, allowed_pairs=pairs))

    def allowed_pairs(self, top: Table) -> tuple[tuple[str, str, str], ...]:
        """The pairs of links that may touch, each with its reason."""
        rows = top.values.get("allowed_pairs", [])
        pairs = []
        for row in rows if isinstance(rows, list) else [rows]:
            texts = row if isinstance(row, list) else []
            if len(texts) not in (2, 3) or not all(isinstance(text, str) for text in texts):
                rule = "a row is [link, link] or [link, link, reason]"
                raise top.fault(f"allowed_pairs contains {row!r}; {rule}")
            pairs.append((texts[0], texts[1], texts[2] if len(texts) == 3 else ""))
        return tuple(pairs)

    def pose(self, poses: Table, pose: str) -> dict[str, float]:
        values = poses.table(pose)
        return {joint: values.number(joint) for joint in values.values}

    def provenance(self, top: Table) -> Provenance:
        sources = {}
        for group in top.table("sources").values:
            entry = top.table("sources").table(group)
            entry.known(("source", "licence"))
            sources[group] = Source(entry.text("source"), entry.text("licence", ""))
        return Provenance(
            top.text("title", ""), top.text("vendor", ""), sources, top.texts("missing"), top.texts("aliases")
        )

    def origin(self, table: Table, key: str = "origin") -> Array:
        """The placement under `key` (4 × 4), or under xyz and rpy."""
        if key in table:
            if key == "origin" and ("xyz" in table or "rpy" in table):
                raise table.fault("give either origin or xyz and rpy, not both")
            return np.array(table.numbers(key, (4, 4)))
        if key != "origin" or ("xyz" not in table and "rpy" not in table):
            return IDENTITY
        xyz, rpy = (table.numbers(key, (3,), (0.0, 0.0, 0.0)) for key in ("xyz", "rpy"))
        if not np.isfinite(rpy).all():
            raise table.fault(f"rpy is {rpy}; every number must be finite")
        return from_rpy(xyz, rpy)

    def tree(self, top: Table, name: str, poses: Poses, about: Provenance) -> Description:
        link_tables, joint_tables = top.tables("links"), top.tables("joints")
        loop_tables = top.tables("loops")
        links = tuple(map(self.link, link_tables))
        joints = tuple(map(self.joint, joint_tables))
        loops = tuple(map(self.loop, loop_tables))
        try:
            return Description(name, links, joints, loops, poses, about)
        except ElementError as error:
            parts = zip((*links, *joints, *loops), (*link_tables, *joint_tables, *loop_tables), strict=True)
            culprit = next((table for part, table in parts if part is error.part), None)
            if culprit is None:
                raise
            raise culprit.fault(str(error)) from None

    def link(self, table: Table) -> Link:
        table.known(("name", *INERTIAL_KEYS, "visual", "collision"))
        inertial = self.inertial(table)
        shapes = [tuple(self.geometry(t) for t in table.tables(key)) for key in ("visual", "collision")]
        return self.at(table, lambda: Link(table.text("name"), inertial, *shapes))

    def inertial(self, table: Table) -> Inertial | None:
        """The mass properties among the keys of a link or of a row, if it has any."""
        if "mass" in table:
            com = table.numbers("com", (3,), [0.0] * 3)
            inertia = table.numbers("inertia", (3, 3), [[0.0] * 3] * 3)
            return self.at(table, lambda: Inertial(table.number("mass"), com, inertia))
        if "com" in table or "inertia" in table:
            raise table.fault("com and inertia need mass")
        return None

    def geometry(self, table: Table) -> Geometry:
        table.known(GEOMETRY_KEYS)
        mesh = None
        if "mesh" in table:
            uri, scale = table.text("mesh"), table.numbers("scale", (3,), (1.0, 1.0, 1.0))
            mesh = self.at(table, lambda: Mesh(uri, scale, self.beside, self.package_paths))
        size = table.values.get("size", [])
        count = len(size) if isinstance(size, list) else 0
        sizes = tuple(table.numbers("size", (count,), ()))
        color = tuple(table.numbers("color", (4,))) if "color" in table else None
        shape, name, origin = table.text("shape"), table.text("name", ""), self.origin(table)
        return self.at(table, lambda: Geometry(shape, sizes, origin, name, mesh, color))

    def joint(self, table: Table) -> Joint:
        table.known(JOINT_KEYS)
        ends, mimic = self.ends(table), self.mimic(table)
        numbers = (*LIMIT_FIELDS, *RESISTANCES)
        known: dict[str, Any] = {key: table.number(key) for key in numbers if key in table}
        return self.at(table, lambda: Joint(**ends, mimic=mimic, **known))

    def ends(self, table: Table) -> dict[str, Any]:
        """What joints and loops have in common: names, type, place and axis."""
        words = {key: table.text(key) for key in ENDS}
        return {**words, "origin": self.origin(table), "axis": table.numbers("axis", (3,), X_AXIS)}

    def mimic(self, table: Table) -> Mimic | None:
        if "mimic" not in table:
            return None
        entry = table.table("mimic")
        entry.known(("joint", "multiplier", "offset"))
        factor, shift = entry.number("multiplier", 1.0), entry.number("offset", 0.0)
        return self.at(table, lambda: Mimic(entry.text("joint"), factor, shift))

    def loop(self, table: Table) -> Loop:
        table.known((*ENDS, *PLACE, "child_origin", "axis", "second_axis", "length"))
        ends, far = self.ends(table), self.origin(table, "child_origin")
        second = table.numbers("second_axis", (3,)) if "second_axis" in table else None
        length = table.number("length") if "length" in table else None
        return self.at(table, lambda: Loop(**ends, child_origin=far, second_axis=second, length=length))

    def screws(self, top: Table, name: str) -> Description:
        table = top.table("screws")
        table.known(("base", "tip", "T_zero", "joints"))
        rows = table.tables("joints")
        for row in rows:
            row.known(("name", "type", "axis", "point", *LIMIT_FIELDS))
        columns = self.columns(rows)
        return from_screws(
            np.array([row.numbers("axis", (3,)) for row in rows]).reshape(-1, 3),
            np.array([row.numbers("point", (3,)) for row in rows]).reshape(-1, 3),
            self.origin(table, "T_zero"),
            name=name,
            base=table.text("base", "base"),
            tip=table.text("tip", "tip"),
            **columns,
        )

    def dh(self, top: Table, name: str) -> Description:
        table = top.table("dh")
        table.known(("convention", "base", "tip", "T_base", "T_tool", "rows"))
        rows = table.tables("rows")
        for row in rows:
            row.known(DH_KEYS)
        columns = self.columns(rows)
        for key in RESISTANCES:
            columns[key] = [row.number(key) if key in row else None for row in rows]
        columns["inertials"] = [self.inertial(row) for row in rows]
        alpha, a, d, theta = (
            np.array([row.number(key, 0.0) for row in rows]) for key in ("alpha", "a", "d", "theta")
        )
        types, names = columns.pop("joint_types"), columns.pop("joint_names")
        before, after = self.origin(table, "T_base"), self.origin(table, "T_tool")
        numbers = DHTable(table.text("convention"), alpha, a, d, theta, types, before, after, tuple(names))
        base, tip = table.text("base", "base"), table.text("tip", "tip")
        return from_dh(numbers, name=name, base=base, tip=tip, **columns)

    def columns(self, rows: list[Table]) -> dict[str, Any]:
        """What screws and table rows have in common: names, letters and limits."""
        letters = []
        for row in rows:
            kind = row.text("type", "revolute")
            if kind not in LETTERS or (kind == "fixed" and "axis" in row):
                allowed = ", ".join(LETTERS)
                raise row.fault(f"type is {kind!r}; here a joint is one of {allowed}")
            letters.append(LETTERS[kind])
        found = {key: any(key in row for row in rows) for key in LIMIT_FIELDS}
        limits = {
            key: np.array([row.number(key, -np.inf if key == "lower" else np.inf) for row in rows])
            for key in LIMIT_FIELDS
            if found[key]
        }
        names = [row.text("name", f"joint_{i + 1}") for i, row in enumerate(rows)]
        return {"joint_types": "".join(letters), "joint_names": names, **limits}
