"""The curve that a self-motion runs along, and the part of it that joint limits leave.

A curve that closes is periodic once its angles are unwound: after one time around it stands `shift` further,
a multiple of 2π for joints that made full revolutions, zero for the others. It is repeated as often as the
limits leave, and its points are named by their arc length s from q.

Source: E. L. Allgower and K. Georg, Numerical Continuation Methods, 1990, for the curve itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.ik.solver import Solver
from cspace.ik.wrapping import into_limits, nearest_winding, revolute_joints, short_way
from cspace.math.wrapping import TURN, count_turns, wrap_near
from cspace.model import Limits
from cspace.tolerances import RESTING_JOINT

CLOSED, FAR = 0, 1
HALVINGS = 50
MOST_TURNS = 1000
"""Revolutions after which a joint counts as rotating without end."""


@dataclass(frozen=True, eq=False)
class Curve:
    """points (m, dof) along the curve, s (m,) their arc length from q, tangents (m, dof); shift (dof,) what
    one time around adds, None for a curve that does not close. q (dof,): where it was traced from.
    """

    solver: Solver
    whole_pose: bool
    q: Array
    points: Array
    tangents: Array
    s: Array
    shift: Array | None

    @property
    def length(self) -> float:
        return float(self.s[-1])

    def repeat(self, back: int, ahead: int) -> Curve:
        """A closed curve so many times around before q and after it."""
        n = len(self.s) - 1
        around, i = np.divmod(np.arange((back + ahead) * n + 1), n)
        around -= back
        return replace(
            self,
            points=self.points[i] + around[:, None] * self.shift,
            tangents=self.tangents[i],
            s=self.s[i] + around * self.length,
        )

    def at(self, s: Array) -> Array:
        """Configurations at these arc lengths (k,), (k, dof)."""
        i = np.clip(np.searchsorted(self.s, s) - 1, 0, len(self.s) - 2)
        step = self.s[i + 1] - self.s[i]
        part = np.where(step > 0, (s - self.s[i]) / np.where(step > 0, step, 1.0), 0.0)
        chord = self.points[i] + part[:, None] * (self.points[i + 1] - self.points[i])
        exact, _ = return_onto_curve(self.solver, self.q, chord, self.tangents[i], self.whole_pose)
        return np.where(np.isnan(exact), self.points[i], exact)  # a corner too sharp for its chord


@dataclass(frozen=True, eq=False)
class Arc:
    """The part of a curve from arc length first to last, infinite where nothing stops it; is_loop: the whole
    of a closed curve, once around.
    """

    curve: Curve
    first: float
    last: float
    is_loop: bool

    def bounds(self) -> Array:
        """The least and the largest value of each joint, (dof, 2)."""
        curve = self.curve
        shift = np.zeros(curve.points.shape[1]) if curve.shift is None else curve.shift
        inside = (curve.s >= self.first) & (curve.s <= self.last)  # every joint has its extremes among these
        ends = [end for end in (self.first, self.last) if np.isfinite(end) and not self.is_loop]
        points = np.concatenate([curve.points[inside], curve.at(np.array(ends))])
        low, high = points.min(axis=0), points.max(axis=0)
        rests = high - low < RESTING_JOINT
        low, high = np.where(rests, curve.q, low), np.where(rests, curve.q, high)
        for end, way, tangent in ((self.first, -1, curve.tangents[0]), (self.last, 1, curve.tangents[-1])):
            if np.isfinite(end):
                continue
            sliding = np.where(np.abs(tangent) > RESTING_JOINT, tangent, 0.0)  # of an unbounded curve
            drift = way * (shift if curve.shift is not None else sliding)
            low, high = np.where(drift < 0, -np.inf, low), np.where(drift > 0, np.inf, high)
        if self.is_loop:
            round_about = (shift != 0) | (high - low >= TURN)
            round_about &= revolute_joints(curve.solver.joint_types)
            low, high = np.where(round_about, -np.pi, low), np.where(round_about, np.pi, high)
        return np.stack([low, high], axis=1)

    def sample(self, n: int) -> Array:
        return self.curve.at(np.linspace(self.first, self.last, n, endpoint=not self.is_loop))


def arc_through(solver: Solver, q: Array, direction: Array, whole_pose: bool) -> Arc | None:
    """The part of the self-motion through q within the robot's limits; None where q itself breaks them."""
    lower, upper = solver.limits.lower, solver.limits.upper
    moved, fits = into_limits(q[None], solver.joint_types, lower, upper)
    if not fits[0]:
        return None
    curve, ends = trace_curve(solver, np.ascontiguousarray(moved[0]), direction, whole_pose)
    if curve.shift is not None:
        ahead = times_around(curve.points, curve.shift, lower, upper)
        back = times_around(curve.points - curve.shift, -curve.shift, lower, upper)
        if min(ahead, back) == MOST_TURNS:
            return Arc(curve, 0.0, curve.length, True)
        # The time around in which a limit is met comes last; where none is met, one time around is enough.
        curve = curve.repeat(back % MOST_TURNS + 1, ahead % MOST_TURNS + 1)
    last = find_stop(curve, lower, upper, 1, ends[1])
    first = find_stop(curve, lower, upper, -1, ends[0])
    return Arc(curve, first, last, False)


def nearest_member(
    solver: Solver, q: Array, direction: Array, whole_pose: bool, seed: Array, limits: Limits | None = None
) -> Array:
    """The configuration (dof,) of the self-motion through q that is nearest to a seed, each revolute joint by
    the turn that brings it closest; with limits of those inside, or q where there is none."""
    rounds, parts = 9, 33
    curve, _ = trace_curve(solver, np.ascontiguousarray(q), direction, whole_pose)
    near, last = slice(None), len(curve.s) - 1
    if curve.shift is not None:  # once around before q, so that every point has neighbours
        curve, near = curve.repeat(1, 1), slice(last, 2 * last)
    k = near.start or 0
    distances = measure_distances(solver, curve.points[near], seed, limits)
    k += int(np.argmin(distances))
    if not np.isfinite(distances).any():
        return q
    low, high = curve.s[max(k - 1, 0)], curve.s[min(k + 1, len(curve.s) - 1)]
    for _ in range(rounds):  # each narrows the piece between two points sixteenfold
        s = np.linspace(low, high, parts)
        points = curve.at(s)
        k = int(np.argmin(measure_distances(solver, points, seed, limits)))
        low, high = s[max(k - 1, 0)], s[min(k + 1, parts - 1)]
    if limits is not None:
        return nearest_winding(points[k], seed, solver.joint_types, limits.lower, limits.upper)
    return np.where(revolute_joints(solver.joint_types), wrap_near(points[k], seed), points[k])


def measure_distances(solver: Solver, points: Array, seed: Array, limits: Limits | None) -> Array:
    """How far configurations (k, dof) are from a seed, revolute joints the short way round or, with limits,
    by the turn inside them, (k,); infinite beyond limits."""
    if limits is None:
        return np.asarray(np.linalg.norm(short_way(points - seed, solver.joint_types), axis=1))
    moved = nearest_winding(points, seed, solver.joint_types, limits.lower, limits.upper)
    inside = ((moved >= limits.lower) & (moved <= limits.upper)).all(axis=1)
    return np.where(inside, np.linalg.norm(moved - seed, axis=1), np.inf)


def trace_curve(
    solver: Solver, q: Array, direction: Array, whole_pose: bool
) -> tuple[Curve, tuple[int, int]]:
    """The curve through q, with the extremes of every joint among its points, and how it ends either way."""
    ahead, along, end = _core._ik_follow(solver, q, np.ascontiguousarray(direction), whole_pose)
    start, ends, shift = 0, (end, end), None
    if end == CLOSED:
        shift = np.where(revolute_joints(solver.joint_types), TURN * count_turns(ahead[-1] - ahead[0]), 0.0)
    else:
        behind, back, other = _core._ik_follow(solver, q, -np.ascontiguousarray(direction), whole_pose)
        start, ends = len(behind) - 1, (other, end)
        ahead = np.concatenate([behind[:0:-1], ahead])
        along = np.concatenate([-back[:0:-1], along])
    points, tangents, start = with_extremes(solver, q, ahead, along, start, whole_pose)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(steps)])
    return Curve(solver, whole_pose, q, points, tangents, s - s[start], shift), ends


def with_extremes(
    solver: Solver, q: Array, points: Array, tangents: Array, start: int, whole_pose: bool
) -> tuple[Array, Array, int]:
    """The points of a curve and, between them, those where a joint turns back: its tangent changes sign."""
    turning = np.abs(tangents).max(axis=0) > RESTING_JOINT
    where, joint = np.nonzero((tangents[:-1] * tangents[1:] < 0) & turning)
    if len(where) == 0:
        return points, tangents, start
    low, high = np.zeros(len(where)), np.ones(len(where))
    before, step = points[where], points[where + 1] - points[where]
    sign = np.sign(tangents[where, joint])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        exact, t = return_onto_curve(solver, q, before + middle[:, None] * step, tangents[where], whole_pose)
        same = np.sign(t[np.arange(len(where)), joint]) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    order = np.lexsort((low, where))
    order = order[~np.isnan(exact[order]).any(axis=1)]  # without those at a corner too sharp for its chord
    at = where[order] + 1
    return (
        np.insert(points, at, exact[order], axis=0),
        np.insert(tangents, at, t[order], axis=0),
        start + int(np.count_nonzero(where[order] < start)),
    )


def find_stop(curve: Curve, lower: Array, upper: Array, way: int, end: int) -> float:
    """The arc length at which the curve, followed from q forward (way 1) or back (−1), meets a limit;
    infinite where it meets none, the end of the curve where it was lost.
    """
    ahead = way * curve.s >= 0
    points, s = curve.points[ahead][::way], curve.s[ahead][::way]
    # Joints at rest stay where the limits hold them, whatever rounding says.
    moving = np.ptp(curve.points, axis=0) > RESTING_JOINT
    outside = (((points < lower) | (points > upper)) & moving).any(axis=1)
    outside[0] = False  # q itself
    if not outside.any():
        return way * np.inf if curve.shift is not None or end == FAR else float(s[-1])
    i = int(np.argmax(outside))
    return find_crossing(curve, float(s[i - 1]), float(s[i]), (lower, upper, moving))


def times_around(points: Array, shift: Array, lower: Array, upper: Array) -> int:
    """How many times the curve can be gone around before a limit is met, MOST_TURNS at most."""
    moving = np.ptp(points, axis=0) > RESTING_JOINT
    if (((points < lower) | (points > upper)) & moving).any():
        return 0
    with np.errstate(divide="ignore", invalid="ignore"):
        room = np.where(shift > 0, upper - points.max(axis=0), points.min(axis=0) - lower) / np.abs(shift)
    least = np.where(shift != 0, room, np.inf).min()
    return int(min(np.floor(least) + 1, MOST_TURNS))


def find_crossing(curve: Curve, inside: float, outside: float, limits: tuple[Array, Array, Any]) -> float:
    """The last arc length, between these two, at which the curve is within limits."""
    lower, upper, moving = limits
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        q = curve.at(np.array([middle]))[0]
        broken = (((q < lower) | (q > upper)) & moving).any()
        inside, outside = (inside, middle) if broken else (middle, outside)
    return inside


def return_onto_curve(
    solver: Solver, q: Array, near: Array, along: Array, whole_pose: bool
) -> tuple[Array, Array]:
    """Rows of joints brought onto the curve through q, and the tangents there."""
    rows = [np.ascontiguousarray(value) for value in (q, near, along)]
    return _core._ik_onto(solver, *rows, whole_pose)
