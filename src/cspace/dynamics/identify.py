"""Identification: the dynamic parameters of a robot from measured motions and torques."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.base_parameters import BaseParameters, base_parameters, print_sums
from cspace.dynamics.massless_motions import BASE, TAKES_PART
from cspace.dynamics.possible_parameters import fit_possible
from cspace.dynamics.regressor import (
    BODY,
    count_parameters,
    cut_rows,
    factor_columns,
    fill_regressor,
    moving_bodies,
    moving_joints,
)
from cspace.dynamics.rows import EARTH, check_gravity, refuse_missing, refuse_rows
from cspace.kinematics.batch import Batch, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial.checks import PoseLike
from cspace.tables import count_things, html_table, join_words, one_line, shown
from cspace.tolerances import LEAST_EXCITATION, UNDETERMINED

WEIGHINGS: Final = 8
"""How often the weights of the joints are computed from the residuals and the residuals again from them: each
time changes them by a tenth of the last change or less."""

RESOLUTION: Final = float(np.sqrt(np.finfo(float).eps))
"""Of a torque, relative to its root mean square: no joint is weighted as if it were measured better, since
the rounding of exact data is no measure of their worth."""


@dataclass(frozen=True, eq=False)
class Identification:
    """Base parameters from data; falsy if the data leave some of them undetermined.

    robot: its name. names: of the b combinations, see base_parameters. base (b,): their values, NaN where the
    data do not determine them; covariance (b, b): of their errors. residuals (dof,): root mean square of
    measured less predicted torque [N·m or N]. condition: of the weighted equations with columns of length
    one; around ten is excellent, above a thousand little is known. samples: how many. unexcited: the joints
    whose parameters are undetermined. parameters (p,): all parameters, such that every body can exist, where
    physical=True asked for them and the data determine the base parameters; else None.
    """

    robot: str
    names: tuple[str, ...]
    base: Array
    covariance: Array
    residuals: Array
    condition: float
    samples: int
    unexcited: tuple[str, ...]
    parameters: Array | None

    def __bool__(self) -> bool:
        return not self.unexcited

    @property
    def errors(self) -> Array:
        """The standard errors of the base parameters (b,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def summary(self) -> str:
        """The answer in one line."""
        many = count_things(len(self.base), "base parameter")
        count = f"{many} from {count_things(self.samples, 'sample')}"
        if self.unexcited:
            return f"{count}: the motion leaves those of {join_words(self.unexcited)} undetermined"
        largest = float(self.residuals.max(initial=0.0))
        return f"{count}, condition {self.condition:.3g}, residuals up to {largest:.3g} N·m or N"

    def __repr__(self) -> str:
        return one_line("Identification", f"of {self.robot}: {self.summary}")

    def _cells(self) -> list[list[str]]:
        rows = zip(self.names, self.base, self.errors, strict=True)
        return [[name, shown(value), shown(error)] for name, value, error in rows]

    def __str__(self) -> str:
        titles = ["parameter", "value", "standard error"]
        return print_sums(f"{self.robot}: {self.summary}", titles, self._cells())

    def _repr_html_(self) -> str:
        titles = ["parameter", "value", "standard error"]
        return html_table(f"{self.robot}: {self.summary}", titles, self._cells())


def identify(
    robot: KinematicModel,
    q: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    tau: ArrayLike,
    *,
    gravity: ArrayLike = EARTH,
    friction: bool = True,
    physical: bool = False,
    T_world_base: PoseLike | None = None,
) -> Identification:
    """The base parameters of a robot from measured motions and torques.

    Weighted least squares of tau = Y(q, q̇, q̈) π over all samples: the variance of each joint is that of its
    residuals. The robot lends its geometry; its own masses count only with physical=True. Samples are read in
    parts, so that millions need little memory besides themselves.

    q (..., n) [rad or m], qd, qdd, tau (..., dof), gravity (3,) [m/s²]. friction: with damping and dry
    friction of every joint. physical: also find all parameters such that the bodies can exist; what the data
    leave open is then as close to the parameters of the robot as possible. T_world_base (..., 4, 4): where
    the base is.

    Returns an Identification, falsy with the joints named where the motion leaves parameters undetermined.
    Raises InputError for a wrong shape or NaN and for a robot without joints.

    Gautier 1991; Swevers et al. 1997; for physical=True Rucker and Wensing 2022.
    """
    refuse_missing(qd=qd, qdd=qdd, tau=tau)
    batch = rows_of(robot, q, qd=qd, qdd=qdd, tau=tau, T_world_base=T_world_base)
    refuse_rows(batch)
    down = check_gravity(gravity)
    base = base_parameters(robot, gravity=down, friction=friction)
    factors = reduce_samples(robot, base, batch, down, friction)
    x, R, residuals = weigh_joints(factors, len(batch.q))
    x, covariance, condition, null = solve_excited(R, x)
    unexcited = name_joints(robot, base, null)
    whole = None
    if physical and not unexcited:
        whole = fit_possible(robot, base, R, friction)
    return Identification(
        robot=robot.name,
        names=base.names,
        base=x,
        covariance=covariance,
        residuals=residuals,
        condition=condition,
        samples=len(batch.q),
        unexcited=unexcited,
        parameters=whole,
    )


def reduce_samples(
    robot: KinematicModel, base: BaseParameters, batch: Batch, gravity: Array, friction: bool
) -> Array:
    """Per joint the triangular factor (dof, b + 1, b + 1) of its equations, the torques as last column.

    Each part of the samples is factored together with the factor of those before it (Demmel et al. 2012).
    """
    b = len(base)
    factors = np.zeros((robot.dof, b + 1, b + 1))
    width = robot.dof * count_parameters(robot._assembly, friction)
    for part in cut_rows(batch, width):
        assert part.tau is not None
        Y = fill_regressor(robot, part, gravity, friction)[:, :, base.columns]
        for i in range(robot.dof):
            equations = np.concatenate([Y[:, i], part.tau[:, i, None]], axis=1)
            factors[i] = factor_columns(np.concatenate([factors[i], equations]))
    return factors


def weigh_joints(factors: Array, samples: int) -> tuple[Array, Array, Array]:
    """The weighted least squares solution (b,), R (b + 1, b + 1) of the weighted equations, and the root mean
    square of the residuals of each joint (dof,)."""
    dof, b = len(factors), factors.shape[1] - 1
    size = np.linalg.norm(factors[:, :, b], axis=1) / np.sqrt(max(1, samples))
    least = np.where(size > 0.0, RESOLUTION * size, 1.0)
    freedom = max(1.0, samples - b / dof)
    spread = np.maximum(size, least)
    for _ in range(WEIGHINGS):
        R = factor_columns((factors / spread[:, None, None]).reshape(-1, b + 1))
        scale = column_lengths(R[:, :b])
        x = np.linalg.lstsq(R[:b, :b] / scale, R[:b, b], rcond=LEAST_EXCITATION)[0] / scale
        left = np.linalg.norm(factors[:, :, :b] @ x - factors[:, :, b], axis=1)
        spread = np.maximum(left / np.sqrt(freedom), least)
    return x, R, left / np.sqrt(max(1, samples))


def column_lengths(A: Array) -> Array:
    """The lengths of the columns, one where they vanish."""
    lengths = np.linalg.norm(A, axis=0)
    return np.asarray(np.where(lengths > 0.0, lengths, 1.0))


def solve_excited(R: Array, x: Array) -> tuple[Array, Array, float, Array]:
    """The parameters (NaN where undetermined), their covariance, the condition, and the null directions.

    R: of the weighted equations, whose columns are scaled to length one before singular values count.
    """
    b = len(x)
    scale = column_lengths(R[:, :b])
    _, sigma, Vt = np.linalg.svd(R[:b, :b] / scale)
    weak = sigma <= LEAST_EXCITATION * sigma.max(initial=0.0)
    null = Vt[weak]
    undetermined = (np.abs(null) > UNDETERMINED).any(axis=0)
    inverse = Vt[~weak].T / sigma[~weak] / scale[:, None]
    covariance = inverse @ inverse.T
    covariance[undetermined] = covariance[:, undetermined] = np.nan
    condition = float(sigma[0] / sigma[-1]) if b and not weak.any() else np.inf
    return np.where(undetermined, np.nan, x), covariance, condition, null


def name_joints(robot: KinematicModel, base: BaseParameters, null: Array) -> tuple[str, ...]:
    """The joints whose parameters take part in null directions (k, b)."""
    joints = moving_joints(robot)
    owners = [joints[body.joint] if body.joint >= 0 else BASE for body in moving_bodies(robot._assembly)]
    by_column = [owner for owner in owners for _ in BODY] + 3 * list(joints)
    takes_part = (np.abs(null) > TAKES_PART).any(axis=0)
    found = [by_column[column] for column in base.columns[takes_part]]
    return tuple(name for name in dict.fromkeys((BASE, *joints)) if name in found)
