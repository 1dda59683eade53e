"""Noise of odometry by name: a random walk that does not depend on the step, and the models of Thrun."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import ceil, log2
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats, as_generator, bounded_number, leading_axes
from cspace.errors import InputError, InputTypeError, name_type
from cspace.math.wrapping import wrap_angle
from cspace.mobile.arcs import arc_jacobians
from cspace.spatial import adjoint_2d, exp_se2, log_se2, pose_2d, to_xytheta
from cspace.spatial.twists import sinc
from cspace.tables import show_fields, tabulate
from cspace.tolerances import FARTHEST_POINT

NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)
BACKWARDS, SHARES = -0.5 * (1.0 + NODES), 0.5 * WEIGHTS
"""Gauss points −s and their weights over s in [0, 1]."""
LONGEST_TURN = 0.5
"""The turn [rad] over which six Gauss points integrate the noise of an arc to rounding."""


class MotionNoise(Protocol):
    """How uncertain a step of odometry is: the covariance of its end, and random steps with that noise."""

    def covariance(self, steps: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
        """Q (..., 3, 3) of the disturbance w of T exp(ξ) exp(w), in the new base.

        steps: ξ = twist times duration (..., 3) [m, rad]. dt: durations (...) [s].
        """

    def sample(
        self, steps: npt.ArrayLike, dt: npt.ArrayLike, *, rng: int | np.random.Generator | None = None
    ) -> Array:
        """Steps with random noise, twists times durations (..., 3) [m, rad]; arguments as of covariance."""


@tabulate()
@dataclass(frozen=True)
class RandomWalk:
    """White noise along the arc: variances in proportion to distance, turn and time. The default of filters.

    Per metre: `distance` of the length [m²/m], `side` of the slide [m²/m], `drift` of the heading [rad²/m];
    per radian: `turn` of the heading [rad²/rad]; per second: `rest` of x and y [m²/s], `rest_turn` of the
    heading [rad²/s]. A step in two halves gets the covariance of the whole step. Raises InputError for a
    number below zero.
    """

    distance: float = 2e-3
    side: float = 1e-4
    turn: float = 5e-2
    drift: float = 2e-2
    rest: float = 1e-6
    rest_turn: float = 1e-5

    def __post_init__(self) -> None:
        check_variances(self)

    def covariance(self, steps: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
        """Q (..., 3, 3) of w in T exp(ξ) exp(w): ∫ Ad(exp(−sξ)) D Ad(exp(−sξ))ᵀ ds over s in [0, 1].

        steps: ξ (..., 3) [m, rad]. dt: (...) [s]. D = diag of the variances of the whole step.
        """
        xi, time = read_steps(steps, dt)
        return integrate_along(xi, self._variances(xi, time))

    def sample(
        self, steps: npt.ArrayLike, dt: npt.ArrayLike, *, rng: int | np.random.Generator | None = None
    ) -> Array:
        """Steps with normal noise of the covariance, log(exp(ξ) exp(w)): (..., 3) [m, rad] → (..., 3)."""
        xi, time = read_steps(steps, dt)
        return disturb_steps(xi, self.covariance(xi, time), as_generator(rng))

    def _variances(self, xi: Array, time: Array) -> Array:
        distance, turn = np.hypot(xi[..., 0], xi[..., 1]), np.abs(xi[..., 2])
        return np.stack(
            [
                self.distance * distance + self.rest * time,
                self.side * distance + self.rest * time,
                self.turn * turn + self.drift * distance + self.rest_turn * time,
            ],
            axis=-1,
        )


@show_fields
@dataclass(frozen=True)
class VelocityNoise:
    """The velocity model of Thrun, in variances: v̂ = v + ε(α1 v² + α2 ω²), ω̂ = ω + ε(α3 v² + α4 ω²), and a
    last turn γ̂ = ε(α5 v² + α6 ω²), each times dt.

    alpha (6,), without units beyond those that make variances of velocities. The noise depends on the step:
    n steps of d/n get 1/n of the variance of one. Raises InputError for a number below zero. Source: Thrun,
    Burgard & Fox 2005, Table 5.3.
    """

    alpha: tuple[float, ...] = (0.02, 0.005, 0.01, 0.02, 0.002, 0.002)

    def __post_init__(self) -> None:
        read_alphas(self, 6)

    def covariance(self, steps: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
        """Q (..., 3, 3) of w in T exp(ξ) exp(w), G M Gᵀ with G of arc_jacobians and the last turn.

        steps: ξ (..., 3) [m, rad]. dt: (...) [s].
        """
        xi, time = read_steps(steps, dt)
        twist, variances = self._velocities(xi, time)
        G = arc_jacobians(twist, time)[1][..., :, [0, 2]]
        Q = (G * variances[..., None, :2]) @ np.swapaxes(G, -1, -2)
        Q[..., 2, 2] += variances[..., 2] * time**2
        return np.asarray(Q)

    def sample(
        self, steps: npt.ArrayLike, dt: npt.ArrayLike, *, rng: int | np.random.Generator | None = None
    ) -> Array:
        """Steps with random velocities and a random last turn, (..., 3) [m, rad] → (..., 3)."""
        xi, time = read_steps(steps, dt)
        twist, variances = self._velocities(xi, time)
        noise = np.sqrt(variances) * as_generator(rng).standard_normal(variances.shape)
        twist = np.stack(
            [twist[..., 0] + noise[..., 0], twist[..., 1], twist[..., 2] + noise[..., 1]], axis=-1
        )
        last = np.zeros_like(twist)
        last[..., 2] = noise[..., 2] * time
        return log_se2(exp_se2(twist * time[..., None]) @ exp_se2(last))

    def _velocities(self, xi: Array, time: Array) -> tuple[Array, Array]:
        """The twists (..., 3), zero where no time passes, and variances of v, ω and γ (..., 3)."""
        safe = np.where(time > 0, time, 1.0)[..., None]
        twist = np.where(time[..., None] > 0, xi / safe, 0.0)
        v2, w2 = twist[..., 0] ** 2 + twist[..., 1] ** 2, twist[..., 2] ** 2
        a = self.alpha
        return twist, np.stack([a[i] * v2 + a[i + 1] * w2 for i in (0, 2, 4)], axis=-1)


@show_fields
@dataclass(frozen=True)
class OdometryNoise:
    """The odometry model of Thrun, in variances: a step is a turn, a straight line and a turn, each with
    noise.

    Variances: α1 rot1² + α2 trans² of rot1, α3 trans² + α4 (rot1² + rot2²) of trans, α1 rot2² + α2 trans² of
    rot2. alpha (4,). The noise depends on the step as that of VelocityNoise does. A step backwards turns by
    rot1 and rot2 less half a turn, and one below 1 cm has rot1 = 0. Raises InputError for a number below
    zero. Source: Thrun, Burgard & Fox 2005, Table 5.6.
    """

    alpha: tuple[float, ...] = (0.02, 0.01, 0.02, 0.005)

    def __post_init__(self) -> None:
        read_alphas(self, 4)

    def covariance(self, steps: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
        """Q (..., 3, 3) of w in T exp(ξ) exp(w), from the derivatives by rot1, trans and rot2.

        steps: ξ (..., 3) [m, rad]. dt: (...) [s], which this model does not use.
        """
        xi, _ = read_steps(steps, dt)
        parts = turn_drive_turn(xi)
        _, trans, rot2 = np.moveaxis(parts, -1, 0)
        c, s, zero, one = np.cos(rot2), np.sin(rot2), np.zeros_like(rot2), np.ones_like(rot2)
        rows = [[trans * s, c, zero], [trans * c, -s, zero], [one, zero, one]]
        J = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
        return np.asarray((J * self._variances(parts)[..., None, :]) @ np.swapaxes(J, -1, -2))

    def sample(
        self, steps: npt.ArrayLike, dt: npt.ArrayLike, *, rng: int | np.random.Generator | None = None
    ) -> Array:
        """Steps with random turns and lengths, (..., 3) [m, rad] → (..., 3)."""
        xi, _ = read_steps(steps, dt)
        parts = turn_drive_turn(xi)
        variances = self._variances(parts)
        rot1, trans, rot2 = np.moveaxis(
            parts + np.sqrt(variances) * as_generator(rng).standard_normal(parts.shape), -1, 0
        )
        increment = np.stack([trans * np.cos(rot1), trans * np.sin(rot1), rot1 + rot2], axis=-1)
        return log_se2(pose_2d(xytheta=increment))

    def _variances(self, parts: Array) -> Array:
        a1, a2, a3, a4 = self.alpha
        r1, t, r2 = np.moveaxis(parts**2, -1, 0)
        return np.stack([a1 * r1 + a2 * t, a3 * t + a4 * (r1 + r2), a1 * r2 + a2 * t], axis=-1)


def turn_drive_turn(steps: Array) -> Array:
    """Steps as a turn, a signed straight length and a turn, rot1, trans, rot2 (..., 3), |rot1| ≤ π/2."""
    x, y, theta = np.moveaxis(to_xytheta(exp_se2(steps)), -1, 0)
    length = np.hypot(x, y)
    rot1 = np.where(length < tolerances.SHORT_STEP, 0.0, np.arctan2(y, x))
    trans = np.where(length < tolerances.SHORT_STEP, np.copysign(length, x), length)
    backwards = np.abs(rot1) > 0.5 * np.pi
    rot1 = np.where(backwards, wrap_angle(rot1 + np.pi), rot1)
    trans = np.where(backwards, -trans, trans)
    return np.stack([rot1, trans, wrap_angle(theta - rot1)], axis=-1)


def integrate_along(xi: Array, variances: Array) -> Array:
    """∫ Ad(exp(−sξ)) diag(variances) Ad(exp(−sξ))ᵀ ds over s in [0, 1]: steps (..., 3) → (..., 3, 3).

    Gauss points over a short first piece, which is then doubled: Q₂ = A Q Aᵀ + Q.
    """
    turn = float(np.abs(xi[..., 2]).max(initial=0.0))
    doublings = ceil(log2(turn / LONGEST_TURN)) if turn > LONGEST_TURN else 0
    piece = xi / 2.0**doublings
    Q = integrate_short(piece, variances / 2.0**doublings)
    for _ in range(doublings):
        A = adjoint_2d(exp_se2(-piece))
        Q, piece = A @ Q @ np.swapaxes(A, -1, -2) + Q, 2.0 * piece
    return Q


def integrate_short(xi: Array, variances: Array) -> Array:
    """integrate_along over arcs of LONGEST_TURN at most, all Gauss points at once and entry by entry."""
    along, aside, angle = (xi[..., k, None] * BACKWARDS for k in range(3))
    half = 0.5 * angle
    c, s, sine = np.cos(angle), np.sin(angle), np.sin(half)
    a, b = sinc(angle), sine * sinc(half)
    x, y = a * along - b * aside, b * along + a * aside
    # Rows of Ad: (c, −s, y), (s, c, −x), (0, 0, 1).
    first, second, last = variances[..., 0], variances[..., 1], variances[..., 2]
    Q = np.empty((*xi.shape, 3))
    turned = (s * s) @ SHARES * (first - second)
    Q[..., 0, 0] = first - turned + (y * y) @ SHARES * last
    Q[..., 1, 1] = second + turned + (x * x) @ SHARES * last
    Q[..., 0, 1] = Q[..., 1, 0] = (c * s) @ SHARES * (first - second) - (x * y) @ SHARES * last
    Q[..., 0, 2] = Q[..., 2, 0] = y @ SHARES * last
    Q[..., 1, 2] = Q[..., 2, 1] = -(x @ SHARES) * last
    Q[..., 2, 2] = last
    return Q


def disturb_steps(xi: Array, Q: Array, rng: np.random.Generator) -> Array:
    """log(exp(ξ) exp(w)) with w normal of covariance Q, which may be singular: (..., 3) → (..., 3)."""
    values, vectors = np.linalg.eigh(Q)
    normal = np.sqrt(np.maximum(values, 0.0)) * rng.standard_normal(xi.shape)
    return log_se2(exp_se2(xi) @ exp_se2(np.einsum("...ij,...j->...i", vectors, normal)))


def read_noise(noise: object, subject: str = "noise") -> MotionNoise:
    """A model of noise, a RandomWalk where none is given; InputTypeError for anything else."""
    if noise is None:
        return RandomWalk()
    if isinstance(noise, type) or not callable(getattr(noise, "covariance", None)) or hasattr(noise, "poses"):
        raise InputTypeError(
            f"{subject} is {_say_kind(noise)}; give a model of noise such as cspace.mobile.RandomWalk()"
        )
    model: MotionNoise = noise  # type: ignore[assignment]
    return model


def _say_kind(value: object) -> str:
    return f"the class {value.__name__}" if isinstance(value, type) else f"{name_type(value)}"


def read_steps(steps: npt.ArrayLike, dt: npt.ArrayLike) -> tuple[Array, Array]:
    """Steps (..., 3) and durations (...), broadcast; InputError for a duration below zero."""
    xi = as_floats(steps, "steps", last=(3,), largest=FARTHEST_POINT)
    time = as_floats(dt, "dt", largest=FARTHEST_POINT)
    if (time < 0).any():
        raise InputError(f"dt is {time.min():g} s; durations are not below zero")
    shape = leading_axes(steps=xi.shape[:-1], dt=time.shape)
    return np.broadcast_to(xi, (*shape, 3)), np.broadcast_to(time, shape)


def check_variances(model: Any) -> None:
    """InputError for a variance of a model that is below zero."""
    for field in fields(model):
        value = bounded_number(getattr(model, field.name), field.name, 0.0, "give a variance of at least 0")
        object.__setattr__(model, field.name, value)


def read_alphas(model: Any, count: int) -> None:
    """The alphas of a model as numbers; InputError for too many, too few, or one below zero."""
    alpha = as_floats(model.alpha, "alpha")
    if alpha.shape != (count,) or (alpha < 0).any():
        raise InputError(f"alpha is {model.alpha!r}; give {count} numbers that are not below zero")
    object.__setattr__(model, "alpha", tuple(map(float, alpha)))
