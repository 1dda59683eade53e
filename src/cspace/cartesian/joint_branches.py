"""The joint paths that follow a Cartesian path: one of each branch that reaches its end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, positive_number
from cspace.cartesian.refine import LeastMotion, Refined, first_nodes, refine_branches
from cspace.ik.tracking.result import Branch, Track
from cspace.ik.tracking.track import track
from cspace.kinematics import KinematicModel
from cspace.trajectory.cartesian_path import CartesianPath
from cspace.trajectory.path import Path

BESIDE_SINGULAR: Final = "the joints would have to jump beside a singular configuration"

NO_DEVIATION: Final = (np.inf, np.inf)


@dataclass(frozen=True, eq=False)
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
    reason: str
    deviation: tuple[float, float]

    def __bool__(self) -> bool:
        return self.path is not None


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
    robot.track. tolerance [m and rad]: the largest distance at the middle of each piece, which is halved
    until it is attained; the error falls with the sixth power of its length.

    At the ends of its pieces a joint path attains position, slope and bend exactly: J q' = t and
    J q'' = t' − J' q' with the twist t of the path and its rate t'.
    """
    tolerance = positive_number(tolerance, "tolerance")
    piece, u = first_nodes(path)
    is_new = np.concatenate([[True], np.diff(piece) == 0])
    found: Track = track(robot, path.poses_on(piece, u)[is_new], start, limits=limits)
    s_of_row = (path.breaks[piece] + u)[is_new]
    whole = [branch for branch in found.branches if branch]
    refined: Iterator[Refined] = iter(())
    if whole:
        q = np.array([branch.q for branch in whole])[:, np.cumsum(is_new) - 1]
        refined = iter(refine_branches(robot, path, LeastMotion(robot, path), q, tolerance))
    branches = tuple(
        make_branch(branch.q[0], next(refined)) if branch else _ended(branch, s_of_row)
        for branch in found.branches
    )
    reason = "" if any(branches) else _why_none(found, branches)
    return JointBranches(branches, found.complete, reason)


def make_branch(q_start: Array, found: Refined) -> JointBranch:
    """The branch of a joint path that was found, or that cannot go on somewhere."""
    if found.path is not None:
        return JointBranch(found.path, q_start, found.path.length, "end", None, "", found.deviation)
    text = f"at s = {found.s_lost:.6g}: {BESIDE_SINGULAR}"
    return JointBranch(None, q_start, found.s_lost, "singularity", None, text, NO_DEVIATION)


def _ended(branch: Branch, s_of_row: Array) -> JointBranch:
    row = min(int(branch.end), len(s_of_row) - 2)
    s = float(s_of_row[row] + (branch.end - row) * (s_of_row[row + 1] - s_of_row[row]))
    first = branch.q[0] if len(branch.q) else branch.last
    text = f"at s = {s:.6g}: {branch.explain_cause()}"
    return JointBranch(None, first, s, branch.cause, branch.joint, text, NO_DEVIATION)


def _why_none(found: Track, branches: tuple[JointBranch, ...]) -> str:
    if not branches:
        return found.reason
    farthest = max(branches, key=lambda branch: branch.s_end)
    return f"no branch follows the whole path; the farthest ends {farthest.reason}"
