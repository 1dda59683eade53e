"""Boundary states of motions: what callers pass, checked, as one array."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, leading_axes, positive_number
from cspace.errors import InputError
from cspace.tolerances import FARTHEST, LEAST_FACTOR

PARTS: Final = ("", "velocity", "acceleration")
"""What the names of arguments end with, by order of the derivative."""


class AxisLimits:
    """Limits of all joints, rows (5, dof): highest and lowest velocities, likewise accelerations, jerks."""

    def __init__(
        self,
        velocity: ArrayLike,
        acceleration: ArrayLike,
        jerk: ArrayLike | None,
        lowest_velocity: ArrayLike | None,
        lowest_acceleration: ArrayLike | None,
        dof: int,
    ) -> None:
        self.rows = np.empty((5, dof))
        read_magnitudes(velocity, "velocity", self.rows[0])
        read_lowest(lowest_velocity, "lowest_velocity", self.rows[0], self.rows[1])
        read_magnitudes(acceleration, "acceleration", self.rows[2])
        read_lowest(lowest_acceleration, "lowest_acceleration", self.rows[2], self.rows[3])
        read_magnitudes(jerk, "jerk", self.rows[4])


def read_states(
    positions: Any, velocities: Any, accelerations: Any, subject: str, dof: int | None = None
) -> Array:
    """Positions, velocities and accelerations of a boundary as one array (..., 3, dof); None is zero."""
    q = as_floats(positions, subject, last=(dof,), largest=FARTHEST)
    n, parts = q.shape[-1], {subject: q}
    for order, value in enumerate((velocities, accelerations), 1):
        if value is None:
            continue
        name = f"{subject}_{PARTS[order]}"
        row = as_floats(value, name, largest=FARTHEST)
        if row.ndim and row.shape[-1] != n:
            raise InputError(f"{name} has shape {row.shape}, expected (..., {n}), one per joint")
        parts[name] = row
    shape = q.shape[:-1]
    if any(row.ndim > 1 for row in parts.values()):
        shape = leading_axes(**{name: row.shape[:-1] for name, row in parts.items()})
    states = np.zeros((*shape, 3, n))
    for name, row in parts.items():
        states[..., PARTS.index(name.removeprefix(subject).lstrip("_")), :] = row
    return states


def read_magnitudes(value: ArrayLike | None, subject: str, out: Array) -> None:
    """Write limits above zero into out (dof,); inf and None are none. One number is that of all joints.

    Finite limits beyond FARTHEST are refused: their cubes overflow.
    """
    if value is None:
        out[...] = np.inf
        return
    row = as_floats(value, subject, finite=False)
    if row.shape not in ((), out.shape):
        raise InputError(f"{subject} has shape {row.shape}, expected () or {out.shape}, one per joint")
    out[...] = row
    if not (out > 0.0).all():
        raise InputError(f"{subject} contains {float(row[~(row > 0.0)].flat[0]):g}; it must be above zero")
    too_large = np.isfinite(out) & (out > FARTHEST)
    if too_large.any():
        raise InputError(
            f"{subject} contains {float(out[too_large][0]):g}; it must not exceed {FARTHEST:g}; inf or None"
            " is no limit"
        )


def read_lowest(value: ArrayLike | None, subject: str, highest: Array, out: Array) -> None:
    """Write lowest velocities or accelerations, below zero, into out (dof,); None mirrors the highest."""
    if value is None:
        np.negative(highest, out=out)
        return
    row = as_floats(value, subject, finite=False)
    if not (row < 0.0).all():
        raise InputError(f"{subject} contains {float(row[~(row < 0.0)].flat[0]):g}; it must be below zero")
    read_magnitudes(-row, subject, out)
    np.negative(out, out=out)


def check_accelerations(limits: AxisLimits, labels: Sequence[str]) -> None:
    """InputError for a joint with neither a limit of acceleration nor one of jerk."""
    rows = limits.rows
    if np.isfinite(rows[2:4]).all():
        return
    free = np.isinf(rows[4]) & np.isinf(rows[2:4]).any(axis=0)
    if free.any():
        name = labels[int(np.flatnonzero(free)[0])]
        raise InputError(f"{name} has no limit of acceleration and none of jerk; give at least one")


def check_goal(goal: Array, limits: AxisLimits, labels: Sequence[str]) -> None:
    """InputError for a goal (..., 3, dof) that is beyond limits, or that no motion within them leads to."""
    if not goal[..., 1:, :].any():
        return
    v_max, v_min, a_max, a_min, jerk = limits.rows
    v, a = goal[..., 1, :], np.where(np.isfinite(jerk), goal[..., 2, :], 0.0)
    before = a * np.abs(a) / (2.0 * jerk)  # the velocity that a jerk at its limit adds since a = 0
    for name, value, low, high in (
        ("goal_velocity", v, v_min, v_max),
        ("goal_acceleration", a, a_min, a_max),
        ("the velocity before goal_acceleration", v - before, v_min, v_max),
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
    if value is None:
        return None
    seconds = positive_number(value, subject, largest=1.0 / LEAST_FACTOR)
    if seconds < LEAST_FACTOR:
        raise InputError(f"{subject} is {seconds:g} s; it must be {LEAST_FACTOR:g} or more")
    return seconds


def check_length(seconds: float) -> None:
    """InputError for a motion that is too long or too short for the range of numbers."""
    if not (seconds == 0.0 or LEAST_FACTOR <= seconds <= 1.0 / LEAST_FACTOR):
        raise InputError(
            f"the motion would last {seconds:g} s; give limits and states with which it lasts"
            f" {LEAST_FACTOR:g} to {1.0 / LEAST_FACTOR:g} s"
        )
