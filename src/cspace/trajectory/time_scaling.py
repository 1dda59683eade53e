"""Polynomials from state to state: cubic, quintic (minimum jerk) and septic, in a given or the shortest
time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.model import Limits
from cspace.tolerances import FARTHEST, LIMIT_ROUNDING
from cspace.trajectory.polynomials import PolynomialTrajectory, attain_end
from cspace.trajectory.states import check_length

BOUNDARY_ORDERS: Final = {"cubic": 2, "quintic": 3, "septic": 4, "minimum_jerk": 3}
"""How many derivatives each polynomial attains at both ends, the position among them. Of all motions with
given positions, velocities and accelerations at both ends the quintic has the least integral of squared jerk
(Flash and Hogan 1985)."""

PEAKS: Final = {
    "cubic": (1.5, 6.0, 12.0),
    "quintic": (1.875, 10.0 / math.sqrt(3.0), 60.0),
    "minimum_jerk": (1.875, 10.0 / math.sqrt(3.0), 60.0),
    "septic": (2.1875, 84.0 * math.sqrt(5.0) / 25.0, 52.5),
}
"""The largest velocity, acceleration and jerk of each polynomial from 0 to 1 in one second, from rest to
rest."""

DOUBLINGS: Final = 60
"""Of a duration that is too short."""

SAMPLES_AT_ONCE: Final = 5000
"""Samples between two steps at which an interrupt is heeded."""

HALVINGS: Final = 40
"""Of the interval between a duration that is too short and one that is not: to twelve digits."""


def state_polynomials(states: Array, h: Array) -> Array:
    """The coefficients (..., dof, 2 m) of the polynomials that attain states at both ends; inf or NaN where
    they exceed the range of numbers.

    states (..., 2, m, dof): derivatives 0 … m − 1 at times 0 and h (...).
    """
    m = states.shape[-2]
    n = 2 * m
    scale = np.stack([h**k / math.factorial(k) for k in range(m)], axis=-1)[..., None]
    low, ends = scale * states[..., 0, :, :], scale * states[..., 1, :, :]
    binomials = np.array([[math.comb(i, k) for i in range(n)] for k in range(m)], dtype=float)
    high = np.linalg.inv(binomials[:, m:]) @ (ends - binomials[:, :m] @ low)
    powers = h[..., None, None] ** np.arange(n)
    with np.errstate(over="ignore", invalid="ignore"):
        coefficients: Array = np.swapaxes(np.concatenate([low, high], axis=-2), -1, -2) / powers
    factorials = np.array([math.factorial(k) for k in range(m)], dtype=float)
    coefficients[..., :m] = np.swapaxes(states[..., 0, :, :], -1, -2) / factorials  # without rounding
    return coefficients


def connect_samples(times: Array, states: Array, joint_names: Sequence[str] | None) -> PolynomialTrajectory:
    """The polynomials through states (k, m, dof) at times (k,), from 0 on.

    Raises InputError for samples whose polynomial exceeds the range of numbers.
    """
    if len(times) == 1:
        return connect_states(states[[0, 0]], 0.0, joint_names)
    _, m, dof = states.shape
    pieces = np.empty((dof, len(times) - 1, 2 * m))
    for begin in range(0, len(times) - 1, SAMPLES_AT_ONCE):  # an interrupt comes between two steps
        rows = slice(begin, begin + SAMPLES_AT_ONCE + 1)
        ends = np.stack([states[rows][:-1], states[rows][1:]], axis=1)
        with np.errstate(all="ignore"):  # of times that are anything
            made = state_polynomials(ends, np.diff(times[rows]))
        beyond = ~np.isfinite(made).all(axis=(1, 2)) | (np.abs(ends) > FARTHEST).any(axis=(1, 2, 3))
        if beyond.any():
            k = begin + int(np.argmax(beyond))
            raise InputError(
                f"the motion from sample {k} at {times[k]:g} s to the next exceeds the range of numbers;"
                " they are too large, or too close in time"
            )
        pieces[:, begin : begin + len(made)] = np.swapaxes(made, 0, 1)
    parts = attain_end(times, pieces, states[-1])
    return PolynomialTrajectory(*parts, joint_names=joint_names)


def connect_states(
    states: Array, h: float, joint_names: Sequence[str] | None, reason: str = ""
) -> PolynomialTrajectory:
    """The polynomials between two states: the first half given from the start, the second from the end.

    states (2, m, dof): derivatives 0 … m − 1 at both ends.
    """
    check_length(h)
    m, dof = states.shape[1:]
    if h == 0.0:
        still = np.zeros((dof, 1, 4))
        still[:, 0, 0] = states[1, 0]
        return PolynomialTrajectory([0.0, 0.0], still, joint_names=joint_names, reason=reason)
    signs = (-1.0) ** np.arange(m)
    length = np.array(h)
    back = state_polynomials(signs[:, None] * states[::-1], length) * (-1.0) ** np.arange(2 * m)
    pieces = np.stack([state_polynomials(states, length), back], axis=1)
    origins = np.broadcast_to([0.0, h], (dof, 2))
    return PolynomialTrajectory([0.0, h / 2, h], pieces, origins, joint_names=joint_names, reason=reason)


def find_rest_duration(profile: str, displacement: Array, limits: Limits) -> float:
    """The shortest duration from rest to rest: of the joint that needs most."""
    size, longest = np.abs(displacement), 0.0
    kinds = (limits.velocity, limits.acceleration, limits.jerk)
    for k, (peak, limit) in enumerate(zip(PEAKS[profile], kinds, strict=True), 1):
        with np.errstate(over="ignore"):
            longest = max(longest, float(np.max((peak * size / limit) ** (1.0 / k), initial=0.0)))
    return longest


def find_duration(profile: str, states: Array, limits: Limits, labels: Sequence[str]) -> float:
    """A duration in which the polynomials keep all limits: the shortest from rest to rest; between moving
    states the end of the first interval of durations found by doubling.

    Raises InputError where a boundary state is beyond a limit, or where no duration is long enough.
    """
    h = find_rest_duration(profile, states[1, 0] - states[0, 0], limits)
    if not states[:, 1:].any():
        return h
    check_boundary(states, limits, labels)
    with np.errstate(over="ignore"):
        speeds = np.abs(states[:, 1]) / limits.acceleration
    low, high = 0.0, max(h, float(speeds.max(initial=0.0)), LIMIT_ROUNDING)
    for _ in range(DOUBLINGS):
        if connect_states(states, high, None).check(limits):
            break
        low, high = high, 2.0 * high
    else:
        raise InputError(
            f"no {profile} motion between these states keeps the limits; use profile='double_s', or give"
            " other velocities and accelerations"
        )
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        kept = bool(connect_states(states, middle, None).check(limits))
        low, high = (low, middle) if kept else (middle, high)
    return high


def check_boundary(states: Array, limits: Limits, labels: Sequence[str]) -> None:
    """InputError for a velocity or an acceleration at an end that exceeds its limit."""
    for k, kind in enumerate(("velocity", "acceleration")[: states.shape[1] - 1], 1):
        most = getattr(limits, kind)
        for end, values in zip(("start", "goal"), states[:, k], strict=True):
            bad = np.flatnonzero(np.abs(values) > most)
            if bad.size:
                j = int(bad[0])
                raise InputError(
                    f"{end}_{kind} of {labels[j]} is {values[j]:g}; it must be within ±{most[j]:g}"
                )
