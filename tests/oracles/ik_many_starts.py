"""Inverse kinematics in the plainest way: Levenberg–Marquardt from many starts, all solutions that come out.

Nothing here looks at the geometry of the arm: the product of exponentials, the geometric Jacobian, a damped
step (Levenberg 1944, Marquardt 1963). Slow and only as complete as its starts are many.
"""

import numpy as np


def rotations(axis, angle):
    """Rodrigues' formula for many angles: (k, 3, 3)."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * K + (1 - c) * (K @ K)


def forward(axes, points, T_zero, q, slides=None):
    """Tip rotation (k, 3, 3), tip position (k, 3) and Jacobian (k, 6, n), rows [v; ω]."""
    k, n = q.shape
    slides = np.zeros(n, dtype=bool) if slides is None else slides
    R, t = np.tile(np.eye(3), (k, 1, 1)), np.zeros((k, 3))
    h, p = np.empty((n, k, 3)), np.empty((n, k, 3))
    for i in range(n):
        h[i], p[i] = R @ axes[i], R @ points[i] + t
        if slides[i]:
            t = t + q[:, i, None] * h[i]
            continue
        turn = rotations(axes[i], q[:, i])
        t = t + np.einsum("kij,kj->ki", R, points[i] - turn @ points[i])
        R = R @ turn
    t = R @ T_zero[:3, 3] + t
    R = R @ T_zero[:3, :3]
    turns = np.where(slides, 0.0, 1.0)[:, None, None]
    v = np.where(np.asarray(slides)[:, None, None], h, np.cross(h, t - p))
    return R, t, np.concatenate([v, turns * h], axis=2).transpose(1, 2, 0)


def rotation_vectors(R):
    """Twice the vector part of R's quaternion: a measure of rotation that is smooth up to a half turn."""
    w = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    cos_half = np.sqrt(np.maximum(1 + np.trace(R, axis1=1, axis2=2), 1e-12)) / 2
    return w / (2 * cos_half[:, None])


def pose_errors(axes, points, T_zero, goals, q, slides=None):
    """[Δp; Δrotation] (k, 6) and the Jacobian (k, 6, n)."""
    R, t, J = forward(axes, points, T_zero, q, slides)
    turn = rotation_vectors(goals[:, :3, :3] @ R.transpose(0, 2, 1))
    return np.concatenate([goals[:, :3, 3] - t, turn], axis=1), J


def levenberg_marquardt(axes, points, T_zero, goals, q, steps, slides=None):
    """Every start (k, n) walked towards its goal (k, 4, 4); returns q and the error left (k,)."""
    q, damping = q.copy(), np.full(len(q), 1e-2)
    e, J = pose_errors(axes, points, T_zero, goals, q, slides)
    identity = np.eye(q.shape[1])
    for _ in range(steps):
        JT = J.transpose(0, 2, 1)
        A = JT @ J + damping[:, None, None] * identity
        step = np.linalg.solve(A, (JT @ e[:, :, None]))[:, :, 0]
        trial = q + step
        e_trial, J_trial = pose_errors(axes, points, T_zero, goals, trial, slides)
        better = np.linalg.norm(e_trial, axis=1) < np.linalg.norm(e, axis=1)
        q[better], e[better], J[better] = trial[better], e_trial[better], J_trial[better]
        damping = np.clip(np.where(better, damping / 5, damping * 4), 1e-14, 1e3)
    return q, np.linalg.norm(e, axis=1)


def distinct(q, apart, slides=False):
    """One of each bunch of configurations (k, n) that agree within `apart` [rad], turns on the circle."""
    kept = np.empty((0, q.shape[1]))
    while len(q):
        kept = np.vstack([kept, q[:1]])
        gap = q - q[0]
        gap = np.where(slides, gap, (gap + np.pi) % (2 * np.pi) - np.pi)
        q = q[np.abs(gap).max(axis=1) > apart]
    return kept


def all_solutions(
    axes, points, T_zero, goals, *, joint_types=None, starts=400, steps=60, rng=0, near=1e-9, apart=1e-5
):
    """For each goal (m, 4, 4) the solutions found, a list of (k_i, n) arrays with angles in (−π, π].

    joint_types: "R" or "P" each, all "R" unless given. Lengths are first brought to the size of radians.
    near: largest error of a solution (scaled lengths, rad); apart: solutions closer than this are one [rad].
    """
    rng = np.random.default_rng(rng)
    size = np.abs(np.vstack([points - points[0], T_zero[None, :3, 3] - points[0]])).max() or 1.0
    points, T_zero, goals = points / size, T_zero.copy(), goals.copy()
    T_zero[:3, 3] /= size
    goals[:, :3, 3] /= size
    m, n = len(goals), len(axes)
    slides = np.array([kind == "P" for kind in joint_types or n * "R"])
    q = rng.uniform(-np.pi, np.pi, (m * starts, n))
    q, left = levenberg_marquardt(axes, points, T_zero, np.repeat(goals, starts, axis=0), q, steps, slides)
    q = np.where(slides, size * q, np.pi - np.mod(np.pi - q, 2 * np.pi))
    q, left = q.reshape(m, starts, n), left.reshape(m, starts)
    return [distinct(row[ok], apart, slides) for row, ok in zip(q, left < near, strict=True)]
