"""JointSpace: the configuration space of any robot, in slices, projections and volumes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from math import inf, prod
from time import perf_counter
from types import MappingProxyType
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace._core import CollisionChecker
from cspace.arrays import Array, as_floats, as_generator, one_array, positive_number, whole_number
from cspace.collision import RobotGeometry, Scene
from cspace.collision.checker import checker_of
from cspace.collision.checks import HasGeometry, read_geometry
from cspace.errors import InputError, InputTypeError, Renamed, name_type, suggest
from cspace.kinematics.batch import thread_count
from cspace.math.wrapping import TURN
from cspace.planning.joint_space.cells import ROWS_AT_ONCE, Grid, count_cells, settle_grid
from cspace.planning.joint_space.projections import Projection
from cspace.planning.joint_space.slices import Slice, name_obstacles
from cspace.planning.joint_space.volumes import Volume
from cspace.planning.space import ArmSpace
from cspace.tables import one_line, tabulate
from cspace.tolerances import LARGEST_NUMBER

Seed = int | np.random.Generator | None

ITSELF: Final = -2
"""What the core answers where a robot touches itself."""

MOST_CELLS: Final = 8192
"""Cells of a slice or a projection along one joint: with 67 million of them a picture takes a minute."""

MOST_SAMPLES: Final = 10**10
"""Samples of a volume: an hour's work, and an error of five millionths."""


EXACT_ONLY: Final = "only planar arms with two joints have an exact space, cs.configuration_space(arm, scene)"


@tabulate("joint_names", "lower", "upper", "obstacles", "margin")
class JointSpace(Renamed):
    """The configurations of a robot with collision geometry, free or blocked, for any number of joints.

    robot: a Robot, or a RobotGeometry. scene: None without obstacles. margin [m]: everything keeps so far
    away from everything else. limits: whether the limits of revolute joints count; a joint without them turns
    around.

    dof, joint_names: the joints. lower, upper (dof,): their range [rad or m], −π and π for a joint that
    wraps; wraps (dof,): the joints where both ends are the same place. obstacles: the names of what may
    block, the last of them "self", for contacts of the robot with itself and with what it carries.

    Raises InputError for a robot without collision geometry, a prismatic joint without limits, a negative
    margin, and names of the scene that do not fit the robot.
    """

    _elsewhere = MappingProxyType(
        dict.fromkeys(("path", "connected"), "cs.plan(robot, start, goal, scene) finds paths")
        | dict.fromkeys(("bitmap", "cells", "obstacle_map"), "slice((i, j)) has the cells of two joints")
        | dict.fromkeys(("components", "component", "boundaries", "sections", "link_radius"), EXACT_ONLY)
    )

    def __init__(
        self,
        robot: HasGeometry,
        scene: Scene | None = None,
        *,
        margin: float = 0.0,
        limits: bool = True,
    ) -> None:
        if not isinstance(limits, (bool, np.bool_)):
            raise InputTypeError(f"limits is {name_type(limits)}; it must be True or False")
        self.robot, self._limits = robot, bool(limits)
        own = read_geometry(robot)
        geometry = own if limits else without_limits(own)
        self._arm = ArmSpace(geometry, scene, margin)
        self.scene, self.margin, self.dof = scene, self._arm.margin, self._arm.dof
        self.lower, self.upper = self._arm.lower, self._arm.upper
        self.wraps = self._arm.wraps.astype(np.bool_)
        self.joint_names = geometry.joint_names
        self.obstacles = name_obstacles(self._arm.checker.obstacles)
        self._core = self._arm.checker.core

    def free(self, q: ArrayLike) -> Any:
        """Whether configurations q (..., dof) are free and within the limits: (...) of bool.

        Free is certain at the centre: the checks keep a distance beyond rounding.
        """
        given = as_floats(q, "q", last=(self.dof,), largest=LARGEST_NUMBER)
        rows = np.ascontiguousarray(given.reshape(-1, self.dof))
        free = self._is_within(rows)
        free[free] = self._core.check_rows(np.ascontiguousarray(rows[free]), 0) == 0
        return free.reshape(given.shape[:-1]) if given.ndim > 1 else bool(free[0])

    def blocked_by(self, q: ArrayLike) -> str | None:
        """What blocks one configuration q (dof,): the name of an obstacle, "self", "limit", or None."""
        row = one_array(q, "q", (self.dof,), "one value per joint", largest=LARGEST_NUMBER)
        if not self._is_within(row[None])[0]:
            return "limit"
        found = int(self._find_obstacles(row[None])[0])
        return None if found < 0 else self.obstacles[found]

    def slice(
        self,
        joints: Sequence[int | str],
        *,
        at: ArrayLike | None = None,
        size: int | Sequence[int] = 256,
        time_limit: float | None = None,
        threads: int | None = None,
    ) -> Slice:
        """The plane of two joints, the others held: where the robot is free, and how much of it is proved.

        A quadtree: a square of cells is settled by one proof where the balls of the robot, grown by how far
        they can move within it, touch nothing, or, made smaller by that, still touch. Squares that remain are
        cut, and cells that remain are decided at their centres.

        joints: two names or numbers. at (dof,) [rad or m]: where the others are held; by default in the
        middle of their range. size: the number of cells along each joint, or (n1, n2). time_limit [s]: after
        it no more proofs are tried. threads: 0 or None for all; the result does not depend on it.

        Raises InputError for a joint that is given twice or is not there, a configuration outside the limits,
        and a size below one.
        """
        grid = self._make_grid(joints, at, size)
        deadline = find_deadline(time_limit)
        count = thread_count(threads, grid.shape)
        blocked, proved = settle_grid(self._core, grid, deadline, count)
        return Slice(
            **self._describe_pair(grid),
            at=grid.q,
            bitmap=blocked,
            is_proved=proved,
            obstacles=self.obstacles,
            _find_obstacles=self._find_obstacles,
        )

    def project(
        self,
        joints: Sequence[int | str],
        *,
        size: int | Sequence[int] = 64,
        samples: int = 64,
        including: ArrayLike | None = None,
        rng: Seed = 0,
        time_limit: float | None = None,
        threads: int | None = None,
    ) -> Projection:
        """The projection onto two joints: for each cell, how often samples of the others are free.

        Each sample sets the other joints uniformly within their range, for all cells alike. joints: two names
        or numbers. size: the number of cells along each joint, or (n1, n2). samples: how many. including
        (dof,) or (k, dof): configurations whose other joints are tried too; they count for `is_free`, not for
        `share`. rng: seed or generator. time_limit [s]: ends the samples, after the first at the earliest.
        threads: 0 or None for all; the result does not depend on it. Errors as of slice.
        """
        grid = self._make_grid(joints, None, size)
        count = whole_number(samples, "samples", 1, MOST_SAMPLES)
        deadline, generator = find_deadline(time_limit), as_generator(rng)
        given = self._check_rows_within(including, "including")
        use = thread_count(threads, grid.shape)
        free, is_free = np.zeros(grid.shape, dtype=np.int64), np.zeros(grid.shape, dtype=np.bool_)
        for q in given:
            is_free |= self._find_free(replace(grid, q=q), use)
        done = 0
        while done < count and (done == 0 or perf_counter() < deadline):
            here = self._find_free(replace(grid, q=generator.uniform(self.lower, self.upper)), use)
            free += here
            done += 1
        is_free |= free > 0
        pair = self._describe_pair(grid)
        return Projection(**pair, is_free=is_free, share=free / done, samples=done, complete=done == count)

    def volume(
        self,
        samples: int = 100_000,
        *,
        rng: Seed = 0,
        time_limit: float | None = None,
        threads: int | None = None,
    ) -> Volume:
        """The free share of the configurations within the limits, by uniform samples.

        It comes with its standard error and an interval of 95 % confidence, and with the shares of what
        blocks. samples: how many. rng: seed or generator. time_limit [s]: ends the samples, after some
        thousands at the earliest. threads: 0 or None for all; the result does not depend on it.

        Raises InputError for less than one sample and a time limit that is not positive.
        """
        count = whole_number(samples, "samples", 1, MOST_SAMPLES)
        deadline, generator = find_deadline(time_limit), as_generator(rng)
        use = thread_count(threads, (count,))
        done = blocked = touching_itself = 0
        while done < count and (done == 0 or perf_counter() < deadline):
            n = min(ROWS_AT_ONCE, count - done)
            rows = generator.uniform(self.lower, self.upper, (n, self.dof))
            hits = self._core.check_rows(rows, use).astype(np.bool_)
            touching_itself += int(self._alone.check_rows(np.ascontiguousarray(rows[hits]), use).sum())
            blocked, done = blocked + int(hits.sum()), done + n
        ranges = self.upper - self.lower
        is_prismatic = np.isin(np.arange(self.dof), self._arm.geometry.prismatic)
        return Volume(
            share=1.0 - blocked / done,
            self_share=touching_itself / done,
            obstacle_share=(blocked - touching_itself) / done,
            samples=done,
            complete=done == count,
            size=prod(ranges.tolist()),
            limit_share=prod(np.where(is_prismatic, 1.0, np.minimum(ranges / TURN, 1.0)).tolist()),
        )

    def _make_grid(
        self, joints: Sequence[int | str], at: ArrayLike | None, size: int | Sequence[int]
    ) -> Grid:
        """The grid of two joints, the others held at a configuration."""
        first, second = pair = self._find_joints(joints)
        q = 0.5 * (self.lower + self.upper)
        if at is not None:
            q = one_array(at, "at", (self.dof,), "one value per joint", largest=LARGEST_NUMBER)
            self._check_rows_within(q, "at")
        ends = [first, second]
        return Grid(q, pair, self.lower[ends], self.upper[ends], count_cells(size, "size", MOST_CELLS))

    def _find_joints(self, joints: Sequence[int | str]) -> tuple[int, int]:
        """The numbers of two joints that are given by name or number."""
        if isinstance(joints, str) or not isinstance(joints, (Sequence, np.ndarray)) or len(joints) != 2:
            raise InputError(f"joints is {joints!r}; give two joints, such as (0, 1) or two names")
        first, second = (find_joint(key, self.joint_names, self._arm.geometry.robot) for key in joints)
        if first == second:
            raise InputError(
                f"joints names {self.joint_names[first]!r} twice; a slice needs two different joints"
            )
        return first, second

    def _describe_pair(self, grid: Grid) -> dict[str, Any]:
        """The fields of JointPair for the joints of a grid."""
        pair = list(grid.joints)
        return {
            "joints": grid.joints,
            "joint_names": tuple(self.joint_names[k] for k in pair),
            "units": tuple("m" if k in self._arm.geometry.prismatic else "rad" for k in pair),
            "lower": grid.lower,
            "upper": grid.upper,
            "wraps": self.wraps[pair],
        }

    def _check_rows_within(self, q: ArrayLike | None, subject: str) -> Array:
        """One configuration (dof,) or several as rows (k, dof), none for None; InputError outside limits."""
        if q is None:
            return np.empty((0, self.dof))
        rows = self._arm.as_rows(q, subject)
        for row in rows:
            if wrong := self._arm.describe_violation(row):
                raise InputError(f"{subject}: {wrong}; hold the joints within their limits")
        return rows

    def _find_free(self, grid: Grid, threads: int) -> npt.NDArray[np.bool_]:
        """The cells (n1, n2) whose centre is free."""
        n1, n2 = grid.shape
        first, second = grid.centers()
        free = np.empty(grid.shape, dtype=np.bool_)
        step = max(1, ROWS_AT_ONCE // n2)
        for begin in range(0, n1, step):
            some = first[begin : begin + step]
            rows = grid.configurations(np.repeat(some, n2), np.tile(second, len(some)))
            free[begin : begin + step] = (self._core.check_rows(rows, threads) == 0).reshape(-1, n2)
        return free

    @cached_property
    def _alone(self) -> CollisionChecker:
        """The checks of the robot, with what it carries, against itself."""
        return checker_of(self._arm.geometry, without_obstacles(self.scene), self.margin).core

    def _find_obstacles(self, rows: Array) -> npt.NDArray[np.int32]:
        """What blocks configurations (k, dof), as its place in `obstacles`; −1 for nothing."""
        found: npt.NDArray[np.int32] = self._core.find_objects(rows, 0)
        return np.where(found == ITSELF, np.int32(len(self.obstacles) - 1), found)

    def _is_within(self, rows: Array) -> npt.NDArray[np.bool_]:
        """Whether configurations (n, dof) lie within the limits: (n,) of bool."""
        within: npt.NDArray[np.bool_] = ((rows >= self.lower) & (rows <= self.upper) | self.wraps).all(axis=1)
        return within

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle makes it from again: the compiled checks cannot be pickled."""
        return make_again, (self.robot, self.scene, self.margin, self._limits)

    def __repr__(self) -> str:
        objects = len(self.obstacles) - 1
        text = f"of {self._arm.geometry.robot}, {self.dof} joints, {objects} obstacle{'s' * (objects != 1)}"
        return one_line("JointSpace", text)


def make_again(robot: HasGeometry, scene: Scene | None, margin: float, limits: bool) -> JointSpace:
    """The same space."""
    return JointSpace(robot, scene, margin=margin, limits=limits)


def find_joint(key: object, names: tuple[str, ...], robot: str) -> int:
    """The number of a joint by its name or its number, from the end where it is negative."""
    if isinstance(key, str):
        if key not in names:
            raise suggest("joint", key, names, owner=robot)
        return names.index(key)
    if isinstance(key, (bool, np.bool_)) or not isinstance(key, (int, np.integer)):
        raise InputTypeError(f"joints contains {name_type(key)}; give joints by name or number")
    if not -len(names) <= key < len(names):
        raise InputError(f"joints has joint {key}, but {robot} has joints 0 to {len(names) - 1}")
    return int(key) % len(names)


def find_deadline(time_limit: float | None) -> float:
    """When the time is up [s, of perf_counter]; never for None."""
    if time_limit is None:
        return inf
    return perf_counter() + positive_number(time_limit, "time_limit", "it must be one positive number [s]")


def without_limits(geometry: RobotGeometry) -> RobotGeometry:
    """A robot whose revolute joints turn around."""
    lower, upper = np.full(geometry.dof, -inf), np.full(geometry.dof, inf)
    kept = list(geometry.prismatic)
    lower[kept], upper[kept] = geometry.lower[kept], geometry.upper[kept]
    return replace(geometry, lower=lower, upper=upper, _kept={})


def without_obstacles(scene: Scene | None) -> Scene | None:
    """A scene with what the robot carries alone."""
    if scene is None:
        return None
    return scene.remove(*(shape.name for shape in scene.obstacles))
