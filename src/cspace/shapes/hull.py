"""Convex hulls as shapes: facets, planes and the exact distance."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.shapes.mesh_cover import SphereCover, cover_mesh
from cspace.shapes.quickhull import find_hull
from cspace.shapes.shape import ORIGIN, Shape, check_points, find_bounds
from cspace.shapes.solids import measure_points
from cspace.shapes.triangles import Faces, nearest_on_triangles, signed_volume
from cspace.spatial.poses import transform_points
from cspace.tolerances import HULL_FLAT


@dataclass(frozen=True, eq=False, repr=False)
class Hull(Shape):
    """The convex hull of points.

    points (n, 3) [m]: at least four, not in one plane. pose (4, 4) or position (3,); name.

    vertices (k, 3): the corners, in the order of the points. facets (m, 3): triangles of vertex numbers,
    counter-clockwise from outside. planes (p, 4): unit outward normal and offset o of each side, normal · x
    ≤ o; facets in a common plane share one, and every point fulfils all of them. All are in the shape frame.
    Raises InputError for points in a plane or a line, NaN, and fewer than four points.
    """

    kind: ClassVar[str] = "hull"
    points: Any
    pose: Any = ORIGIN
    name: str = ""
    vertices: Array = field(init=False)
    facets: Faces = field(init=False)
    planes: Array = field(init=False)

    def __post_init__(self) -> None:
        points = check_points(self.points, "points of a hull", 4, "a hull needs at least four")
        slack = HULL_FLAT * float(np.ptp(points, axis=0).max())
        faces, normals = find_hull(points, "the points of a hull")
        planes = find_planes(points, faces, normals, slack)
        used = find_corners(points, np.unique(faces), planes, slack)
        facets, _ = find_hull(points[used], "the points of a hull")
        self._store(points=points, vertices=points[used], facets=facets, planes=planes)
        self._place()

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        return find_bounds(transform_points(self.pose, self.vertices))

    @property
    def volume(self) -> float:
        """The volume [m³]."""
        return signed_volume(self.vertices[self.facets])

    def cover(self, within: float = 0.01, inside: bool = True) -> SphereCover:
        """Few spheres that contain the hull and stick out of it by at most `within` [m]: see cover_mesh.

        The result has centers (n, 3), radii (n,) and stick_out. inside: False covers the surface alone.
        """
        return cover_mesh(self, within, inside)

    def _measure(self, local: Array) -> tuple[Array, Array]:
        beyond = local @ self.planes[:, :3].T - self.planes[:, 3]
        deepest = beyond.argmax(axis=1)
        distance = beyond[np.arange(len(local)), deepest]
        gradient = self.planes[deepest, :3]
        outside = distance > 0.0
        nearest, _ = nearest_on_triangles(local[outside], self.vertices[self.facets])
        apart, direction = measure_points(local[outside] - nearest)
        apart_from_side = apart > 0.0
        direction[~apart_from_side] = gradient[outside][~apart_from_side]
        distance[outside], gradient[outside] = apart, direction
        return distance, gradient

    def _surface(self) -> tuple[Array, Faces, bool]:
        return self.vertices, self.facets, True

    def _sizes(self) -> str:
        return f"{len(self.vertices)} vertices, {len(self.planes)} sides"


def find_planes(points: Array, faces: Faces, normals: Array, slack: float) -> Array:
    """Outward planes (p, 4) of triangles (m, 3) of a hull, the largest first.

    normals (m, 3): outward, as long as the triangles are large. Triangles within `slack` of the plane of a
    larger one share it. The offsets are such that all points are on the inner side.
    """
    corners, area = points[faces], np.linalg.norm(normals, axis=-1)
    todo = np.argsort(-area, kind="stable")
    planes = []
    while len(todo):
        n = normals[todo[0]] / area[todo[0]]
        planes.append(np.append(n, (points @ n).max()))
        off_plane = np.abs((corners[todo] - corners[todo[0], 0]) @ n).max(axis=1)
        opposite = normals[todo] @ n < 0.0
        todo = todo[((off_plane > slack) | opposite) & (np.arange(len(todo)) > 0)]
    return np.array(planes)


def find_corners(points: Array, used: Faces, planes: Array, slack: float) -> Faces:
    """Those of the points `used` that are in three or more planes, to within `slack`.

    Others lie on a side or an edge. All of them, where the hull of the corners alone would be smaller.
    """
    near = (points[used] @ planes[:, :3].T - planes[:, 3] >= -slack).sum(axis=1)
    corners: Faces = used[near >= 3]
    if len(corners) == len(used) or len(corners) < 4:
        return used
    try:
        faces, normals = find_hull(points[corners], "the corners")
    except InputError:
        return used
    inner = find_planes(points[corners], faces, normals, slack)
    beyond = (points[used] @ inner[:, :3].T - inner[:, 3]).max()
    return corners if beyond <= 2.0 * slack else used
