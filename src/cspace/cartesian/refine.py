"""Joint paths of quintic pieces that keep to a Cartesian path within a tolerance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from cspace import _core
from cspace.arrays import Array, bounded_number
from cspace.errors import InputError
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import frame_number
from cspace.tolerances import LEAST_TOLERANCE, PATH_POSE_LEFT, SHORTEST_PATH_PIECE
from cspace.trajectory.cartesian_path import CartesianPath, Indices
from cspace.trajectory.path import Path

FIRST_SPACING: Final = 0.1
"""[m or rad] Of the poses at which a path is followed first: most pieces of this length need no halving."""

FEWEST_PIECES: Final = 4
"""Of each piece of the Cartesian path, so that a short one is compared with its joint path at all."""

MOST_PIECES: Final = 1_000_000
"""A hundred kilometres or the legs of 250,000 poses: some seconds, and half a gigabyte."""

FINER: Final = 32
"""Parts of an interval between nodes in which a joint moves too far."""


JUMP_ROUNDS: Final = 8
"""Of putting nodes where a joint moves farther from one to the next than a track allows: a path passes few
singular configurations, and each takes two or three."""

LOOKED_AT: Final = (0.25, 0.375, 0.625, 0.75)
"""Where pieces whose middle is near are compared with the path, too: beside a singular configuration the
error is largest elsewhere."""


KEPT_SHARE: Final = 0.98
"""Of the tolerance at these places: between them errors are larger by less than a hundredth."""


UNLOCKED: Final = -1
"""All joints move where poses are corrected."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Configurations at poses of a path: q, its first two derivatives by s (n, dof), and the error that is
    left of each pose (n,), lengths over that of the arm."""

    q: Array
    slope: Array
    bend: Array
    left: Array


class Corrector(Protocol):
    """Finds the configurations of a path at pieces (n,) and u (n,), poses T (n, 4, 4), near guesses (n,
    dof)."""

    def __call__(self, piece: Indices, u: Array, T: Array, guess: Array) -> Nodes: ...


@dataclass(frozen=True, eq=False)
class LeastMotion:
    """Corrects by the least motion of the joints: J q' = t and J q'' = t' − J' q'."""

    robot: KinematicModel
    path: CartesianPath

    def __call__(self, piece: Indices, u: Array, T: Array, guess: Array) -> Nodes:
        q = np.array(guess, order="C")
        slope, bend, info = np.empty_like(q), np.empty_like(q), np.empty((len(q), 2))
        twists = self.path.twists_on(piece, u)
        _core._ik_path_rows(
            self.robot, frame_number(self.robot, None), T, *twists, UNLOCKED, q, slope, bend, info
        )
        return Nodes(q, slope, bend, info[:, 0])


def correct_locked(robot: KinematicModel, T: Array, q: Array, joint: int) -> Array:
    """The configurations near q (k, dof) of poses T (k, 4, 4) with a joint where it is; NaN where there is
    none."""
    found = np.array(q, order="C")
    still, spare, info = np.zeros((2, len(q), 6)), np.empty((2, *q.shape)), np.empty((len(q), 2))
    _core._ik_path_rows(robot, frame_number(robot, None), T, *still, joint, found, *spare, info)
    found[~(info[:, 0] <= PATH_POSE_LEFT)] = np.nan
    return found


@dataclass(frozen=True, eq=False)
class Refined:
    """A joint path, or None and where it cannot go on; the largest distance that was found [m, rad]."""

    path: Path | None
    s_lost: float
    deviation: tuple[float, float]


def read_tolerance(value: float) -> float:
    """The tolerance of a joint path [m and rad]; InputError for one that rounding exceeds."""
    return bounded_number(value, "tolerance", LEAST_TOLERANCE, f"it must be {LEAST_TOLERANCE:g} or more")


def first_nodes(path: CartesianPath) -> tuple[Indices, Array]:
    """Pieces (n,) and parameters (n,) within them of the first nodes, both ends of each piece among them."""
    spans = np.maximum(np.ceil(path.lengths / FIRST_SPACING), FEWEST_PIECES)
    if spans.sum() > MOST_PIECES:
        raise InputError(
            f"the path is {path.length:.6g} m or rad long, more than can be followed at once; give metres and"
            " radians, or follow it in parts"
        )
    counts = spans.astype(int) + 1
    piece = np.repeat(np.arange(len(counts)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    share = (np.arange(len(piece)) - first) / (counts[piece] - 1)
    return piece, share * path.lengths[piece]


def divide_intervals(piece: Indices, u: Array, ends: Indices) -> tuple[Indices, Array]:
    """Nodes with further ones between the nodes `ends` (k,) and those before them, of the same pieces."""
    share = np.arange(1.0, FINER) / FINER
    between = u[ends - 1, None] + (u[ends] - u[ends - 1])[:, None] * share
    at = np.repeat(ends, FINER - 1)
    return np.insert(piece, at, piece[at]), np.insert(u, at, between.ravel())


def find_lost_intervals(path: CartesianPath, nodes: tuple[Indices, Array], lost: list[float]) -> Indices:
    """The nodes (k,) that end the intervals in which a branch was lost: the joints turn so far there
    that a polynomial between nodes leads nowhere. Those too short to divide are left out."""
    piece, u = nodes
    s = path.breaks[piece] + u
    ends = np.unique(np.searchsorted(s, lost)).astype(np.intp)
    ends = ends[(ends > 0) & (ends < len(s))]
    return np.asarray(ends[(piece[ends] == piece[ends - 1]) & (u[ends] - u[ends - 1] > SHORTEST_PATH_PIECE)])


def refine_branches(
    robot: KinematicModel,
    path: CartesianPath,
    correct: Corrector,
    q: Array,
    tolerance: float,
    nodes: tuple[Indices, Array] | None = None,
) -> list[Refined]:
    """The joint paths of branches that are near q (b, n, dof) at nodes, by default the first ones of a path.

    nodes: pieces (n,) and parameters (n,).
    """
    return _Refiner(robot, path, correct, tolerance, q, first_nodes(path) if nodes is None else nodes).run()


class _Refiner:
    """Halves the pieces of all branches at once until each keeps to the path.

    A piece is from node `begin` to node `end` of one branch; nodes are rows of `branch`, `piece`, `u` and of
    the derivatives.
    """

    def __init__(
        self,
        robot: KinematicModel,
        path: CartesianPath,
        correct: Corrector,
        tolerance: float,
        q: Array,
        first: tuple[Indices, Array],
    ) -> None:
        self.robot, self.path, self.correct, self.tolerance = robot, path, correct, tolerance
        self.frame = frame_number(robot, None)
        piece, u = first
        T = path.poses_on(piece, u)
        self.count, n = q.shape[:2]
        rows = self.count * n
        self.branch = np.repeat(np.arange(self.count), n)
        self.piece, self.u = np.tile(piece, self.count), np.tile(u, self.count)
        self.lost = np.full(self.count, np.inf)  # where a branch cannot be followed
        self.off = np.zeros((self.count, 2))
        nodes = correct(self.piece, self.u, np.tile(T, (self.count, 1, 1)), q.reshape(rows, -1))
        self.q, self.slope, self.bend = nodes.q, nodes.slope, nodes.bend
        self._lose(self.branch, self.piece, self.u, nodes.left)
        inside = (self.piece[:-1] == self.piece[1:]) & (self.branch[:-1] == self.branch[1:])
        self.begin = np.flatnonzero(inside)
        self.end = self.begin + 1

    def run(self) -> list[Refined]:
        done_begin, done_end = [], []
        while len(self.begin):
            error, middle = self._measure(self.begin, self.end, np.full(len(self.begin), 0.5))
            branch = self.branch[self.begin]
            alive = np.isinf(self.lost[branch])
            near = np.flatnonzero((error.max(axis=1) <= KEPT_SHARE * self.tolerance) & alive)
            error[near] = np.maximum(error[near], self._measure_sides(near))
            done = (error.max(axis=1) <= KEPT_SHARE * self.tolerance) | ~alive
            np.maximum.at(self.off, branch[done & alive], error[done & alive])
            done_begin.append(self.begin[done])
            done_end.append(self.end[done])
            self._halve(~done, middle)
        return self._make_paths(np.concatenate(done_begin), np.concatenate(done_end))

    def _lose(self, branch: Indices, piece: Indices, u: Array, left: Array) -> None:
        """Ends branches at nodes whose pose is not reached."""
        bad = ~(left <= PATH_POSE_LEFT)
        np.minimum.at(self.lost, branch[bad], (self.path.breaks[piece] + u)[bad])

    def _measure(self, a: Indices, b: Indices, share: Array) -> tuple[Array, Sequence[Any]]:
        """The errors (k, 2) [m, rad] at shares (k,) of pieces from nodes a to b, and what a node there
        begins with."""
        piece, u = self.piece[a], self.u[a] + share * (self.u[b] - self.u[a])
        T = self.path.poses_on(piece, u)
        guess, error = np.empty((len(a), self.robot.dof)), np.empty((len(a), 2))
        nodes = self.q, self.slope, self.bend, self.u
        _core._ik_measure_pieces(self.robot, self.frame, *nodes, a, b, share, T, guess, error)
        return error, (piece, u, T, guess)

    def _measure_sides(self, rows: Indices) -> Array:
        """The larger errors (k, 2) of those at LOOKED_AT of pieces."""
        count = len(LOOKED_AT)
        a, b = (np.tile(node[rows], count) for node in (self.begin, self.end))
        error, _ = self._measure(a, b, np.repeat(LOOKED_AT, len(rows)))
        return np.asarray(error.reshape(count, -1, 2).max(axis=0))

    def _halve(self, bad: NDArray[np.bool_], middle: Sequence[Any]) -> None:
        if not bad.any():
            self.begin = self.end = self.begin[:0]
            return
        a, b = self.begin[bad], self.end[bad]
        piece, u, T, guess = (values[bad] for values in middle)
        nodes = self.correct(piece, u, T, guess)
        branch = self.branch[a]
        self._lose(branch, piece, u, nodes.left)
        short = self.u[b] - self.u[a] < SHORTEST_PATH_PIECE
        self._lose(branch[short], piece[short], u[short], np.full(int(short.sum()), np.inf))
        node = len(self.q) + np.arange(len(a))
        self.branch = np.concatenate([self.branch, branch])
        self.piece = np.concatenate([self.piece, piece])
        self.u = np.concatenate([self.u, u])
        self.q = np.concatenate([self.q, nodes.q])
        self.slope = np.concatenate([self.slope, nodes.slope])
        self.bend = np.concatenate([self.bend, nodes.bend])
        self.begin = np.concatenate([a, node])
        self.end = np.concatenate([node, b])

    def _make_paths(self, begin: Indices, end: Indices) -> list[Refined]:
        s = self.path.breaks[self.piece[begin]] + self.u[begin]
        order = np.lexsort((s, self.branch[begin]))
        begin, end, s = begin[order], end[order], s[order]
        h = (self.u[end] - self.u[begin])[:, None]
        q0, q1 = self.q[begin], self.q[end]
        v0, v1 = h / 5 * self.slope[begin], h / 5 * self.slope[end]
        a0, a1 = h * h / 20 * self.bend[begin], h * h / 20 * self.bend[end]
        control = np.stack([q0, q0 + v0, q0 + 2 * v0 + a0, q1 - 2 * v1 + a1, q1 - v1, q1], axis=1)
        bounds = np.searchsorted(self.branch[begin], np.arange(self.count + 1))
        return [self._make_path(k, s, control, slice(*bounds[k : k + 2])) for k in range(self.count)]

    def _make_path(self, k: int, s: Array, control: Array, rows: slice) -> Refined:
        lost = float(self.lost[k])
        if np.isfinite(lost):
            return Refined(None, lost, (np.inf, np.inf))
        path = Path(np.append(s[rows], self.path.length), control[rows])
        return Refined(path, np.inf, (float(self.off[k, 0]), float(self.off[k, 1])))
