"""Solids that checks take exactly: boxes, cylinders and capsules, whose spheres only tell where to look."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.shapes import Box, Capsule, Cylinder, Shape, Sphere, cover_shape
from cspace.spatial.poses import transform_points
from cspace.tables import show_fields
from cspace.tolerances import FLAT_SHARE, LEAST_COVERED

SOLID_WIDTH: Final = 16
"""Numbers of a solid: its kind, three sizes, the rotation by rows and the place of its frame."""

COVER_SHARE: Final = 0.02
"""Share of the longest side of a solid by which its spheres may stick out where `cover` is less: they only
tell where to look, and closer covers of a metre of a box take seconds."""

NO_SOLIDS: Final = np.empty((0, SOLID_WIDTH))
"""The solids of a robot of spheres and meshes."""

Integers = npt.NDArray[np.int64]


@show_fields
@dataclass(frozen=True, eq=False)
class PlacedShapes:
    """Shapes in the frame of a body. spheres (m, 4) [m] cover them; solids (k, 16): those that are exact;
    sphere_solids (m,): the solid that a sphere helps to cover, −1 where the spheres themselves count. excess
    [m]: no sphere that counts sticks out of its shape by more."""

    spheres: Array
    solids: Array
    sphere_solids: Integers
    excess: float


def solid_row(shape: Shape) -> Array | None:
    """The numbers (16,) of a solid that checks take exactly, None for other shapes; see SOLID_WIDTH."""
    if isinstance(shape, Box):
        head = [0.0, *(shape.size / 2.0)]
    elif isinstance(shape, (Cylinder, Capsule)):
        kind = 1.0 if isinstance(shape, Cylinder) else 2.0
        head = [kind, shape.radius, shape.radius, shape.length / 2.0]
    else:
        return None
    return np.array([*head, *shape.pose[:3, :3].ravel(), *shape.pose[:3, 3]])


def solid_of_row(row: Array) -> Box | Cylinder | Capsule:
    """The solid of a row (16,), as solid_row makes it."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = row[4:13].reshape(3, 3), row[13:]
    if row[0] == 0.0:
        return Box(2.0 * row[1:4], T)
    return (Cylinder if row[0] == 1.0 else Capsule)(row[1], 2.0 * row[3], T)


def checked_shapes(shapes: PlacedShapes) -> tuple[Shape, ...]:
    """The solids, and the spheres that count themselves, as shapes in the frame of the body."""
    counted = shapes.spheres[shapes.sphere_solids < 0]
    return (*map(solid_of_row, shapes.solids), *(Sphere(ball[3], ball[:3]) for ball in counted))


def cover_solid(shape: Box | Cylinder | Capsule, cover: float) -> Array:
    """Spheres (n, 4) that contain a solid; they stick out by `cover` [m], of large ones by more."""
    sides = shape.size if isinstance(shape, Box) else np.array([2.0 * shape.radius, shape.length])
    longest = float(sides.max())
    thick = np.maximum(sides, max(FLAT_SHARE * longest, LEAST_COVERED))
    most = max(cover, COVER_SHARE * longest)
    if isinstance(shape, Box):
        return cover_shape(replace(shape, size=thick), most).spheres
    length = shape.length if isinstance(shape, Capsule) else thick[1]
    return cover_shape(replace(shape, radius=thick[0] / 2.0, length=length), most).spheres


def place_shape(shape: Shape, cover: float, T_body_frame: Array) -> PlacedShapes:
    """A shape, given in a frame of a body, as checks take it. cover [m]: how far spheres may stick out."""
    row = solid_row(shape.moved(T_body_frame))
    if row is None:
        found = cover_shape(shape, cover)
        spheres = place_spheres(found.spheres, T_body_frame)
        return PlacedShapes(spheres, NO_SOLIDS, np.full(len(spheres), -1, dtype=np.int64), found.excess)
    assert isinstance(shape, (Box, Cylinder, Capsule))
    spheres = place_spheres(cover_solid(shape, cover), T_body_frame)
    return PlacedShapes(spheres, row[None], np.zeros(len(spheres), dtype=np.int64), 0.0)


def place_spheres(spheres: Array, T: Array) -> Array:
    """Spheres (n, 4) at a pose T (4, 4)."""
    return np.column_stack([transform_points(T, spheres[:, :3]), spheres[:, 3]])


def join_shapes(parts: list[PlacedShapes]) -> PlacedShapes:
    """The shapes of all parts, their solids numbered anew."""
    solids = np.concatenate([NO_SOLIDS, *(part.solids for part in parts)])
    first = np.cumsum([0, *(len(part.solids) for part in parts)])
    numbers = [
        np.where(part.sphere_solids < 0, -1, part.sphere_solids + start)
        for part, start in zip(parts, first[:-1].tolist(), strict=True)
    ]
    return PlacedShapes(
        np.concatenate([np.zeros((0, 4)), *(part.spheres for part in parts)]),
        solids,
        np.concatenate([np.zeros(0, dtype=np.int64), *numbers]).astype(np.int64),
        max((part.excess for part in parts), default=0.0),
    )


def split_shapes(shapes: PlacedShapes, owners: Integers) -> list[PlacedShapes]:
    """The shapes of each owner of spheres (m,), whose numbers ascend."""
    parts = []
    for rows in np.split(np.arange(len(owners)), np.flatnonzero(np.diff(owners)) + 1):
        numbers = shapes.sphere_solids[rows]
        own = np.unique(numbers[numbers >= 0])
        renumbered = np.where(numbers < 0, -1, np.searchsorted(own, numbers))
        parts.append(PlacedShapes(shapes.spheres[rows], shapes.solids[own], renumbered, shapes.excess))
    return parts
