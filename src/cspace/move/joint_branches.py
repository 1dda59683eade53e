"""The joint paths that follow a Cartesian path: one of each branch that reaches its end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cspace import _core
from cspace.arrays import Array, positive_number
from cspace.ik.tracking.result import Branch, Track
from cspace.ik.tracking.track import track
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import frame_number
from cspace.trajectory.cartesian_path import CartesianPath, Indices
from cspace.trajectory.path import Path

FIRST_SPACING: Final = 0.1
"""[m or rad] Of the poses at which a path is followed first: most pieces of this length need no halving."""

FEWEST_PIECES: Final = 4
"""Of each piece of the Cartesian path, so that a short one is compared with its joint path at all."""

SHORTEST_PIECE: Final = 1e-5
"""[m or rad] A piece that is off and this short ends its branch: the joints would have to jump."""

POSE_LEFT: Final = 1e-9
"""Error of a corrected pose, lengths over that of the arm, above which it is not reached."""


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
    T = path.poses_on(piece, u)
    is_new = np.concatenate([[True], np.diff(piece) == 0])
    found: Track = track(robot, T[is_new], start, limits=limits)
    s_of_row = (path.breaks[piece] + u)[is_new]
    whole = [branch for branch in found.branches if branch]
    refined: Iterator[JointBranch] = iter(())
    if whole:
        q = np.array([branch.q for branch in whole])[:, np.cumsum(is_new) - 1]
        refined = iter(_Refiner(robot, path, piece, u, T, q, tolerance).run())
    branches = tuple(next(refined) if branch else _ended(branch, s_of_row) for branch in found.branches)
    reason = "" if any(branches) else _why_none(found, branches)
    return JointBranches(branches, found.complete, reason)


def first_nodes(path: CartesianPath) -> tuple[Indices, Array]:
    """Pieces (n,) and parameters (n,) within them of the first nodes, both ends of each piece among them."""
    counts = np.maximum(np.ceil(path.lengths / FIRST_SPACING).astype(int), FEWEST_PIECES) + 1
    piece = np.repeat(np.arange(len(counts)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    share = (np.arange(len(piece)) - first) / (counts[piece] - 1)
    return piece, share * path.lengths[piece]


def _ended(branch: Branch, s_of_row: Array) -> JointBranch:
    row = min(int(branch.end), len(s_of_row) - 2)
    s = float(s_of_row[row] + (branch.end - row) * (s_of_row[row + 1] - s_of_row[row]))
    first = branch.q[0] if len(branch.q) else branch.last
    text = f"at s = {s:.6g}: {branch.reason}"
    return JointBranch(None, first, s, branch.cause, branch.joint, text, (np.inf, np.inf))


def _why_none(found: Track, branches: tuple[JointBranch, ...]) -> str:
    if not branches:
        return found.reason
    farthest = max(branches, key=lambda branch: branch.s_end)
    return f"no branch follows the whole path; the farthest ends {farthest.reason}"


class _Refiner:
    """Halves the pieces of all branches at once until each keeps to the path.

    Nodes are rows of q, slope and bend; a piece is from node `begin` to node `end` of one branch.
    """

    def __init__(
        self,
        robot: KinematicModel,
        path: CartesianPath,
        piece: Indices,
        u: Array,
        T: Array,
        q: Array,
        tolerance: float,
    ) -> None:
        self.robot, self.path, self.tolerance = robot, path, tolerance
        self.frame = frame_number(robot, None)
        b, n = q.shape[:2]
        self.count = b
        self.branch = np.repeat(np.arange(b), n)
        self.piece, self.u = np.tile(piece, b), np.tile(u, b)
        twists = [np.tile(rows, (b, 1)) for rows in path.twists_on(piece, u)]
        nodes = self._correct(np.tile(T, (b, 1, 1)), twists, q.reshape(b * n, -1))
        self.q, self.slope, self.bend, left = nodes
        self.lost = np.full(b, np.inf)  # where a branch cannot be followed
        self._lose(self.branch, self.piece, self.u, left)
        begin = np.arange(b * n - 1)
        inside = (self.piece[:-1] == self.piece[1:]) & (self.branch[:-1] == self.branch[1:])
        self.begin = begin[inside]
        self.end = self.begin + 1
        self.off = np.zeros((b, 2))

    def run(self) -> list[JointBranch]:
        done_begin, done_end = [], []
        while len(self.begin):
            error, middle = self._measure_middles()
            alive = np.isinf(self.lost[self.branch[self.begin]])
            good = (error.max(axis=1) <= self.tolerance) | ~alive
            np.maximum.at(self.off, self.branch[self.begin[good & alive]], error[good & alive])
            done_begin.append(self.begin[good])
            done_end.append(self.end[good])
            self._halve(~good, middle)
        return self._make_branches(np.concatenate(done_begin), np.concatenate(done_end))

    def _correct(self, T: Array, twists: Sequence[Array], q: Array) -> tuple[Array, Array, Array, Array]:
        """Configurations at poses near guesses q, slopes, bends, and the error that is left (n,)."""
        q = np.array(q, order="C")
        slope, bend, info = np.empty_like(q), np.empty_like(q), np.empty((len(q), 2))
        _core._ik_path_rows(self.robot, self.frame, T, *twists, q, slope, bend, info)
        return q, slope, bend, info[:, 0]

    def _lose(self, branch: Indices, piece: Indices, u: Array, left: Array) -> None:
        """Ends branches at nodes whose pose is not reached."""
        bad = ~(left <= POSE_LEFT)
        np.minimum.at(self.lost, branch[bad], (self.path.breaks[piece] + u)[bad])

    def _measure_middles(self) -> tuple[Array, tuple[Any, ...]]:
        """The errors (k, 2) [m, rad] at the middle of each piece, and what a node there would be."""
        a, b = self.begin, self.end
        h = (self.u[b] - self.u[a])[:, None]
        guess = 0.5 * (self.q[a] + self.q[b]) + h * (5 / 32) * (self.slope[a] - self.slope[b])
        guess += h * h / 64 * (self.bend[a] + self.bend[b])
        piece, u = self.piece[a], 0.5 * (self.u[a] + self.u[b])
        T = self.path.poses_on(piece, u)
        reached = self.robot.fk(guess)
        error = np.empty((len(a), 2))
        error[:, 0] = np.linalg.norm(reached[:, :3, 3] - T[:, :3, 3], axis=1)
        error[:, 1] = np.linalg.norm(reached[:, :3, :3] - T[:, :3, :3], axis=(1, 2)) * np.sqrt(0.5)
        return error, (piece, u, T, guess)

    def _halve(self, bad: NDArray[np.bool_], middle: tuple[Any, ...]) -> None:
        a, b = self.begin[bad], self.end[bad]
        piece, u, T, guess = (values[bad] for values in middle)
        q, slope, bend, left = self._correct(T, self.path.twists_on(piece, u), guess)
        branch = self.branch[a]
        self._lose(branch, piece, u, left)
        short = self.u[b] - self.u[a] < SHORTEST_PIECE
        self._lose(branch[short], piece[short], u[short], np.full(int(short.sum()), np.inf))
        node = len(self.q) + np.arange(len(a))
        self.branch = np.concatenate([self.branch, branch])
        self.piece = np.concatenate([self.piece, piece])
        self.u = np.concatenate([self.u, u])
        self.q = np.concatenate([self.q, q])
        self.slope = np.concatenate([self.slope, slope])
        self.bend = np.concatenate([self.bend, bend])
        self.begin = np.concatenate([a, node])
        self.end = np.concatenate([node, b])

    def _make_branches(self, begin: Indices, end: Indices) -> list[JointBranch]:
        s = self.path.breaks[self.piece[begin]] + self.u[begin]
        order = np.lexsort((s, self.branch[begin]))
        begin, end, s = begin[order], end[order], s[order]
        ends = np.searchsorted(self.branch[begin], np.arange(self.count + 1))
        h = (self.u[end] - self.u[begin])[:, None]
        q0, q1 = self.q[begin], self.q[end]
        v0, v1 = h / 5 * self.slope[begin], h / 5 * self.slope[end]
        a0, a1 = h * h / 20 * self.bend[begin], h * h / 20 * self.bend[end]
        control = np.stack([q0, q0 + v0, q0 + 2 * v0 + a0, q1 - 2 * v1 + a1, q1 - v1, q1], axis=1)
        found = []
        for k in range(self.count):
            rows = slice(ends[k], ends[k + 1])
            first = q0[ends[k]]
            if np.isfinite(self.lost[k]):
                text = f"at s = {self.lost[k]:.6g}: the joints would have to jump beside a singular configuration"
                found.append(
                    JointBranch(None, first, float(self.lost[k]), "singularity", None, text, (np.inf, np.inf))
                )
                continue
            joints = Path(np.append(s[rows], self.path.length), control[rows])
            off = (float(self.off[k, 0]), float(self.off[k, 1]))
            found.append(JointBranch(joints, first, self.path.length, "end", None, "", off))
        return found
