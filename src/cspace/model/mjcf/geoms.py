"""The shapes of MJCF: where a geom is, how large it is, and how it is drawn."""

from __future__ import annotations

import logging
import math
import os
import posixpath
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.model.attributes import complain_at, fault_at, read_floats
from cspace.model.link import Geometry, Mesh
from cspace.model.mjcf.given import Defaults, Given
from cspace.model.mjcf.settings import Settings, shortest_rotation, unit_direction
from cspace.model.values import from_wxyz, translation_by
from cspace.model.xml import Element
from cspace.spatial.poses import invert_pose

SOLIDS: Final = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}
"""The solids, and how many half sizes each has: radii, half lengths."""

OTHERS: Final = ("plane", "hfield", "mesh", "sdf")
"""The shapes that are no solids of a few numbers."""

FITTED: Final = "fitted"
"""A solid that MuJoCo fits to a mesh; its size is in no attribute."""

LOG: Final = logging.getLogger("cspace")

FIRST_HIDDEN_GROUP: Final = 3
"""MuJoCo's viewer shows the geoms of the groups below this one unless told otherwise."""

Color = tuple[float, float, float, float]


@dataclass(frozen=True)
class Geom:
    """One geom of a body.

    kind: a key of SOLIDS, one of OTHERS, or FITTED. half: its half sizes [m]. T_body_geom (4, 4): where it
    is. given: its attributes.
    """

    kind: str
    half: tuple[float, ...]
    T_body_geom: Array
    given: Given


class Geoms:
    """Reads the geoms of one document; knows its meshes and materials."""

    def __init__(
        self, root: Element, defaults: Defaults, settings: Settings, package_paths: tuple[str, ...]
    ) -> None:
        self.settings = settings
        self.beside = None if root.path is None else os.path.dirname(os.path.abspath(root.path))
        self.package_paths = package_paths
        assets = [element for section in root.all("asset") for element in section.children]
        self.meshes = {mesh_name(e): defaults.given(e) for e in assets if e.tag == "mesh"}
        materials = [element for element in assets if element.tag == "material"]
        self.materials = {e.attributes.get("name", ""): defaults.given(e) for e in materials}

    def geom(self, given: Given, T_body_frame: Array) -> Geom:
        """The geom of an element that stands in a frame of its body."""
        kind = given.word("type", "sphere", (*SOLIDS, *OTHERS))
        if kind not in SOLIDS or given.text("mesh"):
            T = T_body_frame @ self.settings.placement(given)
            return Geom(FITTED if kind in SOLIDS else kind, (), T, given)
        size = given.floats("size", (), 0, 3)
        count = SOLIDS[kind]
        if given.holder("fromto") is None:
            place = self.settings.placement(given)
        else:
            place, length = self.between(given, kind)
            size = [*size[:1] * (count - 1), length]
        if len(size) < count or min(size[:count]) <= 0.0:
            rule = f"it needs {count} above zero: radii and half lengths"
            raise fault_at(given.place("size"), f"size of a {kind} is {size[:count]}; {rule}")
        return Geom(kind, tuple(size[:count]), T_body_frame @ place, given)

    def between(self, given: Given, kind: str) -> tuple[Array, float]:
        """The frame (4, 4) of a long solid between two points, and half its length [m]."""
        element = given.place("fromto")
        if kind == "sphere":
            raise fault_at(element, "fromto makes capsules, cylinders, boxes and ellipsoids, no sphere")
        if "pos" in element.attributes:
            raise fault_at(element, f"<{element.tag}> has a place twice, by 'pos' and 'fromto'")
        ends = np.array(given.floats("fromto", None, 6))
        start, end = ends[:3], ends[3:]
        along = start - end  # MuJoCo's z points from the second point to the first
        T = shortest_rotation(unit_direction(along.tolist(), element, "fromto"))
        return translation_by((start + end) / 2.0) @ T, math.hypot(*along.tolist()) / 2.0

    def shapes(self, geom: Geom) -> tuple[Geometry | None, Geometry | None]:
        """How it is drawn and how it collides; None where it is not, or where links have no such shape."""
        shape = self.shape(geom)
        given = geom.given
        drawn = given.number("group", 0.0) < FIRST_HIDDEN_GROUP
        collides = given.number("contype", 1.0) != 0.0 or given.number("conaffinity", 1.0) != 0.0
        return shape if drawn else None, self.solid(geom, shape) if collides else None

    def solid(self, geom: Geom, shape: Geometry | None) -> Geometry | None:
        """How a geom that can touch others collides: an ellipsoid as the box around it.

        None, which is logged, where links have no such shape.
        """
        given = geom.given
        if shape is None and geom.kind == "ellipsoid":
            name, color = given.element.attributes.get("name", ""), self.color(given)
            size = tuple(2.0 * x for x in geom.half)
            return complain_at(
                given.element, lambda: Geometry("box", size, geom.T_body_geom, name, None, color)
            )
        if shape is None:
            LOG.warning(
                "%s:%d: a geom of type %s can collide, but links have no such shape; it is left out",
                given.element.path,
                given.element.line,
                given.word("type", "sphere", (*SOLIDS, *OTHERS)),
            )
        return shape

    def shape(self, geom: Geom) -> Geometry | None:
        """The geom as a shape of a link; planes, height fields and ellipsoids are none."""
        kind, half, given = geom.kind, geom.half, geom.given
        name, color = given.element.attributes.get("name", ""), self.color(given)
        if kind == "mesh":
            return self.mesh(geom, name, color)
        if kind == "sphere":
            size = half
        elif kind == "box":
            size = tuple(2.0 * x for x in half)
        elif kind in ("cylinder", "capsule"):
            size = (half[0], 2.0 * half[1])
        else:
            return None
        return complain_at(given.element, lambda: Geometry(kind, size, geom.T_body_geom, name, None, color))

    def mesh(self, geom: Geom, name: str, color: Color | None) -> Geometry | None:
        """The mesh of a geom by reference; None where no file holds it."""
        given = geom.given
        called = given.text("mesh")
        if called not in self.meshes:
            raise fault_at(given.place("mesh"), str(suggest("mesh", called, self.meshes, owner="<asset>")))
        asset = self.meshes[called]
        file = asset.element.attributes.get("file", "").strip()
        x, y, z = asset.floats("scale", (1.0, 1.0, 1.0), 3)
        if not file:
            return None
        file = posixpath.basename(file.replace("\\", "/")) if self.settings.strip else file
        uri = posixpath.join(self.settings.mesh_folder, file)
        T = geom.T_body_geom @ invert_pose(reference_frame(asset, np.array([x, y, z])))
        mesh = complain_at(asset.element, lambda: Mesh(uri, (x, y, z), self.beside, self.package_paths))
        return complain_at(given.element, lambda: Geometry("mesh", (), T, name, mesh, color))

    def color(self, given: Given) -> Color | None:
        """The colour of a geom: its own, else that of its material."""
        holder = given.holder("rgba")
        material = given.text("material")
        if holder is None and material in self.materials:
            holder = self.materials[material].holder("rgba")
        if holder is None:
            return None
        r, g, b, a = read_floats(holder, "rgba", None, 4)
        return (r, g, b, a)


def mesh_name(element: Element) -> str:
    """The name of a mesh: its own, or that of its file without folder and suffix."""
    file = element.attributes.get("file", "").replace("\\", "/")
    return element.attributes.get("name", "") or posixpath.splitext(posixpath.basename(file))[0]


def reference_frame(asset: Given, scale: Array) -> Array:
    """The frame (4, 4) that a mesh is moved out of: refpos and refquat, refpos scaled (3,) as the mesh is."""
    T = translation_by(scale * asset.floats("refpos", (0.0, 0.0, 0.0), 3))
    if asset.holder("refquat") is None:
        return T
    numbers = asset.floats("refquat", None, 4)
    return T @ complain_at(asset.element, lambda: from_wxyz(numbers, "refquat of <mesh>"))
