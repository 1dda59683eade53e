"""What the results for one goal and for many have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from cspace.arrays import Array
from cspace.errors import Renamed
from cspace.ik.conditions import arm_length
from cspace.ik.context import About
from cspace.ik.goals.partial import PartialGoal, plain_goal
from cspace.ik.on_limits import settle_on_limits
from cspace.ik.solver import Solver
from cspace.ik.wrapping import nearest_winding
from cspace.kinematics.batch import check_choice
from cspace.kinematics.forward import measure_misses
from cspace.model import Limits
from cspace.tolerances import NO_DERIVATIVE

UNREACHABLE: Final = 0
EXACT: Final = 1
SINGULAR: Final = 2
NEAREST: Final = 3
INCOMPLETE: Final = 8
"""Added to a verdict where solutions may be missing."""
VERDICTS: Final = ("unreachable", "exact", "singular", "least_squares")
METRICS: Final = ("euclidean", "max")


class Answers(Renamed):
    """The rows q (..., k, dof) that answer goals (..., 4, 4) or (..., 3), without leading axes for one."""

    __slots__ = ()

    if TYPE_CHECKING:

        @property
        def solver(self) -> Solver: ...
        @property
        def goal(self) -> Array: ...
        @property
        def q(self) -> Array: ...
        @property
        def _about(self) -> About | None: ...

    @property
    def _real(self) -> Any:
        """Which rows are solutions, (..., k)."""
        return np.isfinite(self.q[..., 0])

    @property
    def residual(self) -> Array:
        """How far fk(q) is from the goal, (..., k): the larger of the position error [m] and the angle [rad];
        NaN where a goal of many has fewer solutions.
        """
        if self._partial is None:
            return measure_misses(self.solver, self.q, self.goal)
        real = self._real
        out = np.full(real.shape, np.nan)
        out[real] = self._wanted.take(np.nonzero(real)[:-1]).residual(self.solver.fk(self.q[real]))
        return out

    @property
    def freedom(self) -> tuple[str, ...]:
        """The names of the parameters that the goal leaves free, one per dimension, self-motions aside."""
        return () if self._about is None else self._about.freedom

    @property
    def derivative(self) -> Array:
        """dq per base twist [v; ω] of the goal, (..., k, dof, 6): to first order ik(exp(twist) goal) is
        q + derivative @ twist. NaN where a solution is singular or missing. Computed on access.
        """
        moves = solve_derivative(*self._whole, self._is_point)
        return np.swapaxes(self._wanted.own_joints(np.swapaxes(moves, -1, -2)), -1, -2)

    @property
    def _is_point(self) -> bool:
        return self.goal.ndim < self.q.ndim

    @property
    def _partial(self) -> PartialGoal | None:
        return None if self._about is None else self._about.goal

    @property
    def _wanted(self) -> PartialGoal:
        """The goals by their parts, whole poses and points too."""
        return self._partial or plain_goal(self.goal)

    @property
    def _whole(self) -> tuple[Solver, Array]:
        """The solver that reaches the whole goal, and its rows, with the virtual joints of a partial goal."""
        if self._about is None or self._about.goal is None:
            return self.solver, self.q
        return cast(Solver, self._about.extended), cast(Array, self._about.q)

    def _settled(self, limits: Limits) -> Array:
        """The solutions, those that rounding takes past a limit set to it."""
        return settle_on_limits(self.solver, self.q, limits, self._constrained)

    @property
    def _constrained(self) -> slice:
        """The rows of the Jacobian that the goals count."""
        return slice(3 if self._is_point else 6)

    def _towards(self, seed: Array, metric: str, limits: Limits) -> tuple[Array, Any]:
        """The rows (..., k, dof), each revolute joint by the turn inside its limits that brings it closest to
        seeds (..., dof), and the number of the nearest row, (...).
        """
        check_choice(metric, "metric", METRICS)
        seed = seed[..., None, :]
        moved = nearest_winding(self.q, seed, self.solver.joint_types, limits.lower, limits.upper)
        gap = np.abs(moved - seed)
        distance = gap.max(axis=-1) if metric == "max" else np.linalg.norm(gap, axis=-1)
        return moved, np.argmin(np.where(self._real, distance, np.inf), axis=-1)


def solve_derivative(solver: Solver, q: Array, position_only: bool = False) -> Array:
    """dq per twist of the goal: the pseudo-inverse of the Jacobian, (..., dof, 6).

    q: (..., dof) [rad, m], rows of NaN allowed. A goal that moves by the base twist [v; ω] (v the velocity of
    its origin [m/s], ω [rad/s]) moves the solution by derivative @ twist. Where the arm has more joints than
    the goal asks for it is the smallest motion; where fewer, it counts for twists that the arm can follow.
    NaN where the solution is singular. position_only: the goal is a point, and ω makes no difference.
    """
    scale = np.ones(6)
    scale[:3] /= arm_length(solver)
    out = np.full((*q.shape[:-1], solver.dof, 6), np.nan)
    real = np.isfinite(q).all(axis=-1)
    if not real.any():
        return out
    J = scale[:, None] * solver.jacobian(q[real])
    rows = 3 if position_only else 6
    U, sigma, Vt = np.linalg.svd(J[:, :rows], full_matrices=False)
    regular = sigma[:, -1] > NO_DERIVATIVE * sigma[:, 0]
    inverse = np.einsum("kji,kj,klj->kil", Vt, 1 / np.where(regular[:, None], sigma, np.nan), U)
    found = np.zeros((len(J), solver.dof, 6))
    found[..., :rows] = inverse * scale[:rows]
    found[~regular] = np.nan
    out[real] = found
    return out
