"""Scenes as arrays: what the compiled checks take, in the frame of the base of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace._core import pack_solids
from cspace.arrays import Array
from cspace.collision.scene import Scene
from cspace.errors import InputTypeError, name_type
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
from cspace.shapes.shape import IDENTITY, check_place
from cspace.spatial.checks import PoseLike
from cspace.spatial.poses import invert_pose, transform_points
from cspace.tables import show_fields

Numbers = npt.NDArray[np.int64]


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


SOLIDS: Final = (Box, Sphere, Capsule, Cylinder, HalfSpace)
"""The shapes of a few numbers, in the order in which the core takes them."""

PACKED: Final = (*SOLIDS, Hull, Mesh, HeightField, PointCloud)
"""The shapes that have arrays."""


def pack_scene(scene: Scene, T_world_base: PoseLike | None = None) -> PackedScene:
    """The obstacles of a scene as arrays in the frame T_world_base (4, 4) of a robot's base, float64."""
    if T_world_base is None:
        return pack_obstacles(scene, IDENTITY)
    return pack_obstacles(scene, invert_pose(check_place(T_world_base, "T_world_base")))


def pack_obstacles(scene: Scene, T_base_world: Array) -> PackedScene:
    """As pack_scene, in a frame that is known to be a pose."""
    obstacles = scene.obstacles
    boxes, capsules, cylinders, half_spaces, others = pack_solids(obstacles, SOLIDS, T_base_world)
    meshes, clouds = [], []
    for number in others:
        shape = obstacles[number]
        T = T_base_world @ shape.pose
        if isinstance(shape, PointCloud):
            clouds.append((number, (place_points(T, shape.points), shape.radius)))
        else:
            meshes.append((number, place_surface(shape, T)))
    return PackedScene(
        tuple([shape.name for shape in obstacles]),
        scene.version,
        *boxes,
        *capsules,
        *cylinders,
        *half_spaces,
        *split_owners(meshes),
        *split_owners(clouds),
    )


def place_points(T: Array, points: Array) -> Array:
    """Points (n, 3) at a pose T (4, 4); the given array where nothing moves, since clouds are large."""
    return points if np.array_equal(T, IDENTITY) else transform_points(T, points)


def split_owners(found: list[tuple[int, Any]]) -> tuple[tuple[Any, ...], Numbers]:
    """What was found, and the numbers of the obstacles."""
    return tuple([part for _, part in found]), np.array([number for number, _ in found], dtype=np.int64)


def place_surface(shape: Shape, T: Array) -> tuple[Array, bool]:
    """The triangles (m, 3, 3) of a shape at a pose T (4, 4), and whether they enclose a solid."""
    if isinstance(shape, Hull):
        return transform_points(T, shape.vertices)[shape.facets], True
    if isinstance(shape, Mesh):
        return transform_points(T, shape.vertices)[shape.faces], shape.solid
    if isinstance(shape, HeightField):
        return shape.surface(T), True
    known = ", ".join(kind.__name__ for kind in PACKED)
    raise InputTypeError(f"{shape.name!r} is {name_type(shape)}, which no check reads; use one of {known}")
