"""Trajectories of polynomial pieces, each joint with its own knots."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.tolerances import LARGEST_DERIVATIVE
from cspace.trajectory.piece_roots import find_piece_roots
from cspace.trajectory.trajectory import HIGHEST_ORDER, Trajectory, read_factor


class PolynomialTrajectory(Trajectory):
    """A motion whose joints follow polynomials, piece by piece: Σᵢ cᵢ (t − origin)ⁱ.

    knots (k + 1,) or (dof, k + 1) [s]: times from 0 to the duration, which do not decrease; the same for all
    joints, or of each joint. coefficients (dof, k, degree + 1): c₀, c₁, … of each piece. origins (dof, k)
    [s]: where local time is zero, by default at the beginning of each piece. A piece that is given from its
    end attains the state there exactly. joint_names, reason: as in Trajectory.

    Raises InputError for wrong shapes, NaN, and knots that decrease or do not begin at 0.
    """

    def __init__(
        self,
        knots: ArrayLike,
        coefficients: ArrayLike,
        origins: ArrayLike | None = None,
        *,
        joint_names: Sequence[str] | None = None,
        reason: str = "",
    ) -> None:
        c = as_floats(coefficients, "coefficients")
        t = as_floats(knots, "knots")
        if c.ndim != 3 or t.shape not in ((c.shape[1] + 1,), (c.shape[0], c.shape[1] + 1)) or c.size == 0:
            raise InputError(
                f"knots have shape {t.shape}, coefficients {c.shape};"
                " expected (k + 1,) or (dof, k + 1), and (dof, k, degree + 1)"
            )
        t = np.broadcast_to(t, (c.shape[0], c.shape[1] + 1))
        if (t[:, 0] != 0.0).any() or (t[:, -1] != t[0, -1]).any() or (np.diff(t, axis=1) < 0.0).any():
            raise InputError("knots must begin at 0, not decrease, and end at the same time for all joints")
        begins = t[:, :-1] if origins is None else as_floats(origins, "origins")
        if begins.shape != c.shape[:2]:
            raise InputError(f"origins has shape {begins.shape}, expected {c.shape[:2]}")
        self._check_range(t, c, begins)
        self.joint_knots, self.coefficients, self.origins = t, c, begins
        self._turning: dict[int, list[Array]] = {}
        super().__init__(c.shape[0], float(t[0, -1]), joint_names, reason)

    @staticmethod
    def _check_range(knots: Array, coefficients: Array, origins: Array) -> None:
        """InputError where a derivative may exceed the range of numbers."""
        powers = np.arange(coefficients.shape[2])
        with np.errstate(over="ignore", invalid="ignore"):
            reach = np.maximum(1.0, np.abs(knots).max() + np.abs(origins).max())
            sizes = np.maximum(coefficients.max(axis=(0, 1)), -coefficients.min(axis=(0, 1)))
            most = sizes * reach**powers * (1.0 + powers) ** HIGHEST_ORDER
        if not most.sum() <= LARGEST_DERIVATIVE:
            raise InputError(
                "the motion exceeds the range of numbers: its coefficients times powers of its duration are"
                f" larger than {LARGEST_DERIVATIVE:g}"
            )

    @property
    def degree(self) -> int:
        """The highest power of time."""
        return int(self.coefficients.shape[2]) - 1

    @property
    def knots(self) -> Array:
        """The times (k,) [s] at which pieces of the motion begin and end."""
        return np.unique(self.joint_knots)

    def _evaluate_joint(self, joint: int, times: Array, order: int, before: bool) -> Array:
        side = "left" if before else "right"
        piece = np.searchsorted(self.joint_knots[joint, 1:-1], times, side=side)  # type: ignore[call-overload]
        local = times - self.origins[joint, piece]
        return evaluate_polynomials(self.coefficients[joint, piece], local, order)

    def _turning_times(self, order: int) -> list[Array]:
        if order not in self._turning:
            self._turning[order] = self._find_turning_times(order)
        return self._turning[order]

    def _find_turning_times(self, order: int) -> list[Array]:
        rates = differentiate_polynomials(self.coefficients, order + 1)
        begin, end = self.joint_knots[:, :-1] - self.origins, self.joint_knots[:, 1:] - self.origins
        roots = find_piece_roots(rates.reshape(-1, rates.shape[-1]), begin.ravel(), end.ravel())
        times = roots.reshape(*begin.shape, roots.shape[-1]) + self.origins[..., None]
        times = np.clip(times, self.joint_knots[:, :-1, None], self.joint_knots[:, 1:, None])
        rows = [np.concatenate([t[np.isfinite(t)], k]) for t, k in zip(times, self.joint_knots, strict=True)]
        return [np.unique(row) for row in rows]

    def scaled(self, factor: float) -> PolynomialTrajectory:
        """The same path, slower by a factor: its duration is multiplied by it.

        Raises InputError for a factor that is not above zero.
        """
        factor = read_factor(factor)
        powers = factor ** -np.arange(self.degree + 1.0)
        return self._made_of(self.joint_knots * factor, self.coefficients * powers, self.origins * factor)

    def reversed(self) -> PolynomialTrajectory:
        """The same motion backwards in time."""
        signs = (-1.0) ** np.arange(self.degree + 1)
        knots = (self.duration - self.joint_knots)[:, ::-1]
        return self._made_of(
            knots, (self.coefficients * signs)[:, ::-1], (self.duration - self.origins)[:, ::-1]
        )

    def _join(self, other: Trajectory) -> Trajectory:
        if not isinstance(other, PolynomialTrajectory):
            return super()._join(other)
        degree = max(self.degree, other.degree)
        parts = [
            np.pad(each.coefficients, ((0, 0), (0, 0), (0, degree - each.degree))) for each in (self, other)
        ]
        knots = np.concatenate([self.joint_knots, self.duration + other.joint_knots[:, 1:]], axis=1)
        origins = np.concatenate([self.origins, self.duration + other.origins], axis=1)
        return PolynomialTrajectory(
            knots,
            np.concatenate(parts, axis=1),
            origins,
            joint_names=self.joint_names or other.joint_names,
            reason=self.reason or other.reason,
        )

    @classmethod
    def _trusted(
        cls,
        knots: Array,
        coefficients: Array,
        origins: Array,
        duration: float,
        joint_names: tuple[str, ...] | None,
        reason: str,
    ) -> PolynomialTrajectory:
        """A motion of arrays that need no check."""
        made = cls.__new__(cls)
        made.joint_knots, made.coefficients, made.origins = knots, coefficients, origins
        made.dof, made.duration, made.joint_names, made.reason = len(knots), duration, joint_names, reason
        made._turning = {}
        return made

    def _made_of(self, knots: Array, coefficients: Array, origins: Array) -> PolynomialTrajectory:
        return PolynomialTrajectory(
            knots, coefficients, origins, joint_names=self.joint_names, reason=self.reason
        )


def differentiate_polynomials(coefficients: Array, order: int) -> Array:
    """The coefficients (..., n) of derivatives of polynomials (..., m); at least one, which may be zero."""
    n = coefficients.shape[-1]
    if order >= n:
        return np.zeros((*coefficients.shape[:-1], 1))
    factors = np.array([math.perm(i, order) for i in range(order, n)], dtype=float)
    rates: Array = coefficients[..., order:] * factors
    return rates


def evaluate_polynomials(coefficients: Array, t: Array, order: int = 0) -> Array:
    """Derivatives (...) of polynomials with coefficients (..., n) at t (...), by Horner's rule."""
    rates = differentiate_polynomials(coefficients, order)
    value: Array = rates[..., -1].copy()
    for i in range(rates.shape[-1] - 2, -1, -1):
        value = value * t + rates[..., i]
    return value


def expand_at_end(coefficients: Array, h: Array) -> Array:
    """Polynomials (..., n) of t as polynomials of t − h, for h (...)."""
    n = coefficients.shape[-1]
    rows = [evaluate_polynomials(coefficients, h, i) / math.factorial(i) for i in range(n)]
    return np.stack(rows, axis=-1)


def attain_end(knots: Array, coefficients: Array, end: Array) -> tuple[Array, Array, Array]:
    """Pieces whose last one is given from its end in its second half, where it attains a state exactly.

    knots (k + 1,) [s], coefficients (dof, k, n) in time from the beginning of each piece; end (m, dof): q,
    qd, qdd, … at the end. Returns knots (k + 2,), coefficients (dof, k + 1, n) and origins (dof, k + 1).
    """
    begin, stop = knots[-2], knots[-1]
    last = expand_at_end(coefficients[:, -1], np.full(len(coefficients), stop - begin))
    for i, row in enumerate(end):
        last[:, i] = row / math.factorial(i)
    middle = 0.5 * (begin + stop)
    split = np.concatenate([knots[:-1], [middle, stop]])
    pieces = np.concatenate([coefficients, last[:, None]], axis=1)
    origins = np.concatenate([knots[:-1], [stop]])
    return split, pieces, np.array(np.broadcast_to(origins, pieces.shape[:2]))
