"""COLLADA files (.dae): the triangles of all geometries, placed by the nodes of the scene."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import MeshError
from cspace.shapes.obj import cut_fan
from cspace.shapes.triangles import Faces
from cspace.spatial.checks import embed_rotation
from cspace.spatial.rotations import matrix_of_axis_angle

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

UP: Final = {
    "X_UP": np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
    "Y_UP": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "Z_UP": np.eye(3),
}
"""From the axes of a file to those with z up."""


def parse_collada(data: bytes) -> tuple[Array, Faces]:
    """Vertices (k, 3) [m] and triangles (m, 3), with the unit and the upward axis of the file applied."""
    from xml.etree import ElementTree

    if b"<!ENTITY" in data:
        raise MeshError("the file declares an entity; entity declarations are refused")
    try:
        root = ElementTree.fromstring(data)
    except ElementTree.ParseError as error:
        raise MeshError(f"malformed XML: {error}", line=error.position[0]) from None
    for element in root.iter():
        element.tag = re.sub(r"^\{.*\}", "", element.tag)
    if root.tag != "COLLADA":
        raise MeshError(f"this is no COLLADA file: the root element is <{root.tag}>", line=1)
    geometries = {element.get("id", ""): read_geometry(element) for element in root.iter("geometry")}
    unit, axis = root.find("asset/unit"), root.findtext("asset/up_axis", "Y_UP").strip()
    T = np.eye(4)
    T[:3, :3] = UP[axis] * (1.0 if unit is None else float(unit.get("meter", "1")))
    parts = [part for scene in root.iter("visual_scene") for part in placed_parts(scene, T, root, geometries)]
    if not parts:
        parts = [(T, mesh) for mesh in geometries.values()]
    vertices, faces, count = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.intp)], 0
    for pose, (points, triangles) in parts:
        vertices.append(points @ pose[:3, :3].T + pose[:3, 3])
        mirrored = np.linalg.det(pose[:3, :3]) < 0.0
        faces.append((triangles[:, ::-1] if mirrored else triangles) + count)
        count += len(points)
    return np.concatenate(vertices), np.concatenate(faces)


def placed_parts(
    node: Element, T: Array, root: Element, geometries: dict[str, tuple[Array, Faces]]
) -> Iterator[tuple[Array, tuple[Array, Faces]]]:
    """The meshes of a node and those inside it, each with its transform (4, 4)."""
    T = T @ node_transform(node)
    for use in node.findall("instance_geometry") + node.findall("instance_controller"):
        if (mesh := geometries.get(use.get("url", "").lstrip("#"))) is not None:
            yield T, mesh
    for use in node.findall("instance_node"):
        name = use.get("url", "").lstrip("#")
        for other in root.iter("node"):
            if other.get("id") == name and other is not node:
                yield from placed_parts(other, T, root, geometries)
    for child in node.findall("node"):
        yield from placed_parts(child, T, root, geometries)


def node_transform(node: Element) -> Array:
    """The product (4, 4) of the transforms of a node, in their order."""
    T = np.eye(4)
    for element in node:
        if element.tag not in ("matrix", "translate", "rotate", "scale"):
            continue
        numbers, step = read_numbers(element), np.eye(4)
        if element.tag == "matrix":
            step = numbers.reshape(4, 4)
        elif element.tag == "translate":
            step[:3, 3] = numbers
        elif element.tag == "rotate":
            axis = numbers[:3] / np.linalg.norm(numbers[:3])
            step = embed_rotation(matrix_of_axis_angle(axis, np.deg2rad(numbers[3])))
        else:
            step[:3, :3] = np.diag(numbers)
        T = T @ step
    return T


def read_numbers(element: Element) -> Array:
    """The numbers of the text of an element."""
    return (
        np.array((element.text or "").split()).astype(np.float64)
        if (element.text or "").strip()
        else np.empty(0)
    )


def read_geometry(geometry: Element) -> tuple[Array, Faces]:
    """Vertices (k, 3) and triangles (m, 3) of a geometry: of its triangles, polylists and polygons."""
    sources = {source.get("id", ""): source for source in geometry.iter("source")}
    positions = {
        vertices.get("id", ""): use.get("source", "").lstrip("#")
        for vertices in geometry.iter("vertices")
        for use in vertices.findall("input")
        if use.get("semantic") == "POSITION"
    }
    points: list[Array] = [np.empty((0, 3))]
    faces: list[tuple[int, int, int]] = []
    for kind in ("triangles", "polylist", "polygons"):
        for part in geometry.iter(kind):
            inputs = part.findall("input")
            width = 1 + max(int(use.get("offset", "0")) for use in inputs)
            use = next(use for use in inputs if use.get("semantic") == "VERTEX")
            source = sources[positions[use.get("source", "").lstrip("#")]]
            corners = [
                read_numbers(p).astype(np.intp).reshape(-1, width)[:, int(use.get("offset", "0"))]
                for p in part.findall("p")
            ]
            first = sum(map(len, points))
            for polygon in split_corners(part, corners):
                faces += cut_fan([first + corner for corner in polygon])
            points.append(read_source(source))
    return np.concatenate(points), np.array(faces, dtype=np.intp).reshape(-1, 3)


def split_corners(part: Element, corners: list[Faces]) -> Iterator[list[int]]:
    """The polygons of an element, each as its vertex numbers."""
    if part.tag == "polygons":
        yield from (polygon.tolist() for polygon in corners)
        return
    whole = np.concatenate([*corners, np.empty(0, dtype=np.intp)])
    counts = part.find("vcount")
    sizes = [3] * (len(whole) // 3) if counts is None else read_numbers(counts).astype(int).tolist()
    at = 0
    for size in sizes:
        yield whole[at : at + size].tolist()
        at += size


def read_source(source: Element) -> Array:
    """The points (k, 3) of a source."""
    numbers = source.find("float_array")
    accessor = source.find("technique_common/accessor")
    if numbers is None:
        raise MeshError("a source of vertices has no <float_array>")
    stride = 3 if accessor is None else int(accessor.get("stride", "3"))
    return read_numbers(numbers).reshape(-1, stride)[:, :3]
