"""What inverse kinematics answers for many goals: arrays, padded with NaN."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, attribute_error
from cspace.ik.context import About
from cspace.ik.derivative import derivative
from cspace.ik.on_limits import settle_on_limits
from cspace.ik.prepare import prepare
from cspace.ik.solutions import (
    INCOMPLETE,
    METRICS,
    UNREACHABLE,
    VERDICTS,
    Solutions,
    bounds_of,
    pose_errors,
    position_goal,
)
from cspace.ik.wrapping import into_limits, nearest_winding, short_way, wrap
from cspace.kinematics.batch import choice
from cspace.tolerances import FARTHEST

if TYPE_CHECKING:
    from cspace.model import Limits

__all__ = ["SolutionsBatch"]


class SolutionsBatch:
    """Every configuration that reaches each of n goals.

    q: (..., k_max, dof) [rad, m], the solutions of each goal first, NaN behind them. count: (...,)
    solutions per goal. goal: (..., 4, 4), or (..., 3) for positions. status: (...,) strings as of
    `Solutions`. freedom: what the goals leave free, as of `Solutions`. Index with one goal's index to get its
    `Solutions`: batch[i].branch, batch[i].self_motions.
    """

    def __init__(
        self,
        robot: Any,
        goal: Array,
        q: Array,
        count: npt.NDArray[np.int64],
        verdict: npt.NDArray[np.uint8],
        partial: Any = None,
        freedom: tuple[str, ...] = (),
    ) -> None:
        self.robot = robot
        self.goal = goal
        self.q = q
        self.count = count
        self._verdict = verdict
        self._partial = partial  # solve_partial.Many, where the goals are no poses
        self.freedom = freedom

    if not TYPE_CHECKING:  # type checkers report such names themselves

        def __getattr__(self, name: str) -> Any:
            raise attribute_error(self, name)

    def __len__(self) -> int:
        return len(self.count)

    @property
    def _status(self) -> npt.NDArray[np.uint8]:
        return np.asarray(self._verdict % INCOMPLETE, dtype=np.uint8)

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """ "exact", "singular" or "unreachable" per goal, (...,)."""
        return np.array(VERDICTS)[self._status]

    @property
    def complete(self) -> npt.NDArray[np.bool_]:
        """Whether every solution of each goal is listed, (...,)."""
        return np.asarray(self._verdict < INCOMPLETE)

    @property
    def reachable(self) -> npt.NDArray[np.bool_]:
        """Whether each goal has a solution, (...,)."""
        return self.count > 0

    @property
    def residual(self) -> Array:
        """How far fk(q) is from the goal, (..., k_max): the larger of position [m] and angle [rad]; NaN
        padded.
        """
        shape = self.goal.shape[self.count.ndim :]
        goal = np.broadcast_to(np.expand_dims(self.goal, self.count.ndim), (*self.q.shape[:-1], *shape))
        out = np.full(self.q.shape[:-1], np.nan)
        real = self._real
        if self._partial is not None:
            for index in np.argwhere(real):
                one = self._partial.goal.take(tuple(index[:-1]))
                out[tuple(index)] = one.residual(self.robot.fk(self.q[tuple(index)]))
            return out
        out[real] = pose_errors(self.robot, self.q[real], goal[real])
        return out

    @property
    def derivative(self) -> Array:
        """dq per base twist [v; ω] of each goal, (..., k_max, dof, 6), NaN padded, as of `Solutions`."""
        if self._partial is None:
            return derivative(self.robot, self.q, self.goal.shape[self.count.ndim :] == (3,))
        out = np.full((*self.q.shape, 6), np.nan)
        for index in np.ndindex(self.count.shape):  # the joints of each goal are known to its own answer
            out[index][: self.count[index]] = self[index].derivative
        return out

    @property
    def reason(self) -> npt.NDArray[np.object_]:
        """The verdict of each goal as one sentence, (...,). Made when read, goal by goal: an unreachable
        one costs a search, so for a few goals ask batch[i].reason."""
        return self._of_each("reason", np.dtype(object))

    @property
    def out_of_reach(self) -> Array:
        """By how much each goal is out of reach [m], (...,), as of `Solutions`; made when read, by a search
        for each unreachable goal.
        """
        return self._of_each("out_of_reach", np.dtype(float))

    def _of_each(self, name: str, kind: np.dtype[Any]) -> npt.NDArray[Any]:
        out = np.empty(self.count.shape, dtype=kind)
        for index in np.ndindex(out.shape):
            out[index] = getattr(self[index], name)
        return out

    @property
    def _real(self) -> npt.NDArray[np.bool_]:
        return np.asarray(np.arange(self.q.shape[-2]) < self.count[..., None])

    def __getitem__(self, index: Any) -> Solutions:
        verdict = self._verdict[index]
        if np.ndim(verdict):
            raise InputError(
                f"index {index!r} picks {np.shape(verdict)} goals, expected one: use .q for slices"
            )
        goal = np.ascontiguousarray(self.goal[index])
        rows = self.q[index][: int(self.count[index])]
        if self._partial is not None:
            return self._row_of_partial(index, rows)
        prepare(self.robot)  # a robot out of a pickle comes without its solver
        if not self.robot._ik_direct or self.freedom:
            return self._row_of_redundant(goal, int(verdict), np.ascontiguousarray(rows))
        is_pose = goal.shape == (4, 4)
        full = _core._ik_single(self.robot, goal) if is_pose else _core._ik_position(self.robot, goal)
        if len(full) == len(rows) and np.array_equal(full.q, rows):
            return cast(Solutions, full)
        branches = tuple(
            int(full._branch_numbers[int(np.argmin(np.abs(np.sin((full.q - row) / 2)).max(axis=1)))])
            for row in rows
        )
        made = _core._ik_make(
            self.robot,
            goal if is_pose else position_goal(goal),
            int(verdict),
            np.ascontiguousarray(rows),
            branches,
            (False,) * len(rows),
            None if len(rows) or not len(full) else "solutions exist, the filters left none",
        )
        return cast(Solutions, made)

    def _row_of_redundant(self, goal: Array, verdict: int, rows: Array) -> Solutions:
        """One goal's rows as a result, without the names of their branches."""
        k = len(rows)
        about = About(freedom=self.freedom)
        made = _core._ik_make(self.robot, goal, verdict, rows, (-1,) * k, (False,) * k, None, about)
        return cast(Solutions, made)

    def within(self, limits: Limits | None = None) -> SolutionsBatch:
        """The solutions inside the limits, each revolute joint first moved by a multiple of 2π to fit.

        A joint that rounding takes past a limit is set to it, so q is inside exactly.
        """
        bounds = bounds_of(self.robot, limits)
        rows = slice(3 if self.goal.shape[self.count.ndim :] == (3,) else 6)
        settled = settle_on_limits(self.robot, self.q, bounds, rows)
        moved, fits = into_limits(settled, self.robot.joint_types, bounds.lower, bounds.upper)
        return self._keep(moved, fits & self._real)

    def wrapped(self) -> SolutionsBatch:
        """The same solutions with revolute joints in (−π, π]."""
        q = wrap(self.q, self.robot.joint_types)
        return SolutionsBatch(
            self.robot, self.goal, q, self.count, self._verdict, self._partial, self.freedom
        )

    def nearest(self, q: Any, metric: str = "euclidean") -> Array:
        """Per goal the configuration nearest to q (dof,) or (..., dof), (..., dof); NaN where there is
        none.
        """
        choice(metric, "metric", METRICS)
        seed = self._seed(q)[..., None, :]
        limits = self.robot.limits
        moved = nearest_winding(self.q, seed, self.robot.joint_types, limits.lower, limits.upper)
        gap = np.abs(moved - seed)
        distance = gap.max(axis=-1) if metric == "max" else np.linalg.norm(gap, axis=-1)
        row = np.argmin(np.where(self._real, distance, np.inf), axis=-1)
        return np.take_along_axis(moved, row[..., None, None], axis=-2)[..., 0, :]

    def _row_of_partial(self, index: Any, rows: Array) -> Solutions:
        """One goal is asked again, for what the rows do not say, and its answer cut to the rows."""
        full = self._partial.one(self.robot, index)
        gaps = short_way(full.q[None] - rows[:, None], self.robot.joint_types)
        kept = np.abs(gaps).max(axis=2).argmin(axis=1) if len(rows) else np.zeros(0, dtype=int)
        return cast(Solutions, full._take(kept, rows, full._note))

    def _seed(self, q: Any) -> Array:
        """One configuration per goal, (..., dof), from as many as given or one for all."""
        dof = self.robot.dof
        seed = as_floats(q, "q", last=(dof,), largest=FARTHEST)
        whole = (*self.count.shape, dof)
        try:
            return np.broadcast_to(seed, whole)
        except ValueError:
            raise InputError(
                f"q has shape {seed.shape}, expected ({dof},) for all goals or {whole}, one for each"
            ) from None

    def _keep(self, q: Array, keep: npt.NDArray[np.bool_]) -> SolutionsBatch:
        order = np.argsort(~keep, axis=-1, kind="stable")
        sorted_q = np.take_along_axis(q, order[..., None], axis=-2)
        count = keep.sum(axis=-1)
        sorted_q[np.arange(q.shape[-2]) >= count[..., None]] = np.nan
        return SolutionsBatch(
            self.robot, self.goal, sorted_q, count, self._verdict, self._partial, self.freedom
        )

    def __repr__(self) -> str:
        reached = int(np.count_nonzero(self.count))
        unreachable = int(np.count_nonzero(self._status == UNREACHABLE))
        return (
            f"SolutionsBatch({self.robot.name}: {self.count.size} goals, {reached} with solutions, "
            f"{unreachable} unreachable, {int(self.count.sum())} configurations)"
        )
