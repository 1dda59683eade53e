"""Base parameters: the combinations of dynamic parameters that torques depend on."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.dynamics.regressor import (
    count_parameters,
    cut_rows,
    factor_columns,
    fill_regressor,
    parameter_names,
    parameters,
)
from cspace.dynamics.rows import EARTH, check_gravity
from cspace.errors import InputError
from cspace.kinematics.batch import Batch, check_robot, rows_of
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.spatial import exp_so3
from cspace.tables import align_cells, html_table, one_line, shown
from cspace.tolerances import DEPENDENT_COLUMN

EQUATIONS: Final = 4
"""Random equations per parameter: enough that no direction is weak by chance."""

FAST: Final = 3.0
"""Spread of random velocities [rad/s or m/s]: the square is that of the accelerations and of gravity."""

SHORT_COLUMN: Final = 0.1
"""Share of the longest column that shorter ones are not scaled beyond: scaled to length one, the square of a
small offset would weigh as much as gravity, and rounded angles of a file as much as links."""

NEARLY_LARGEST: Final = 0.1
"""A column that is at least this share of the largest one left may be chosen before it: the choice is as
stable, and the parameters of the first links keep their names."""

ROUNDING: Final = 4096.0 * np.finfo(float).eps
"""Of the weights of a combination, for columns of length one."""


WIDTH: Final = 110
"""Characters of a line of a printed table."""


@dataclass(frozen=True, eq=False)
class BaseParameters:
    """The combinations of dynamic parameters that torques depend on.

    tau = Y[:, columns] (matrix π) for the regressor Y of any motion, and no smaller set of columns is enough.

    robot: its name. names: of the combinations, b texts such as "Izz_forearm + 0.3 hx_hand". columns (b,):
    the parameter that each begins with. matrix (b, p): of the combinations. values (b,): those of the robot.
    """

    robot: str
    names: tuple[str, ...]
    columns: npt.NDArray[np.intp]
    matrix: Array
    values: Array

    def __len__(self) -> int:
        return len(self.names)

    @property
    def summary(self) -> str:
        """How many there are, in one line."""
        return f"{len(self)} combinations of {self.matrix.shape[1]} parameters"

    def __repr__(self) -> str:
        return one_line("BaseParameters", f"of {self.robot}: {self.summary}")

    def _cells(self) -> list[list[str]]:
        return [[name, shown(value)] for name, value in zip(self.names, self.values, strict=True)]

    def __str__(self) -> str:
        return print_sums(f"{self.robot}: {self.summary}", ["parameter", "value"], self._cells())

    def _repr_html_(self) -> str:
        return html_table(f"{self.robot}: {self.summary}", ["parameter", "value"], self._cells())


def base_parameters(
    robot: KinematicModel, *, gravity: ArrayLike = EARTH, friction: bool = True
) -> BaseParameters:
    """The base parameters of a robot: all that torques can tell about its masses.

    They are found from the regressor at random motions, beyond the limits of the joints too, by a QR
    factorisation of its columns, each scaled to length one, with column pivoting. Columns that depend on
    those before them are those of parameters which only count in a sum.

    gravity (3,) [m/s²]: without it fewer parameters count. friction: with damping and dry friction.

    Raises InputError for gravity of a wrong shape and a robot without joints, InputTypeError for what is not
    a robot.

    Gautier 1991; Khalil and Dombre 2002, section 9.4.
    """
    check_robot(robot)
    if robot.dof == 0:
        raise InputError(f"{robot.name} has no joints, so no torque depends on its masses")
    down = check_gravity(gravity)
    R = triangular_factor(random_rows(robot), robot, down, friction)
    chosen, K = split_columns(R)
    p = R.shape[1]
    matrix = np.zeros((len(chosen), p))
    matrix[:, chosen] = np.eye(len(chosen))
    matrix[:, np.setdiff1d(np.arange(p), chosen)] = K
    names = parameter_names(robot, friction=friction)
    sums = tuple(describe_sum(row, first, names) for row, first in zip(matrix, chosen, strict=True))
    return BaseParameters(robot.name, sums, chosen, matrix, matrix @ parameters(robot, friction=friction))


def random_rows(robot: KinematicModel) -> Batch:
    """Random motions that excite every parameter which can be excited."""
    rng = np.random.default_rng(0)
    n, dof = len(robot.joint_names), robot.dof
    rows = EQUATIONS * count_parameters(robot._assembly, True) // dof + 1
    reach = np.array([np.pi if kind == "R" else 1.0 for kind in robot.joint_types])
    T = np.tile(np.eye(4), (rows, 1, 1))
    T[:, :3, :3] = exp_so3(rng.normal(size=(rows, 3)) * FAST)
    return rows_of(
        robot,
        rng.uniform(-reach, reach, (rows, n)),
        qd=rng.normal(size=(rows, dof)) * FAST,
        qdd=rng.normal(size=(rows, dof)) * FAST**2,
        T_world_base=T if robot.floating else None,
    )


def triangular_factor(batch: Batch, robot: KinematicModel, gravity: Array, friction: bool) -> Array:
    """R (p, p) of the QR factorisation of the regressors of all rows, one above the other."""
    p = count_parameters(robot._assembly, friction)
    R = np.zeros((0, p))
    for Y in regressors_of(batch, robot, gravity, friction):
        R = factor_columns(np.concatenate([R, Y.reshape(-1, p)]))
    return R


def regressors_of(batch: Batch, robot: KinematicModel, gravity: Array, friction: bool) -> Iterator[Array]:
    """The regressors (rows, dof, p) of the rows, some at a time."""
    width = robot.dof * count_parameters(robot._assembly, friction)
    for part in cut_rows(batch, width):
        yield fill_regressor(robot, part, gravity, friction)


def split_columns(A: Array) -> tuple[npt.NDArray[np.intp], Array]:
    """Which columns of A (m, p) are independent, in rising order (b,), and K (b, p − b) with the others
    A₂ = A₁ K."""
    sizes = np.linalg.norm(A, axis=0)
    sizes = np.maximum(sizes, SHORT_COLUMN * sizes.max(initial=0.0))
    scaled = A / np.where(sizes > 0.0, sizes, 1.0)
    rest, chosen = scaled.copy(), []
    while rest.size:
        lengths = np.linalg.norm(rest, axis=0)
        largest = lengths.max()
        if not largest > DEPENDENT_COLUMN:
            break
        k = int(np.argmax(lengths >= NEARLY_LARGEST * largest))
        direction = rest[:, k] / lengths[k]
        for _ in range(2):  # the second time removes what rounding left
            rest = rest - np.outer(direction, direction @ rest)
        rest[:, k] = 0.0
        chosen.append(k)
    first = np.sort(np.array(chosen, dtype=np.intp))
    others = np.setdiff1d(np.arange(A.shape[1]), first)
    K = np.linalg.lstsq(scaled[:, first], scaled[:, others], rcond=None)[0]
    K = np.where(np.abs(K) > ROUNDING, K, 0.0)
    return first, K * sizes[others] / sizes[first, None]


def describe_sum(weights: Array, first: int, names: tuple[str, ...]) -> str:
    """A combination as text, the parameter `first` before the others: "Izz_a + 0.3 hx_b − m_c"."""
    text = names[first]
    for k in np.flatnonzero(np.abs(weights) > DEPENDENT_COLUMN):
        if k != first:
            size = f"{abs(weights[k]):.4g}"
            text += f" {'+' if weights[k] > 0.0 else '−'} {'' if size == '1' else size + ' '}{names[k]}"
    return text


def print_sums(head: str, titles: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table whose first cells are combinations, as lines of at most WIDTH characters: the numbers, then
    the combination, which goes on below itself where it is long."""
    numbers = align_cells([titles[1:], *(row[1:] for row in rows)]).splitlines()
    indent = len(numbers[0]) + 2
    lines = textwrap.wrap(head, WIDTH, break_long_words=False)
    for number, name in zip(numbers, (titles[0], *(row[0] for row in rows)), strict=True):
        first, *others = wrap_sum(name, WIDTH - indent)
        lines += [f"{number}  {first}", *(" " * indent + part for part in others)]
    return "\n".join(lines)


def wrap_sum(text: str, width: int) -> list[str]:
    """A combination as lines, broken before its signs; one term alone may be longer than the width."""
    lines: list[str] = []
    for term in re.split(r" (?=[+−] )", text):
        if lines and len(lines[-1]) + 1 + len(term) <= width:
            lines[-1] += f" {term}"
        else:
            lines.append(term)
    return lines
