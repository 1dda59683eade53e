"""Collision checks: configurations, clearance with its gradient, and edges over their whole length."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from math import prod
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from cspace._core import RobotBase, _remember_checker
from cspace.arrays import Array, as_floats, positive_number
from cspace.collision.checker import checker_of
from cspace.collision.robot_geometry import RobotGeometry
from cspace.collision.scene import Scene
from cspace.errors import InputError, InputTypeError, name_type
from cspace.kinematics.batch import thread_count
from cspace.tables import one_line, show_fields, shown, tabulate
from cspace.tolerances import LARGEST_NUMBER

MOST_CAUSES = 3
"""Pairs that an explanation names."""


class HasGeometry(Protocol):
    """A Robot or a RobotGeometry."""

    @property
    def collision(self) -> RobotGeometry:
        """What collision checks use."""


VERDICTS = ("free", "blocked", "undecided")
"""Of an edge, in the order of the core."""


@show_fields
@dataclass(frozen=True, eq=False)
class Clearance:
    """The least distance of a robot from a contact.

    distance [m]: between the nearest pair; negative where it touches, by how deep; inf without any pair.
    gradient (dof,) [m/rad or 1]: of the distance by the coordinates; NaN without any pair. pair: the names of
    a link and of the obstacle or link that is nearest, None without any. crease: another pair is as near and
    has another gradient. Of a batch distance (n,), gradient (n, dof), pair and crease are lists.
    """

    distance: Any
    gradient: Array
    pair: Any
    crease: Any


@tabulate()
@dataclass(frozen=True, eq=False)
class Edge:
    """A straight motion between two configurations, checked; truthy if it is free.

    verdict: "free", "blocked" or "undecided" (a contact could be neither found nor excluded). proved: whether
    it holds between samples too. at: where the contact was found, 0 at the start and 1 at the end; NaN unless
    blocked. pair: what touches there, None unless blocked. reason: in words, "" if free.
    """

    verdict: str
    proved: bool
    at: float
    pair: tuple[str, str] | None
    reason: str

    def __bool__(self) -> bool:
        return self.verdict == "free"

    def __repr__(self) -> str:
        how = ", proved" if self.proved else ", sampled"
        return one_line(
            "Edge", f"{self.verdict}{how if self else ''}{': ' if self.reason else ''}{self.reason}"
        )


def read_geometry(robot: HasGeometry) -> RobotGeometry:
    """The collision geometry of a robot; InputTypeError for what is not one."""
    geometry: RobotGeometry | None = getattr(robot, "collision", None)
    if geometry is None:
        raise InputTypeError(f"robot is {name_type(robot)}; it must be a Robot, as cs.load_robot gives")
    return geometry


def collides(
    robot: HasGeometry,
    q: ArrayLike,
    scene: Scene | None = None,
    *,
    margin: float = 0.0,
    threads: int | None = None,
) -> Any:
    """Whether a robot touches an obstacle or itself.

    q (..., dof) [rad or m]; limits do not count. scene: None for self-collision alone. margin: everything
    closer than this counts as touching [m]. threads: 0 for all; None takes all for batches that gain from it.
    Returns a bool, or for a batch an array (...) of bool. A result of False is certain: spheres keep a
    distance beyond rounding.

    Raises InputError for a robot without collision geometry, a wrong shape, NaN, a negative margin, and for
    names of the scene that do not fit the robot.
    """
    geometry = read_geometry(robot)
    checker = checker_of(geometry, scene, margin)
    rows = as_configurations(geometry, q)
    if checker.margin == 0.0 and isinstance(robot, RobotBase):
        _remember_checker(robot, scene, checker.core)
    if rows.ndim == 1:
        return checker.core.find_contact(rows) is not None
    count = thread_count(threads, rows.shape[:-1])
    found = checker.core.check_rows(flat_rows(rows), count)
    return found.view(np.bool_).reshape(rows.shape[:-1])


def contact(
    robot: HasGeometry, q: ArrayLike, scene: Scene | None = None, *, margin: float = 0.0
) -> tuple[str, str] | None:
    """The names of a link and of an obstacle or link that touch at q (dof,); None if nothing does.

    Of several contacts it is the one that was found first. margin and errors as of collides.
    """
    geometry = read_geometry(robot)
    checker = checker_of(geometry, scene, margin)
    found = checker.core.find_contact(one_configuration(geometry, q, "q"))
    return None if found is None else checker.name_pair(found)


def clearance(robot: HasGeometry, q: ArrayLike, scene: Scene | None = None) -> Clearance:
    """The least distance at q (..., dof) with its gradient and the pair, as Clearance.

    Distances are those of the spheres, in double precision. With the unit normal n of the nearest obstacle
    ∂d/∂q_j = n · (z_j × (c − o_j)) for a revolute joint and n · z_j for a prismatic one; of a pair of links
    only the joints between them count. Errors as of collides.
    """
    geometry = read_geometry(robot)
    checker = checker_of(geometry, scene, 0.0)
    rows = as_configurations(geometry, q)
    found = [checker.core.find_clearance(row) for row in flat_rows(rows)]
    pairs = [None if pair is None else checker.name_pair(pair) for *_, pair in found]
    if rows.ndim == 1:
        distance, gradient, crease, _ = found[0]
        return Clearance(distance, gradient, pairs[0], crease)
    shape = rows.shape[:-1]
    distances = np.array([row[0] for row in found]).reshape(shape)
    gradients = np.array([row[1] for row in found]).reshape(rows.shape)
    return Clearance(distances, gradients, pairs, [row[2] for row in found])


def edge(
    robot: HasGeometry,
    start: ArrayLike,
    end: ArrayLike,
    scene: Scene | None = None,
    *,
    margin: float = 0.0,
    resolution: float | None = None,
) -> Edge:
    """The straight motion from start (dof,) to end (dof,), checked over its whole length.

    It is proved free by bounds on the velocity and acceleration of every sphere, found blocked at a contact,
    or, rarely, undecided: then it passes something by less than the bounds can tell apart. Joints do not
    wrap: the motion goes from one value to the other. resolution: check samples instead, at most so far apart
    [L2 norm of the joints]; then a contact between samples is missed. margin and errors as of collides.
    """
    geometry = read_geometry(robot)
    checker = checker_of(geometry, scene, margin)
    step = 0.0
    if resolution is not None:
        step = positive_number(resolution, "resolution", "it must be one positive number")
    a, b = one_configuration(geometry, start, "start"), one_configuration(geometry, end, "end")
    code, found, at = checker.core.check_edge(a, b, step)
    verdict = VERDICTS[code]
    if found is not None:
        pair = checker.name_pair(found)
        reason = f"{pair[0]} touches {pair[1]} at {shown(at)} of the way{geometry.remark}"
        return Edge(verdict, True, at, pair, reason)
    if verdict == "undecided":
        reason = "the motion passes an obstacle too closely to prove it free; add clearance or a margin"
        reason += geometry.remark
        return Edge(verdict, False, float("nan"), None, reason)
    return Edge(verdict, resolution is None, float("nan"), None, "")


def explain_contacts(robot: HasGeometry, rows: Array, scene: Scene | None, margin: float = 0.0) -> str:
    """What configurations (n, dof) touch, the most frequent pairs first, in words."""
    geometry = read_geometry(robot)
    checker = checker_of(geometry, scene, margin)
    found = (checker.core.find_contact(q) for q in rows)
    pairs = Counter(" touches ".join(checker.name_pair(pair)) for pair in found if pair is not None)
    named = ", ".join(f"{name} ({n})" for name, n in pairs.most_common(MOST_CAUSES))
    return named + (" and others" if len(pairs) > MOST_CAUSES else "") + geometry.remark


def as_configurations(geometry: RobotGeometry, q: ArrayLike, subject: str = "q") -> Array:
    """q (..., dof) as contiguous float64.

    Raises InputError for another shape, NaN, and a prismatic joint beyond its limits: bounds of rounding and
    of motion are made for its travel.
    """
    rows = np.ascontiguousarray(as_floats(q, subject, last=(geometry.dof,), largest=LARGEST_NUMBER))
    for k in geometry.prismatic:
        low, high, travel = geometry.lower[k], geometry.upper[k], rows[..., k]
        if ((travel < low) | (travel > high)).any():
            bad = float(travel[(travel < low) | (travel > high)].flat[0]) if travel.ndim else float(travel)
            raise InputError(
                f"prismatic joint {geometry.joint_names[k]!r} is at {bad:g} m in {subject}; checks are made"
                f" for its limits {low:g} to {high:g} m"
            )
    return rows


def flat_rows(rows: Array) -> Array:
    """Configurations (..., dof) as (n, dof), also where dof is zero."""
    return rows.reshape(prod(rows.shape[:-1]), rows.shape[-1])


def one_configuration(geometry: RobotGeometry, q: ArrayLike, subject: str) -> Array:
    """One configuration (dof,), as by as_configurations; InputError for several."""
    row = as_configurations(geometry, q, subject)
    if row.ndim != 1:
        raise InputError(f"{subject} has shape {row.shape}; it must be one configuration ({geometry.dof},)")
    return row
