"""A Cartesian path along which the tip may turn about an axis of its own: a torch, or a hand on a handle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.cartesian.chain_search import find_chain
from cspace.cartesian.guided import smooth_rows
from cspace.cartesian.joint_branches import JointBranch, end_at_limits, make_branch
from cspace.cartesian.redundant_path import (
    SMOOTHINGS,
    end_of_chain,
    follow_redundant,
)
from cspace.cartesian.refine import LeastMotion, first_nodes, read_tolerance, refine_branches
from cspace.errors import InputError
from cspace.ik.near_rows import solve_locked_redundant
from cspace.ik.solver import Solver, as_solver
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_robot, limits_of
from cspace.math.wrapping import TURN
from cspace.model import Limits
from cspace.spatial import exp_so3, log_so3
from cspace.spatial.vectors import AXES, cross, length_and_direction
from cspace.tolerances import SINGULAR_VALUE
from cspace.trajectory.cartesian_path import CartesianPath, Indices, check_cartesian_path
from cspace.trajectory.path import Path

ANGLES: Final = 48
"""Of the free turn that are tried at each station: 7.5° apart."""

CONFIGURATIONS_LOOKED_AT: Final = 3
"""For the freedom that an arm has."""

NO_FREEDOM: Final = (
    "a free turn leaves this arm no freedom: it reaches each pose at single angles, which are not searched"
)
"""Of arms with few joints."""

JOINT_VALUES: Final = 12
"""Of the redundant joint that are tried with each of them, where an arm has one as well."""


def follow_free_turn(
    robot: KinematicModel,
    path: CartesianPath,
    axis: str | ArrayLike = "z",
    start: ArrayLike | None = None,
    *,
    limits: bool | Limits = True,
    tolerance: float = 1e-5,
) -> JointBranch:
    """The joint path along a Cartesian path of which the turn of the tip about one of its axes is free.

    axis: of the tip, "x", "y", "z", "-x", … or a direction (3,) in its frame. The turn is chosen along the
    whole path at once, as the redundant joint of follow_redundant is; an arm that has a redundant joint as
    well chooses the turn first. start (dof,): any configuration that reaches the first pose up to such a
    turn. Other arguments as of follow_cartesian.
    """
    check_robot(robot)
    check_cartesian_path(path)
    solver = as_solver(robot)
    if len(solver.redundant_joints) > 1:
        raise InputError(
            f"the robot has {len(solver.redundant_joints)} redundant joints; a free turn goes with 1 at most"
        )
    tolerance = read_tolerance(tolerance)
    bounds = limits_of(robot.limits, limits, robot.name)
    first = None if start is None else one_array(start, "start", (robot.dof,), "one configuration")
    along = tool_axis(axis)
    if not solver.redundant_joints and not has_freedom(robot, along):
        q = np.zeros((0, robot.dof)) if first is None else first[None]
        return end_of_chain(q, 0.0, "unreachable", f"at s = 0: {NO_FREEDOM}", robot.dof)
    freedom = FreeTurn(robot, solver, along, bounds)
    stations, chain = find_chain(robot, freedom, path, bounds, first)
    if chain.reason:
        return end_of_chain(chain.q, chain.s_end, chain.cause, chain.reason, robot.dof)
    angles = np.unwrap(chain.values)[:, None]
    found: JointBranch | None = None
    for weight in SMOOTHINGS:
        turned = TurnedPath(path, freedom.axis, smooth_rows(stations.s, angles, weight))
        found = follow_turned(robot, solver, turned, stations.s, chain.q, first, bounds, tolerance)
        found = end_at_limits(found, bounds, robot)
        if found:
            return found
    assert found is not None
    return found


def follow_turned(
    robot: KinematicModel,
    solver: Solver,
    turned: TurnedPath,
    s: Array,
    chain: Array,
    start: Array | None,
    bounds: Limits,
    tolerance: float,
) -> JointBranch:
    """The joint path near a chain (n, dof) at parameters s (n,), the turn being chosen."""
    if solver.redundant_joints:
        return follow_redundant(robot, turned, start, limits=bounds, tolerance=tolerance)
    piece, u = first_nodes(turned)
    at = turned.breaks[piece] + u
    guess = np.stack([np.interp(at, s, column) for column in chain.T], axis=1)
    found = refine_branches(robot, turned, LeastMotion(robot, turned), guess[None], tolerance)
    return make_branch(chain[0], found[0])


def has_freedom(robot: KinematicModel, axis: Array) -> bool:
    """Whether joints can move while the tip keeps its place and an axis (3,) of it its direction.

    At one of some configurations: at singular ones there is more freedom.
    """
    rng = np.random.default_rng(0)
    for q in rng.uniform(-1.0, 1.0, (CONFIGURATIONS_LOOKED_AT, robot.dof)):
        direction = robot.fk(q)[:3, :3] @ axis
        across = np.linalg.svd(direction[None])[2][1:]
        J = robot.jacobian(q)
        sizes = np.linalg.svd(np.concatenate([J[:3], across @ J[3:]]), compute_uv=False)
        if np.sum(sizes > SINGULAR_VALUE) == robot.dof:
            return False
    return True


def tool_axis(axis: str | ArrayLike) -> Array:
    """A unit vector (3,) in the frame of the tip."""
    if isinstance(axis, str):
        if axis not in AXES:
            raise InputError(f"axis {axis!r} is unknown, expected x, y, z, -x, -y, -z or a direction (3,)")
        return AXES[axis]
    size, unit = length_and_direction(one_array(axis, "axis", (3,), "a direction"))
    if not size > 0.0:
        raise InputError("axis is zero; it needs a direction")
    return unit


@dataclass(frozen=True, eq=False)
class FreeTurn:
    """The turns of the tip about an axis of its own (see Freedom)."""

    robot: KinematicModel
    solver: Solver
    axis: Array
    bounds: Limits
    is_ring: bool = True

    def spread_values(self) -> Array:
        """Angles (m,), evenly spaced."""
        return TURN * (np.arange(ANGLES) / ANGLES - 0.5)

    def solve(self, T: Array, values: Array) -> tuple[Array, Any]:
        """The solutions of poses that are turned by angles."""
        turned = np.array(T)
        turned[:, :3, :3] = T[:, :3, :3] @ exp_so3(values[:, None] * self.axis)
        if not self.solver.redundant_joints:
            found: Any = self.solver.solve(turned)
            return found.q, found.count
        joint = self.solver.redundant_joints[0]
        lower, upper = self.bounds.lower[joint], self.bounds.upper[joint]
        if not upper - lower < TURN:
            lower, upper = -np.pi, np.pi
        tried = lower + (upper - lower) * (np.arange(JOINT_VALUES) + 0.5) / JOINT_VALUES
        every = np.repeat(turned, JOINT_VALUES, axis=0)
        q, _ = solve_locked_redundant(self.solver, every, np.tile(tried, len(T))[:, None])
        return pack_rows(q.reshape(len(T), -1, q.shape[2]))

    def value_of(self, q: Array, T: Array) -> float:
        """The angle by which the tip is turned from a pose."""
        turn = log_so3(T[:3, :3].T @ self.robot.fk(q)[:3, :3])
        return float(turn @ self.axis)

    def carry(self, T: Array) -> Array:
        """The angles at which the tip does not turn about its axis: those of the path are taken back, else
        the chain would have to follow them in steps of its grid."""
        R = T[:, :3, :3]
        turns = log_so3(np.swapaxes(R[:-1], 1, 2) @ R[1:]) @ self.axis
        return np.concatenate([[0.0], -np.cumsum(turns)])


def pack_rows(q: Array) -> tuple[Array, Any]:
    """Configurations (n, room, dof) with those of NaN behind the others, and how many are not (n,)."""
    missing = np.isnan(q[:, :, 0])
    order = np.argsort(missing, axis=1, kind="stable")
    return np.take_along_axis(q, order[:, :, None], axis=1), (~missing).sum(axis=1)


class TurnedPath(CartesianPath):
    """A Cartesian path whose tip turns about an axis of its own by an angle ψ(s) besides."""

    def __init__(self, path: CartesianPath, axis: Array, angle: Path) -> None:
        self.__dict__.update(path.__dict__)
        self._given, self._own_axis, self._angle = path, axis, angle

    def _angles(self, piece: Indices, u: Array, order: int) -> Array:
        s = np.minimum(self.breaks[piece] + u, self._angle.length)
        return self._angle(s, order)

    def part(self, end: float) -> TurnedPath:
        """As of a CartesianPath."""
        return TurnedPath(self._given.part(end), self._own_axis, self._angle)

    def poses_on(self, piece: Indices, u: Array) -> Array:
        """As of a CartesianPath."""
        T = self._given.poses_on(piece, u)
        T[:, :3, :3] = T[:, :3, :3] @ exp_so3(self._angles(piece, u, 0) * self._own_axis)
        return T

    def twists_on(self, piece: Indices, u: Array) -> tuple[Array, Array]:
        """As of a CartesianPath: ω + ψ' a, and its rate with a' = ω × a."""
        first, second = self._given.twists_on(piece, u)
        a = self._given.poses_on(piece, u)[:, :3, :3] @ self._own_axis
        rate, bend = self._angles(piece, u, 1), self._angles(piece, u, 2)
        second[:, 3:] += bend * a + rate * cross(first[:, 3:], a)
        first[:, 3:] += rate * a
        return first, second
