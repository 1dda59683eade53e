"""The swivel of an arm with two spherical joints: its elbow about the line from shoulder to wrist; and which
swivels keep all limits: every place where that can change is a root in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.ik.answers import EXACT, UNREACHABLE
from cspace.ik.conditions import common_point
from cspace.ik.context import About
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solver import HasSolver, Solver, as_solver
from cspace.ik.wrapping import measure_violations
from cspace.math.wrapping import TURN, wrap_angle
from cspace.spatial import exp_so3
from cspace.tolerances import FARTHEST, INSIDE_END, SAME_SWIVEL

BRANCHES = 8
JOINTS = 7


def swivel(robot: HasSolver, q: Any) -> Array:
    """The angle of the elbow about the line from shoulder to wrist.

    ψ = atan2(n · (z × e), z · e), n = (W − S)/|W − S|, z = r − (r · n) n.

    robot: a Robot or a Solver. q (..., 7) [rad] → ψ (...) [rad]. S: where axes 1, 2, 3 meet, W: where axes
    5, 6, 7 do, e: from S to the point of axis 4 nearest to S, r: the direction of axis 1. Where W lies on
    axis 1 a fixed direction perpendicular to it stands for r. Raises InputError for an arm that is not built
    so. M. Shimizu et al. 2008, section II.
    """
    solver = as_solver(robot).check_swivel()
    rows = as_floats(q, "q", last=(JOINTS,), largest=FARTHEST)
    out = np.empty(int(np.prod(rows.shape[:-1])))
    _core._ik_swivels(solver, np.ascontiguousarray(rows.reshape(-1, JOINTS)), out)
    return out.reshape(rows.shape[:-1])


def solve_swivel(solver: Solver, T: Array, angle: Any) -> Solutions | SolutionsBatch:
    """Every solution at given swivels; goals and swivels are broadcast against each other."""
    angles = as_floats(angle, "swivel", largest=FARTHEST)
    shape = leading_axes(goal=T.shape[:-2], swivel=angles.shape)
    goals = np.ascontiguousarray(np.broadcast_to(T, (*shape, 4, 4)))
    swivels = np.ascontiguousarray(np.broadcast_to(angles, shape).reshape(-1))
    q = np.empty((len(swivels), BRANCHES, JOINTS))
    _core._ik_swivel_rows(solver.check_swivel(), goals.reshape(-1, 4, 4), swivels, q)
    real = np.isfinite(q[..., 0])
    verdict = np.where(real.any(axis=-1), EXACT, UNREACHABLE).astype(np.uint8)
    if shape:  # the rows of each goal first
        order = np.argsort(~real, axis=-1, kind="stable")
        q, count = np.take_along_axis(q, order[..., None], axis=-2), real.sum(axis=-1)
        return SolutionsBatch.of(solver, goals, q, count, verdict, About(), np.zeros(real.shape, dtype=bool))
    rows, numbers = q[0, real[0]], np.flatnonzero(real[0])
    note = None if len(rows) else "no swivel reaches the goal, because the wrist centre is out of reach"
    return Solutions.of(solver, goals, int(verdict[0]), rows, numbers, (False,) * len(rows), note)


Flags = npt.NDArray[np.bool_]
LOOKS = 48
"""Swivels at which a branch is looked for that shows how the shoulder turns."""


@dataclass(frozen=True, eq=False)
class Sphere:
    """Three joints that meet, numbered from `first`; their rotation C + c cos ψ + s sin ψ, each (3, 3)."""

    first: int
    parts: tuple[Array, Array, Array]


def swivel_intervals(solver: Solver, T: Array) -> Redundancy:
    """The intervals of the swivel in which a branch keeps all limits, for one goal T (4, 4).

    The rotation M of three joints whose axes intersect is affine in cos ψ and sin ψ. The first of them is at
    its limit L where hᵦ · (e^{−L hₐ} M hᵨ) = hᵦ · hᵨ; the others have similar conditions. These roots divide
    the circle, and one swivel decides for each part. M. Shimizu et al. 2008, section IV.
    """
    places = critical_swivels(solver, T)
    if not len(places):
        places = np.array([-np.pi])
    ends = np.append(places, places[0] + TURN)
    middles = 0.5 * (ends[:-1] + ends[1:])
    rows = rows_at(solver, T, middles)
    fits = keep_limits(solver, rows)
    made = [
        interval
        for branch in range(BRANCHES)
        for interval in of_branch(solver, T, branch, ends, rows[:, branch], fits[:, branch])
    ]
    made.sort(key=lambda interval: (interval.branch, interval.lower))
    return Redundancy(solver, T, "swivel", tuple(made), True)


def rows_at(solver: Solver, T: Array, swivels: Array) -> Array:
    """Every branch (m, 8, 7) at some swivels (m,), NaN where it is not."""
    q = np.empty((len(swivels), BRANCHES, JOINTS))
    goals = np.ascontiguousarray(np.broadcast_to(T, (len(swivels), 4, 4)))
    _core._ik_swivel_rows(solver.check_swivel(), goals, np.ascontiguousarray(swivels), q)
    return q


def keep_limits(solver: Solver, rows: Array) -> Flags:
    """Which rows (m, 8, 7) are there and keep all limits, (m, 8)."""
    beyond = measure_violations(rows, solver.joint_types, solver.limits.lower, solver.limits.upper)
    return np.asarray(np.isfinite(rows[..., 0]) & (beyond <= 0).all(axis=-1))


def critical_swivels(solver: Solver, T: Array) -> Array:
    """Where a joint of either spherical joint may reach a limit, or two branches meet: sorted, in (−π, π]."""
    looks = np.linspace(-np.pi, np.pi, LOOKS, endpoint=False) + 0.01
    rows = rows_at(solver, T, looks)
    found: list[Array] = []
    elbows: list[float] = []
    for look, branch in zip(*np.nonzero(np.isfinite(rows[..., 0])), strict=True):
        q = rows[look, branch]
        if any(abs(np.sin((q[3] - other) / 2)) < SAME_SWIVEL for other in elbows):
            continue
        elbows.append(float(q[3]))
        for sphere in find_spheres(solver, T, q, float(looks[look])):
            found += [find_roots(sphere, *condition) for condition in limit_conditions(solver, sphere)]
    values = np.sort(np.concatenate(found)) if found else np.empty(0)
    return values[np.append(True, np.diff(values) > SAME_SWIVEL)] if len(values) else values


def find_spheres(solver: Solver, T: Array, q: Array, psi: float) -> tuple[Sphere, Sphere]:
    """Shoulder and wrist of the branches with the elbow of q, whose swivel is psi."""
    chain = solver.chain
    turns = exp_so3(chain.axes * q[:, None])
    shoulder, elbow = turns[0] @ turns[1] @ turns[2], turns[3]
    S, W = (common_point(chain.axes[k : k + 3], chain.points[k : k + 3])[0] for k in (0, 4))
    n = (T @ np.linalg.inv(chain.T_zero) @ np.append(W, 1.0))[:3] - S
    n = n / np.linalg.norm(n)
    along, K = np.outer(n, n), np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    start = exp_so3(-psi * n) @ shoulder
    G = T[:3, :3] @ chain.T_zero[:3, :3].T
    parts = along, np.eye(3) - along, K
    left = tuple(part @ start for part in parts)
    right = tuple(elbow.T @ part.T @ G for part in left)
    return Sphere(0, left), Sphere(4, right)


def limit_conditions(solver: Solver, sphere: Sphere) -> list[tuple[Array, Array, float]]:
    """(u, v, r): uᵀ M v = r where a joint reaches a limit, or the middle one an end of its reach."""
    a, b, c = solver.chain.axes[sphere.first : sphere.first + 3]
    lower, upper = (
        limit[sphere.first : sphere.first + 3] for limit in (solver.limits.lower, solver.limits.upper)
    )
    span = np.sqrt(max(1 - (a @ b) ** 2, 0.0) * max(1 - (b @ c) ** 2, 0.0))
    out = [(a, c, float((a @ b) * (b @ c) + sign * span)) for sign in (-1.0, 1.0)]
    for limits in (lower, upper):
        first, middle, last = (
            exp_so3(h * L) if np.isfinite(L) else None for h, L in zip((a, b, c), limits, strict=True)
        )
        if first is not None:
            out.append((first @ b, c, float(b @ c)))
        if middle is not None:
            out.append((a, c, float(a @ middle @ c)))
        if last is not None:
            out.append((a, last.T @ b, float(a @ b)))
    return out


def find_roots(sphere: Sphere, u: Array, v: Array, r: float) -> Array:
    """The swivels (0 to 2,) in (−π, π] at which uᵀ M v = r."""
    still, cosine, sine = (float(u @ part @ v) for part in sphere.parts)
    size = float(np.hypot(cosine, sine))
    if size < SAME_SWIVEL or abs(r - still) > size:
        return np.empty(0)
    middle, half = np.arctan2(sine, cosine), np.arccos((r - still) / size)
    return wrap_angle(np.array([middle - half, middle + half]))


def of_branch(solver: Solver, T: Array, branch: int, ends: Array, rows: Array, fits: Flags) -> list[Interval]:
    """The intervals of one branch from its cells: ends (m + 1,), rows (m, 7), fits (m,)."""
    m = len(fits)
    if fits.all():
        return [Interval(-np.pi, np.pi, branch + 1, ("nothing", "nothing"), rows[0])]
    out = []
    for start in np.flatnonzero(fits & ~np.roll(fits, 1)):
        count = int(np.argmin(np.roll(fits, -start)))
        lower = float(ends[start])
        upper = float(ends[(start + count - 1) % m + 1]) + (TURN if start + count > m else 0.0)
        step = min(INSIDE_END, 0.5 * (upper - lower))
        cause = what_ends(solver, T, branch, lower, step), what_ends(solver, T, branch, upper, -step)
        out.append(Interval(lower, upper, branch + 1, cause, rows[(start + count // 2) % m]))
    return out


def what_ends(solver: Solver, T: Array, branch: int, end: float, inwards: float) -> str:
    """The joint at a limit just inside an end, or "fold" where the branch goes on no further."""
    inside, beyond = rows_at(solver, T, np.array([end + inwards, end - inwards]))[:, branch]
    if not np.isfinite(beyond[0]):
        return "fold"
    lower, upper = solver.limits.lower, solver.limits.upper
    out = measure_violations(beyond[None], solver.joint_types, lower, upper)[0]
    joint = int(np.argmax(out))
    if not out[joint] > 0:
        return "fold"
    gaps = [abs(np.sin((inside[joint] - limit[joint]) / 2)) for limit in (lower, upper)]
    return f"{solver.joint_names[joint]} at {'upper' if gaps[1] < gaps[0] else 'lower'} limit"
