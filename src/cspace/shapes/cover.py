"""Covers of shapes by spheres, with a bound on how far the spheres stick out."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, positive_number
from cspace.errors import InputError
from cspace.shapes.mesh_cover import cover_mesh
from cspace.shapes.point_cloud import PointCloud
from cspace.shapes.shape import IDENTITY, Shape
from cspace.shapes.solids import Capsule, Cylinder, HalfSpace, Sphere
from cspace.spatial.poses import transform_points
from cspace.tables import show_fields
from cspace.tolerances import LARGEST_NUMBER, MOST_COVER_CELLS

HALF_DIAGONAL = math.sqrt(3.0) / 2.0
"""Of a cube of side one."""

FINE_CELLS = 0.6
"""Share of the excess that the ball around a cell may have, before the balls are merged into larger ones."""

MOST_PAIRS_MERGED = 1 << 25
"""Pairs of balls whose distances are compared at once; beyond it fewer balls are candidates."""


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
    no more than asked. Meshes, hulls and height fields are covered by cover_mesh. Every other shape is
    divided into the cells of an octree: a cell without a point of the shape is dropped, a cell whose ball
    sticks out too far is divided; few balls that contain those of the cells are chosen greedily. The result
    has its own bound `excess`, and spheres (n, 4).

    Raises InputError for a half space, an excess that is not positive, and one that needs more than
    tolerances.MOST_COVER_CELLS cells.
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
    elif local._surface() is not None:
        found_spheres = cover_mesh(local, most)
        cover = Cover(found_spheres.spheres, found_spheres.stick_out)
    elif isinstance(local, Cylinder) and (found := cover_cylinder(local, most)).excess <= most:
        cover = found
    else:
        cover = cover_cells(local, most)
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


def cover_cells(shape: Shape, excess: float) -> Cover:
    """Few balls that contain the balls around the cells of an octree of the bounding box.

    The ball around a cell of side a has the radius R = √3 a / 2. With the signed distance d of its centre it
    sticks out by at most d + R; where d > R the cell has no point of the shape.
    """
    low, high = shape.bounds
    side = max(float((high - low).min()), excess / math.sqrt(3.0))
    counts = np.maximum(np.ceil((high - low) / side), 1.0)
    refuse_cells(float(counts.prod()), excess)
    grids = [(low[k] + high[k]) / 2.0 + side * (np.arange(n) - (n - 1.0) / 2.0) for k, n in enumerate(counts)]
    centers = np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1).reshape(-1, 3)
    corners = np.stack(np.meshgrid(*[[-0.25, 0.25]] * 3), axis=-1).reshape(-1, 3)
    cells, depths = [], []
    while len(centers):
        refuse_cells(len(centers), excess)
        radius = HALF_DIAGONAL * side
        distance = np.asarray(shape.distance(centers))
        done = (distance + radius <= FINE_CELLS * excess) & (distance <= radius)
        cells.append(np.column_stack([centers[done], np.full(int(done.sum()), radius)]))
        depths.append(-distance[done])
        divided = centers[(distance + radius > FINE_CELLS * excess) & (distance <= radius)]
        centers = (divided[:, None] + side * corners).reshape(-1, 3)
        side /= 2.0
    return merge_balls(np.concatenate(cells), np.concatenate(depths), excess)


def merge_balls(balls: Array, depth: Array, excess: float) -> Cover:
    """Few balls that contain all balls (n, 4), chosen greedily, the one that contains most first.

    depth (n,): of the centres below the surface. A ball around a centre may have the radius depth + excess;
    it is shrunk to what it contains.
    """
    step = -(-(len(balls) ** 2) // MOST_PAIRS_MERGED)
    order = np.argsort(-depth, kind="stable")
    candidates = np.concatenate([order[::step], order[: len(order) // 8]]) if step > 1 else order
    apart = np.linalg.norm(balls[candidates, None, :3] - balls[:, :3], axis=-1) + balls[:, 3]
    covers = apart <= (depth[candidates] + excess)[:, None]
    contained = np.ascontiguousarray(covers.T)
    todo = np.ones(len(balls), dtype=bool)
    gain = covers.sum(axis=1)
    found, worst = [], 0.0
    while gain.any():
        best = int(gain.argmax())
        new = covers[best] & todo
        radius = float(apart[best, new].max())
        found.append([*balls[candidates[best], :3], radius])
        worst = max(worst, radius - float(depth[candidates[best]]))
        todo &= ~new
        gain = gain - contained[new].sum(axis=0)
    rest = balls[todo]
    worst = max(worst, float((rest[:, 3] - depth[todo]).max(initial=0.0)))
    return Cover(np.concatenate([np.array(found).reshape(-1, 4), rest]), worst)


def refuse_cells(count: float, excess: float) -> None:
    """InputError where a cover has too many cells."""
    if count > MOST_COVER_CELLS:
        raise InputError(
            f"excess is {excess:g} m; the cover needs more than {MOST_COVER_CELLS} cells, use a larger excess"
        )
