"""Configuration space of a planar arm with two revolute joints: exact pictures, boundary and components."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from types import MappingProxyType
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats, bounded_number, guard_memory, one_array
from cspace.collision import Scene
from cspace.errors import InputError, InputTypeError, Renamed, name_type
from cspace.maps import PolygonWorld
from cspace.planning.joint_space.cells import count_cells
from cspace.planning.two_joints.answers import KINDS, BoundaryCurve, Connection, FreeComponent
from cspace.planning.two_joints.planar_arm import PlanarArm, read_planar_arm
from cspace.planning.two_joints.polygons import Piece, cut_polygons
from cspace.planning.two_joints.sections import cut_scene
from cspace.tables import html_table, one_line, shown
from cspace.tolerances import FARTHEST, LARGEST_NUMBER

RANKS: Final = ("connected", "undetermined", "separate", "blocked")
"""The verdicts on goals, the best one first."""

MOST_CELLS: Final = 30_000
"""Cells of a bitmap along one joint: more than a gigabyte is no picture."""


Obstacles: TypeAlias = Scene | PolygonWorld | Sequence[ArrayLike] | None
"""What a configuration space takes as obstacles."""

AS_JOINT_SPACE: Final = "cs.configuration_space(arm, scene, exact=False) has it"


class ConfigurationSpace(Renamed):
    """The configurations of a planar arm with two revolute joints, free or blocked by obstacles.

    A configuration q = (q1, q2) is blocked where a link touches an obstacle, or beyond a joint limit. At
    each q1 a convex obstacle blocks one arc of directions of link 2, known in closed form; everything here
    comes from these arcs, nothing from samples. `cs.configuration_space` makes it.

    arm: the links and their plane. obstacles: the names. sections: name → convex pieces (corners, radius) in
    the plane. link_radius [m]. dof, joint_names: the joints. lower, upper (2,): the range of both joints
    [rad], −π and π where a joint has no limits; wraps (2,): there both ends are the same place.

    Lozano-Pérez 1983.
    """

    _elsewhere = MappingProxyType(
        {
            "slice": "bitmap(n) is the whole space; " + AS_JOINT_SPACE,
            "project": AS_JOINT_SPACE,
            "volume": "components[k].area is exact; " + AS_JOINT_SPACE,
        }
        | dict.fromkeys(("robot", "scene", "margin"), AS_JOINT_SPACE)
    )

    def __init__(self, arm: PlanarArm, sections: dict[str, list[Piece]], link_radius: float) -> None:
        self.arm, self.sections, self.link_radius = arm, sections, link_radius
        self.obstacles = tuple(sections)
        self.dof, self.joint_names = 2, arm.joint_names
        self.lower, self.upper, self.wraps = arm.lower, arm.upper, arm.wraps
        self._core = make_core(arm, sections, link_radius)

    def cells(self, n: int | Sequence[int] = 1000) -> tuple[Array, Array]:
        """The coordinates q1 (n1,) and q2 (n2,) [rad] of the centres of the cells of `bitmap(n)`."""
        return tuple(
            low + (high - low) * (np.arange(count) + 0.5) / count
            for low, high, count in zip(self.lower, self.upper, count_cells(n, "n", MOST_CELLS), strict=True)
        )

    def bitmap(self, n: int | Sequence[int] = 1000) -> npt.NDArray[np.bool_]:
        """Where the arm collides: bool (n1, n2), of the configurations at the centres of equal cells.

        n: the number of cells along each joint, or (n1, n2). Row i belongs to q1, column j to q2, in
        ascending order: `cells(n)` are the coordinates. Raises InputError for an n that exceeds the memory.
        """
        rows, columns = count_cells(n, "n", MOST_CELLS)
        with guard_memory("n", n, rows * columns / 8.0, "take fewer cells"):
            return self._core.bitmap(rows, columns).view(np.bool_)

    def obstacle_map(self, n: int | Sequence[int] = 1000) -> npt.NDArray[np.int32]:
        """The obstacle in each cell of `bitmap(n)`: int32 (n1, n2), its place in `obstacles`, −1 if free.

        Where the arm touches several obstacles it is one of them.
        """
        rows, columns = count_cells(n, "n", MOST_CELLS)
        with guard_memory("n", n, rows * columns / 2.0, "take fewer cells"):
            return self._core.obstacle_map(rows, columns)

    def free(self, q: ArrayLike) -> Any:
        """Whether configurations q (..., 2) [rad] are free and within the limits: (...) of bool."""
        given = as_floats(q, "q", last=(2,), largest=FARTHEST)
        rows = np.ascontiguousarray(given.reshape(-1, 2))
        free = (self._core.obstacles_at(rows) < 0) & self._is_within(rows)
        return free.reshape(given.shape[:-1]) if given.ndim > 1 else bool(free[0])

    def blocked_by(self, q: ArrayLike) -> str | None:
        """What blocks one configuration q (2,): the name of an obstacle, "limit", or None if it is free."""
        row = one_array(q, "q", (2,), "q1 and q2 [rad]", largest=FARTHEST)
        found = int(self._core.obstacles_at(row[None])[0])
        if found >= 0:
            return self.obstacles[found]
        return None if self._is_within(row[None])[0] else "limit"

    @cached_property
    def boundaries(self) -> tuple[BoundaryCurve, ...]:
        """The boundary of free space as curves, each of one kind of contact with one obstacle.

        The curves are exact at their points, which lie at most 0.1 rad apart in q2; consecutive curves meet
        to within 1e-9 rad in q1.
        """
        points, ends, kinds, obstacles = self._core.boundaries()
        curves = np.split(points, ends[:-1]) if len(ends) else []
        return tuple(
            BoundaryCurve(curve, KINDS[kind], self.obstacles[obstacle] if obstacle >= 0 else "")
            for curve, kind, obstacle in zip(curves, kinds, obstacles, strict=True)
        )

    @cached_property
    def components(self) -> tuple[FreeComponent, ...]:
        """The connected components of free space, the largest first."""
        areas, points, regions = self._core.components()
        alone = np.bincount(regions, minlength=1)[regions] == 1
        return tuple(
            FreeComponent(
                float(area.mean()), (float(area[0]), float(area[1])), point, int(region), bool(single)
            )
            for area, point, region, single in zip(areas, points, regions, alone, strict=True)
        )

    def component(self, q: ArrayLike) -> int | None:
        """The component of a configuration q (2,), as its place in `components`; None if q is not free.

        None also within 1e-7 rad of the tip of a component, where it is not resolved.
        """
        row = one_array(q, "q", (2,), "q1 and q2 [rad]", largest=FARTHEST)
        found = self._core.component_at(row)
        return found if found >= 0 else None

    def connected(self, q_a: ArrayLike, q_b: ArrayLike) -> Connection:
        """Whether two free configurations (2,) are connected within free space: a Connection.

        Both answers are proved, "connected" by boxes of free configurations between the two, "separate" by
        a wall of blocked ones. "undetermined": only a passage that is not resolved may connect them.
        Raises InputError for a configuration that is not free, with what blocks it.
        """
        return self._connect(self._check_free(q_a, "q_a"), self._check_free(q_b, "q_b"))

    def path(self, start: ArrayLike, goals: ArrayLike) -> Connection:
        """A free path from start (2,) to the nearest of goals (2,) or (k, 2): a Connection with its path.

        The path (m, 2) is a chain of straight lines in (q1, q2), proved free over their whole length. It is
        taut: short, and without a margin to the obstacles. It begins at start and ends at the goal, or at a
        copy of it 2π away where a joint wraps: q changes without jumps. Goals that are not free are left
        out. Without a connection the path is empty and the reason that of the goals.
        Raises InputError for a start that is not free.
        """
        begin = self._check_free(start, "start")
        ends = np.atleast_2d(as_floats(goals, "goals", last=(2,), largest=FARTHEST)).reshape(-1, 2)
        found = [self._reach(begin, end, k) for k, end in enumerate(ends)]
        if not found:
            raise InputError("goals is empty; give one goal (2,) or several (k, 2)")
        best = min(found, key=lambda each: (RANKS.index(each.status), each.length))
        if best or len(found) == 1:
            return best
        return Connection(best.status, "; ".join(each.reason for each in found))

    def _reach(self, begin: Array, end: Array, number: int) -> Connection:
        """The connection of a start to one goal, with its path."""
        if (blocked := self.blocked_by(end)) is not None:
            return Connection("blocked", f"goal {number} {write_q(end)} is blocked: {blocked}")
        answer = self._connect(begin, np.ascontiguousarray(end))
        if not answer:
            return answer
        return Connection(answer.status, answer.reason, self._core.find_path(begin, end))

    def _connect(self, a: Array, b: Array) -> Connection:
        one, other = self.component(a), self.component(b)
        between = f"{write_q(a)} and {write_q(b)}"
        if one is None or other is None:
            return Connection(
                "undetermined", f"{between}: one lies where free space is too narrow to resolve"
            )
        if one == other:
            return Connection("connected", f"{between} lie in component {one}")
        if self.components[one].region != self.components[other].region:
            return Connection("separate", f"{between} lie in the components {one} and {other}")
        return Connection(
            "undetermined",
            f"{between} lie in the components {one} and {other}, which a passage too narrow to resolve may "
            "connect",
        )

    def _check_free(self, q: ArrayLike, subject: str) -> Array:
        row = one_array(q, subject, (2,), "q1 and q2 [rad]", largest=FARTHEST)
        if (blocked := self.blocked_by(row)) is None:
            return row
        what = "lies beyond a joint limit" if blocked == "limit" else f"touches {blocked!r}"
        raise InputError(f"{subject} {write_q(row)} {what}; give a configuration that is free")

    def _is_within(self, rows: Array) -> npt.NDArray[np.bool_]:
        """Whether configurations (n, 2) lie within the limits: (n,) of bool."""
        return np.asarray(((rows >= self.lower) & (rows <= self.upper) | self.wraps).all(axis=1))

    def __repr__(self) -> str:
        count = len(self.obstacles)
        return one_line(
            "ConfigurationSpace", f"of {self.arm.name}, {count} obstacle{'' if count == 1 else 's'}"
        )

    def _repr_html_(self) -> str:
        rows = [
            (f"{k}", f"{c.area:.6g}", ", ".join(map(shown, c.point)), "yes" if c.proved else "no")
            for k, c in enumerate(self.components)
        ]
        caption = f"Configuration space of {self.arm.name}: {len(rows)} free components"
        return html_table(caption, ("component", "area [rad²]", "a configuration", "proved"), rows)


def exact_space(
    robot: object, obstacles: Obstacles, *, link_radius: float, limits: bool, height: float | None
) -> ConfigurationSpace:
    """The exact configuration space of a planar arm with two revolute joints; see configuration_space."""
    arm = read_planar_arm(robot, limits)
    radius = bounded_number(
        link_radius, "link_radius", 0.0, "it must be a length [m], 0 or more", LARGEST_NUMBER
    )
    if height is not None:
        height = float(as_floats(height, "height", largest=LARGEST_NUMBER))
    if isinstance(obstacles, Scene):
        return ConfigurationSpace(arm, cut_scene(obstacles, arm, height, radius), radius)
    if not isinstance(obstacles, (PolygonWorld, list, tuple)):
        raise InputTypeError(
            f"obstacles is {name_type(obstacles)}; it must be a Scene, a PolygonWorld or a list of"
            " polygons (n, 2); without obstacles it is cs.Scene()"
        )
    return ConfigurationSpace(arm, cut_polygons(obstacles), radius)


def make_core(arm: PlanarArm, sections: dict[str, list[Piece]], link_radius: float) -> _core.TwoJointSpace:
    """The compiled space of an arm among pieces."""
    pieces = [(piece, k) for k, found in enumerate(sections.values()) for piece in found]
    joint_1, joint_2 = np.column_stack([arm.signs, arm.offsets, arm.lower, arm.upper])
    return _core.TwoJointSpace(
        arm.base,
        arm.lengths,
        link_radius,
        joint_1,
        joint_2,
        bool(arm.wraps[0]),
        bool(arm.wraps[1]),
        np.vstack([np.empty((0, 2)), *(piece.corners for piece, _ in pieces)]),
        np.cumsum([len(piece.corners) for piece, _ in pieces], dtype=np.int32),
        np.array([piece.radius for piece, _ in pieces], dtype=np.float64),
        np.array([k for _, k in pieces], dtype=np.int32),
    )


def write_q(q: Array) -> str:
    """A configuration as text."""
    return f"({q[0]:.6g}, {q[1]:.6g})"
