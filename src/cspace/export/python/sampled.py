"""Descents from configurations spread over the joints: what they find is a sample of the solutions."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.export.python.base import Array, Solutions, admit, answer, measure, units

__all__ = ["solve_by_sample"]

STARTS = 96


def spread(arm: dict[str, Any], k: int) -> Array:
    """Joints spread without a pattern over the circle, slides over twice the arm's length to either side."""
    i = np.arange(len(arm["axes"]))
    turns = 0.5 + (k + 1) * 0.6180339887498949 * (i + 1) + 0.7548776662466927 * i * i
    return np.asarray((2 * np.mod(turns, 1.0) - 1) * np.where(arm["slides"], 2 * arm["length"], np.pi))


def fall(arm: dict[str, Any], goal: Array, q: Array, steps: int = 30) -> Array:
    """A damped descent towards the goal, cheap and without an end."""
    damping = 1e-2
    e, J = measure(arm, goal, q)
    for _ in range(steps):
        step = np.linalg.solve(J.T @ J + damping * np.eye(len(q)), J.T @ e)
        trial = q + units(arm) * step
        e_trial, J_trial = measure(arm, goal, trial)
        if e_trial @ e_trial < e @ e:
            q, e, J, damping = trial, e_trial, J_trial, max(damping / 5, 1e-14)
        else:
            damping *= 4
        if e @ e < 1e-16:
            break
    return q


def solve_by_sample(arm: dict[str, Any], T: Array, idle: Array) -> Solutions:
    """What many starts lead to, the idle configuration first."""
    found: list[Array] = []
    for start in [idle, *(spread(arm, k) for k in range(STARTS))]:
        q = fall(arm, T, start)
        if np.linalg.norm(measure(arm, T, q)[0]) < 1e-3:
            admit(arm, T, found, q)
        if len(found) == 16:
            break
    return answer(arm, T, found, complete=False)
