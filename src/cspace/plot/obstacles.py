"""Shapes as bodies that rays can meet, and what of a picture they hide."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.plot.raytrace.solids import Body, Facets, Solid, make_cylinder
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
from cspace.spatial.poses import invert_pose, transform_points
from cspace.spatial.vectors import frame_along

MOST_POINTS: Final = 1500
"""Points of a cloud that are drawn; of more, so many are taken at equal distances in their list."""
MOST_FACES: Final = 4000
"""Triangles of a mesh that are drawn; of a larger one the convex hull, or of an open surface some."""
POINT_SIZE: Final = 0.006
"""Least radius of a drawn point, as a share of the size of the picture."""
UPRIGHT: Final = 0.999
"""Cosine of the angle to the vertical from which the plane of a half space is drawn as the floor."""
CORNERS: Final = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
"""The corners of the unit cube."""
SIDES: Final = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
"""The sides of a cube by the numbers of its corners, counter-clockwise from outside."""


def bodies_of(shape: Shape, color: Array, around: Array) -> list[Body]:
    """The bodies that show a shape. around (2, 3): the box of the picture [m], for what has no end."""
    T = shape.pose
    if isinstance(shape, Box):
        corners = transform_points(T, CORNERS * shape.size)
        return [Facets([corners[list(side)] for side in SIDES], color)]
    if isinstance(shape, Sphere):
        return [Solid(T[:3, 3], T[:3, 3], shape.radius, shape.radius, color)]
    if isinstance(shape, Capsule):
        low, high = shape.ends
        return [Solid(low, high, shape.radius, shape.radius, color)]
    if isinstance(shape, Cylinder):
        return [make_cylinder(T[:3, 3], T[:3, 2], shape.radius, 0.5 * shape.length, color)]
    if isinstance(shape, HalfSpace):
        return [Facets([plate_of(shape, around)], color)] if floor_level(shape) is None else []
    if isinstance(shape, PointCloud):
        return cloud_balls(shape, color, around)
    return [Facets(list(triangles_of(shape)), color)]


def floor_level(shape: Shape) -> float | None:
    """The height [m] of a half space below a horizontal plane; None for other shapes."""
    if not isinstance(shape, HalfSpace) or shape.plane[2] < UPRIGHT:
        return None
    return float(shape.plane[3])


def plate_of(shape: HalfSpace, around: Array) -> Array:
    """A square (4, 3) in the plane of a half space, beside the middle of the picture, seen from outside."""
    normal, offset = shape.plane[:3], shape.plane[3]
    middle = around.mean(axis=0)
    center, half = middle - (normal @ middle - offset) * normal, 0.5 * float(np.ptp(around, axis=0).max())
    R = frame_along(normal)
    return np.array(
        [center + half * (i * R[:, 0] + j * R[:, 1]) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    )


def cloud_balls(shape: PointCloud, color: Array, around: Array) -> list[Body]:
    """The points of a cloud as balls; of many, some."""
    points = transform_points(shape.pose, shape.points)
    if len(points) > MOST_POINTS:
        points = points[np.linspace(0, len(points) - 1, MOST_POINTS).astype(np.intp)]
    radius = max(shape.radius, POINT_SIZE * float(np.ptp(around, axis=0).max()))
    return [Solid(point, point, radius, radius, color) for point in points]


def triangles_of(shape: Any) -> Array:
    """The triangles (m, 3, 3) [m] of a hull, a mesh or a height field; an open surface has both sides."""
    if isinstance(shape, HeightField):
        return transform_points(shape.pose, coarser_field(shape).triangles)
    is_open = isinstance(shape, Mesh) and not shape.closed
    if isinstance(shape, Mesh) and not is_open and len(shape.faces) > MOST_FACES:
        shape = shape.hull()
    faces = shape.facets if isinstance(shape, Hull) else shape.faces
    triangles = transform_points(shape.pose, shape.vertices)[faces]
    if not is_open:
        return triangles
    some = triangles[np.linspace(0, len(faces) - 1, min(len(faces), MOST_FACES // 2)).astype(np.intp)]
    return np.concatenate([some, some[:, ::-1]])


def coarser_field(shape: HeightField) -> HeightField:
    """A height field of no more cells than are drawn: every second point, every third, …"""
    rows, columns = shape.heights.shape
    cells = max(2, int(np.sqrt(MOST_FACES / 4.0)))
    i, j = (np.linspace(0, n - 1, min(n, cells)).astype(np.intp) for n in (rows, columns))
    return HeightField(shape.heights[np.ix_(i, j)], shape.size, bottom=shape.bottom)


class Blockers:
    """The boxes around shapes, each in its own frame: what hides points from an eye far away."""

    def __init__(self, shapes: Sequence[Shape]) -> None:
        solid = {k: shape for k, shape in enumerate(shapes) if not isinstance(shape, HalfSpace)}
        self.count, self.numbers = len(shapes), list(solid)
        self.into = [invert_pose(shape.pose) for shape in solid.values()]
        self.boxes = [shape.placed(np.zeros(3)).bounds for shape in solid.values()]
        planes = [shape.plane[:3] for shape in shapes if isinstance(shape, HalfSpace)]
        self.normals = np.array(planes).reshape(-1, 3)

    def hide(self, points: Array, eye: Array) -> npt.NDArray[np.bool_]:
        """Which shape hides which of the points (m, 3) from an eye in the direction (3,): (shapes, m)."""
        hidden = np.zeros((self.count, len(points)), dtype=bool)
        for k, T, box in zip(self.numbers, self.into, self.boxes, strict=True):
            way = T[:3, :3] @ eye
            way = np.where(way == 0.0, np.finfo(np.float64).tiny, way)
            ends = (box[:, None] - transform_points(T, points)) / way
            entry, leaving = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
            hidden[k] = leaving > np.maximum(entry, 0.0)
        return hidden

    def hidden_share(self, points: Array, eye: Array) -> float:
        """The share of points (m, 3) that are hidden from an eye in the direction (3,).

        A half space that turns its back to the eye hides half of what is not hidden otherwise: only the front
        of a plate is drawn.
        """
        turned = int((self.normals @ eye < 0.0).sum())
        return 1.0 - 0.5**turned * (1.0 - float(self.hide(points, eye).any(axis=0).mean()))
