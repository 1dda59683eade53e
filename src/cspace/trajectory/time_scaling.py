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
from cspace.tolerances import FARTHEST, LIMIT_ROUNDING, NEGLIGIBLE_TERM
from cspace.trajectory.piece_roots import find_piece_roots
from cspace.trajectory.polynomials import (
    PolynomialTrajectory,
    attain_end,
    differentiate_polynomials,
    evaluate_polynomials,
)
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

MOST_JUMPS: Final = 1000
"""Of the search for a duration: it takes five to ten, and more only past windows that just fail to open."""

SAMPLES_AT_ONCE: Final = 5000
"""Samples between two steps at which an interrupt is heeded."""


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


def find_duration(
    profile: str, states: Array, limits: Limits, labels: Sequence[str], cycle: float | None = None
) -> tuple[float, bool]:
    """The shortest duration in which the polynomials keep all limits, and whether there is one.

    Between moving states the durations that keep the limits can be several intervals. The search begins
    below all of them; while a limit is exceeded it jumps to where the place that exceeds it most no longer
    does. cycle [s]: of which the duration is a multiple. Without a duration it is the last one looked at.

    Raises InputError where a boundary state is beyond a limit.
    """
    if not states[:, 1:].any():
        return _round_up(find_rest_duration(profile, states[1, 0] - states[0, 0], limits), cycle), True
    check_boundary(states, limits, labels)
    changes = states[1] - states[0]
    if not changes.any():
        return 0.0, True
    most = np.array([limits.velocity, limits.acceleration, limits.jerk])
    with np.errstate(over="ignore"):
        h = max(float(np.max(np.abs(changes[:3]) / most[: len(changes[:3])])), LIMIT_ROUNDING)
    parts = _split_by_power(states)
    for _ in range(MOST_JUMPS):
        check_length(h)
        h = _round_up(h, cycle)
        until = _leave_violations(parts, h, most)
        if until <= h:
            return h, True
        if until == np.inf:
            break
        h = until
    return h, False


def _round_up(h: float, cycle: float | None) -> float:
    """The first multiple of a cycle from h on, but for roundings; h without a cycle."""
    return h if cycle is None else math.ceil(h / cycle * (1.0 - 4.0 * np.finfo(float).eps)) * cycle


def _split_by_power(states: Array) -> Array:
    """What multiplies hᵏ in the polynomials of the share of a duration h (dof, m, 2 m), by k and by power."""
    m = states.shape[1]
    basis = state_polynomials(np.eye(2 * m).reshape(2, m, 2 * m), np.array(1.0)).reshape(2, m, 2 * m)
    return np.asarray(np.einsum("ekj,ekn->jkn", states, basis))


def _leave_violations(parts: Array, h: float, most: Array) -> float:
    """The duration up to which limits that are exceeded at h stay so; h if none is, inf if they always are.

    Of each joint and order the place of the largest value is kept. There the value is a polynomial of the
    duration, which crosses the limit at a root.
    """
    powers, until = h ** np.arange(parts.shape[1]) @ parts, h
    begin = np.zeros(len(powers))
    for order, limits in enumerate(most, 1):
        rates = differentiate_polynomials(powers, order + 1)
        places = np.nan_to_num(find_piece_roots(rates, begin, begin + 1.0))
        places = np.concatenate([places, begin[:, None], begin[:, None] + 1.0], axis=1)
        values = evaluate_polynomials(powers[:, None], places, order)
        for j, k in enumerate(np.abs(values).argmax(axis=1)):
            if abs(values[j, k]) > limits[j] * h**order * (1.0 + 0.5 * LIMIT_ROUNDING):
                at_place = evaluate_polynomials(parts[j], places[j, k], order) * np.sign(values[j, k])
                until = max(until, _next_crossing(at_place, limits[j], order, h))
    return until


def _next_crossing(values: Array, limit: float, order: int, h: float) -> float:
    """The first duration after h at which Σ values[k] hᵏ falls to limit · h^order; inf if there is none."""
    excess = np.zeros(max(len(values), order + 1))
    excess[: len(values)] = values
    excess[order] -= limit
    with np.errstate(over="ignore"):
        excess *= h ** np.arange(len(excess))  # a polynomial of the duration in units of h
    excess /= np.abs(excess).max()
    excess[np.abs(excess) < NEGLIGIBLE_TERM] = 0.0
    if not np.isfinite(excess).all():
        return np.inf
    roots = np.roots(excess[::-1])
    later = roots.real[(np.abs(roots.imag) <= LIMIT_ROUNDING * np.abs(roots)) & (roots.real > 1.0)]
    return h * float(later.min(initial=np.inf))


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
