"""Six turning joints in general position: one joint's half-tangent as an eigenvalue (Raghavan and Roth 1993;
Manocha and Canny 1994).

With a frame on each axis the arm and its goal close up, Rz(a0) M0 Rz(a1) M1 … Rz(a5) M5 = I. The z axis l and
the origin p of either half of the loop, with p x l, (p.p) l - 2 (p.l) p, p.p and p.l, are fourteen equations
linear in the products of the cosines and sines of two angles on the right, which eight of them take out.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array, Solutions, admit, answer, gap, inverse
from cspace.export.python.sampled import solve_by_sample

__all__ = ["solve_by_companion"]

QUARTERS = np.array([0.0, np.pi / 2, np.pi])
# From the values at three quarter turns to the coefficients of cosine, sine and one.
HARMONICS = np.array([[0.5, 0.0, -0.5], [-0.5, 1.0, -0.5], [0.5, 0.0, 0.5]])
# From these to those of t^2, t and one, for the half-tangent t and times 1 + t^2.
HALVED = np.array([[-1.0, 0.0, 1.0], [0.0, 2.0, 0.0], [1.0, 0.0, 1.0]])
TRIALS = 3


def about_z(angle: Any) -> Array:
    """The turns by angles (...) about z, (..., 4, 4)."""
    angle = np.asarray(angle)
    T = np.zeros((*angle.shape, 4, 4))
    T[..., 2, 2] = T[..., 3, 3] = 1.0
    T[..., 0, 0] = T[..., 1, 1] = np.cos(angle)
    T[..., 1, 0] = np.sin(angle)
    T[..., 0, 1] = -T[..., 1, 0]
    return T


def fourteen(T: Array) -> Array:
    """l, p, p x l, (p.p) l - 2 (p.l) p, p.p, p.l of poses (..., 4, 4), as (..., 14)."""
    l, p = T[..., :3, 2], T[..., :3, 3]
    pp, pl = (p * p).sum(-1, keepdims=True), (p * l).sum(-1, keepdims=True)
    return np.concatenate([l, p, np.cross(p, l), pp * l - 2 * pl * p, pp, pl], axis=-1)


def equations(M: list[Array]) -> Array:
    """(3, 6, 9): six equations by powers of the first half-tangent and of those of the next two."""
    turn = about_z(QUARTERS)
    back = inverse(M[4]) @ turn.transpose(0, 2, 1)[:, None] @ inverse(M[3])  # over a4
    right = fourteen(turn.transpose(0, 2, 1)[None, :] @ back)  # over a4, a5
    right = np.einsum("ia,jb,abn->ijn", HARMONICS, HARMONICS, right)
    left = M[5] @ turn[:, None, None] @ M[0] @ turn[None, :, None] @ M[1] @ turn[None, None, :] @ M[2]
    left = np.einsum("ia,jb,kc,abcn->ijkn", HARMONICS, HARMONICS, HARMONICS, fourteen(left))
    left[2, 2, 2] -= right[2, 2]
    keep = right.reshape(9, 14)[:8]
    take_out = np.linalg.svd(keep)[2][8:]
    halved = np.einsum("ia,jb,kc,abcn->ijkn", HALVED, HALVED, HALVED, left)
    return np.asarray(np.einsum("mn,ijkn->imjk", take_out, halved).reshape(3, 6, 9))


def half_tangents(E: Array) -> tuple[Array, Array]:
    """Real half-tangents of the first angle (k,) and those of the next two (k, 2): 24 eigenvalues."""
    A = np.zeros((3, 12, 12))
    A[:, :6, :9] = A[:, 6:, 3:] = E
    C = np.zeros((24, 24))
    C[:12, 12:] = np.eye(12)
    C[12:, :12], C[12:, 12:] = np.linalg.solve(A[0], -A[2]), np.linalg.solve(A[0], -A[1])
    values, vectors = np.linalg.eig(C)
    real = np.abs(values.imag) < 1e-2 * (1 + np.abs(values.real))
    x = vectors[:12, real].real.T.reshape(-1, 4, 3)
    high, low = x[:, :3].reshape(-1, 9), x[:, 1:].reshape(-1, 9)
    t1 = (high * low).sum(1) / (low * low).sum(1)
    high, low = x[:, :, :2].reshape(-1, 8), x[:, :, 1:].reshape(-1, 8)
    return values[real].real, np.stack([t1, (high * low).sum(1) / (low * low).sum(1)], axis=1)


def last_three(M: list[Array], X: Array) -> list[Array]:
    """a3, a4, a5 with X Rz(a3) M3 Rz(a4) M4 Rz(a5) = I, up to what X is off: both solutions for a4."""
    goal, z, h = inverse(X), M[3][2, :3], M[4][:3, 2]
    c, s = z[0] * h[0] + z[1] * h[1], z[1] * h[0] - z[0] * h[1]
    size = max(float(np.hypot(c, s)), 1e-300)
    away = np.arccos(np.clip((goal[2, 2] - z[2] * h[2]) / size, -1, 1))
    found = []
    for a4 in (np.arctan2(s, c) + away, np.arctan2(s, c) - away):
        inner = M[3] @ about_z(a4) @ M[4]
        a3 = np.angle(complex(goal[0, 2], goal[1, 2]) * complex(inner[0, 2], -inner[1, 2]))
        rest = inverse(about_z(a3) @ inner) @ goal
        found.append(np.array([a3, a4, np.arctan2(rest[1, 0], rest[0, 0])]))
    return found


def candidates(links: list[Array], number: int, shift: Array) -> list[Array]:
    """Configurations near solutions, by one formulation: where the loop starts, and which way it is read."""
    first, backwards = number % 6, number >= 6
    order = [(first + j) % 6 for j in range(6)]
    M = [inverse(links[5 if k == 5 else 4 - k]) if backwards else links[k] for k in order]
    turned = [M[0] @ about_z(shift[1]), M[1] @ about_z(shift[2]), *M[2:5], M[5] @ about_z(shift[0])]
    try:
        t0, others = half_tangents(equations(turned))
    except np.linalg.LinAlgError:
        return []
    found = []
    for t, two in zip(t0, others, strict=True):
        a = 2 * np.arctan([t, *two]) + shift
        X = M[5] @ about_z(a[0]) @ M[0] @ about_z(a[1]) @ M[1] @ about_z(a[2]) @ M[2]
        for rest in last_three(M, X):
            q = np.empty(6)
            for k, angle in zip(order, [*a, *rest], strict=True):
                q[5 - k if backwards else k] = -angle if backwards else angle
            found.append(q)
    return found


def is_beyond_reach(between: list[Array], closing: Array) -> bool:
    """Whether the link that the goal makes of tip and base is longer than all the others together."""
    others = sum(float(np.linalg.norm(link[:3, 3])) for link in between)
    return float(np.linalg.norm(closing[:3, 3])) > (1 + 1e-9) * others


def solve_by_companion(arm: dict[str, Any], T: Array, idle: Array) -> Solutions:
    """All solutions of formulations that suit the arm, until two agree that there are no more.

    Where a family runs through every value of the first angle there is nothing to find: descents lead to it.
    """
    plan = arm["plan"]
    found: list[Array] = []
    goal = T.copy()
    goal[:3, 3] /= arm["length"]
    links = [*plan["frames"]["between"], plan["frames"]["last"] @ inverse(goal) @ plan["frames"]["first"]]
    if is_beyond_reach(plan["frames"]["between"], links[5]):
        return answer(arm, T, found)
    agreed = 0
    for trial in range(TRIALS):
        for number in plan["order"][:4]:
            shift = np.pi * (2 * np.mod((trial + 1) * np.array([0.618, 0.445, 0.287]) + 0.1 * number, 1) - 1)
            before = len(found)
            for q in candidates(links, number, shift):
                if not any(gap(arm, q, other) < 1e-7 for other in found):
                    admit(arm, T, found, q, 10)
            agreed = agreed + 1 if len(found) == before else 0
            if found and agreed == 2 and len(found) % 2 == 0:
                return answer(arm, T, found)
        if not found:
            return solve_by_sample(arm, T, idle)
    return answer(arm, T, found, complete=False)
