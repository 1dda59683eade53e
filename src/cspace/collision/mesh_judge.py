"""MeshJudge: checks of configurations and paths with the exact shapes of links, by the optional package coal.

Checks elsewhere in this room use spheres in place of links. The judge takes what the description gives:
meshes, by trees of boxes around their triangles (Gottschalk, Lin & Manocha 1996), and primitives.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, bounded_number, positive_number
from cspace.collision.checker import touching_pairs
from cspace.collision.checks import as_configurations, flat_rows, one_configuration, read_geometry
from cspace.collision.link_shapes import described_solids, skeleton_solids
from cspace.collision.robot_geometry import SKELETON, RobotGeometry
from cspace.collision.scene import Scene
from cspace.errors import InputError, InputTypeError, MissingExtraError, name_type
from cspace.kinematics import Assembly
from cspace.model import Description
from cspace.shapes import Box, Capsule, Cylinder, HalfSpace, Mesh, PointCloud, Shape, Sphere
from cspace.shapes.shape import IDENTITY
from cspace.tables import one_line, shown, tabulate
from cspace.tolerances import LARGEST_NUMBER, POINT_RADIUS

VERIFY_STEP: Final = 0.005
"""Between two samples of a path no point of the robot moves by more [m]."""

MOST_SAMPLES: Final = 1_000_000
"""Samples of a path: minutes of work."""

CHUNK: Final = 1024
"""Configurations whose distances are held at once."""

SOLIDS: Final = (Box, Capsule, Cylinder, HalfSpace, Sphere)
"""What coal knows as solids."""


class HasShapes(Protocol):
    """A Robot: its description, its geometry and its kinematics."""

    description: Description
    _assembly: Assembly

    @property
    def collision(self) -> RobotGeometry:
        """What collision checks use."""

    def fk(self, q: ArrayLike, frame: str | None = None) -> Array:
        """Poses of a frame."""


@tabulate()
@dataclass(frozen=True)
class MeshVerdict:
    """What a judge found on a path; truthy if nothing touches.

    samples: configurations that were checked. step [m]: no point of the robot moves by more between two of
    them. at: where the first contact is, 0 at the start and 1 at the end of the path by its length; NaN
    without. pair: what touches there, None without. reason: in words.
    """

    samples: int
    step: float
    at: float
    pair: tuple[str, str] | None
    reason: str

    def __bool__(self) -> bool:
        return self.pair is None

    def __repr__(self) -> str:
        return one_line("MeshVerdict", self.reason)


@dataclass(frozen=True, eq=False)
class _Piece:
    """A shape of the package and of coal. owner: name of its link or object. frame: the link that carries it,
    "" for obstacles. center (3,), radius: a ball around it in the frame; infinite for a half space."""

    owner: str
    frame: str
    shape: Shape
    solid: Any
    center: Array
    radius: float


@tabulate("joint_names", "margin")
class MeshJudge:
    """Checks of a robot in a scene with the exact shapes of its links.

    robot: a Robot. The shapes are the collision elements of its description, meshes as surfaces of triangles,
    and spheres where `robot.with_spheres` put them in place of the elements; with geometry="skeleton" the
    capsules along the arm. scene: None without
    obstacles. margin [m]: everything keeps so far away from everything else. Pairs of links are those that
    `robot.collision` checks; allowed pairs and attached objects are those of the scene.

    Raises MissingExtraError without coal (`pip install 'cspace[mesh]'`), InputError for a robot without
    collision geometry and a negative margin.
    """

    def __init__(self, robot: HasShapes, scene: Scene | None = None, margin: float = 0.0) -> None:
        geometry = read_geometry(robot)
        if not geometry:
            raise InputError(f"{geometry.robot} cannot be checked for collisions: {geometry.reason}")
        if not isinstance(scene, Scene | None):
            raise InputTypeError(f"scene is {name_type(scene)}; it must be a cspace.Scene")
        self._coal = import_coal()
        self._robot, self._geometry = robot, geometry
        self._scene = Scene() if scene is None else scene
        self._scene.check_links({*geometry.links, *geometry.frames}, geometry.frames, geometry.robot)
        rule = "it must be a length [m], 0 or more"
        self._request = self._coal.CollisionRequest()
        self.margin = bounded_number(margin, "margin", 0.0, rule, largest=LARGEST_NUMBER)
        self._request.security_margin = self.margin
        self._pieces = list(self._list_pieces())
        self._pairs = self._list_pairs()

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The joints of the configurations."""
        return self._geometry.joint_names

    @property
    def basis(self) -> str:
        """What the links are checked as, in words."""
        links = set(self._geometry.links)
        if any(isinstance(piece.shape, Mesh) and piece.owner in links for piece in self._pieces):
            return "with meshes"
        return f"without meshes, which {self._geometry.robot} lacks (links are {self._geometry.source}),"

    def __repr__(self) -> str:
        counts = f"{len(self._pieces)} shapes, {len(self._pairs)} pairs checked"
        return one_line("MeshJudge", f"of {self._geometry.robot}: {counts}")

    # --- what is checked --------------------------------------------------------------------------------
    def _list_pieces(self) -> Iterator[_Piece]:
        """The shapes of links, of attached objects and of obstacles."""
        for link, shapes in self._link_shapes().items():
            for shape in shapes:
                yield from self._make_pieces(link, link, shape)
        for name, attachment in self._scene.attached.items():
            shape = self._scene[name].placed(attachment.T_frame_object)
            yield from self._make_pieces(name, attachment.frame, shape)
        for shape in self._scene.obstacles:
            yield from self._make_pieces(shape.name, "", shape)

    def _link_shapes(self) -> Mapping[str, tuple[Shape, ...]]:
        """The shapes of each link in its frame."""
        geometry = self._geometry
        if geometry.source == SKELETON:
            return skeleton_solids(self._robot._assembly)
        return described_solids(self._robot.description, geometry.frames)

    def _make_pieces(self, owner: str, frame: str, shape: Shape) -> Iterator[_Piece]:
        """The pieces of one shape: a sphere per point of a cloud, else one."""
        if isinstance(shape, PointCloud):
            points = np.asarray(shape.points) @ shape.pose[:3, :3].T + shape.pose[:3, 3]
            for point in points:
                yield from self._make_pieces(owner, frame, Sphere(max(shape.radius, POINT_RADIUS), point))
            return
        center, radius = bounding_ball(shape)
        yield _Piece(owner, frame, shape, make_solid(self._coal, shape), center, radius)

    def _list_pairs(self) -> list[tuple[int, int]]:
        """The pairs of pieces that are checked against each other, by number."""
        geometry, scene = self._geometry, self._scene
        bodies = {link: geometry.frames[link][0] for link in geometry.frames}
        checked = {frozenset((geometry.links[a], geometry.links[b])) for a, b in geometry.pairs.tolist()}
        allowed = touching_pairs(scene)
        pairs = []
        for i, one in enumerate(self._pieces):
            for j, other in enumerate(self._pieces[i + 1 :], i + 1):
                names = frozenset((one.owner, other.owner))
                if not one.frame or len(names) == 1 or names in allowed:
                    continue  # obstacles come last
                if other.frame:
                    is_link_pair = one.owner not in scene.attached and other.owner not in scene.attached
                    moves = bodies[one.frame] != bodies[other.frame]
                    if not moves or (is_link_pair and names not in checked):
                        continue
                pairs.append((i, j))
        return pairs

    # --- checks -----------------------------------------------------------------------------------------
    def collides(self, q: ArrayLike) -> Any:
        """Whether the robot touches an obstacle or itself at q (..., dof): bool or array (...)."""
        rows = as_configurations(self._geometry, q)
        found = [pair is not None for row in flat_rows(rows) for pair in self._contacts(row[None])]
        return found[0] if rows.ndim == 1 else np.array(found).reshape(rows.shape[:-1])

    def contact(self, q: ArrayLike) -> tuple[str, str] | None:
        """The names of a pair that touches at q (dof,); None if nothing does."""
        return next(self._contacts(one_configuration(self._geometry, q, "q")[None]))

    def judge_path(self, path: ArrayLike, step: float = VERIFY_STEP) -> MeshVerdict:
        """Check samples of a path (m, dof), corners joined by straight motions of the joints.

        step [m]: no point of the robot moves by more between two samples; what touches between them does so
        by less than that.
        """
        corners = flat_rows(as_configurations(self._geometry, path, "path"))
        if not len(corners):
            raise InputError(f"path has shape {np.shape(path)}; it must have at least one corner")
        most = positive_number(step, "step", "it must be one positive length [m]")
        rows, places = self._sample(corners, most)
        for row, place, pair in zip(rows, places, self._contacts(rows), strict=True):
            if pair is not None:
                joints = ", ".join(shown(x) for x in row)
                reason = f"{pair[0]} touches {pair[1]} at {shown(place)} of the way, at ({joints})"
                return MeshVerdict(len(rows), most, float(place), pair, reason)
        reason = f"{len(rows)} samples are free, no point moves by more than {1000 * most:g} mm between them"
        return MeshVerdict(len(rows), most, float("nan"), None, reason)

    def _sample(self, corners: Array, step: float) -> tuple[Array, Array]:
        """Samples (n, dof) of a path and where they are (n,), 0 to 1 by its length."""
        levers = self._measure_levers()
        steps = np.diff(corners, axis=0)
        counts = count_samples(np.abs(steps) @ levers, step)
        rows, places = [corners[:1]], [np.zeros(1)]
        lengths = np.linalg.norm(steps, axis=1)
        done, whole = np.concatenate([[0.0], np.cumsum(lengths)]), max(lengths.sum(), np.finfo(float).tiny)
        for a, move, n, before, length in zip(corners, steps, counts, done, lengths, strict=False):
            t = np.arange(1, n + 1) / n
            rows.append(a + t[:, None] * move)
            places.append((before + t * length) / whole)
        return np.concatenate(rows), np.concatenate(places)

    def _measure_levers(self) -> Array:
        """Per coordinate a bound on how far a point of the robot moves with it [m/rad or 1] (dof,)."""
        joints = self._geometry.joints
        travel = np.maximum(np.abs(self._geometry.lower), np.abs(self._geometry.upper))
        reach = np.zeros(len(joints))  # of what each joint carries, from its origin
        for piece in self._pieces:
            if piece.frame:
                body, T_body_frame = self._geometry.frames[piece.frame]
                if body >= 0:
                    center = T_body_frame[:3, :3] @ piece.center + T_body_frame[:3, 3]
                    reach[body] = max(reach[body], float(np.linalg.norm(center)) + piece.radius)
        levers = np.zeros(self._geometry.dof)
        for k in reversed(range(len(joints))):
            parent, coordinate, ratio, offset = (
                int(joints[k, 16]),
                int(joints[k, 17]),
                joints[k, 18],
                joints[k, 19],
            )
            slides = bool(joints[k, 20])
            if coordinate >= 0:
                levers[coordinate] += abs(ratio) * (1.0 if slides else reach[k])
            length = float(np.linalg.norm(joints[k, [3, 7, 11]]))
            if slides:
                length += abs(offset) + (abs(ratio) * travel[coordinate] if coordinate >= 0 else 0.0)
            if parent >= 0:
                reach[parent] = max(reach[parent], reach[k] + length)
        return levers

    def _contacts(self, rows: Array) -> Iterator[tuple[str, str] | None]:
        """Per configuration (n, dof) of a path the names of the first pair that touches, or None.

        Whether a piece is inside another one without touching its surface is looked at in the first
        configuration alone: later it would have to pass the surface.
        """
        for first in range(0, len(rows), CHUNK):
            part = rows[first : first + CHUNK]
            frames = {piece.frame for piece in self._pieces if piece.frame}
            poses = {frame: self._robot.fk(part, frame) for frame in frames}
            for k, near in enumerate(self._find_near(part, poses)):
                yield self._find_touch(near, poses, k, first + k == 0)

    def _find_touch(
        self, near: np.ndarray[Any, np.dtype[np.bool_]], poses: dict[str, Array], k: int, is_first: bool
    ) -> tuple[str, str] | None:
        """The names of the first pair of those near (pairs,) that touches at configuration k, or None."""
        for n in np.flatnonzero(near).tolist():
            one, other = (self._pieces[i] for i in self._pairs[n])
            if self._touch(one, other, poses, k, is_first):
                return one.owner, other.owner
        return None

    def _find_near(self, rows: Array, poses: dict[str, Array]) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Which pairs (n, pairs) may touch: balls around both come together."""
        centers = np.stack([place_center(piece, poses, len(rows)) for piece in self._pieces], axis=1)
        radii = np.array([piece.radius for piece in self._pieces])
        i, j = np.array(self._pairs, dtype=np.intp).reshape(-1, 2).T
        gaps = np.linalg.norm(centers[:, i] - centers[:, j], axis=-1)
        return np.asarray(gaps <= radii[i] + radii[j] + self.margin)

    def _touch(self, one: _Piece, other: _Piece, poses: dict[str, Array], k: int, looks_inside: bool) -> bool:
        """Whether two pieces touch at configuration k, or one is inside the other."""
        Ts = [poses[piece.frame][k] if piece.frame else IDENTITY for piece in (one, other)]
        placed = [T @ piece.shape.pose for T, piece in zip(Ts, (one, other), strict=True)]
        transforms = [self._coal.Transform3s(T[:3, :3], T[:3, 3]) for T in placed]
        solids = one.solid, transforms[0], other.solid, transforms[1]
        if self._coal.collide(*solids, self._request, self._coal.CollisionResult()):
            return True
        return looks_inside and (is_inside(one, other, *placed) or is_inside(other, one, *placed[::-1]))


def count_samples(travel: Array, step: float) -> np.ndarray[Any, np.dtype[np.int64]]:
    """The samples of motions (n,) by how far points move at most (n,) [m]; InputError for too many."""
    with np.errstate(over="ignore"):
        counts = np.maximum(1.0, np.ceil(travel / step))
    if counts.sum() > MOST_SAMPLES:
        raise InputError(
            f"step is {step:g} m; the path needs {counts.sum():.3g} samples, and {MOST_SAMPLES} at most are"
            " checked; give a larger step, or a shorter path"
        )
    return counts.astype(np.int64)


def import_coal() -> Any:
    """The package coal; MissingExtraError without it."""
    try:
        return import_module("coal")
    except ImportError as error:
        raise MissingExtraError("mesh", 'verify="mesh"') from error


def make_solid(coal: Any, shape: Shape) -> Any:
    """The geometry of coal for a shape, without its pose."""
    if isinstance(shape, Sphere):
        return coal.Sphere(shape.radius)
    if isinstance(shape, Box):
        return coal.Box(*map(float, shape.size))
    if isinstance(shape, Capsule):
        return coal.Capsule(shape.radius, shape.length)
    if isinstance(shape, Cylinder):
        return coal.Cylinder(shape.radius, shape.length)
    if isinstance(shape, HalfSpace):
        return coal.Halfspace(np.array(shape.normal), shape.offset)
    surface = shape._surface()
    assert surface is not None
    vertices, faces, _ = surface
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(faces), len(vertices))
    model.addVertices(np.asarray(vertices, dtype=np.float64))
    model.addTriangles(np.asarray(faces, dtype=np.int64))
    model.endModel()
    return model


def bounding_ball(shape: Shape) -> tuple[Array, float]:
    """Centre (3,) and radius of a ball around a shape where it is placed; infinite for a half space."""
    low, high = shape.bounds
    if not np.isfinite([low, high]).all():
        return np.zeros(3), float("inf")
    return (low + high) / 2.0, float(np.linalg.norm(high - low)) / 2.0


def place_center(piece: _Piece, poses: dict[str, Array], count: int) -> Array:
    """The centre of a piece in the world at so many configurations (count, 3)."""
    if not piece.frame:
        return np.broadcast_to(piece.center, (count, 3))
    T = poses[piece.frame]
    return np.asarray(T[:, :3, :3] @ piece.center + T[:, :3, 3])


def is_inside(one: _Piece, other: _Piece, T_one: Array, T_other: Array) -> bool:
    """Whether a piece begins inside a solid of which coal knows the surface alone. T (4, 4): their poses."""
    surface = other.shape._surface()
    if surface is None or not surface[2] or isinstance(other.shape, SOLIDS):
        return False
    own = one.shape._surface()
    is_solid = isinstance(one.shape, SOLIDS) or own is None
    point = np.zeros(3) if is_solid or own is None else own[0][0]  # the middle of a solid, or a corner
    world = T_one[:3, :3] @ point + T_one[:3, 3]
    return bool(other.shape.placed(T_other).contains(world))
