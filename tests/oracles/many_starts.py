"""Newton's method from many random starts, in plain numpy: what it finds, a complete solver must list."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation


def tip_and_jacobian(axes, points, prismatic, tip, q):
    """Tip (m, 3) and its Jacobian (m, 3, n) for joints q (m, n), by the product of exponentials."""
    m, n = q.shape
    R, t = np.broadcast_to(np.eye(3), (m, 3, 3)), np.zeros((m, 3))
    origins, directions = [], []
    for i in range(n):
        h = R @ axes[i]
        directions.append(h)
        origins.append((R @ points[i]) + t)
        if prismatic[i]:
            t = t + q[:, i : i + 1] * h
        else:
            turn = Rotation.from_rotvec(q[:, i : i + 1] * axes[i]).as_matrix()
            t = t + np.einsum("mij,mj->mi", R, points[i] - turn @ points[i])
            R = R @ turn
    p = R @ tip + t
    columns = [
        h if slides else np.cross(h, p - o)
        for h, o, slides in zip(directions, origins, prismatic, strict=True)
    ]
    return p, np.stack(columns, axis=-1)


def position_roots(axes, points, prismatic, tip, goal, rng, starts=200):
    """Distinct regular joints (k, n) that reach `goal`, angles in (−π, π]."""
    n = len(axes)
    q = rng.uniform(-np.pi, np.pi, (starts, n))
    for _ in range(60):
        p, J = tip_and_jacobian(axes, points, prismatic, tip, q)
        normal = np.swapaxes(J, 1, 2) @ J + 1e-10 * np.eye(n)
        step = np.linalg.solve(normal, np.einsum("mij,mi->mj", J, goal - p)[..., None])[..., 0]
        q = q + step / np.maximum(1.0, np.abs(step).max(axis=1, keepdims=True))
    p, J = tip_and_jacobian(axes, points, prismatic, tip, q)
    regular = np.linalg.svd(J, compute_uv=False)[:, -1] > 1e-3
    q = q[(np.linalg.norm(p - goal, axis=1) < 1e-9) & regular]
    turns = ~np.asarray(prismatic)
    q[:, turns] = np.pi - (np.pi - q[:, turns]) % (2 * np.pi)
    found = []
    for row in q:
        if not any(np.abs(wrapped(row - other, turns)).max() < 1e-5 for other in found):
            found.append(row)
    return np.array(found).reshape(-1, n)


def wrapped(d, turns):
    """Differences of joints (..., n), those of angles modulo a turn."""
    return np.where(turns, 2 * np.sin(0.5 * d), d)
