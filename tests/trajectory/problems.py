"""Random problems of motions from state to state."""

from __future__ import annotations

import numpy as np

MAGNITUDES = ("velocity", "acceleration", "jerk")


def random_problem(rng, dof=3, kind="any"):
    """Arguments of state_to_state. kind: "any", "rest" (at both ends) or "steps" (small multiples of 1/2)."""
    if kind == "steps":
        q, v, a = (rng.integers(-4, 5, (2, dof)) / 2.0 for _ in range(3))
        limits = {name: rng.integers(1, 5, dof) / 2.0 for name in MAGNITUDES}
    else:
        q = rng.uniform(-3, 3, (2, dof))
        v, a = (np.zeros((2, dof)) if kind == "rest" else rng.uniform(-1, 1, (2, dof)) for _ in range(2))
        limits = {name: np.exp(rng.uniform(-1, 2, dof)) for name in MAGNITUDES}
    a[1] = np.clip(a[1], -limits["acceleration"], limits["acceleration"])
    # Velocities at the goal that are within limits, also before and after the acceleration there.
    room = 0.95 * limits["velocity"]
    a[1] *= np.minimum(1.0, np.sqrt(room * limits["jerk"]) / np.maximum(np.abs(a[1]), 1e-9))
    room = room - a[1] ** 2 / (2.0 * limits["jerk"])
    v[1] = np.clip(v[1], -room, room)
    return {
        "start": q[0],
        "goal": q[1],
        "start_velocity": v[0],
        "goal_velocity": v[1],
        "start_acceleration": a[0],
        "goal_acceleration": a[1],
        **limits,
    }


def within_limits(problem):
    """The problem with a start that is within limits and not bound to leave them."""
    limits = {name: problem[name] for name in MAGNITUDES}
    a = np.clip(problem["start_acceleration"], -limits["acceleration"], limits["acceleration"])
    room = 0.95 * limits["velocity"]
    a = a * np.minimum(1.0, np.sqrt(room * limits["jerk"]) / np.maximum(np.abs(a), 1e-9))
    room = room - a**2 / (2.0 * limits["jerk"])
    return problem | {
        "start_acceleration": a,
        "start_velocity": np.clip(problem["start_velocity"], -room, room),
    }
