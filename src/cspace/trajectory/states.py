"""Boundary states of motions: what callers pass, checked, as one array."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, leading_axes, positive_number
from cspace.errors import InputError
from cspace.tolerances import FARTHEST


@dataclass(frozen=True, eq=False)
class AxisLimits:
    """Limits of all joints, each (dof,): highest and lowest velocities and accelerations, jerks."""

    velocity: Array
    lowest_velocity: Array
    acceleration: Array
    lowest_acceleration: Array
    jerk: Array

    def stacked(self) -> Array:
        """All limits (5, dof)."""
        return np.stack(
            [self.velocity, self.lowest_velocity, self.acceleration, self.lowest_acceleration, self.jerk]
        )


def read_states(
    positions: Any, velocities: Any, accelerations: Any, subject: str, dof: int | None = None
) -> Array:
    """Positions, velocities and accelerations of a boundary as one array (..., 3, dof); None is zero."""
    q = as_floats(positions, subject, last=(dof,), largest=FARTHEST)
    n = q.shape[-1]
    rows = [q]
    for value, name in ((velocities, "velocity"), (accelerations, "acceleration")):
        row = np.zeros(n) if value is None else as_floats(value, f"{subject}_{name}", largest=FARTHEST)
        if row.ndim and row.shape[-1] != n:
            raise InputError(f"{subject}_{name} has shape {row.shape}, expected (..., {n}), one per joint")
        rows.append(row if row.ndim else np.full(n, float(row)))
    shape = leading_axes(**{f"part {i}": row.shape[:-1] for i, row in enumerate(rows)})
    return np.stack([np.broadcast_to(row, (*shape, n)) for row in rows], axis=-2)


def read_magnitudes(value: ArrayLike, subject: str, dof: int) -> Array:
    """Limits above zero (dof,); infinity is none. One number is that of all joints."""
    row = as_floats(value, subject, finite=False)
    if row.shape not in ((), (dof,)):
        raise InputError(f"{subject} has shape {row.shape}, expected () or ({dof},), one per joint")
    if not (row > 0.0).all():
        raise InputError(f"{subject} contains {float(row[~(row > 0.0)].flat[0]):g}; it must be above zero")
    return np.array(np.broadcast_to(row, (dof,)))


def read_lowest(value: ArrayLike | None, subject: str, highest: Array) -> Array:
    """Lowest velocities or accelerations (dof,), below zero; by default the highest ones mirrored."""
    if value is None:
        return -highest
    row = as_floats(value, subject, finite=False)
    if not (row < 0.0).all():
        raise InputError(f"{subject} contains {float(row[~(row < 0.0)].flat[0]):g}; it must be below zero")
    return -read_magnitudes(-row, subject, len(highest))


def check_accelerations(limits: AxisLimits, labels: Sequence[str]) -> None:
    """InputError for a joint with neither a limit of acceleration nor one of jerk."""
    free = np.isinf(limits.jerk) & (np.isinf(limits.acceleration) | np.isinf(limits.lowest_acceleration))
    if free.any():
        name = labels[int(np.flatnonzero(free)[0])]
        raise InputError(f"{name} has no limit of acceleration and none of jerk; give at least one")


def check_goal(goal: Array, limits: AxisLimits, labels: Sequence[str]) -> None:
    """InputError for a goal (..., 3, dof) that is beyond limits, or that no motion within them leads to."""
    v, a = goal[..., 1, :], np.where(np.isfinite(limits.jerk), goal[..., 2, :], 0.0)
    before = a * np.abs(a) / (2.0 * limits.jerk)  # the velocity that a jerk at its limit adds since a = 0
    for name, value, low, high in (
        ("goal_velocity", v, limits.lowest_velocity, limits.velocity),
        ("goal_acceleration", a, limits.lowest_acceleration, limits.acceleration),
        ("the velocity before goal_acceleration", v - before, limits.lowest_velocity, limits.velocity),
    ):
        bad = np.argwhere((value > high) | (value < low))
        if bad.size:
            index = tuple(map(int, bad[0]))
            j = index[-1]
            raise InputError(
                f"{name} of {labels[j]} is {value[index]:g}; it must be within its limits"
                f" {low[j]:g} … {high[j]:g}"
            )


def read_duration(value: Any, subject: str) -> float | None:
    """A duration [s] above zero, or None."""
    return None if value is None else positive_number(value, subject)
