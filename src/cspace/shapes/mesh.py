"""Triangle meshes: solids with a closed surface, or surfaces."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from cspace.arrays import Array, as_floats, one_array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.shapes.hull import Hull
from cspace.shapes.mesh_cover import SphereCover, cover_mesh
from cspace.shapes.mesh_files import read_mesh
from cspace.shapes.shape import ORIGIN, Shape, check_points, find_bounds
from cspace.shapes.solids import measure_points
from cspace.shapes.triangles import (
    Faces,
    count_open_edges,
    fill_holes,
    merge_vertices,
    nearest_on_triangles,
    signed_volume,
    winding_numbers,
)
from cspace.spatial.poses import transform_points
from cspace.tolerances import LARGEST_NUMBER


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(Shape):
    """A triangle mesh.

    vertices (k, 3) [m], faces (m, 3): vertex numbers. Equal vertices are merged and triangles that use a
    vertex twice are left out. pose (4, 4) or position (3,); name. solid: the surface encloses a solid, which
    needs a closed surface; its normals are turned outward if all point inward. With solid=False only the
    surface counts: distances are not negative.

    The solid is where the winding number is at least one half; the distance is that of the nearest triangle.
    Raises InputError for an open surface with solid=True, for vertex numbers out of range, NaN, and a mesh
    without triangles.
    """

    kind: ClassVar[str] = "mesh"
    vertices: Any
    faces: Any
    pose: Any = ORIGIN
    name: str = ""
    solid: bool = True

    def __post_init__(self) -> None:
        vertices = check_points(self.vertices, "vertices of a mesh", 3, "a mesh needs at least three")
        vertices, faces = merge_vertices(vertices, check_faces(self.faces, len(vertices)))
        if not len(faces):
            raise InputError("the mesh has no triangle with three different vertices")
        if not isinstance(self.solid, bool):
            raise InputTypeError(f"solid is {name_type(self.solid)}; it must be True or False")
        if self.solid and (gaps := count_open_edges(faces)):
            raise InputError(
                f"the surface of the mesh is not closed: {gaps} edges of {len(faces)} triangles have no"
                " opposite edge of another triangle; use solid=False for the surface alone, then"
                " fill_holes() or hull() for a solid"
            )
        if self.solid and signed_volume(vertices[faces]) < 0.0:
            faces = faces[:, ::-1].copy()
        self._store(vertices=vertices, faces=faces)
        self._place()

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        scale: Any = 1.0,
        pose: Any = ORIGIN,
        name: str = "",
        solid: bool | None = None,
    ) -> Mesh:
        """A mesh from a file: STL (binary or text), OBJ, PLY or COLLADA (.dae), by the suffix.

        scale: a factor, or three of them along the axes (3,), from the units of the file to metres. pose
        (4, 4) or position (3,). solid: as of Mesh; None where the surface is closed. Materials, normals and
        textures are not read. Raises MeshError with the file for one that cannot be read.
        """
        vertices, faces = read_mesh(path)
        factors = scale_factors(scale)
        if factors.prod() < 0.0:
            faces = faces[:, ::-1]
        surface = cls(vertices * factors, faces, pose, name, solid=bool(solid))
        if solid is not None or count_open_edges(surface.faces):
            return surface
        return cls(surface.vertices, surface.faces, surface.pose, name)

    @property
    def closed(self) -> bool:
        """Whether the surface is closed: every edge has an opposite edge of another triangle."""
        return count_open_edges(self.faces) == 0

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        return find_bounds(transform_points(self.pose, self.vertices))

    @property
    def volume(self) -> float:
        """The enclosed volume [m³]; of an open surface, that of the cone over it from its middle."""
        return signed_volume(self.vertices[self.faces])

    def hull(self) -> Hull:
        """The convex hull of the mesh, with its pose and name. InputError for a flat mesh."""
        return Hull(self.vertices, self.pose, self.name)

    def fill_holes(self) -> Mesh:
        """The solid whose surface is this one with every hole filled, with the same pose and name.

        A hole is a connected rim of edges without an opposite edge; a fan of triangles joins it to its
        middle. So a link without its end plate, or with cracks, becomes a solid. A rim that is far from flat
        gets a fan that may cross the surface; the solid is then where the winding number is one or more.
        """
        return Mesh(*fill_holes(self.vertices, self.faces), self.pose, self.name)

    def cover(self, within: float = 0.01, inside: bool = True) -> SphereCover:
        """Few spheres that contain the mesh and stick out of it by at most `within` [m]: see cover_mesh.

        The result has centers (n, 3), radii (n,) and stick_out. inside: False covers the surface alone.
        """
        return cover_mesh(self, within, inside)

    def _measure(self, local: Array) -> tuple[Array, Array]:
        return measure_mesh(local, self.vertices[self.faces], self.solid)

    def _surface(self) -> tuple[Array, Faces, bool]:
        return self.vertices, self.faces, self.solid

    def _sizes(self) -> str:
        what = "solid" if self.solid else "surface"
        return f"{what}, {len(self.vertices)} vertices, {len(self.faces)} triangles"


def check_faces(value: Any, count: int) -> Faces:
    """Vertex numbers (m, 3), each below `count`; InputError for others, InputTypeError for other numbers."""
    numbers = one_array(value, "faces of a mesh", (None, 3), "three vertex numbers each")
    faces = numbers.astype(np.intp)
    if (faces != numbers).any():
        raise InputTypeError("faces of a mesh must be vertex numbers, integers")
    if len(faces) and not 0 <= faces.min() <= faces.max() < count:
        worst = int(faces.min() if faces.min() < 0 else faces.max())
        raise InputError(f"faces of a mesh name vertex {worst}; there are vertices 0 to {count - 1}")
    return faces


def scale_factors(value: Any) -> Array:
    """One factor, or three along the axes, as (3,), none zero."""
    factors = as_floats(value, "scale", largest=LARGEST_NUMBER)
    if factors.shape not in ((), (3,)):
        raise InputError(f"scale has shape {factors.shape}; give one factor, or three along the axes")
    if not factors.all():
        raise InputError(f"scale is {factors.tolist()}; no factor may be zero")
    return np.ones(3) * factors


def measure_mesh(points: Array, triangles: Array, solid: bool) -> tuple[Array, Array]:
    """Distance (n,) of points (n, 3) from triangles (m, 3, 3), negative in a solid, and gradient (n, 3)."""
    nearest, which = nearest_on_triangles(points, triangles)
    distance, gradient = measure_points(points - nearest)
    a, b, c = np.moveaxis(triangles[which], 1, 0)
    normal = measure_points(np.cross(b - a, c - a))[1]
    on_surface = distance == 0.0
    gradient[on_surface] = normal[on_surface]
    if solid:
        near = (points >= triangles.min(axis=(0, 1))).all(axis=1) & (
            points <= triangles.max(axis=(0, 1))
        ).all(axis=1)
        inside = np.nonzero(near & ~on_surface)[0]
        inside = inside[winding_numbers(points[inside], triangles) >= 0.5]
        distance[inside] *= -1.0
        gradient[inside] *= -1.0
    return distance, gradient
