"""Scenes as arrays: what the compiled checks take, in the frame of the base of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.collision.scene import Scene
from cspace.errors import InputTypeError
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
from cspace.shapes.shape import check_place
from cspace.spatial.poses import invert_pose, transform_points
from cspace.tables import show_fields

Numbers = npt.NDArray[np.intp]


@show_fields
@dataclass(frozen=True, eq=False)
class PackedScene:
    """The obstacles of a scene, in the base frame of a robot [m]; attached objects belong to the robot.

    names: of the obstacles; the arrays ending in _object hold the number of the obstacle per row.
    boxes (n, 15): centre, rotation by rows (its columns are the axes), half sizes. capsules (n, 7): both ends
    and the radius; spheres are capsules of equal ends. cylinders (n, 8): centre, unit axis, half length,
    radius. half_spaces (n, 4): outward normal and offset o, solid where normal · x ≤ o. meshes: triangles
    (m, 3, 3) each and whether they enclose a solid; hulls and height fields are among them, and corners of
    triangles that meet are equal bit for bit. clouds: points (n, 3) each and the radius of all.
    """

    names: tuple[str, ...]
    version: int
    boxes: Array
    box_object: Numbers
    capsules: Array
    capsule_object: Numbers
    cylinders: Array
    cylinder_object: Numbers
    half_spaces: Array
    half_space_object: Numbers
    meshes: tuple[tuple[Array, bool], ...]
    mesh_object: Numbers
    clouds: tuple[tuple[Array, float], ...]
    cloud_object: Numbers


def pack_scene(scene: Scene, T_world_base: Any = None) -> PackedScene:
    """The obstacles of a scene as arrays in the frame T_world_base (4, 4) of a robot's base, float64."""
    T_base_world = (
        np.eye(4) if T_world_base is None else invert_pose(check_place(T_world_base, "T_world_base"))
    )
    rows: dict[str, list[Any]] = {kind: [] for kind in WIDTHS}
    owners: dict[str, list[int]] = {kind: [] for kind in WIDTHS}
    obstacles = scene.obstacles
    for number, shape in enumerate(obstacles):
        kind, packed = pack_shape(shape, T_base_world @ shape.pose)
        rows[kind] += packed
        owners[kind] += [number] * len(packed)
    arrays: dict[str, Any] = {
        kind: np.array(rows[kind], dtype=np.float64).reshape(-1, width) if width else tuple(rows[kind])
        for kind, width in WIDTHS.items()
    }
    numbers: dict[str, Any] = {OWNERS[kind]: np.array(found, dtype=np.intp) for kind, found in owners.items()}
    return PackedScene(tuple(shape.name for shape in obstacles), scene.version, **arrays, **numbers)


WIDTHS = {"boxes": 15, "capsules": 7, "cylinders": 8, "half_spaces": 4, "meshes": 0, "clouds": 0}
"""The arrays, and the numbers of their rows; zero for lists of arrays."""

PACKED = (Box, Sphere, Capsule, Cylinder, HalfSpace, Hull, Mesh, HeightField, PointCloud)
"""The shapes that have arrays."""

OWNERS = {
    **{"boxes": "box_object", "capsules": "capsule_object", "cylinders": "cylinder_object"},
    **{"half_spaces": "half_space_object", "meshes": "mesh_object", "clouds": "cloud_object"},
}
"""The array of owners beside each array."""


def pack_shape(shape: Shape, T: Array) -> tuple[str, list[Any]]:
    """The array that a shape at a pose T (4, 4) belongs to, and its rows."""
    R, p = T[:3, :3], T[:3, 3]
    if isinstance(shape, Box):
        return "boxes", [np.concatenate([p, R.ravel(), shape.size / 2.0])]
    if isinstance(shape, Sphere):
        return "capsules", [np.concatenate([p, p, [shape.radius]])]
    if isinstance(shape, Capsule):
        half = shape.length / 2.0 * R[:, 2]
        return "capsules", [np.concatenate([p - half, p + half, [shape.radius]])]
    if isinstance(shape, Cylinder):
        return "cylinders", [np.concatenate([p, R[:, 2], [shape.length / 2.0, shape.radius]])]
    if isinstance(shape, HalfSpace):
        return "half_spaces", [shape.placed(T).plane]
    if isinstance(shape, Hull):
        return "meshes", [(transform_points(T, shape.vertices)[shape.facets], True)]
    if isinstance(shape, Mesh):
        return "meshes", [(transform_points(T, shape.vertices)[shape.faces], shape.solid)]
    if isinstance(shape, HeightField):
        return "meshes", [(shape.surface(T), True)]
    if isinstance(shape, PointCloud):
        return "clouds", [(transform_points(T, shape.points), shape.radius)]
    known = ", ".join(kind.__name__ for kind in PACKED)
    raise InputTypeError(
        f"{shape.name!r} is a {type(shape).__name__}, which no check reads; use one of {known}"
    )
