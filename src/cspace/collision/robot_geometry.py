"""The collision geometry of a robot: spheres on its links, and the pairs of links that are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace._core import CollisionChecker, CollisionRobot, compile_solids
from cspace.arrays import Array, positive_number
from cspace.collision.deficits import measure_deficits
from cspace.collision.exact_solids import (
    PlacedShapes,
    checked_shapes,
    join_shapes,
    place_shape,
    split_shapes,
)
from cspace.collision.link_pairs import SAMPLES, Allowed, adjacent_pairs, always_touching
from cspace.collision.link_shapes import Solids, described_solids, skeleton_solids
from cspace.collision.pack_scene import SOLIDS
from cspace.errors import InputError, suggest
from cspace.kinematics import Assembly, KinematicModel, random_configurations
from cspace.model import Description
from cspace.shapes import Shape
from cspace.spatial.poses import invert_pose, transform_points
from cspace.tables import count_things, one_line, tabulate
from cspace.tolerances import LARGEST_NUMBER

GEOMETRIES: Final = ("collision", "skeleton")
"""What the geometry of a robot is made from: the elements of its description, or capsules along the arm."""

SKELETON: Final = "capsules of the skeleton"
DESCRIBED: Final = "collision elements of the description"
GIVEN: Final = "spheres as given"
"""The sources of a geometry."""

FREE_TRAVEL: Final = 1.0
"""How far prismatic joints without limits move in samples [m]."""

Integers = npt.NDArray[np.int64]

NO_PAIRS: Final[Integers] = np.empty((0, 2), dtype=np.int64)
"""No links are checked against each other, or nothing may touch."""


@tabulate()
@dataclass(frozen=True, eq=False)
class RobotGeometry:
    """Spheres and solids that stand for the links of a robot in collision checks; falsy, with a reason,
    without any.

    robot: the name. source: what the spheres are made from. reason: why there are none. links: names of the
    links with spheres; link_bodies (n,): what carries each, 0 the base and k + 1 joint k. spheres (m, 4):
    centres and radii [m] in the frame of the body; sphere_links (m,): the link of each. solids (s, 16):
    boxes, cylinders and capsules, which are taken exactly; sphere_solids (m,): the solid that a sphere only
    helps to cover, −1 where the sphere itself counts. excess [m]: no sphere that counts sticks out of the
    shapes of its link by more. pairs (k, 2): links that are checked against each other. allowed: pairs of
    links that are not, with the reason.

    joints (j, 21): T_parent_joint by rows, parent, coordinate, ratio, offset, prismatic, the base at the
    origin. lower, upper (dof,): limits. joint_names. T_world_base (4, 4). frames: name → (joint that carries
    it or −1, its pose (4, 4) there).
    """

    robot: str
    source: str
    reason: str
    links: tuple[str, ...]
    link_bodies: Integers
    spheres: Array
    sphere_links: Integers
    solids: Array
    sphere_solids: Integers
    excess: float
    pairs: Integers
    allowed: tuple[Allowed, ...]
    joints: Array
    lower: Array
    upper: Array
    joint_names: tuple[str, ...]
    T_world_base: Array
    frames: Mapping[str, tuple[int, Array]]
    described: Description | None = None
    _kept: dict[Any, Any] = field(default_factory=dict, repr=False)
    """Compiled checks of the last scenes, see checker.py."""

    def __getstate__(self) -> dict[str, Any]:
        """What it is made of, without what is compiled."""
        return {each.name: getattr(self, each.name) for each in fields(self)} | {"_kept": {}}

    def __bool__(self) -> bool:
        return len(self.spheres) > 0

    def __len__(self) -> int:
        """The number of solids and of spheres that count."""
        return len(self.solids) + self.counted_spheres

    @property
    def remark(self) -> str:
        """What reasons say of shapes that are not those of the robot; "" where they are."""
        return f"; links are {SKELETON}, not the robot's shapes" if self.source == SKELETON else ""

    @property
    def counted_spheres(self) -> int:
        """The number of spheres that count, beside those that only help to cover a solid."""
        return int((self.sphere_solids < 0).sum())

    @property
    def collision(self) -> RobotGeometry:
        """Itself, so that checks take it like a Robot."""
        return self

    @property
    def dof(self) -> int:
        """The number of coordinates of a configuration."""
        return len(self.joint_names)

    @cached_property
    def prismatic(self) -> tuple[int, ...]:
        """The coordinates that move prismatic joints."""
        return tuple(sorted({int(row[17]) for row in self.joints if row[20]}))

    @cached_property
    def T_base_world(self) -> Array:
        """The inverse (4, 4) of T_world_base."""
        return invert_pose(self.T_world_base)

    @cached_property
    def compiled(self) -> CollisionRobot:
        """The compiled robot without attached objects."""
        return self.compile(self.link_bodies, self.shapes, self.sphere_links, self.pairs)

    @property
    def deficits(self) -> Mapping[str, float]:
        """Link → the depth [m] up to which its shapes lie outside of given spheres, as an upper bound.

        0: the spheres are proved to cover the shapes; inf: the link has shapes and no spheres. Empty if the
        spheres were not given in place of shapes. Measured when first read, which takes seconds for meshes.
        Raises DescriptionError for meshes that are not found or cannot be read.
        """
        if self.described is None:
            return {}
        if "deficits" not in self._kept:
            rows = split_rows(self.spheres, self.sphere_links)
            given = {}
            for name, own in zip(self.links, rows, strict=True):
                centers = transform_points(invert_pose(self.frames[name][1]), own[:, :3])
                given[name] = np.column_stack([centers, own[:, 3]])
            self._kept["deficits"] = measure_deficits(described_solids(self.described, self.frames), given)
        found: Mapping[str, float] = self._kept["deficits"]
        return found

    @cached_property
    def link_shapes(self) -> Mapping[str, tuple[Shape, ...]]:
        """Link → the shapes that checks take, in the frame of the link: solids, and spheres that count."""
        parts = split_shapes(self.shapes, self.sphere_links) if self else []
        return {
            name: tuple(shape.moved(invert_pose(self.frames[name][1])) for shape in checked_shapes(part))
            for name, part in zip(self.links, parts, strict=True)
        }

    @property
    def shapes(self) -> PlacedShapes:
        """The spheres and solids of all links."""
        return PlacedShapes(self.spheres, self.solids, self.sphere_solids, self.excess)

    def compile(
        self, link_bodies: Integers, shapes: PlacedShapes, sphere_links: Integers, pairs: Integers
    ) -> CollisionRobot:
        """The compiled robot with these links, which follow their bodies. sphere_links: of the shapes.

        Raises InputError for a prismatic joint without limits.
        """
        bounds = np.array([self.lower, self.upper])
        for k in self.prismatic:
            if not np.isfinite(bounds[:, k]).all():
                raise InputError(
                    f"prismatic joint {self.joint_names[k]!r} of {self.robot} has no limits; collision checks"
                    " need them, since rounding grows with its travel"
                )
        return CollisionRobot(
            self.joints,
            bounds,
            link_bodies,
            shapes.spheres,
            sphere_links,
            pairs,
            shapes.solids,
            shapes.sphere_solids,
        )

    def __repr__(self) -> str:
        if not self:
            return one_line("RobotGeometry", f"of {self.robot}: empty, {self.reason}")
        solids, spheres = len(self.solids), self.counted_spheres
        shapes = [count_things(n, noun) for n, noun in ((solids, "solid"), (spheres, "sphere")) if n]
        excess = f", excess {1000 * self.excess:.3g} mm" if spheres else ""
        return one_line(
            "RobotGeometry",
            f"of {self.robot}: {' and '.join(shapes)} on {count_things(len(self.links), 'link')},"
            f" {count_things(len(self.pairs), 'pair')} checked{excess}; {self.source}",
        )


def check_geometry(geometry: object) -> None:
    """Raises UnknownNameError for a name that is no source of collision geometry."""
    if geometry not in GEOMETRIES:
        raise suggest("geometry", geometry, GEOMETRIES)


def robot_geometry(
    robot: KinematicModel,
    description: Description,
    *,
    geometry: str = "collision",
    cover: float = 0.01,
    described: Description | None = None,
    T_world_base: Array | None = None,
) -> RobotGeometry:
    """The collision geometry of a robot.

    geometry: "collision" takes the collision elements of the description: spheres as they are, other shapes
    and meshes covered by spheres that stick out by at most `cover` [m]. "skeleton" takes capsules along the
    arm, which show how checks work but are not the shape of the robot. Links off the chain count at the
    values at which their joints are locked. described: the description whose shapes the spheres of this one
    stand for. T_world_base (4, 4): the mount that the robot has.

    Links that a joint connects, and links that touch at each of 256 random configurations, are not checked
    against each other; nor are pairs that the description allows. What is welded to a link is checked against
    the links that this one's joints carry. Raises DescriptionError for meshes that
    cannot be read, UnknownNameError for another geometry, InputError for a cover that is not positive.
    """
    check_geometry(geometry)
    excess = positive_number(cover, "cover", "it must be one positive number [m]", largest=LARGEST_NUMBER)
    mount = np.eye(4) if T_world_base is None else T_world_base
    assembly = robot._assembly
    frames = frames_on_base(assembly, mount)
    skeleton = geometry == "skeleton"
    solids = skeleton_solids(assembly) if skeleton else described_solids(description, frames)
    links, link_bodies, placed, sphere_links = place_links({} if robot.floating else solids, frames, excess)
    spheres = placed.spheres
    samples = random_configurations(robot.limits, robot.joint_types, SAMPLES, rng=0, reach=FREE_TRAVEL)
    centers = [
        transform_points((robot.fk(samples, name) @ invert_pose(frames[name][1]))[:, None], own)
        for name, own in zip(links, split_rows(spheres[:, :3], sphere_links), strict=True)
    ]
    adjacent = adjacent_pairs(links, {joint.child: joint.parent for joint in description.joints})
    radii = split_rows(spheres[:, 3], sphere_links)
    without_pairs = RobotGeometry(
        robot=robot.name,
        source=SKELETON if skeleton else DESCRIBED if described is None else GIVEN,
        reason="" if len(spheres) else missing_reason(robot, description),
        links=links,
        link_bodies=link_bodies,
        spheres=spheres,
        sphere_links=sphere_links,
        solids=placed.solids,
        sphere_solids=placed.sphere_solids,
        excess=placed.excess,
        pairs=NO_PAIRS,
        allowed=(),
        joints=joint_rows(assembly, mount),
        lower=np.array(robot.limits.lower),
        upper=np.array(robot.limits.upper),
        joint_names=robot.joint_names,
        T_world_base=mount,
        frames=frames,
        described=described,
    )
    pairs, allowed = choose_pairs(description, without_pairs, adjacent, samples, centers, radii)
    rows = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return replace(without_pairs, pairs=rows, allowed=tuple(allowed), _kept={})


def frames_on_base(assembly: Assembly, T_world_base: Array) -> dict[str, tuple[int, Array]]:
    """Frame → (joint that carries it or −1, its pose there), those of the base as seen from the base."""
    T_base_world = invert_pose(T_world_base)
    frames = {}
    for name, f in assembly.frame_index.items():
        joint, T = int(assembly.frame_joint[f]), assembly.T_joint_frame[f]
        frames[name] = (joint, T_base_world @ T if joint < 0 else T)
    return frames


def joint_rows(assembly: Assembly, T_world_base: Array) -> Array:
    """The joints as rows (j, 21), see RobotGeometry."""
    placed = np.array(assembly.T_parent_joint)
    on_base = assembly.parent < 0
    placed[on_base] = invert_pose(T_world_base) @ placed[on_base]
    columns = [assembly.parent, assembly.coordinate, assembly.ratio, assembly.offset, assembly.prismatic]
    return np.column_stack([placed.reshape(-1, 16), *columns]).astype(np.float64)


def missing_reason(robot: KinematicModel, description: Description) -> str:
    """Why a robot has no collision geometry, and what to do."""
    if robot.floating:
        return f"the base of {robot.name} is floating, and checks need a fixed one; give base= and tip="
    where = "the catalogue" if "collision" in description.provenance.missing else "its description"
    return (
        f"{where} has no collision geometry for {robot.name}; give spheres by robot.with_spheres(…), or load"
        ' the robot with geometry="skeleton" for capsules along the arm'
    )


def place_links(
    solids: Solids, frames: Mapping[str, tuple[int, Array]], cover: float
) -> tuple[tuple[str, ...], Integers, PlacedShapes, Integers]:
    """Links in the order of their bodies, the bodies, shapes in their frames, the links of the spheres."""
    order = sorted(solids, key=lambda name: frames[name][0])
    parts: list[PlacedShapes] = []
    owners: list[int] = []
    for number, name in enumerate(order):
        for solid in solids[name]:
            parts.append(place_solid(solid, cover, frames[name][1], name))
            owners += [number] * len(parts[-1].spheres)
    bodies = np.array([frames[name][0] + 1 for name in order], dtype=np.int64)
    return tuple(order), bodies, join_shapes(parts), np.array(owners, dtype=np.int64)


def place_solid(solid: Shape, cover: float, T: Array, link: str) -> PlacedShapes:
    """A solid of a link as checks take it; InputError, with the link, where it cannot be covered."""
    try:
        return place_shape(solid, cover, T)
    except InputError as error:
        raise InputError(f"collision geometry of link {link!r}: {error}") from error


def split_rows(rows: Array, owners: Integers) -> list[Array]:
    """The rows of each owner, whose numbers ascend."""
    return np.split(rows, np.flatnonzero(np.diff(owners)) + 1) if len(rows) else []


def meets_always(geometry: RobotGeometry, pair: tuple[int, int], samples: Array) -> bool:
    """Whether two links whose spheres touch in all samples do so as they are: solids are less than covers."""
    if not len(geometry.solids):
        return True
    slides = list(geometry.prismatic)
    if not np.isfinite([geometry.lower[slides], geometry.upper[slides]]).all():
        return True  # no checks are made for such a robot
    pairs = np.array([pair], dtype=np.int64)
    core = geometry.compile(geometry.link_bodies, geometry.shapes, geometry.sphere_links, pairs)
    nothing = compile_solids((), SOLIDS, np.eye(4))
    checker = CollisionChecker(core, nothing, 0.0, NO_PAIRS)
    return bool(checker.check_rows(np.ascontiguousarray(samples), 1).all())


def choose_pairs(
    description: Description,
    geometry: RobotGeometry,
    adjacent: Sequence[tuple[int, int]],
    samples: Array,
    centers: Sequence[Array],
    radii: Sequence[Array],
) -> tuple[list[tuple[int, int]], list[Allowed]]:
    """The pairs of links that are checked, by number, and the others with their reasons.

    centers: per link those of its spheres at the samples (samples, n, 3) [m]; radii (n,).
    """
    links, bodies = geometry.links, geometry.link_bodies
    reasons = {pair: "adjacent" for pair in adjacent}
    number = {name: k for k, name in enumerate(links)}
    for a, b, reason in description.allowed_pairs:
        if a in number and b in number:
            reasons[min(number[a], number[b]), max(number[a], number[b])] = reason
    every = [(a, b) for a in range(len(links)) for b in range(a + 1, len(links)) if bodies[a] != bodies[b]]
    always = f"touch at each of {SAMPLES} random configurations"
    open_pairs = [pair for pair in every if pair not in reasons]
    touching = always_touching(open_pairs, centers, radii)
    reasons |= dict.fromkeys([pair for pair in touching if meets_always(geometry, pair, samples)], always)
    allowed = [(links[a], links[b], reasons[a, b]) for a, b in every if (a, b) in reasons]
    return [pair for pair in every if pair not in reasons], allowed
