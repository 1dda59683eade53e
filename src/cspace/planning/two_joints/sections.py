"""Sections of shapes: what the plane of an arm cuts out of them, as convex pieces with round corners."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.collision import Scene
from cspace.errors import InputError, InputTypeError, name_type
from cspace.planning.two_joints.planar_arm import PlanarArm
from cspace.planning.two_joints.polygons import Piece, convex_hull
from cspace.shapes import Box, Capsule, Cylinder, HalfSpace, Hull, PointCloud, Shape, Sphere
from cspace.spatial.poses import transform_points
from cspace.tolerances import IN_PLANE

FAR: Final = 4.0
"""How far the section of a half space goes beyond what the arm reaches, over its reach."""


@dataclass(frozen=True)
class Plane:
    """Where shapes are cut: axes (2, 3), unit normal (3,), height along it [m]; and the arm's reach [m] with
    its base (2,) there, beyond which nothing matters."""

    axes: Array
    normal: Array
    height: float
    base: Array
    reach: float

    def flat(self, points: Array) -> Array:
        """Coordinates (..., 2) in the plane of points (..., 3)."""
        return np.asarray(points @ self.axes.T)

    def above(self, points: Array) -> Any:
        """How far points (..., 3) lie above the plane: (...) [m]."""
        return points @ self.normal - self.height


def cut_scene(scene: Scene, arm: PlanarArm, height: float | None, margin: float) -> dict[str, list[Piece]]:
    """The sections of the obstacles of a scene, by name; obstacles that the plane misses have none.

    margin: the radius of the links [m]. Errors as of configuration_space.
    """
    check_scene(scene, arm, height)
    plane = Plane(
        arm.axes,
        arm.normal,
        arm.height if height is None else height,
        arm.base,
        arm.reach + margin,
    )
    return {shape.name: cut_shape(shape, plane) for shape in scene.obstacles}


def check_scene(scene: Scene, arm: PlanarArm, height: float | None) -> None:
    """InputError for what a section cannot tell: attached objects, pairs that may touch, links apart."""
    if scene.attached:
        raise InputError(
            f"object {next(iter(scene.attached))!r} is attached to the robot; the configuration space is that"
            " of the links alone: detach or remove it"
        )
    if scene.allowed:
        raise InputError(
            f"{' and '.join(map(repr, scene.allowed[0]))} may touch; the configuration space counts every"
            " obstacle: forbid the pair, or remove the obstacle"
        )
    if height is None and len(scene) and abs(arm.step) > IN_PLANE * (1.0 + arm.reach):
        raise InputError(
            f"link 1 of {arm.name} moves {abs(arm.step):.6g} m {'above' if arm.step > 0.0 else 'below'} its"
            " tip; one plane cannot cut the obstacles for both links: give height= of the plane along its"
            " normal, or the obstacles as polygons"
        )


def cut_shape(shape: Shape, plane: Plane) -> list[Piece]:
    """The section of a shape as convex pieces; InputError for a shape whose section is not known."""
    for kind, cut in CUTS.items():
        if isinstance(shape, kind):
            return cut(shape, plane)
    raise InputTypeError(
        f"obstacle {shape.name!r} is {name_type(shape)}; sections are known of "
        f"{', '.join(kind.__name__ for kind in CUTS)}: give a Hull, its section as a polygon,"
        " or exact=False for slices of the space with any shape"
    )


def cut_box(box: Box, plane: Plane) -> list[Piece]:
    """The section of a box."""
    signs = np.array(np.meshgrid(*[[-0.5, 0.5]] * 3)).reshape(3, -1).T
    return cut_corners(transform_points(box.pose, signs * box.size), plane)


def cut_hull(hull: Hull, plane: Plane) -> list[Piece]:
    """The section of a convex hull."""
    return cut_corners(transform_points(hull.pose, hull.vertices), plane)


def cut_corners(corners: Array, plane: Plane) -> list[Piece]:
    """The section of the convex hull of points (n, 3): the hull of where the plane cuts their connections."""
    above = plane.above(corners)
    flat = plane.flat(corners)
    on_plane = np.abs(above) <= in_plane(corners)
    found = list(flat[on_plane])
    low, high = np.flatnonzero((above < 0.0) & ~on_plane), np.flatnonzero((above > 0.0) & ~on_plane)
    if len(low) and len(high):
        i, j = (side.ravel() for side in np.meshgrid(low, high))
        part = above[i] / (above[i] - above[j])
        found += list(flat[i] + part[:, None] * (flat[j] - flat[i]))
    return [Piece(convex_hull(np.array(found)), 0.0)] if found else []


def cut_sphere(sphere: Sphere, plane: Plane) -> list[Piece]:
    """The disc in which the plane cuts a sphere."""
    return cut_balls(sphere.pose[None, :3, 3], sphere.radius, plane)


def cut_points(cloud: PointCloud, plane: Plane) -> list[Piece]:
    """The discs in which the plane cuts the balls of a point cloud."""
    return cut_balls(transform_points(cloud.pose, cloud.points), cloud.radius, plane)


def cut_balls(centers: Array, radius: float, plane: Plane) -> list[Piece]:
    """The discs of balls around centres (n, 3), those within reach."""
    squares = radius**2 - plane.above(centers) ** 2
    flat = plane.flat(centers)
    near = np.linalg.norm(flat - plane.base, axis=1) <= plane.reach + radius
    return [
        Piece(center[None], float(np.sqrt(square)))
        for center, square in zip(flat[near], squares[near], strict=True)
        if square >= 0.0
    ]


def cut_cylinder(cylinder: Cylinder, plane: Plane) -> list[Piece]:
    """The disc of an upright cylinder, the rectangle of one that lies in the plane."""
    center, axis = cylinder.pose[:3, 3], cylinder.pose[:3, 2]
    above = float(plane.above(center))
    if is_upright(axis, plane):
        within = abs(above) <= cylinder.length / 2.0 + in_plane(center)
        return [Piece(plane.flat(center)[None], cylinder.radius)] if within else []
    along = lies_in(axis, plane, cylinder) * cylinder.length / 2.0
    square = cylinder.radius**2 - above**2
    if square < 0.0:
        return []
    across = np.array([-along[1], along[0]]) / np.linalg.norm(along) * np.sqrt(square)
    middle = plane.flat(center)
    return [Piece(convex_hull(np.array([middle + s * along + t * across for s, t in CORNERS])), 0.0)]


CORNERS: Final = ((-1, -1), (1, -1), (1, 1), (-1, 1))


def cut_capsule(capsule: Capsule, plane: Plane) -> list[Piece]:
    """The disc of an upright capsule, the rounded bar of one that lies in the plane."""
    center, axis = capsule.pose[:3, 3], capsule.pose[:3, 2]
    above = float(plane.above(center))
    if is_upright(axis, plane):
        beyond = max(abs(above) - capsule.length / 2.0, 0.0)
        ends = plane.flat(center)[None]
    else:
        along = lies_in(axis, plane, capsule) * capsule.length / 2.0
        beyond = above
        ends = plane.flat(center) + np.array([-along, along])
    square = capsule.radius**2 - beyond**2
    return [Piece(convex_hull(ends), float(np.sqrt(square)))] if square >= 0.0 else []


def cut_half_space(half_space: HalfSpace, plane: Plane) -> list[Piece]:
    """A rectangle that covers the part of a half space within reach."""
    *normal, offset = half_space.plane
    across = plane.flat(np.array(normal))
    beyond = offset - float(plane.normal @ normal) * plane.height  # across · x ≤ beyond in the plane
    length = float(np.linalg.norm(across))
    if length <= IN_PLANE:
        across, beyond, length = np.array([1.0, 0.0]), np.copysign(2.0 * FAR * plane.reach, beyond), 1.0
        beyond += float(across @ plane.base)
    n = across / length
    deep = beyond / length - float(n @ plane.base)  # how deep the base lies inside
    if deep < -plane.reach:
        return []
    side = FAR * plane.reach
    edge, t = plane.base + min(deep, side) * n, np.array([-n[1], n[0]])
    return [Piece(convex_hull(np.array([edge + s * side * t - (1 - d) * side * n for s, d in CORNERS])), 0.0)]


def in_plane(points: Array) -> float:
    """The distance [m] from the plane up to which points of this size lie in it."""
    return IN_PLANE * max(1.0, float(np.abs(points).max()))


def is_upright(axis: Array, plane: Plane) -> bool:
    """Whether a unit axis is normal to the plane."""
    return bool(np.linalg.norm(np.cross(axis, plane.normal)) <= IN_PLANE)


def lies_in(axis: Array, plane: Plane, shape: Shape) -> Array:
    """A unit axis in the plane (2,); InputError for one that leaves it."""
    if abs(float(axis @ plane.normal)) > IN_PLANE:
        raise InputError(
            f"{shape.title} {shape.name!r} is tilted against the plane of the arm, so its section is no disc"
            " and no rectangle; give a Hull of its points, or its section as a polygon"
        )
    return plane.flat(axis)


CUTS: Final[dict[type[Shape], Callable[[Any, Plane], list[Piece]]]] = {
    Box: cut_box,
    Sphere: cut_sphere,
    Capsule: cut_capsule,
    Cylinder: cut_cylinder,
    HalfSpace: cut_half_space,
    Hull: cut_hull,
    PointCloud: cut_points,
}
"""The shapes whose sections are known."""
