"""How much of the shapes of a description given spheres leave outside."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.collision.link_shapes import Solids
from cspace.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere, measure_cover
from cspace.spatial.poses import transform_points
from cspace.tolerances import DEFICIT_ACCURACY

SIDES: Final = 24
"""Sides of the polygons around circles: they are at most 2 % wider."""


def measure_deficits(solids: Solids, spheres: Mapping[str, Array]) -> dict[str, float]:
    """Link → the depth [m] up to which its shapes lie outside of its spheres, as an upper bound.

    spheres: per link rows (n, 4) of centres and radii [m] in its frame. 0: the spheres are proved to cover
    the shapes; inf: the link has shapes and no spheres.
    """
    return {
        link: max(measure_shape(shape, spheres.get(link)) for shape in shapes)
        for link, shapes in solids.items()
    }


def measure_shape(shape: Shape, spheres: Array | None) -> float:
    """The depth [m] up to which a shape lies outside of spheres (n, 4), as an upper bound."""
    if spheres is None or not len(spheres):
        return np.inf
    surface, (centers, radii) = surround_shape(shape), (spheres[:, :3], spheres[:, 3])
    return measure_cover(surface, centers, radii, tolerance=DEFICIT_ACCURACY).uncovered_depth.upper


def surround_shape(shape: Shape) -> Shape:
    """A shape with a surface of triangles that contains another one; meshes and hulls are their own."""
    if isinstance(shape, Box):
        signs = np.array(np.meshgrid(*[(-0.5, 0.5)] * 3)).reshape(3, -1).T
        return Hull(transform_points(shape.pose, signs * shape.size))
    if isinstance(shape, Cylinder):
        ends = np.array([-shape.length, shape.length]) / 2.0
        rim = shape.radius / np.cos(np.pi / SIDES) * circle_points()
        return Hull(transform_points(shape.pose, [[x, y, z] for x, y in rim for z in ends]))
    if isinstance(shape, (Sphere, Capsule)):
        half = shape.length / 2.0 if isinstance(shape, Capsule) else 0.0
        ball = shape.radius / np.cos(np.pi / SIDES) ** 2 * sphere_points()
        up = np.array([0.0, 0.0, half])
        return Hull(transform_points(shape.pose, np.concatenate([ball + up, ball - up])))
    return shape


def circle_points() -> Array:
    """Corners (SIDES, 2) of a polygon in the unit circle."""
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    return np.column_stack([np.cos(angle), np.sin(angle)])


def sphere_points() -> Array:
    """Corners (n, 3) of a polyhedron of meridians and parallels in the unit sphere."""
    polar = np.pi * np.arange(SIDES // 2 + 1) / (SIDES // 2)
    ring = circle_points()
    rows = [np.column_stack([np.sin(p) * ring, np.full(SIDES, np.cos(p))]) for p in polar[1:-1]]
    return np.concatenate([[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], *rows])
