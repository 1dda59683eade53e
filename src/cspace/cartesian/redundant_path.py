"""The joint path of a redundant arm along a whole Cartesian path: what is free is chosen at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.cartesian.chain_search import ROOMY, find_chain
from cspace.cartesian.guided import Guided, null_bases, smooth_rows
from cspace.cartesian.joint_branches import (
    NO_DEVIATION,
    JointBranch,
    JointBranches,
    end_at_limits,
    follow_cartesian,
    make_branch,
)
from cspace.cartesian.refine import (
    JUMP_ROUNDS,
    Refined,
    correct_locked,
    divide_intervals,
    find_lost_intervals,
    first_nodes,
    read_tolerance,
    refine_branches,
)
from cspace.errors import InputError
from cspace.ik.near_rows import solve_locked_redundant
from cspace.ik.solver import Solver, as_solver
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_robot, limits_of
from cspace.math.wrapping import wrap_near
from cspace.model import Limits
from cspace.trajectory.cartesian_path import CartesianPath, check_cartesian_path

VALUES: Final = 48
"""Of the redundant joint that are tried at each: 7.5° apart in a full turn."""

SMOOTHINGS: Final = (10.0, 1.0, 0.0)
"""Weights of the second differences with which the chosen values are smoothed: the first whose joints stay
within limits is taken."""


def follow_redundant(
    robot: KinematicModel,
    path: CartesianPath,
    start: ArrayLike | None = None,
    *,
    limits: bool | Limits = True,
    tolerance: float = 1e-5,
) -> JointBranch:
    """The joint path of an arm with one redundant joint, chosen along the whole path at once.

    Among the configurations at values of the redundant joint, the cheapest chain along the path is found:
    little motion, joints near the middle of their limits, and away from singularities. The joint path follows
    the Cartesian path exactly, and beside that a smooth curve near the chain in the direction of the null
    space.

    start (dof,): the first configuration; by default any of the first pose. Other arguments as of
    follow_cartesian. Raises InputError for an arm that has not exactly one redundant joint.

    Bellman 1957 (dynamic programming); Whittaker 1922 (smoothing by differences).
    """
    check_robot(robot)
    check_cartesian_path(path)
    solver = as_solver(robot)
    if len(solver.redundant_joints) != 1:
        raise InputError(
            f"the robot has {len(solver.redundant_joints)} redundant joints; a whole path is planned for one"
        )
    tolerance = read_tolerance(tolerance)
    bounds = limits_of(robot.limits, limits, robot.name)
    first = None if start is None else one_array(start, "start", (robot.dof,), "one configuration")
    stations, chain = find_chain(robot, RedundantJoint.of(solver, bounds), path, bounds, first)
    if chain.reason:
        return end_of_chain(chain.q, chain.s_end, chain.cause, chain.reason, robot.dof)
    return follow_chain(robot, path, stations.s, chain.q, 1, SMOOTHINGS, bounds, tolerance)


def follow_chain(
    robot: KinematicModel,
    path: CartesianPath,
    s: Array,
    q: Array,
    freedom: int,
    smoothings: Sequence[float],
    bounds: Limits,
    tolerance: float,
) -> JointBranch:
    """The joint path beside a chain q (n, dof) at parameters s (n,), in the null spaces of the Jacobian.

    freedom: their dimensions. smoothings: weights of the second differences, tried in this order.
    """
    bases = null_bases(robot, q, freedom).reshape(len(q), -1)
    rows = np.concatenate([q, bases], axis=1)
    found: JointBranch | None = None
    for weight in smoothings:
        guided = Guided(robot, path, smooth_rows(s, rows, weight))
        found = end_at_limits(make_branch(q[0], _refine_guided(guided, tolerance)), bounds, robot)
        if found:
            return found
    assert found is not None
    return found


def _refine_guided(guided: Guided, tolerance: float) -> Refined:
    """The joint path beside the curve of a corrector, with further nodes where it is lost between them."""
    path, nodes = guided.path, first_nodes(guided.path)
    for _ in range(JUMP_ROUNDS):
        guess = guided.guide(*nodes, 0)[0]
        refined = refine_branches(guided.robot, path, guided, guess[None], tolerance, nodes)[0]
        ends = find_lost_intervals(path, nodes, [refined.s_lost])
        if not len(ends):
            break
        nodes = divide_intervals(*nodes, ends)
    return refined


def follow_poses(
    robot: KinematicModel, path: CartesianPath, start: Array | None, limits: bool | Limits, tolerance: float
) -> JointBranches:
    """The joint paths of any arm along a Cartesian path: planned at once where one joint is redundant, and by
    least motion otherwise, or where the plan ends before the path does."""
    if len(as_solver(robot).redundant_joints) != 1:
        return follow_cartesian(robot, path, start, limits=limits, tolerance=tolerance)
    branch = follow_redundant(robot, path, start, limits=limits, tolerance=tolerance)
    if branch:
        return JointBranches((branch,), False, "")
    least = follow_cartesian(robot, path, start, limits=limits, tolerance=tolerance)
    farther = any(each.s_end >= branch.s_end for each in least.branches)
    return least if farther else JointBranches((branch,), False, branch.reason)


@dataclass(frozen=True, eq=False)
class RedundantJoint:
    """The values of the one redundant joint of an arm (see Freedom)."""

    solver: Solver
    lower: float
    upper: float
    is_ring: bool

    @classmethod
    def of(cls, solver: Solver, bounds: Limits) -> RedundantJoint:
        joint = solver.redundant_joints[0]
        lower, upper = float(bounds.lower[joint]), float(bounds.upper[joint])
        is_ring = not upper - lower < ROOMY
        if is_ring:
            lower, upper = -np.pi, np.pi
        return cls(solver, lower, upper, is_ring)

    def spread_values(self) -> Array:
        """Values (m,), evenly spaced."""
        return np.asarray(self.lower + (self.upper - self.lower) * (np.arange(VALUES) + 0.5) / VALUES)

    def solve(self, T: Array, values: Array) -> tuple[Array, Any]:
        """The solutions of poses with the joint at values."""
        return solve_locked_redundant(self.solver, T, values[:, None])

    def move(self, T: Array, q: Array, values: Array) -> Array:
        """The configurations near q (k, dof) of poses with the joint at values; NaN where there is none."""
        joint = self.solver.redundant_joints[0]
        near = np.array(q)
        near[:, joint] += wrap_near(values - q[:, joint], 0.0) if self.is_ring else values - q[:, joint]
        return correct_locked(self.solver, T, near, joint)

    def value_of(self, q: Array, T: Array) -> float:
        """The joint itself, in the ring where it is one."""
        value = float(q[self.solver.redundant_joints[0]])
        return float(wrap_near(value, 0.0)) if self.is_ring else value

    def carry(self, T: Array) -> Array:
        """The joint at rest."""
        return np.zeros(len(T))


def end_of_chain(q: Array, s: float, cause: str, reason: str, dof: int) -> JointBranch:
    """The branch of a chain q (k, dof) that ends at s."""
    first = q[0] if len(q) else np.full(dof, np.nan)
    return JointBranch(None, first, s, cause, None, partial(str, reason), NO_DEVIATION)
