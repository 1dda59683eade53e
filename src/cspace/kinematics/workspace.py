"""Configurations at random, and what a robot can reach: sampled, with its exact boundary for planar arms."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from cspace.arrays import Array, as_generator, bounded_number, guard_memory, whole_number
from cspace.errors import InputError
from cspace.kinematics.batch import frame_number
from cspace.kinematics.forward import forward_kinematics
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.kinematics.planar_boundary import PlanarArm, trace_boundary
from cspace.math.wrapping import TURN
from cspace.model import Chain, Limits
from cspace.spatial.vectors import frame_along
from cspace.tables import one_line, tabulate
from cspace.tolerances import PLANAR_AXES

Seed: TypeAlias = "int | np.random.Generator | None"

ROWS_AT_ONCE = 1 << 15


def random_configurations(
    limits: Limits, joint_types: str, n: int | None = None, *, rng: Seed = None, reach: float | None = None
) -> Array:
    """Configurations drawn uniformly between the limits.

    limits: of the joints, each (n_joints,). joint_types: "R" or "P" per joint. n: how many; None gives one,
    without a leading axis. rng: seed or generator. A revolute joint without limits is sampled from (−π, π];
    one with a limit on one side from the π inside it; a prismatic joint without limits needs
    reach, the length [m] drawn on the open side.

    Returns q (n, n_joints) or (n_joints,) [rad or m].
    Raises InputError for a prismatic joint with an open side and without reach, a negative n or reach, an
    n beyond the memory;
    InputTypeError for values that are not numbers.
    """
    if n is not None:
        n = whole_number(n, "n", 0, sys.maxsize)
    if reach is not None:
        reach = bounded_number(reach, "reach", 0.0, "it must be one length [m], 0 or more")
    lower, upper = np.array(limits.lower), np.array(limits.upper)
    below, above = np.isinf(lower), np.isinf(upper)
    span = np.array([np.pi if kind == "R" else np.nan if reach is None else reach for kind in joint_types])
    if (open_ended := np.flatnonzero((below | above) & np.isnan(span))).size:
        i = int(open_ended[0])
        raise InputError(
            f"prismatic joint {i} has the limits {lower[i]:g} and {upper[i]:g} m; without a finite range give"
            " reach="
        )
    lower[below] = np.where(above, -span, upper - span)[below]
    upper[above] = np.where(below, span, lower + span)[above]
    generator, count = as_generator(rng), 1 if n is None else n
    with guard_memory("n", n, count * lower.size, "draw fewer configurations"):
        q = np.empty((count, lower.size))
    for begin in range(0, count, ROWS_AT_ONCE):  # an interrupt comes between two steps
        rows = q[begin : begin + ROWS_AT_ONCE]
        # From the upper end downward: (−π, π] excludes −π and includes π.
        np.subtract(upper, (upper - lower) * generator.random(rows.shape), out=rows)
    return q[0] if n is None else q


@tabulate()
@dataclass(frozen=True, eq=False)
class Workspace:
    """Reachable positions of a frame.

    points (n, 3): positions [m] in the base. q (n, n_joints): the configurations [rad or m] that reach them.
    boundary: closed curves (m, 3) [m], the first point repeated, for a planar arm of revolute joints; empty
    for other robots. Of one joint it is the arc of the tip, there and back. area: what they enclose [m²],
    None without a boundary.
    """

    points: Array
    q: Array
    boundary: tuple[Array, ...] = ()
    area: float | None = None

    def __repr__(self) -> str:
        area = "" if self.area is None else f", {len(self.boundary)} boundary curves, area {self.area:.6g} m²"
        return one_line("Workspace", f"of {len(self.points)} points{area}")

    @property
    def bounds(self) -> tuple[Array, Array]:
        """The corners (3,), (3,) of the box around the points and the boundary [m]."""
        everything = np.concatenate([self.points, *self.boundary])
        return everything.min(axis=0), everything.max(axis=0)


def workspace(
    robot: KinematicModel,
    n: int = 10_000,
    frame: str | None = None,
    *,
    rng: Seed = None,
    reach: float | None = None,
    threads: int | None = None,
) -> Workspace:
    """Positions that a frame reaches, drawn through the joints; of a planar arm also the boundary.

    The configurations are uniform between the limits, so the points crowd where many configurations lead to
    one place: they show reach, not density. The boundary is that of the tip of a serial arm whose joints
    all rotate about parallel axes: of up to three joints with any limits, or of any number without limits.

    n: how many points. frame: its name; without it the tip. rng: seed or generator. reach [m]: range drawn
    from if a prismatic joint has no limits. threads: as in fk.

    Returns a Workspace: points (n, 3), q (n, n_joints), boundary curves (m, 3).
    Raises InputError for an n below 1 and for a prismatic joint without limits and reach.

    Kumar and Waldron 1981.
    """
    frame_number(robot, frame)
    limits, kinds = robot.limits, robot.joint_types
    count = whole_number(n, "n", 1, 10**9)
    with guard_memory("n", n, (len(kinds) + 16) * count, "draw fewer configurations"):
        q = random_configurations(limits, kinds, count, rng=rng, reach=reach)
        points = forward_kinematics(robot, q, frame, threads=threads)[:, :3, 3].copy()
    curves: tuple[Array, ...] = ()
    area = None
    if robot.tip is not None and frame in (None, robot.tip) and not robot.floating:
        plane = _planar(robot.chain, limits.lower, limits.upper)
        if plane is not None:
            arm, R, origin = plane
            flat = trace_boundary(arm)
            # Gauss's formula, negative for curves that run clockwise.
            area = 0.5 * sum(float(np.vdot(curve[:-1], curve[1:]).imag) for curve in flat)
            curves = tuple(origin + np.column_stack([z.real, z.imag]) @ R[:, :2].T for z in flat)
    return Workspace(points, q, curves, area)


def _planar(chain: Chain, lower: Array, upper: Array) -> tuple[PlanarArm, Array, Array] | None:
    """The arm in its plane, the axes (3, 3) of the plane, its origin (3,); None for other robots."""
    n = len(chain.axes)
    free = np.isinf(lower).all() and np.isinf(upper).all()
    if n < 1 or chain.joint_types != "R" * n or len(chain.coordinates.names) != n or (n > 3 and not free):
        return None
    R = frame_along(chain.axes[0])
    normal = R[:, 2]
    if np.abs(np.cross(chain.axes, normal)).max() > PLANAR_AXES:
        return None
    tip = chain.T_zero[:3, 3]
    links = np.diff(np.vstack([chain.points, tip]) @ R[:, :2] @ (1.0, 1j))
    lengths = np.abs(links)
    if lengths.min() <= PLANAR_AXES * lengths.sum():
        return None
    at_zero = np.diff(np.angle(links), prepend=0.0)
    signs = np.sign(chain.axes @ normal)
    law = chain.coordinates
    ends = law.multiplier[:, None] * np.column_stack([lower, upper])[law.index] + law.offset[:, None]
    ends = np.sort(ends * signs[:, None], axis=1)
    width = np.minimum(ends[:, 1] - ends[:, 0], TURN)
    start = np.where(width < TURN, at_zero + np.where(width < TURN, ends[:, 0], 0.0), -np.pi)
    origin = chain.points[0] + normal * ((tip - chain.points[0]) @ normal)
    return PlanarArm(lengths, np.column_stack([start, width])), R, origin
