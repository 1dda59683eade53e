"""Random paths, and how far a motion along one exceeds limits between the places of its grid."""

from __future__ import annotations

import numpy as np

import cspace as cs
from cspace.trajectory import Path, TimedPath

MAKERS = {
    "cubic": lambda w: cs.spline(w),
    "quintic": lambda w: cs.spline(w, 5),
    "clamped": lambda w: cs.spline(w, ends="clamped"),
    "centripetal": lambda w: cs.spline(w, spacing="centripetal"),
    "blend": lambda w: cs.blend(w, 0.1),
    "circular": lambda w: cs.blend(w, 0.1, kind="circular"),
    "corners": lambda w: cs.blend(w, 0.0),
    "b_spline": lambda w: cs.trajectory.b_spline(w, min(3, len(w) - 1)),
}


def random_waypoints(rng: np.random.Generator, most: int = 50, dof: int | None = None) -> np.ndarray:
    """From two to `most` waypoints of one to eight joints; some are the same, collinear or turn back."""
    n = dof or int(rng.integers(1, 9))
    w = rng.uniform(-1.5, 1.5, (int(rng.integers(2, most + 1)), n))
    for i in range(2, len(w)):
        kind = rng.random()
        if kind < 0.05:
            w[i] = w[i - 1]
        elif kind < 0.1:
            w[i] = 2.0 * w[i - 1] - w[i - 2]
        elif kind < 0.15:
            w[i] = w[i - 2]
        elif kind < 0.2:
            w[i] = w[i - 1] + 1e-9 * rng.normal(size=n)
    return w


def excess(timed: TimedPath, velocity: np.ndarray, acceleration: np.ndarray, parts: int = 10) -> float:
    """By which share a motion exceeds a limit at most, at places between those of its grid."""
    most = 0.0
    for share in np.linspace(0.0, 1.0, parts + 1):
        at = timed._look_at((float(share),))
        slope, bend = (timed.path.evaluate_pieces(at.piece, at.local, order) for order in (1, 2))
        qd = slope * at.speed[:, None]
        qdd = bend * at.speed[:, None] ** 2 + slope * at.acceleration[:, None]
        most = max(most, float((np.abs(qd) / velocity).max()), float((np.abs(qdd) / acceleration).max()))
    return most - 1.0


def line(length: float = 1.0, dof: int = 1) -> Path:
    """A straight line of that length in each joint."""
    return cs.spline(np.array([np.zeros(dof), np.full(dof, length)]))
