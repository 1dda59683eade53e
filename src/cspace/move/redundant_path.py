"""The joint path of a redundant arm along a whole Cartesian path: the redundant joint is planned at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, one_array, positive_number
from cspace.errors import InputError
from cspace.ik.near_rows import solve_locked_branches
from cspace.ik.solver import Solver, as_solver
from cspace.kinematics import KinematicModel
from cspace.model import Limits
from cspace.move.joint_branches import JointBranch, NO_DEVIATION, make_branch
from cspace.move.refine import Nodes, first_nodes, refine_branches
from cspace.spatial import log_so3
from cspace.trajectory.cartesian_path import CartesianPath, Indices
from cspace.trajectory.path import Path
from cspace.trajectory.splines import quintic_controls

STATION_SPACING: Final = 0.04
"""[m or rad] Of the poses at which the redundant joint is chosen."""

STATIONS: Final = (16, 96)
"""Fewest and most of them."""

VALUES: Final = 48
"""Of the redundant joint that are tried at each: 7.5° apart in a full turn."""

FINER: Final = 8
"""Parts of the distance of two values that are tried around the chain that was found first."""

REACH: Final = 3
"""Values that the redundant joint may move between neighbouring stations."""

LONGEST_STEP: Final = 0.7
"""[rad] That a joint may turn between neighbouring stations; more is another branch."""

LIMIT_WEIGHT: Final = 0.3
"""Of x²/(1 − x²), x the distance from the middle of the limits in half ranges, against joints that move by 1 rad
per unit of the path: a few degrees of detour keep a joint away from its limits."""

AT_LIMIT: Final = 1e-3
"""What is left of 1 − x² at a limit."""

SINGULAR_WEIGHT: Final = 0.02
"""Of the inverse of det(J Jᵀ), relative to the best one on the path."""

SMOOTHINGS: Final = (10.0, 1.0, 0.0)
"""Weights of the second differences with which the chosen values are smoothed: the first whose joints stay within
limits is taken."""

LEAST_VOLUME: Final = 1e-6
"""Of the best determinant: nearer to singularities all are equally bad."""

ANCHOR: Final = 1e9
"""Weight of the start in the smoothing: it stays where it is."""

ROUNDING: Final = 1e-13
"""[m or rad] Of a pose that is reached."""

CORRECTIONS: Final = 12
"""Of Newton's method from the spline between stations."""

FULL_TURN: Final = 2 * np.pi

ROOMY: Final = FULL_TURN + 2.0
"""[rad] Range of a joint of which multiples of 2π count as one configuration; its limits are looked at afterwards."""


def follow_redundant(
    robot: KinematicModel,
    path: CartesianPath,
    start: ArrayLike | None = None,
    *,
    limits: bool | Limits = True,
    tolerance: float = 1e-5,
) -> JointBranch:
    """The joint path of an arm with one redundant joint, chosen along the whole path at once.

    Among the configurations at values of the redundant joint, the cheapest chain along the path is found: little
    motion, joints near the middle of their limits, and away from singularities. The joint path follows the
    Cartesian path exactly, and beside that a smooth curve near the chain in the direction of the null space.

    start (dof,): the first configuration; by default any of the first pose. Other arguments as of
    follow_cartesian. Raises InputError for an arm that has not exactly one redundant joint.

    Bellman 1957 (dynamic programming); Whittaker 1922 (smoothing by differences).
    """
    solver = as_solver(robot)
    if len(solver.redundant_joints) != 1:
        raise InputError(
            f"the robot has {len(solver.redundant_joints)} redundant joints; the whole path is planned for one"
        )
    tolerance = positive_number(tolerance, "tolerance")
    bounds = _choose_limits(robot, limits)
    stations = Stations.of(path)
    search = _ChainSearch(robot, solver, stations, bounds, start)
    q = search.run()
    if isinstance(q, JointBranch):
        return q
    found: JointBranch | None = None
    for weight in SMOOTHINGS:
        found = _Guided(robot, path, _smooth_chain(robot, stations.s, q, weight)).refine(tolerance)
        if found.path is not None and _is_within(found.path, bounds):
            return found
    assert found is not None
    return found if found.path is None else _outside(found, bounds, robot)


@dataclass(frozen=True, eq=False)
class Stations:
    """Parameters (n,) along a path, evenly spaced, and the poses (n, 4, 4) there."""

    s: Array
    T: Array

    @property
    def spacing(self) -> float:
        return float(self.s[1])

    @classmethod
    def of(cls, path: CartesianPath) -> Stations:
        count = int(np.clip(np.ceil(path.length / STATION_SPACING), *STATIONS))
        s = np.linspace(0.0, path.length, count + 1)
        return cls(s, path(s))


def _choose_limits(robot: KinematicModel, limits: bool | Limits) -> Limits:
    if isinstance(limits, Limits):
        return limits
    return robot.limits if limits else Limits(np.full(robot.dof, -np.inf), np.full(robot.dof, np.inf))


class _ChainSearch:
    """Finds the cheapest chain of configurations, one of each station: first among values of the redundant joint
    that are spread over its range, then among finer ones around the chain."""

    def __init__(
        self, robot: KinematicModel, solver: Solver, stations: Stations, bounds: Limits, start: ArrayLike | None
    ) -> None:
        self.robot, self.solver, self.stations, self.bounds = robot, solver, stations, bounds
        self.joint = solver.redundant_joints[0]
        self.revolute = np.array([kind != "P" for kind in robot.joint_types])
        self.wide = self.revolute & ~(bounds.upper - bounds.lower < ROOMY)
        self.start = None if start is None else one_array(start, "start", (robot.dof,), "one configuration")
        self.is_ring = bool(self.wide[self.joint])
        self.narrow = np.isfinite(bounds.lower) & np.isfinite(bounds.upper) & ~self.wide
        self.half = np.where(self.narrow, 0.5 * (bounds.upper - bounds.lower), 1.0)
        self.middle = np.where(self.narrow, bounds.lower + self.half, 0.0)

    def run(self) -> Array | JointBranch:
        """The chain (n, dof) with continuous angles, or where there is none."""
        values = self._spread_values()
        q, count = self._search(np.tile(values, (len(self.stations.s), 1)), self.is_ring, REACH)
        if count < len(self.stations.s):
            return self._where_it_ends(count)
        step = (values[1] - values[0]) / FINER
        finer = q[:, self.joint, None] + step * np.arange(-FINER, FINER + 1)
        closer, count = self._search(finer, False, 2 * FINER)
        return self._unwrap(closer if count == len(q) else q)

    def _spread_values(self) -> Array:
        """Values (m,) of the redundant joint."""
        if self.is_ring:
            offset = 0.0 if self.start is None else self.start[self.joint]
            return np.asarray(offset + FULL_TURN * np.arange(VALUES) / VALUES)
        lower, upper = self.bounds.lower[self.joint], self.bounds.upper[self.joint]
        return np.asarray(lower + (upper - lower) * (np.arange(VALUES) + 0.5) / VALUES)

    def _search(self, values: Array, is_ring: bool, reach: int) -> tuple[Array, int]:
        """The cheapest chain (k, dof) at values (n, m) of the redundant joint, and how many stations it reaches."""
        n, m = values.shape
        T = np.repeat(self.stations.T, m, axis=0)
        rows, count, _ = solve_locked_branches(self.solver, T, values.reshape(-1, 1))
        kept = np.arange(rows.shape[1]) < count[:, None]
        q = self._into_limits(rows[kept])
        cell = np.repeat(np.arange(n * m), count)
        inside = ((q >= self.bounds.lower) & (q <= self.bounds.upper) | self.wide).all(axis=1)
        q, cell = q[inside], cell[inside]
        if self.start is not None:
            own = int(np.argmin(np.abs(np.angle(np.exp(1j * (values[0] - self.start[self.joint]))))))
            later = cell >= m
            q, cell = np.concatenate([self.start[None], q[later]]), np.concatenate([[own], cell[later]])
        self.counts = np.bincount(cell // m, minlength=n)
        begin = np.searchsorted(cell, np.arange(n * m + 1)).astype(np.uint64)
        stride = np.where(self.revolute, LONGEST_STEP, np.inf)
        period = np.where(self.wide, FULL_TURN, 0.0)
        q = np.ascontiguousarray(q)
        states, _ = _core._ik_cheapest_chain(q, self._measure_cost(q), begin, m, stride, period, reach, is_ring)
        return q[states], len(states)

    def _into_limits(self, q: Array) -> Array:
        """Angles of joints that cannot make a full turn, moved by the multiple of 2π that is nearest to the
        middle of their limits."""
        turning = self.revolute & self.narrow
        return np.asarray(q - FULL_TURN * np.where(turning, np.round((q - self.middle) / FULL_TURN), 0.0))

    def _measure_cost(self, q: Array) -> Array:
        """Of the distance from the middle of the limits and from singularities of the other joints."""
        off = np.where(self.narrow, (q - self.middle) / self.half, 0.0) ** 2
        cost = LIMIT_WEIGHT * np.sum(off / (1.0 + AT_LIMIT - np.minimum(off, 1.0)), axis=1)
        J = self.robot.jacobian(q)
        volume = np.linalg.det(J @ np.swapaxes(J, 1, 2))
        best = volume.max(initial=0.0)
        if best > 0.0:
            cost += SINGULAR_WEIGHT * best / np.maximum(volume, LEAST_VOLUME * best)
        return np.asarray(cost * self.stations.spacing**2)

    def _unwrap(self, q: Array) -> Array:
        """The chain with continuous angles; without a start, each joint is moved by the multiple of 2π that keeps
        it within its limits, if there is one."""
        step = np.diff(q, axis=0)
        step -= np.where(self.wide, FULL_TURN * np.round(step / FULL_TURN), 0.0)
        out = q[0] + np.concatenate([np.zeros((1, q.shape[1])), np.cumsum(step, axis=0)])
        if self.start is not None:
            return out
        low, high = out.min(axis=0), out.max(axis=0)
        lower, upper = self.bounds.lower, self.bounds.upper
        limited = self.wide & np.isfinite(lower) & np.isfinite(upper)
        turns = np.where(limited, np.ceil((np.where(limited, lower, 0.0) - low) / FULL_TURN), 0.0)
        fits = high + FULL_TURN * turns <= upper
        moved = limited & ((low < lower) | (high > upper)) & fits
        return np.asarray(out + np.where(moved, FULL_TURN * turns, 0.0))

    def _where_it_ends(self, reached: int) -> JointBranch:
        s = float(self.stations.s[reached])
        if not self.counts[reached]:
            text, cause = "no configuration within the limits reaches the path there", "unreachable"
        else:
            text, cause = "no chain of configurations that move little leads on", "jump"
        whence = "" if self.start is None else " from this start"
        first = np.full(self.robot.dof, np.nan) if self.start is None else self.start
        return JointBranch(None, first, s, cause, None, f"at s = {s:.6g}: {text}{whence}", NO_DEVIATION)


def _smooth_chain(robot: KinematicModel, s: Array, q: Array, weight: float) -> Path:
    """A smooth curve near a chain q (n, dof) from its first configuration on, and the directions of the null
    space along the chain, as one curve of 2 dof values."""
    n = len(q)
    second = np.diff(np.eye(n), 2, axis=0)
    anchor = np.zeros(n)
    anchor[0] = ANCHOR
    null = np.linalg.svd(robot.jacobian(q))[2][:, -1]
    flips = np.cumprod(np.where(np.sum(null[1:] * null[:-1], axis=1) < 0, -1.0, 1.0))
    null[1:] *= flips[:, None]
    rows = np.concatenate([q, null], axis=1)
    smooth = np.linalg.solve(
        np.eye(n) + np.diag(anchor) + weight * second.T @ second, rows + anchor[:, None] * rows
    )
    return Path(s, quintic_controls(np.diff(s), smooth, "natural"))


@dataclass(frozen=True, eq=False)
class _Guided:
    """A Cartesian path followed beside a guiding curve r(s) with directions d(s): d · (q − r) = 0."""

    robot: KinematicModel
    path: CartesianPath
    curve: Path

    def refine(self, tolerance: float) -> JointBranch:
        """The joint path from the start of the curve on."""
        piece, u = first_nodes(self.path)
        guess = self._guide(piece, u, 0)[0]
        found = refine_branches(self.robot, self.path, self, guess[None], tolerance)[0]
        return make_branch(self.curve.start[: self.robot.dof], found)

    def _guide(self, piece: Indices, u: Array, order: int) -> tuple[Array, Array]:
        s = np.minimum(self.path.breaks[piece] + u, self.curve.length)
        values = self.curve(s, order)
        return values[:, : self.robot.dof], values[:, self.robot.dof :]

    def __call__(self, piece: Indices, u: Array, T: Array, guess: Array) -> Nodes:
        """Newton's method; then J q' = t and J q'' = t' − J' q', with the derivatives of the last row."""
        r, d = zip(*(self._guide(piece, u, order) for order in range(3)), strict=True)
        q = np.array(guess)
        left = np.full(len(q), np.inf)
        for _ in range(CORRECTIONS):
            error, left = self._measure_error(q, T)
            if not (left > ROUNDING).any():
                break
            q += self._solve(q, d[0], error, _dot(d[0], r[0] - q))
        twist, rate = self.path.twists_on(piece, u)
        slope = self._solve(q, d[0], twist, _dot(d[0], r[1]) + _dot(d[1], r[0] - q))
        rate = rate - np.einsum("nij,nj->ni", self.robot.jacobian_dot(q, slope), slope)
        last = _dot(d[0], r[2]) + 2 * _dot(d[1], r[1] - slope) + _dot(d[2], r[0] - q)
        return Nodes(q, slope, self._solve(q, d[0], rate, last), left)

    def _solve(self, q: Array, direction: Array, task: Array, last: Array) -> Array:
        """x with J x = task and direction · x = last, for each row; NaN where it is singular."""
        matrix = np.concatenate([self.robot.jacobian(q), direction[:, None, :]], axis=1)
        right = np.concatenate([task, last[:, None]], axis=1)
        try:
            return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
        except np.linalg.LinAlgError:
            return np.full_like(q, np.nan)

    def _measure_error(self, q: Array, T: Array) -> tuple[Array, Array]:
        if not np.isfinite(q).all():
            return np.full((len(q), 6), np.nan), np.full(len(q), np.inf)
        reached = self.robot.fk(q)
        turned = log_so3(T[:, :3, :3] @ np.swapaxes(reached[:, :3, :3], 1, 2))
        error = np.concatenate([T[:, :3, 3] - reached[:, :3, 3], turned], axis=1)
        return error, np.abs(error).max(axis=1)


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=1))


def _is_within(path: Path, bounds: Limits) -> bool:
    """Whether the control points of a joint path are within limits: then all of it is."""
    points = path.control_points
    return bool(((points >= bounds.lower) & (points <= bounds.upper)).all())


def _outside(found: JointBranch, bounds: Limits, robot: KinematicModel) -> JointBranch:
    assert found.path is not None
    points = found.path.control_points
    over = np.maximum(points - bounds.upper, bounds.lower - points)
    piece, _, joint = np.unravel_index(int(np.argmax(over)), over.shape)
    name, s = robot.joint_names[joint], float(found.path.breaks[piece])
    text = f"at s = {s:.6g}: {name} would leave its limits"
    return JointBranch(None, found.q_start, s, "limit", name, text, NO_DEVIATION)
