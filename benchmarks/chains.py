"""Arms as numbers, and their forward kinematics in plain numpy: what every contender gets and is judged by.

Nothing here uses cspace or a peer, so the judge depends on no contender.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Arm:
    """A serial arm by its screws at zero: axes (n, 3), a point on each (n, 3) [m], T_zero (4, 4), limits
    (n,), joint_types, a string of R (turns) and P (slides).

    dh: (n, 4) rows alpha, a, d, theta offset (standard convention) between T_base and T_tool (4, 4), for
    peers that take nothing else.
    """

    name: str
    axes: Array
    points: Array
    T_zero: Array
    lower: Array
    upper: Array
    dh: Array
    T_dh_base: Array
    T_dh_tool: Array
    joint_types: str

    @property
    def dof(self) -> int:
        return len(self.axes)

    @property
    def turns(self) -> npt.NDArray[np.bool_]:
        """Which joints turn (n,); the others slide."""
        return np.array([kind == "R" for kind in self.joint_types])

    def save(self, path: Path) -> None:
        np.savez(path, **self.__dict__)

    @staticmethod
    def load(path: Path) -> Arm:
        with np.load(path) as data:
            return Arm(**{key: data[key] if data[key].ndim else str(data[key]) for key in data.files})


def skew(v: Array) -> Array:
    """[v]× of vectors (..., 3), shape (..., 3, 3)."""
    zero = np.zeros_like(v[..., 0])
    x, y, z = np.moveaxis(v, -1, 0)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*v.shape[:-1], 3, 3)


def rotations(axis: Array, angle: Array) -> Array:
    """Rodrigues' formula: rotations (..., 3, 3) about a unit axis (3,) by angles (...)."""
    K = skew(axis)
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.eye(3) + s * K + (1 - c) * (K @ K)


def motion(arm: Arm, joint: int, q: Array) -> Array:
    """exp(ξ q) (..., 4, 4) of one joint at q (...): a turn about its axis or a slide along it."""
    T = np.broadcast_to(np.eye(4), (*q.shape, 4, 4)).copy()
    if arm.joint_types[joint] == "P":
        T[..., :3, 3] = q[..., None] * arm.axes[joint]
    else:
        T[..., :3, :3] = rotations(arm.axes[joint], q)
        T[..., :3, 3] = arm.points[joint] - T[..., :3, :3] @ arm.points[joint]
    return T


def fk(arm: Arm, q: Array) -> Array:
    """Poses (..., 4, 4) of the tip at q (..., n): the product of the exponentials of the screws, then
    T_zero."""
    q = np.asarray(q, dtype=float)
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4)).copy()
    for i in range(arm.dof):
        T = T @ motion(arm, i, q[..., i])
    return T @ arm.T_zero


def jacobian(arm: Arm, q: Array) -> Array:
    """Jacobians (..., 6, n), rows [v; ω] of the tip in the base frame, at q (..., n)."""
    q = np.asarray(q, dtype=float)
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4)).copy()
    axes, points = [], []
    for i in range(arm.dof):
        axes.append(T[..., :3, :3] @ arm.axes[i])
        points.append(T[..., :3, :3] @ arm.points[i] + T[..., :3, 3])
        T = T @ motion(arm, i, q[..., i])
    tip = (T @ arm.T_zero)[..., :3, 3]
    columns = [
        np.concatenate([np.cross(w, tip - p), w] if turns else [w, np.zeros_like(w)], axis=-1)
        for w, p, turns in zip(axes, points, arm.turns, strict=True)
    ]
    return np.stack(columns, axis=-1)


def offsets(arm: Arm) -> Array:
    """The steps (n + 1, 3) from axis to axis to tip that product-of-exponentials peers take.

    Where neighbouring axes meet, the point of the later one is put where they meet, since such peers
    recognise a wrist or a shoulder by a zero step.
    """
    points = arm.points.copy()
    for i in range(arm.dof - 2, -1, -1):
        meeting = meeting_point(points[i], arm.axes[i], points[i + 1], arm.axes[i + 1])
        if meeting is not None:
            shared = i + 2 < arm.dof and np.allclose(points[i + 1], points[i + 2], atol=1e-9)
            if not shared:
                points[i + 1] = meeting
                points[i] = meeting
            elif np.allclose(points[i + 1], meeting, atol=1e-9):
                points[i] = meeting
    places = np.vstack([np.zeros(3), points, arm.T_zero[:3, 3]])
    return np.diff(places, axis=0)


def alignment(arm: Arm, other: Callable[[Array], Array]) -> tuple[Array, Array] | None:
    """T_a, T_b (4, 4) with other(q) = T_a · fk(q) · T_b: a peer with its own copy of the arm may have turned
    its base by half a turn about z and placed its tip elsewhere. None where the arms differ by more than
    that."""
    zero, probe = np.zeros(arm.dof), np.linspace(0.3, 1.3, arm.dof)
    for turn in (1.0, -1.0):
        base = np.diag([turn, turn, 1.0, 1.0])
        tool = np.linalg.inv(base @ fk(arm, zero)) @ other(zero)
        if np.abs(base @ fk(arm, probe) @ tool - other(probe)).max() < 1e-6:
            return base, tool
    return None


def meeting_point(p1: Array, h1: Array, p2: Array, h2: Array) -> Array | None:
    """The point (3,) where two lines meet; None for parallel or skew ones."""
    A = np.stack([h1, -h2], axis=1)
    if np.linalg.norm(np.cross(h1, h2)) < 1e-6:
        return None
    (s, t), *_ = np.linalg.lstsq(A, p2 - p1, rcond=None)
    near, far = p1 + s * h1, p2 + t * h2
    return near if np.linalg.norm(near - far) < 1e-6 else None
