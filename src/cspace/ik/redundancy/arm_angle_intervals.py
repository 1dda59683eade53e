"""Which swivels keep all limits: every place where that can change is a root in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.ik.conditions import common_point
from cspace.ik.redundancy.arm_angle import BRANCHES, JOINTS
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.solver import Solver
from cspace.ik.wrapping import measure_violations
from cspace.math.wrapping import TURN, wrap_angle
from cspace.spatial import exp_so3
from cspace.tolerances import INSIDE_END, SAME_SWIVEL

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

    The rotation of three joints that meet is affine in cos ψ and sin ψ, and each of them stands at a value L
    where one entry of it does: hᵦ · (e^{−L hₐ} M hᵨ) = hᵦ · hᵨ for the first, alike for the others. Between
    two neighbours of all those roots one swivel decides. M. Shimizu et al. 2008, section IV.
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
