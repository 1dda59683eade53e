"""Motions from which the dynamic parameters of a robot can be identified."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, as_generator, positive_number, whole_number
from cspace.dynamics.base_parameters import BaseParameters, base_parameters
from cspace.dynamics.identify import column_lengths
from cspace.dynamics.regressor import factor_columns, fill_regressor
from cspace.dynamics.rows import EARTH, check_gravity
from cspace.errors import InputError
from cspace.kinematics import require_limits
from cspace.kinematics.batch import check_robot, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.tables import one_line, tabulate
from cspace.tolerances import LEAST_EXCITATION

MOST_HARMONICS: Final = 100
"""Of a Fourier series; five are usual."""

MOST_TRIALS: Final = 1_000_000
"""Motions that are tried; a few hundred are usual."""

MOST_SAMPLES: Final = 10_000_000
"""Samples of a trajectory."""

TESTED: Final = 20
"""Times per harmonic at which the condition of the equations is computed."""

DENSE: Final = 32
"""Times per harmonic at which the limits are checked; between them a trigonometric polynomial exceeds its
largest value at these times by 1 / cos(π / 32) at most, half a percent (Ehlich and Zeller 1964)."""

DRAWN: Final = 0.25
"""Share of the trials that are drawn at random; the others vary the best one so far."""

STRIDE: Final = 0.5
"""First size of a variation, relative to a drawn motion."""

GROWTH, SHRINKAGE = 1.3, 0.93
"""What the size of variations is multiplied by after a better and a worse trial: in balance, one in five is
better (Rechenberg 1973)."""


@tabulate()
@dataclass(frozen=True, eq=False)
class ExcitingTrajectory:
    """A periodic motion that excites the base parameters; falsy if it leaves some of them undetermined.

    q(t) = offset + Σₖ (aₖ sin(k ω t) − bₖ cos(k ω t)) / (k ω) with ω = 2π / duration; it begins and ends at
    rest, without acceleration.

    robot: its name. duration [s]. offset (n,), a and b (harmonics, n) [rad/s or m/s]. condition: of the
    equations of the base parameters, with columns of length one. times (m,) [s], q, qd, qdd (m, n): samples.
    """

    robot: str
    duration: float
    offset: Array
    a: Array
    b: Array
    condition: float
    times: Array
    q: Array
    qd: Array
    qdd: Array

    def __bool__(self) -> bool:
        return math.isfinite(self.condition)

    def __call__(self, times: ArrayLike) -> tuple[Array, Array, Array]:
        """Configurations, velocities and accelerations (..., n) at times (...) [s].

        Raises InputError for NaN.
        """
        t = as_floats(times, "times")
        series = series_at(t.ravel(), self.duration, len(self.a))
        shape = (*t.shape, len(self.offset))
        q, qd, qdd = ((S @ np.concatenate([self.a, self.b])).reshape(shape) for S in series)
        return q + self.offset, qd, qdd

    def __repr__(self) -> str:
        text = (
            f"of {self.robot}: {self.duration:g} s, {len(self.times)} samples, condition {self.condition:.3g}"
        )
        return one_line("ExcitingTrajectory", text)


def exciting_trajectory(
    robot: KinematicModel,
    *,
    duration: float = 10.0,
    harmonics: int = 5,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    gravity: ArrayLike = EARTH,
    friction: bool = True,
    rate: float = 100.0,
    trials: int = 200,
    rng: int | np.random.Generator | None = None,
) -> ExcitingTrajectory:
    """A motion from which the base parameters can be identified: a Fourier series within the limits.

    Random coefficients, then variations of the best ones so far, each scaled such that every joint attains
    one of its limits; of all the motion with the smallest condition number counts. Nothing is known of
    obstacles: check the motion before a robot follows it.

    duration [s]: of one period. harmonics: of the series, two or more. velocity, acceleration: the largest
    ones, a number or one per joint (n,), in place of those of the robot; accelerations may be unlimited.
    Joints without limits of position turn by up to π to both sides. gravity (3,), friction: as in identify.
    rate [Hz]: of the samples. trials: how many motions are compared. rng: seed or generator.

    Returns an ExcitingTrajectory.
    Raises InputError for a floating base, joints without a limit of velocity, a prismatic joint without
    limits of position, and numbers out of range, InputTypeError for what is not a robot.

    Swevers et al. 1997.
    """
    check_robot(robot)
    length, rate = positive_number(duration, "duration"), positive_number(rate, "rate")
    count = whole_number(harmonics, "harmonics", 2, MOST_HARMONICS)
    trials = whole_number(trials, "trials", 1, MOST_TRIALS)
    samples = whole_number(math.ceil(length * rate) + 1, "duration · rate", 2, MOST_SAMPLES)
    half, middle = position_ranges(robot)
    fastest = require_limits(robot, "velocity", velocity)
    strongest = robot.limits.acceleration
    if acceleration is not None:
        strongest = require_limits(robot, "acceleration", acceleration)
    search = Search(robot, length, count, half, middle, fastest, strongest, check_gravity(gravity), friction)
    condition, best = search_best(search, trials, as_generator(rng))
    offset, coefficients = search.fit_limits(best)
    times = np.linspace(0.0, length, samples)
    q, qd, qdd = (S @ coefficients for S in series_at(times, length, count))
    a, b = coefficients[:count], coefficients[count:]
    return ExcitingTrajectory(robot.name, length, offset, a, b, condition, times, q + offset, qd, qdd)


def position_ranges(robot: KinematicModel) -> tuple[Array, Array]:
    """Half of the range of each joint and its middle, (n,) each."""
    if robot.floating:
        raise InputError(
            f"the base of {robot.name} is floating, so joints alone do not choose its motion;"
            " use the robot with floating=False"
        )
    lower, upper = robot.limits.lower, robot.limits.upper
    open_ended = np.isinf(lower) | np.isinf(upper)
    for name, kind, is_open in zip(robot.joint_names, robot.joint_types, open_ended, strict=True):
        if is_open and kind == "P":
            raise InputError(
                f"prismatic joint {name} of {robot.name} has no limits of position; it needs both"
            )
    below = np.where(np.isinf(lower), np.where(np.isinf(upper), -np.pi, upper - 2.0 * np.pi), lower)
    above = np.where(np.isinf(upper), below + 2.0 * np.pi, upper)
    return 0.5 * (above - below), 0.5 * (below + above)


def series_at(times: Array, duration: float, harmonics: int) -> tuple[Array, Array, Array]:
    """What the coefficients (2 harmonics, n) are multiplied by for q − offset, q̇ and q̈ at times (m,)."""
    omega = 2.0 * np.pi / duration * np.arange(1, harmonics + 1)
    c, s = np.cos(times[:, None] * omega), np.sin(times[:, None] * omega)
    return (
        np.concatenate([s / omega, -c / omega], axis=1),
        np.concatenate([c, s], axis=1),
        np.concatenate([-s * omega, c * omega], axis=1),
    )


class Search:
    """The motions that are compared: their coefficients (2 harmonics, n), limits and condition numbers."""

    def __init__(
        self,
        robot: KinematicModel,
        duration: float,
        harmonics: int,
        half: Array,
        middle: Array,
        velocity: Array,
        acceleration: Array,
        gravity: Array,
        friction: bool,
    ) -> None:
        self.robot, self.gravity, self.friction = robot, gravity, friction
        self.harmonics, self.half, self.middle = harmonics, half, middle
        self.velocity, self.acceleration = velocity, acceleration
        self.base: BaseParameters = base_parameters(robot, gravity=gravity, friction=friction)
        dense, tested = (np.arange(n * harmonics) * duration / (n * harmonics) for n in (DENSE, TESTED))
        self.dense = series_at(dense, duration, harmonics)
        self.tested = series_at(tested, duration, harmonics)
        effort = robot.limits.effort
        known = np.isfinite(effort).all() and (effort > 0.0).all()
        self.weight = 1.0 / effort if known else np.ones(robot.dof)

    def draw(self, rng: np.random.Generator) -> Array:
        """Random coefficients."""
        return rng.normal(size=(2 * self.harmonics, len(self.half)))

    def start_at_rest(self, x: Array) -> Array:
        """The nearest coefficients with q̇ = 0 and q̈ = 0 at the start, Σ aₖ = 0 and Σ k bₖ = 0."""
        a, b = x[: self.harmonics], x[self.harmonics :]
        k = np.arange(1.0, self.harmonics + 1.0)
        return np.concatenate([a - a.mean(axis=0), b - np.outer(k, k @ b) / (k @ k)])

    def fit_limits(self, x: Array) -> tuple[Array, Array]:
        """The offset (n,) and coefficients with which every joint attains a limit and exceeds none."""
        still = self.start_at_rest(x)
        q, qd, qdd = (S @ still for S in self.dense)
        center, margin = 0.5 * (q.max(axis=0) + q.min(axis=0)), np.cos(np.pi / DENSE)
        with np.errstate(divide="ignore"):
            scales = [
                self.half / np.abs(q - center).max(axis=0),
                self.velocity / np.abs(qd).max(axis=0),
                self.acceleration / np.abs(qdd).max(axis=0),
            ]
        scale = margin * np.min(scales, axis=0)
        scale = np.where(np.isfinite(scale), scale, 0.0)
        return self.middle - scale * center, scale * still

    def find_condition(self, x: Array) -> float:
        """The condition number of the equations of a motion, inf where parameters stay undetermined."""
        offset, coefficients = self.fit_limits(x)
        q, qd, qdd = (S @ coefficients for S in self.tested)
        batch = rows_of(self.robot, q + offset, qd=qd, qdd=qdd)
        Y = fill_regressor(self.robot, batch, self.gravity, self.friction)[:, :, self.base.columns]
        weighted = (Y * self.weight[:, None]).reshape(-1, len(self.base))
        R = factor_columns(weighted)
        sigma = np.linalg.svd(R / column_lengths(R), compute_uv=False)
        if len(sigma) < len(self.base) or sigma[-1] <= LEAST_EXCITATION * sigma[0]:
            return math.inf
        return float(sigma[0] / sigma[-1])


def search_best(search: Search, trials: int, rng: np.random.Generator) -> tuple[float, Array]:
    """The smallest condition number found and its coefficients: random draws, then a (1 + 1) evolution
    strategy."""
    best = search.draw(rng)
    condition, stride = search.find_condition(best), STRIDE
    drawn = max(1, int(DRAWN * trials))
    for trial in range(1, trials):
        x = search.draw(rng) if trial < drawn else best + stride * search.draw(rng)
        found = search.find_condition(x)
        better = found < condition
        if trial >= drawn:
            stride *= GROWTH if better else SHRINKAGE
        if better:
            best, condition = x, found
    return condition, best
