"""A robot in a scene, compiled: its links with attached objects, the obstacles, and the names of both."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations
from typing import Final

import numpy as np
import numpy.typing as npt

from cspace._core import CollisionChecker, CollisionRobot, CollisionScene, compile_solids
from cspace.arrays import Array, bounded_number
from cspace.collision.exact_solids import PlacedShapes, join_shapes, place_shape, split_shapes
from cspace.collision.pack_scene import SOLIDS, PackedScene, pack_obstacles
from cspace.collision.robot_geometry import NO_PAIRS, RobotGeometry
from cspace.collision.scene import Scene
from cspace.errors import InputError, InputTypeError, name_type
from cspace.shapes import Shape
from cspace.tolerances import LARGEST_NUMBER

KEPT_CHECKERS: Final = 8
"""Scenes whose checkers a geometry keeps: a planner needs one, and an edit makes a new scene."""

ATTACHED_COVER: Final = 0.005
"""Excess [m] of the spheres that cover an attached object."""

NOTHING: Final = Scene()
"""The scene without obstacles."""


@dataclass(frozen=True, eq=False)
class CheckedRobot:
    """The links of a robot with the objects that it carries, in the order of their bodies, compiled."""

    core: CollisionRobot
    links: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Checker:
    """The compiled checks of a robot in a scene, and the names of links and obstacles by their numbers."""

    core: CollisionChecker
    robot: CheckedRobot
    obstacles: tuple[str, ...]
    margin: float

    def name_pair(self, found: tuple[bool, int, int]) -> tuple[str, str]:
        """The names of a contact: a link, and an obstacle or another link."""
        is_pair, link, other = found
        return self.robot.links[link], (self.robot.links if is_pair else self.obstacles)[other]


def checker_of(geometry: RobotGeometry, scene: Scene | None, margin: float) -> Checker:
    """The checks of a robot in a scene; those of the last scenes are kept.

    scene: None without obstacles. margin: by how much everything must keep away from everything else [m].
    Raises InputError for a robot without collision geometry, for shapes that no check reads, for names that
    do not fit and a margin that is negative; InputTypeError for a scene that is not one.
    """
    scene = NOTHING if scene is None else scene
    if not isinstance(scene, Scene):
        raise InputTypeError(
            f"scene is {name_type(scene)}; it must be a cspace.Scene, such as cs.Scene([cs.Box(…)])"
        )
    gap = bounded_number(margin, "margin", 0.0, "it must be a length [m], 0 or more", largest=LARGEST_NUMBER)
    kept, key = geometry._kept, (scene.version, gap)
    checker: Checker | None = kept.get(key)
    if checker is None:
        checker = make_checker(geometry, scene, gap)
        checkers = [name for name in kept if isinstance(name, tuple)]
        for name in checkers[: max(0, len(checkers) - KEPT_CHECKERS + 1)]:
            kept.pop(name, None)
        kept[key] = checker
    return checker


def make_checker(geometry: RobotGeometry, scene: Scene, margin: float) -> Checker:
    """As checker_of, made anew."""
    if not geometry:
        raise InputError(f"{geometry.robot} cannot be checked for collisions: {geometry.reason}")
    scene.check_links((*geometry.links, *geometry.frames), geometry.frames, geometry.robot)
    robot = add_attached(geometry, scene)
    obstacles = tuple([shape.name for shape in scene.obstacles])
    core = compile_scene(scene, geometry.T_base_world)
    allowed = number_pairs(touching_pairs(scene), robot.links, obstacles)
    return Checker(CollisionChecker(robot.core, core, margin, allowed), robot, obstacles, margin)


def number_pairs(
    pairs: set[frozenset[str]], links: tuple[str, ...], obstacles: tuple[str, ...]
) -> npt.NDArray[np.int64]:
    """The pairs (k, 2) of a link and an obstacle among pairs of names, by number."""
    if not pairs:
        return NO_PAIRS
    link_of = {name: k for k, name in enumerate(links)}
    obstacle_of = {name: k for k, name in enumerate(obstacles)}
    found = [
        (link_of[a], obstacle_of[b])
        for pair in pairs
        for a, b in permutations(pair)
        if a in link_of and b in obstacle_of
    ]
    return np.array(found, dtype=np.int64).reshape(-1, 2)


def compile_scene(scene: Scene, T_base_world: Array) -> CollisionScene:
    """The compiled obstacles; solids of a few numbers need no arrays between."""
    of_solids = compile_solids(scene.obstacles, SOLIDS, T_base_world)
    return compile_packed(pack_obstacles(scene, T_base_world)) if of_solids is None else of_solids


def compile_packed(packed: PackedScene) -> CollisionScene:
    """The compiled obstacles, from their arrays."""
    owners = [
        packed.box_object,
        packed.capsule_object,
        packed.cylinder_object,
        packed.half_space_object,
        packed.mesh_object,
        packed.cloud_object,
    ]
    triangles, mesh_sizes = join_parts([mesh for mesh, _ in packed.meshes], 9)
    points, cloud_sizes = join_parts([cloud for cloud, _ in packed.clouds], 3)
    return CollisionScene(
        packed.boxes,
        packed.capsules,
        packed.cylinders,
        packed.half_spaces,
        triangles,
        mesh_sizes,
        np.array([solid for _, solid in packed.meshes], dtype=np.int64),
        points,
        cloud_sizes,
        np.array([radius for _, radius in packed.clouds], dtype=np.float64),
        np.concatenate(owners),
    )


def join_parts(parts: list[Array], width: int) -> tuple[Array, npt.NDArray[np.int64]]:
    """The rows (n, width) of all parts below each other, contiguous, and how many each part has."""
    rows = [np.ascontiguousarray(part).reshape(-1, width) for part in parts]
    sizes = np.array([len(part) for part in rows], dtype=np.int64)
    if len(rows) == 1:
        return rows[0], sizes
    return np.concatenate(rows) if rows else np.empty((0, width)), sizes


def touching_pairs(scene: Scene) -> set[frozenset[str]]:
    """The pairs of names that may touch: those allowed, and what attached objects may touch."""
    pairs = {frozenset(pair) for pair in scene.allowed}
    for name, attachment in scene.attached.items():
        pairs |= {frozenset((name, other)) for other in attachment.touch}
    return pairs


def place_attached(name: str, solid: Shape, T_joint_frame: Array) -> PlacedShapes:
    """A carried object as checks take it; InputError, with its name, where it is too fine to be covered."""
    try:
        return place_shape(solid, ATTACHED_COVER, T_joint_frame)
    except InputError as error:
        raise InputError(
            f"{name!r} cannot be carried: spheres that stick out by {1000 * ATTACHED_COVER:g} mm cover it,"
            f" and it needs too many; attach simpler shapes in its place ({error})"
        ) from error


def add_attached(geometry: RobotGeometry, scene: Scene) -> CheckedRobot:
    """The robot with the objects that it carries: shapes of the bodies that carry them.

    An attached object is checked against all links of other bodies, and against other attached objects.
    """
    if not scene.attached and not scene.allowed:
        return CheckedRobot(geometry.compiled, geometry.links)
    links = list(geometry.links)
    bodies = geometry.link_bodies.tolist()
    parts = split_shapes(geometry.shapes, geometry.sphere_links)
    checked = {frozenset((links[a], links[b])) for a, b in geometry.pairs.tolist()}
    for name, attachment in scene.attached.items():
        joint, T_joint_frame = geometry.frames[attachment.frame]
        solid = scene[name].placed(attachment.T_frame_object)
        checked |= {frozenset((name, links[k])) for k in range(len(links)) if bodies[k] != joint + 1}
        links.append(name)
        bodies.append(joint + 1)
        parts.append(place_attached(name, solid, T_joint_frame))
    checked -= touching_pairs(scene)
    order = sorted(range(len(links)), key=lambda k: bodies[k])
    names = tuple(links[k] for k in order)
    number = {name: k for k, name in enumerate(names)}
    pairs = sorted(tuple(sorted(number[name] for name in pair)) for pair in checked)
    core = geometry.compile(
        np.array([bodies[k] for k in order], dtype=np.int64),
        join_shapes([parts[k] for k in order]),
        np.repeat(np.arange(len(order)), [len(parts[k].spheres) for k in order]).astype(np.int64),
        np.array(pairs, dtype=np.int64).reshape(-1, 2),
    )
    return CheckedRobot(core, names)
