"""Covers of shapes by spheres, with a bound on how far the spheres stick out."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, positive_number
from cspace.errors import InputError
from cspace.shapes.hull import Hull
from cspace.shapes.mesh_cover import cover_mesh
from cspace.shapes.point_cloud import PointCloud
from cspace.shapes.shape import IDENTITY, Shape
from cspace.shapes.solids import Box, Capsule, Cylinder, HalfSpace, Sphere
from cspace.spatial.poses import transform_points
from cspace.tables import show_fields
from cspace.tolerances import LARGEST_NUMBER

ROUND_SHARE: Final = 0.1
"""Share of the excess of a cylinder's cover by which the prism around it may stick out."""

LEAST_SIDES: Final = 16
"""Sides of the prism around a cylinder, at least."""


@show_fields
@dataclass(frozen=True, eq=False)
class Cover:
    """Spheres whose union contains a shape.

    spheres (n, 4): centres and radii [m] in the frame where the shape is placed. excess [m]: no point of a
    sphere is farther from the shape.
    """

    spheres: Array
    excess: float


def cover_shape(shape: Shape, excess: float = 0.02) -> Cover:
    """Spheres that contain a shape and stick out of it by at most `excess` [m].

    A sphere is its own cover. A capsule (r, L) becomes n + 1 balls on its axis, L / n apart, of the radius
    √(r² + (L/2n)²); a cylinder n balls on its axis of the same radius, where that sticks out of its ends by
    no more than asked. Other cylinders are covered as prisms with many sides, and prisms, boxes, meshes,
    hulls and height fields by cover_mesh. The result has its own bound `excess`, and spheres (n, 4).

    Raises InputError for a half space, an excess that is not positive, and one that is too small for the
    memory that covers are allowed.
    """
    most = positive_number(excess, "excess", "it must be one positive number [m]", largest=LARGEST_NUMBER)
    if isinstance(shape, HalfSpace):
        raise InputError("a half space is unbounded, so no spheres cover it; use a box")
    local = replace(shape, pose=IDENTITY)  # type: ignore[type-var]
    if isinstance(local, Sphere):
        cover = Cover(np.array([[0.0, 0.0, 0.0, local.radius]]), 0.0)
    elif isinstance(local, PointCloud):
        cover = Cover(np.column_stack([local.points, np.full(len(local.points), local.radius)]), 0.0)
    elif isinstance(local, Capsule):
        cover = cover_capsule(local, most)
    elif isinstance(local, Box):
        cover = cover_box(local, most)
    elif isinstance(local, Cylinder):
        cover = cover_cylinder(local, most)
        cover = cover if cover.excess <= most else cover_prism(local, most)
    else:
        found = cover_mesh(local, most)
        cover = Cover(found.spheres, found.stick_out)
    spheres = cover.spheres.copy()
    spheres[:, :3] = transform_points(shape.pose, spheres[:, :3])
    return Cover(spheres, cover.excess)


def count_balls(radius: float, length: float, excess: float) -> int:
    """The least n with √(r² + (L/2n)²) ≤ r + excess."""
    return max(1, math.ceil(length / (2.0 * math.sqrt(excess * (2.0 * radius + excess)))))


def cover_capsule(shape: Capsule, excess: float) -> Cover:
    """Balls at equal distances on the axis of a capsule, both ends included."""
    if shape.length == 0.0:
        return Cover(np.array([[0.0, 0.0, 0.0, shape.radius]]), 0.0)
    n = count_balls(shape.radius, shape.length, excess)
    radius = math.hypot(shape.radius, shape.length / (2 * n))
    return Cover(
        on_axis(np.linspace(-shape.length, shape.length, n + 1) / 2.0, radius), radius - shape.radius
    )


def cover_cylinder(shape: Cylinder, excess: float) -> Cover:
    """Balls in the middle of equal parts of a cylinder."""
    n = count_balls(shape.radius, shape.length, excess)
    half = shape.length / (2 * n)
    radius = math.hypot(shape.radius, half)
    heights = half * (2.0 * np.arange(n) + 1.0 - n)
    return Cover(on_axis(heights, radius), max(radius - shape.radius, radius - half))


def on_axis(heights: npt.NDArray[np.floating[Any]], radius: float) -> Array:
    """Spheres (n, 4) of one radius at heights (n,) on the z axis."""
    spheres = np.zeros((len(heights), 4))
    spheres[:, 2], spheres[:, 3] = heights, radius
    return spheres


def cover_prism(shape: Cylinder, excess: float) -> Cover:
    """Spheres of a prism around a cylinder, whose corners stick out by ROUND_SHARE of the excess at most."""
    sides = LEAST_SIDES
    while shape.radius * (1.0 / math.cos(math.pi / sides) - 1.0) > ROUND_SHARE * excess:
        sides *= 2
    corner = shape.radius / math.cos(math.pi / sides)
    angles = 2.0 * math.pi / sides * np.arange(sides)
    rim = np.column_stack([corner * np.cos(angles), corner * np.sin(angles)])
    half = shape.length / 2.0
    corners = np.concatenate([np.insert(rim, 2, z, axis=1) for z in (-half, half)])
    found = cover_mesh(Hull(corners), excess - (corner - shape.radius))
    return Cover(found.spheres, found.stick_out + (corner - shape.radius))


def cover_box(shape: Box, excess: float) -> Cover:
    """Spheres of a box as a hull."""
    signs = np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3), axis=-1).reshape(-1, 3)
    found = cover_mesh(Hull(signs * shape.size), excess)
    return Cover(found.spheres, found.stick_out)
