"""A Cartesian path along which the tip may turn about an axis of its own: a torch, or a hand on a handle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.cartesian.chain_search import ChainSearch, Stations
from cspace.cartesian.joint_branches import JointBranch, JointBranches, follow_cartesian
from cspace.cartesian.redundant_path import SMOOTHINGS, end_of_chain, follow_chain, follow_poses
from cspace.cartesian.refine import read_tolerance
from cspace.cartesian.relax_chain import ChainMotion
from cspace.errors import InputError
from cspace.ik.near_rows import solve_locked_redundant
from cspace.ik.solver import Solver, as_solver
from cspace.kinematics import KinematicModel, assemble_chain
from cspace.kinematics.batch import check_robot, limits_of
from cspace.kinematics.manipulability import generic_rank
from cspace.math.wrapping import TURN
from cspace.model import Limits
from cspace.spatial import exp_so3, log_so3
from cspace.spatial.vectors import AXES, length_and_direction
from cspace.tolerances import CHAIN_TURN_WEIGHT, PATH_START
from cspace.trajectory.cartesian_path import CartesianPath, Indices, check_cartesian_path
from cspace.trajectory.path import Path

MOST_RELAXED: Final = 2
"""Of the branches with a turn that stays, those of least motion."""

ANGLES: Final = 48
"""Of the free turn that are tried at each station: 7.5° apart."""

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
    whole path at once: of the joint paths that find_free_turns finds, the one that moves the joints least.
    start (dof,): any configuration that reaches the first pose up to such a turn. Other arguments as of
    follow_cartesian.
    """
    found = find_free_turns(robot, path, axis, start, limits=limits, tolerance=tolerance)
    arrived = [branch for branch in found.branches if branch]
    s = Stations.of(path).s
    return (
        min(arrived, key=lambda each: measure_motion(each, s)) if arrived else find_farthest(found.branches)
    )


def find_free_turns(
    robot: KinematicModel,
    path: CartesianPath,
    axis: str | ArrayLike = "z",
    start: ArrayLike | None = None,
    *,
    limits: bool | Limits = True,
    tolerance: float = 1e-5,
    always_searches: bool = False,
) -> JointBranches:
    """The joint paths that are compared where the turn of the tip about an axis is free.

    Those whose turn stays as it is at the start, those of least motion near them (ChainMotion), and the one
    near the cheapest chain (ChainSearch); where none arrives, all that end before. always_searches: for that
    chain of a redundant arm too, although others arrive; it takes ten times as long. Other arguments as of
    follow_free_turn.
    """
    check_robot(robot)
    check_cartesian_path(path)
    solver = as_solver(robot)
    if len(solver.redundant_joints) > 1:
        raise InputError(
            f"the robot has {len(solver.redundant_joints)} redundant joints; a free turn goes with 1 at most"
        )
    first = None if start is None else one_array(start, "start", (robot.dof,), "one configuration")
    bounds = limits_of(robot.limits, limits, robot.name)
    turn = FreeTurn(robot, solver, tool_axis(axis), bounds, first)
    planner = FreeTurnPlanner(turn, path, first, read_tolerance(tolerance))
    held = planner.hold()
    kept = sorted(filter(None, held.branches), key=lambda each: measure_motion(each, planner.stations.s))
    relaxed = [each for branch in kept[:MOST_RELAXED] if (each := planner.relax_branch(branch))]
    branches = [*kept, *relaxed]
    if always_searches or not branches or not solver.redundant_joints:
        found = planner.search()
        branches += filter(None, found)
    if branches:
        return JointBranches(tuple(branches), False, "")
    ended = (*held.branches, *found)
    return JointBranches(ended, False, find_farthest(ended).reason)


def find_farthest(branches: Sequence[JointBranch]) -> JointBranch:
    """The branch that ends last; of several the last one."""
    return max(reversed(branches), key=lambda branch: branch.s_end)


def measure_motion(branch: JointBranch, s: Array) -> float:
    """The sum of the squared steps of the joints between parameters s (n,)."""
    assert branch.path is not None
    return float(np.sum(np.diff(branch.path(s), axis=0) ** 2))


@dataclass(frozen=True, eq=False)
class FreeTurnPlanner:
    """The joint paths along a path with a free turn: those of an arm with one more joint, which takes the
    free turn of the tip back, so that its poses are those of the path."""

    turn: FreeTurn
    path: CartesianPath
    start: Array | None
    tolerance: float

    @cached_property
    def stations(self) -> Stations:
        return Stations.of(self.path)

    @cached_property
    def extended(self) -> KinematicModel:
        """The arm with the joint that takes the turn back."""
        longer = self.turn.solver.chain.append("free turn", "R", self.turn.axis)
        return KinematicModel(assemble_chain(longer), self.turn.robot.name)

    @cached_property
    def bounds(self) -> Limits:
        """Of the joints of the extended arm."""
        given = self.turn.bounds
        return Limits(np.append(given.lower, -np.inf), np.append(given.upper, np.inf))

    @cached_property
    def freedom(self) -> int:
        """How many dimensions of joints move while the tip stays but for its turn."""
        return self.extended.dof - generic_rank(self.extended)

    @cached_property
    def start_turn(self) -> float:
        """By which the start is turned from the first pose; zero up to rounding."""
        turn = 0.0 if self.start is None else self.turn.value_of(self.start, self.stations.T[0])
        return turn if abs(turn) > PATH_START else 0.0

    def hold(self) -> JointBranches:
        """The branches whose turn stays as it is at the start."""
        turned = TurnedPath(self.path, exp_so3(self.start_turn * self.turn.axis))
        path = turned if self.start_turn else self.path
        return follow_poses(self.turn.robot, path, self.start, self.turn.bounds, self.tolerance)

    def relax_branch(self, branch: JointBranch) -> JointBranch:
        """The branch of least motion near one that arrives and whose turn stays."""
        assert branch.path is not None
        q = branch.path(self.stations.s)
        return self.relax(np.append(q, np.full((len(q), 1), -self.start_turn), axis=1))

    def relax(self, q: Array) -> JointBranch:
        """The branch of least motion near a chain (n, dof + 1)."""
        weights = np.append(np.ones(self.turn.robot.dof), CHAIN_TURN_WEIGHT)
        s, T = self.stations.s, self.stations.T
        motion = ChainMotion(self.extended, s, T, self.freedom, weights, self.bounds)
        return self.follow(motion.relax(q, keeps_start=self.start is not None), (0.0,))

    def follow(self, q: Array, smoothings: Sequence[float]) -> JointBranch:
        """The branch beside a chain (n, dof + 1)."""
        s, freedom, bounds = self.stations.s, self.freedom, self.bounds
        found = follow_chain(self.extended, self.path, s, q, freedom, smoothings, bounds, self.tolerance)
        return without_turn(found)

    def search(self) -> list[JointBranch]:
        """The branch near the cheapest chain, or how far one goes; every branch of an arm without freedom."""
        if not self.freedom:
            return self.follow_single_turns()
        robot = self.turn.robot
        chain = ChainSearch(robot, self.turn, self.stations, self.turn.bounds, self.start).run()
        if chain.reason:
            return [end_of_chain(chain.q, chain.s_end, chain.cause, chain.reason, robot.dof)]
        q = np.append(chain.q, -np.unwrap(chain.values)[:, None], axis=1)
        return [self.relax(q) or self.follow(q, SMOOTHINGS)]

    def follow_single_turns(self) -> list[JointBranch]:
        """The branches of an arm that reaches each pose at single turns; one that ends at once for none."""
        start = None if self.start is None else np.append(self.start, -self.start_turn)
        options: Any = {"limits": self.bounds, "tolerance": self.tolerance}
        found = follow_cartesian(Solver(self.extended.chain), self.path, start, **options)
        if found.branches:
            return [without_turn(branch) for branch in found.branches]
        return [end_of_chain(np.zeros((0, 0)), 0.0, "unreachable", found.reason, self.turn.robot.dof)]


def without_turn(branch: JointBranch) -> JointBranch:
    """A branch of the extended arm without its last joint."""
    path = branch.path
    if path is not None:
        path = Path(path.breaks, path.control_points[..., :-1], remarks=path.remarks)
    return replace(branch, path=path, q_start=branch.q_start[:-1])


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
    start: Array | None = None
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
        if self.start is not None:
            tried = np.append(tried, self.start[joint])
        every = np.repeat(turned, len(tried), axis=0)
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
    """A Cartesian path whose tip is turned by R (3, 3), seen in the tip: its twists are the same."""

    def __init__(self, path: CartesianPath, R: Array) -> None:
        self.__dict__.update(path.__dict__)
        self._turn = R

    def part(self, end: float) -> TurnedPath:
        """As of a CartesianPath."""
        return TurnedPath(super().part(end), self._turn)

    def poses_on(self, piece: Indices, u: Array) -> Array:
        """As of a CartesianPath."""
        T = super().poses_on(piece, u)
        T[:, :3, :3] = T[:, :3, :3] @ self._turn
        return T
