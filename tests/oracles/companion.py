"""All solutions of six revolute joints by a 24 × 24 companion matrix (Manocha and Canny 1994).

A slow restatement in plain numpy: the fourteen equations of Raghavan and Roth (1993) are built by evaluating
both sides of the loop, the right side is taken out by a null space, and the hidden angle's half-tangent is an
eigenvalue. Every candidate is polished by Newton's method and judged by its residual.
"""

from __future__ import annotations

import numpy as np

from oracles.ik_many_starts import distinct, levenberg_marquardt

QUARTERS = (0.0, np.pi / 2, np.pi)


def rz(angle):
    c, s = np.cos(angle), np.sin(angle)
    T = np.eye(4)
    T[:2, :2] = [[c, -s], [s, c]]
    return T


def frame_on(axis, point):
    z = axis / np.linalg.norm(axis)
    x = np.cross(z, [1.0, 0, 0] if abs(z[0]) < 0.6 else [0, 1.0, 0])
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = x, np.cross(z, x), z, point
    return T


def fourteen(T):
    """l, p, p × l, (p·p) l − 2 (p·l) p, p·p, p·l of the z axis and the origin of T."""
    l, p = T[:3, 2], T[:3, 3]
    return np.concatenate([l, p, np.cross(p, l), (p @ p) * l - 2 * (p @ l) * p, [p @ p, p @ l]])


def affine(f, *fixed):
    """The coefficients of f in (cos, sin, 1) of each of its angles, from its values at quarter turns."""
    to_coefficients = np.array([[0.5, 0, -0.5], [-0.5, 1, -0.5], [0.5, 0, 0.5]])
    return np.einsum(
        "ia,jb,abn->ijn", to_coefficients, to_coefficients, [[f(a, b) for b in QUARTERS] for a in QUARTERS]
    )


def half_angles(coefficients):
    """From (cos, sin, 1) to the squares and product (t², t, 1) of a half-tangent, times 1 + t²."""
    c, s, one = coefficients
    return np.array([one - c, 2 * s, one + c])


def equations(M):
    """E (3, 6, 9): powers of the hidden half-tangent, the six equations, products of the other two."""
    right = affine(lambda a4, a5: fourteen(rz(-a5) @ np.linalg.inv(M[4]) @ rz(-a4) @ np.linalg.inv(M[3])))
    keep = [(i, j) for i in range(3) for j in range(3) if (i, j) != (2, 2)]
    P = np.array([right[i, j] for i, j in keep]).T  # (14, 8)
    N = np.linalg.svd(P.T)[2][8:]  # six rows that annihilate it
    out = np.empty((3, 3, 3, 14))

    def left(a0):
        return affine(lambda a1, a2: fourteen(M[5] @ rz(a0) @ M[0] @ rz(a1) @ M[1] @ rz(a2) @ M[2]))

    levels = np.array([left(a0) for a0 in QUARTERS])
    levels[:, 2, 2] -= right[2, 2]
    by_a0 = np.array(
        [
            0.5 * (levels[0] - levels[2]),
            levels[1] - 0.5 * (levels[0] + levels[2]),
            0.5 * (levels[0] + levels[2]),
        ]
    )
    for k, slab in enumerate(half_angles(by_a0)):
        by_a1 = half_angles(slab)
        out[k] = np.array([half_angles(row) for row in by_a1])
    return np.einsum("mn,kabn->kmab", N, out).reshape(3, 6, 9)


def companion(E):
    """Real half-tangents of the hidden angle with the vectors (12,) that go with them."""
    A = np.zeros((3, 12, 12))
    A[:, :6, :9] = E
    A[:, 6:, 3:] = E
    inverse = np.linalg.inv(A[0])
    C = np.zeros((24, 24))
    C[:12, 12:] = np.eye(12)
    C[12:, :12], C[12:, 12:] = -inverse @ A[2], -inverse @ A[1]
    values, vectors = np.linalg.eig(C)
    real = np.abs(values.imag) < 1e-3 * (1 + np.abs(values.real))
    return values[real].real, vectors[:12, real].real.T


def all_solutions(axes, points, T_zero, goal, rng):
    """Every configuration (k, 6) that reaches goal (4, 4), angles in (−π, π], as far as this oracle sees."""
    frames = [frame_on(h, p) for h, p in zip(axes, points, strict=True)]
    links = [np.linalg.inv(frames[i]) @ frames[i + 1] for i in range(5)]
    links.append(np.linalg.inv(frames[5]) @ T_zero @ np.linalg.inv(goal) @ frames[0])
    found = []
    for first in range(6):
        M = [links[(first + j) % 6] for j in range(6)]
        shift = rng.uniform(-np.pi, np.pi, 3)  # no angle of a solution may be a half turn from its origin
        try:
            values, vectors = companion(
                equations([M[0] @ rz(shift[1]), M[1] @ rz(shift[2]), *M[2:5], M[5] @ rz(shift[0])])
            )
        except np.linalg.LinAlgError:
            continue
        for t0, x in zip(values, vectors, strict=True):
            top, low = x.reshape(4, 3)[:, :2].ravel(), x.reshape(4, 3)[:, 1:].ravel()
            t1, t2 = (x[:9] @ x[3:]) / (x[3:] @ x[3:]), (top @ low) / (low @ low)
            a = 2 * np.arctan([t0, t1, t2]) + shift
            X = M[5] @ rz(a[0]) @ M[0] @ rz(a[1]) @ M[1] @ rz(a[2]) @ M[2]
            for rest in remaining_angles(M, X):
                q = np.empty(6)
                q[[(first + j) % 6 for j in range(6)]] = [*a, *rest]
                found.append(q)
    if not found:
        return np.empty((0, 6))
    goals = np.tile(goal, (len(found), 1, 1))
    q, left = levenberg_marquardt(axes, points, T_zero, goals, np.array(found), 40)
    q = np.pi - (np.pi - q) % (2 * np.pi)
    return distinct(q[left < 1e-10], 1e-6)


def remaining_angles(M, X):
    """a3, a4, a5 with X Rz(a3) M3 Rz(a4) M4 Rz(a5) = I, up to what X is off: a4 by its height, both signs."""
    M3, M4 = M[3], M[4]
    goal = np.linalg.inv(X)  # Rz(a3) M3 Rz(a4) M4 Rz(a5)
    z, h = M3[2, :3], M4[:3, 2]  # the z component of z₅: z · Rz(a4) h
    c, s, one = z[0] * h[0] + z[1] * h[1], z[1] * h[0] - z[0] * h[1], z[2] * h[2]
    size, level = np.hypot(c, s), goal[2, 2] - one
    mean, away = np.arctan2(s, c), np.arccos(np.clip(level / max(size, 1e-300), -1, 1))
    for a4 in (mean + away, mean - away):
        inner = M3 @ rz(a4) @ M4
        a3 = np.arctan2(
            inner[0, 2] * goal[1, 2] - inner[1, 2] * goal[0, 2],
            inner[0, 2] * goal[0, 2] + inner[1, 2] * goal[1, 2],
        )
        last = np.linalg.inv(rz(a3) @ inner) @ goal
        yield a3, a4, np.arctan2(last[1, 0], last[0, 0])
