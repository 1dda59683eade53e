"""The joint paths that follow a Cartesian path: one of each branch that reaches its end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace.arrays import Array
from cspace.cartesian.limit_ends import find_limit_end
from cspace.cartesian.refine import (
    JUMP_ROUNDS,
    LeastMotion,
    Refined,
    divide_intervals,
    find_lost_intervals,
    first_nodes,
    read_tolerance,
    refine_branches,
)
from cspace.ik.tracking.result import Branch, Track
from cspace.ik.tracking.track import track
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_robot, limits_of
from cspace.model import Limits
from cspace.tables import one_line, show_fields, shown, tabulate
from cspace.tolerances import PATH_START_ROUNDING, SHORTEST_PATH_PIECE
from cspace.trajectory.cartesian_path import CartesianPath, Indices, check_cartesian_path
from cspace.trajectory.path import Path

Nodes: TypeAlias = tuple[Indices, Array]
"""Pieces (n,) of a Cartesian path and parameters (n,) in them."""

BESIDE_SINGULAR: Final = "the joints would have to jump beside a singular configuration"

NO_DEVIATION: Final = (np.inf, np.inf)


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class JointBranch:
    """One branch along a Cartesian path: truthy if it reaches the end.

    path: of the joints over the same parameter s; None where the branch ends before. q_start (dof,). s_end:
    where the branch ends. cause: "end", "limit", "singularity", "jump" or "unreachable". joint: that ended
    it. reason: the same as a sentence. deviation: the largest distance from the Cartesian path that was found
    at the middle of a piece, as (metres, radians).
    """

    path: Path | None
    q_start: Array
    s_end: float
    cause: str
    joint: str | None
    _explain: Callable[[], str]
    deviation: tuple[float, float]

    def __bool__(self) -> bool:
        return self.path is not None

    def __repr__(self) -> str:
        told = self.reason or f"follows the path to s = {shown(self.s_end)}"
        return one_line("JointBranch", told)

    @cached_property
    def reason(self) -> str:
        """Where it ends and why, as one sentence; empty if it reaches the end."""
        return self._explain()


@show_fields
@dataclass(frozen=True, eq=False)
class JointBranches:
    """All branches along a Cartesian path; truthy if one reaches the end.

    complete: whether they are all there are. reason: why none arrives.
    """

    branches: tuple[JointBranch, ...]
    complete: bool
    reason: str

    def __bool__(self) -> bool:
        return any(self.branches)

    def __len__(self) -> int:
        return len(self.branches)


def follow_cartesian(
    robot: KinematicModel,
    path: CartesianPath,
    start: ArrayLike | None = None,
    *,
    limits: Any = True,
    tolerance: float = 1e-5,
) -> JointBranches:
    """The joint paths along a Cartesian path, as quintic pieces that keep to it within a tolerance.

    path: of the tip. start (dof,) [rad or m]: follow the branch of this configuration alone. limits: as of
    robot.track. tolerance [m and rad]: the largest distance at five places of each piece, which is halved
    until it is attained; the error falls with the sixth power of its length.

    At the ends of its pieces a joint path attains position, slope and bend exactly: J q' = t and
    J q'' = t' − J' q' with the twist t of the path and its rate t'.
    """
    check_robot(robot)
    check_cartesian_path(path)
    tolerance = read_tolerance(tolerance)
    bounds = limits_of(robot.limits, limits, robot.name)
    found, nodes = _track_densely(robot, path, start, bounds, first_nodes(path))
    whole = [branch.q for branch in found.branches if branch]
    paths = _refine_tracked(robot, path, whole, tolerance, nodes)
    refined = (
        each if each.path is not None else _refine_lost(robot, path, bounds, tolerance, nodes, q[0], each)
        for q, each in zip(whole, paths, strict=True)
    )
    s_of_row = (path.breaks[nodes[0]] + nodes[1])[_are_new(nodes[0])]
    given = None if start is None else np.asarray(start, dtype=np.float64)
    branches = tuple(
        end_at_limits(make_branch(branch.q[0] if given is None else given, next(refined)), bounds, robot)
        if branch
        else _ended(branch, s_of_row)
        for branch in found.branches
    )
    reason = "" if any(branches) else _why_none(found, branches)
    return JointBranches(branches, found.complete, reason)


def _refine_tracked(
    robot: KinematicModel, path: CartesianPath, whole: list[Array], tolerance: float, nodes: Nodes
) -> list[Refined]:
    """The joint paths of branches near their configurations (n, dof) at nodes."""
    if not whole:
        return []
    q = np.array(whole)[:, np.cumsum(_are_new(nodes[0])) - 1]
    return refine_branches(robot, path, LeastMotion(robot, path), q, tolerance, nodes)


def _refine_lost(
    robot: KinematicModel,
    path: CartesianPath,
    bounds: Limits,
    tolerance: float,
    nodes: Nodes,
    start: Array,
    lost: Refined,
) -> Refined:
    """The joint path of the branch of a start (dof,), with further nodes where it is lost between them."""
    for _ in range(JUMP_ROUNDS):
        ends = find_lost_intervals(path, nodes, [lost.s_lost])
        if not len(ends):
            break
        found, nodes = _track_densely(robot, path, start, bounds, divide_intervals(*nodes, ends))
        again = _refine_tracked(robot, path, [each.q for each in found.branches if each], tolerance, nodes)
        if not again:
            break
        lost = again[0]
    return lost


def _track_densely(
    robot: KinematicModel,
    path: CartesianPath,
    start: ArrayLike | None,
    bounds: Limits,
    nodes: Nodes,
) -> tuple[Track, Nodes]:
    """The branches at nodes of a path, pieces (n,) and parameters (n,), and the nodes with those added.

    Beside a singular configuration joints may turn far on a short way. Nodes are added there, until no joint
    moves farther from one to the next than a track allows.
    """
    piece, u = nodes
    for _ in range(JUMP_ROUNDS):
        is_new = _are_new(piece)
        found: Track = track(robot, path.poses_on(piece, u)[is_new], start, limits=bounds)
        rows = {len(each.q) for each in found.branches if each.cause == "jump" and each.joint is not None}
        ends = np.flatnonzero(is_new)[sorted(row for row in rows if row > 0)]
        if not len(ends) or (u[ends] - u[ends - 1]).max() <= SHORTEST_PATH_PIECE:
            break
        piece, u = divide_intervals(piece, u, ends)
    return found, (piece, u)


def _are_new(piece: Indices) -> NDArray[np.bool_]:
    """Which nodes are not the same as the one before, where a piece of the path ends and another begins."""
    return np.concatenate([[True], np.diff(piece) == 0])


def make_branch(q_start: Array, found: Refined) -> JointBranch:
    """The branch of a joint path that was found, or that cannot go on somewhere."""
    if found.path is not None:
        path = begin_at(found.path, q_start)
        return JointBranch(path, q_start, path.length, "end", None, str, found.deviation)
    text = f"at s = {found.s_lost:.6g}: {BESIDE_SINGULAR}"
    return JointBranch(None, q_start, found.s_lost, "singularity", None, partial(str, text), NO_DEVIATION)


def begin_at(path: Path, q_start: Array) -> Path:
    """A path that begins at q_start (dof,) in every bit, if it does but for rounding.

    The first three control points are moved, so that slope and bend stay as they are.
    """
    gap = q_start - path.start
    if not gap.any() or not np.abs(gap).max() <= PATH_START_ROUNDING:
        return path
    control = np.array(path.control_points)
    control[0, 1:3] += gap
    control[0, 0] = q_start
    return Path(path.breaks, control, remarks=path.remarks)


def end_at_limits(branch: JointBranch, bounds: Limits, robot: KinematicModel) -> JointBranch:
    """The branch, ended where its joint path leaves the limits of position, also between its nodes."""
    end = None if branch.path is None else find_limit_end(branch.path, bounds)
    if end is None:
        return branch
    name = robot.joint_names[end.joint]
    text = f"at s = {end.s:.6g}: {name} would leave its limits"
    return JointBranch(None, branch.q_start, end.s, "limit", name, partial(str, text), NO_DEVIATION)


def _ended(branch: Branch, s_of_row: Array) -> JointBranch:
    row = min(int(branch.end), len(s_of_row) - 2)
    s = float(s_of_row[row] + (branch.end - row) * (s_of_row[row + 1] - s_of_row[row]))
    first = branch.q[0] if len(branch.q) else branch.last
    explain = partial(_explain_end, s, branch)
    return JointBranch(None, first, s, branch.cause, branch.joint, explain, NO_DEVIATION)


def _explain_end(s: float, branch: Branch) -> str:
    return f"at s = {s:.6g}: {branch.explain_cause()}"


def _why_none(found: Track, branches: tuple[JointBranch, ...]) -> str:
    if not branches:
        return found.reason
    farthest = max(branches, key=lambda branch: branch.s_end)
    return f"no branch follows the whole path; the farthest ends {farthest.reason}"
