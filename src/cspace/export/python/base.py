"""An arm as the product of exponentials: where its tip is, how it moves, and candidates made solutions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

REACHED = 1e-9  # error of a solution [rad, m over the arm's length]
SAME = 1e-9  # solutions closer than this are one [rad, m over the arm's length]


@dataclass
class Solutions:
    """Every configuration that reaches a pose; truthy if there is one.

    q (k, dof); status: "exact", "singular" (some rows stand for a self-motion: joints move, the tip does
    not), "unreachable"; self_motion (k,): which rows stand for one; complete: nothing is known to be
    left out.
    """

    q: Array
    status: str
    self_motion: npt.NDArray[np.bool_]
    complete: bool

    def __len__(self) -> int:
        return len(self.q)


def rotation(axis: Array, angle: float) -> Array:
    """The turn by an angle about a unit axis (Rodrigues 1840)."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K))


def inverse(T: Array) -> Array:
    """The inverse of a pose."""
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
    return out


def joint_motion(arm: dict[str, Any], i: int, value: float) -> Array:
    """The displacement that joint i makes."""
    T = np.eye(4)
    if arm["slides"][i]:
        T[:3, 3] = value * arm["axes"][i]
    else:
        T[:3, :3] = rotation(arm["axes"][i], value)
        T[:3, 3] = arm["points"][i] - T[:3, :3] @ arm["points"][i]
    return T


def pose_and_jacobian(arm: dict[str, Any], q: Array) -> tuple[Array, Array]:
    """T (4, 4), and J (6, dof) with rows [v; w] in the base."""
    T, axes, points = np.eye(4), [], []
    for i, value in enumerate(q):
        axes.append(T[:3, :3] @ arm["axes"][i])
        points.append(T[:3, :3] @ arm["points"][i] + T[:3, 3])
        T = T @ joint_motion(arm, i, value)
    T = T @ arm["T_zero"]
    h, slides = np.array(axes), arm["slides"][:, None]
    v = np.where(slides, h, np.cross(h, T[:3, 3] - points))
    return T, np.hstack([v, np.where(slides, 0.0, h)]).T


def rotation_vector(R: Array) -> Array:
    """The rotation vector of R, up to a half turn."""
    w = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    s, c = float(np.linalg.norm(w)), (np.trace(R) - 1) / 2
    angle = np.arctan2(s, c)
    if s > 1e-6 or c > 0:
        return np.asarray((angle / s if s > 1e-12 else 1.0) * w)
    k = int(np.argmax(np.diag(R)))
    axis = R[:, k] + np.eye(3)[k]
    return np.asarray(angle / np.linalg.norm(axis) * axis)


def measure_error(arm: dict[str, Any], goal: Array, q: Array) -> tuple[Array, Array]:
    """What the configuration misses the goal by (6,), and the Jacobian (6, dof); lengths over the arm's."""
    T, J = pose_and_jacobian(arm, q)
    e = np.concatenate([goal[:3, 3] - T[:3, 3], rotation_vector(goal[:3, :3] @ T[:3, :3].T)])
    e[:3] /= arm["length"]
    J[:3] /= arm["length"]
    return e, J * units(arm)


def units(arm: dict[str, Any]) -> Array:
    """By what a change of each joint counts: slides over the arm's length."""
    return np.where(arm["slides"], arm["length"], 1.0)


def step_towards(e: Array, J: Array, damping: float) -> Array:
    """A damped least-squares step; it leaves directions alone that do not move the tip at all."""
    U, s, Vt = np.linalg.svd(J, full_matrices=False)
    gain = np.where(s > 1e-12, s / (s * s + damping + 1e-300), 0.0)
    step = Vt.T @ (gain * (U.T @ e))
    reach = float(np.abs(step).max())
    return np.asarray(step * min(1.0, 0.3 / reach) if reach > 0 else step)


def refine(arm: dict[str, Any], goal: Array, q: Array, steps: int = 60) -> tuple[Array, float]:
    """A candidate made a solution, or brought near one: Newton's method, then damped least squares."""
    best, least, at = q, np.inf, q
    for _ in range(16):
        e, J = measure_error(arm, goal, at)
        size = float(np.linalg.norm(e))
        if size < least:
            best, least = at, size
        elif least < 1e-12:
            break
        if least < 1e-15:
            break
        at = at + units(arm) * step_towards(e, J, 0.0)
    if least > 1e-12:
        best = q
    return descend(arm, goal, best, 2 if least < 1e-12 else steps)


def descend(arm: dict[str, Any], goal: Array, q: Array, steps: int) -> tuple[Array, float]:
    """Levenberg-Marquardt (Levenberg 1944, Marquardt 1963)."""
    e, J = measure_error(arm, goal, q)
    size, damping, stalls = float(np.linalg.norm(e)), 0.0, 0
    for _ in range(steps):
        if size < 1e-15 or stalls > 5:
            break
        trial = q + units(arm) * step_towards(e, J, damping)
        e_trial, J_trial = measure_error(arm, goal, trial)
        left = float(np.linalg.norm(e_trial))
        if left < size:
            stalls = stalls + 1 if left > 0.99 * size else 0
            q, e, J, size, damping = trial, e_trial, J_trial, left, 0.1 * damping
        else:
            weakest = float(np.linalg.svd(J, compute_uv=False)[-1])
            if size < 1e-13 or damping > 1e3:
                break
            damping = max(4 * damping, 0.1 * weakest**2, 1e-20)
    return q, size


def wrapped(arm: dict[str, Any], q: Array) -> Array:
    """Revolute joints in (-pi, pi]."""
    return np.where(arm["slides"], q, np.pi - np.mod(np.pi - q, 2 * np.pi))


def pose_gap(arm: dict[str, Any], a: Array, b: Array) -> float:
    """The largest difference of a joint, angles the short way round, slides over the arm's length."""
    away = np.where(arm["slides"], (a - b) / arm["length"], np.mod(a - b + np.pi, 2 * np.pi) - np.pi)
    return float(np.abs(away).max())


def moves_freely(arm: dict[str, Any], goal: Array, q: Array, direction: Array) -> bool:
    """Whether a stride along the direction comes back to the goal somewhere else, however long it is."""
    for stride in (0.02, 0.05):
        moved_on = False
        for way in (stride, -stride):
            moved, left = refine(arm, goal, q + units(arm) * way * direction, 30)
            along = float(((moved - q) / units(arm)) @ direction)
            moved_on = moved_on or (left < 1e-12 and along / way > 0.8)
        if not moved_on:
            return False
    return True


def is_self_motion(arm: dict[str, Any], goal: Array, q: Array) -> bool:
    """Whether joints can move at q while the tip stays: the null space proposes, a stride decides."""
    _, s, Vt = np.linalg.svd(measure_error(arm, goal, q)[1])
    null = list(Vt[np.concatenate([s, np.zeros(len(q) - len(s))]) < 1e-7])
    for a in range(len(null)):
        for b in range(a + 1, len(null)):
            turns = np.pi * np.arange(1, 12) / 12
            null += [np.cos(t) * null[a] + np.sin(t) * null[b] for t in turns]
    return any(moves_freely(arm, goal, q, direction) for direction in null[:40])


def noise_level(arm: dict[str, Any], goal: Array, q: Array) -> float:
    """How far rounding may move a configuration along its weakest direction."""
    e, J = measure_error(arm, goal, q)
    weakest = float(np.linalg.svd(J, compute_uv=False)[-1])
    return 10 * max(float(np.linalg.norm(e)), 1e-15) / max(weakest, 1e-9)


def accept_candidate(
    arm: dict[str, Any], goal: Array, found: list[Array], candidate: Array, steps: int = 60
) -> bool:
    """Add what the candidate leads to, unless it is no solution or there already."""
    q, left = refine(arm, goal, candidate, steps)
    if not left <= REACHED:
        return False
    near = noise_level(arm, goal, q)
    for other in found:
        away = pose_gap(arm, other, q)
        if away < SAME:
            return False
        if away < near or (away < 1e-3 and away < noise_level(arm, goal, other)):
            halfway = other + np.where(arm["slides"], q - other, wrapped(arm, q - other)) / 2
            if np.linalg.norm(measure_error(arm, goal, halfway)[0]) < 2e-14:
                return False
    found.append(wrapped(arm, q))
    return True


def make_answer(arm: dict[str, Any], goal: Array, found: list[Array], complete: bool = True) -> Solutions:
    """The solutions with what is to be said of them."""
    q = np.array(found).reshape(len(found), len(arm["axes"]))
    self_motion = np.array([is_self_motion(arm, goal, row) for row in q], dtype=bool)
    status = "singular" if self_motion.any() else "exact" if len(q) else "unreachable"
    return Solutions(q, status, self_motion, complete)
