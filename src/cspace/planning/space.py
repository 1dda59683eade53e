"""ArmSpace: the configurations that an arm may take in a scene, with the checks that planners use."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TypeGuard

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace._core import as_rows, find_reach
from cspace.arrays import Array, as_floats
from cspace.collision import Clearance, Edge, RobotGeometry, Scene, clearance, edge
from cspace.collision.checker import Checker, checker_of
from cspace.collision.checks import HasGeometry, read_geometry
from cspace.errors import InputError
from cspace.kinematics.batch import find_pose
from cspace.math.wrapping import TURN, wrap_near
from cspace.tables import one_line, tabulate
from cspace.tolerances import LARGEST_NUMBER


@tabulate("dof", "lower", "upper", "wraps", "margin")
class ArmSpace:
    """Where an arm may be: within its limits, free of collisions with a scene and with itself.

    robot: a Robot, or a RobotGeometry. scene: None without obstacles. margin [m]: everything keeps so far
    away from everything else. dof: number of coordinates. lower, upper (dof,): bounds [rad or m], one turn
    for joints that wrap. wraps (dof,): revolute joints without limits, which take the short way.

    Raises InputError for a robot without collision geometry, a prismatic joint without limits, a negative
    margin, and names of the scene that do not fit the robot.
    """

    def __init__(self, robot: HasGeometry, scene: Scene | None = None, margin: float = 0.0) -> None:
        self.robot, self.geometry, self.scene, self.margin = robot, read_geometry(robot), scene, margin
        self.checker: Checker = checker_of(self.geometry, scene, margin)
        self.dof = self.geometry.dof
        kept = self.geometry._kept
        if "bounds" not in kept:
            kept["bounds"] = find_bounds(self.geometry)
        self.bounds, self.wraps = kept["bounds"]
        self.lower, self.upper = self.bounds

    def __reduce__(self) -> tuple[type[ArmSpace], tuple[HasGeometry, Scene | None, float]]:
        """What it is made of: the checks are compiled anew."""
        return type(self), (self.robot, self.scene, self.margin)

    @cached_property
    def reach(self) -> float:
        """The farthest that a sphere may be from the axis of a joint that moves it [m]."""
        return find_reach(self.checker.core)

    def edge(self, a: ArrayLike, b: ArrayLike, *, resolution: float | None = None) -> Edge:
        """The motion from a to b (dof,), joints that wrap the short way; see collision.edge."""
        return edge(
            self.geometry,
            a,
            self.unwrap(a, b),
            self.scene,
            margin=self.margin,
            resolution=resolution,
        )

    def unwrap(self, a: ArrayLike, b: ArrayLike) -> Array:
        """b (dof,) with each joint that wraps at the multiple of 2π that is nearest to a."""
        start, end = np.asarray(a, dtype=np.float64), np.array(b, dtype=np.float64)
        wraps = self.wraps.astype(bool)
        end[..., wraps] = wrap_near(end[..., wraps], start[..., wraps])
        return end

    def distance(self, a: ArrayLike, b: ArrayLike) -> float:
        """The length of the motion from a to b (L2 norm of the joints)."""
        return float(np.linalg.norm(self.unwrap(a, b) - np.asarray(a)))

    def clearance(self, q: ArrayLike) -> Clearance:
        """The least distance at q (..., dof); see collision.clearance."""
        return clearance(self.geometry, q, self.scene)

    def plain_rows(self, q: object) -> Array | None:
        """As as_rows for arrays of float64 and lists of numbers; None for anything else."""
        return None if q is None else as_rows(q, self.dof, LARGEST_NUMBER)

    def as_rows(self, q: ArrayLike, subject: str) -> Array:
        """One configuration (dof,) or several (n, dof), or names of poses of the robot, as rows.

        Raises InputError for another shape or NaN, UnknownNameError for an unknown name.
        """
        if (plain := self.plain_rows(q)) is not None:
            return plain
        if are_names(q):
            q = self._find_named(q)
        rows = np.ascontiguousarray(as_floats(q, subject, last=(self.dof,), largest=LARGEST_NUMBER))
        if rows.ndim > 2 or (not rows.size and self.dof):
            raise InputError(
                f"{subject} has shape {rows.shape}; give configurations ({self.dof},) or (n, {self.dof})"
            )
        return rows.reshape(-1, self.dof) if rows.ndim < 2 else rows

    def _find_named(self, names: str | Sequence[str]) -> Array:
        """The configurations (n, dof) of named poses of the robot."""
        each = [names] if isinstance(names, str) else names
        return np.stack([find_pose(self.robot, name) for name in each])

    def describe_violation(self, q: Array) -> str:
        """The first joint that is outside its limits, in words."""
        for k in np.flatnonzero((q < self.lower) | (q > self.upper)).tolist():
            if not self.wraps[k]:
                low, high = self.lower[k], self.upper[k]
                typed = " rad" if k not in self.geometry.prismatic and abs(q[k]) > TURN else ""
                return (
                    f"joint {self.geometry.joint_names[k]!r} is at {q[k]:.9g}{typed}, outside its limits"
                    f" {low:.9g} to {high:.9g}"
                )
        return ""

    def describe_contact(self, q: Array, found: tuple[bool, int, int] | None) -> str:
        """What touches at q, how deep, and what to do, in words."""
        if found is None:
            return ""
        a, b = self.checker.name_pair(found)
        if not found[0] and self._is_fixed(a):
            return f"{a} touches {b}, and no joint moves either; permit it by scene.allow({a!r}, {b!r})"
        nearest = self.clearance(q)
        if nearest.pair is not None and nearest.distance < 0.0:
            a, b = nearest.pair
            text = f"{a} touches {b}, {1000 * -nearest.distance:.3g} mm deep"
        else:
            text = f"{a} is closer to {b} than the margin of {1000 * self.margin:.3g} mm"
        way = f"robot.escape may lead out of it, or permit it by scene.allow({a!r}, {b!r})"
        return f"{text}; {way}{self.geometry.remark}"

    def _is_fixed(self, link: str) -> bool:
        """Whether a link or an attached object is fixed to the base."""
        geometry = self.geometry
        if link in geometry.links:
            return bool(geometry.link_bodies[geometry.links.index(link)] == 0)
        return self.scene is not None and geometry.frames[self.scene.attached[link].frame][0] < 0

    def __repr__(self) -> str:
        objects = 0 if self.scene is None else len(self.scene)
        return one_line("ArmSpace", f"of {self.geometry.robot} with {objects} objects, {self.dof} dof")


def are_names(q: object) -> TypeGuard[str | Sequence[str]]:
    """Whether a value is a name, or a list of names."""
    several = isinstance(q, (list, tuple)) and bool(q) and all(isinstance(name, str) for name in q)
    return isinstance(q, str) or several


def find_bounds(geometry: RobotGeometry) -> tuple[Array, npt.NDArray[np.uint8]]:
    """The bounds (2, dof) of the joints, and which of them wrap (dof,)."""
    lower, upper = geometry.lower.copy(), geometry.upper.copy()
    open_below, open_above = np.isinf(lower), np.isinf(upper)
    has_period = np.ones(geometry.dof, dtype=bool)  # moves revolute joints alone, by whole multiples
    for row in geometry.joints:
        if row[20] or row[18] != round(row[18]):
            has_period[int(row[17])] = False
    wraps = open_below & open_above & has_period
    lower[open_below & open_above], upper[open_below & open_above] = -np.pi, np.pi
    lower[open_below & ~open_above] = upper[open_below & ~open_above] - TURN
    upper[open_above & ~open_below] = lower[open_above & ~open_below] + TURN
    bounds = np.array([lower, upper])
    bounds.setflags(write=False)
    return bounds, wraps.astype(np.uint8)
