"""What inverse kinematics answers for many goals: arrays, padded with NaN."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, attribute_error
from cspace.ik.context import About
from cspace.ik.derivative import solve_derivative
from cspace.ik.least_squares import least_squares_answer
from cspace.ik.on_limits import settle_on_limits
from cspace.ik.solutions import (
    INCOMPLETE,
    METRICS,
    NEAREST,
    UNREACHABLE,
    VERDICTS,
    Solutions,
    bounds_of,
    pose_errors,
    position_goal,
)
from cspace.ik.wrapping import into_limits, nearest_winding, short_way, wrap_joints
from cspace.kinematics.batch import check_choice
from cspace.tolerances import FARTHEST

if TYPE_CHECKING:
    from cspace.ik.goals.partial import PartialGoal
    from cspace.ik.solver import Solver
    from cspace.model import Limits


@dataclass(frozen=True, eq=False)
class PartialRows:
    """What the answers to many partial goals carry.

    about: the goals. q (..., k, dof): rows as found; extended (..., k, n): with the goals' joints;
    self_motion (..., k): which of them stand for a self-motion.
    """

    about: About
    q: Array
    extended: Array
    self_motion: npt.NDArray[np.bool_]

    @property
    def goal(self) -> PartialGoal:
        """The goals."""
        return cast("PartialGoal", self.about.goal)

    def one(self, solver: Solver, index: Any, verdict: int) -> Solutions:
        """The solutions of the goal at an index."""
        k = int(np.isfinite(self.q[index][:, 0]).sum())
        goal = self.goal.take(index)
        about = replace(self.about, goal=goal, q=self.extended[index][:k])
        flags = self.self_motion[index][:k]
        return Solutions.of(solver, goal.T, verdict, self.q[index][:k], (-1,) * k, flags, None, about)


@dataclass(eq=False, repr=False)
class SolutionsBatch:
    """Every configuration that reaches each of n goals.

    q: (..., k_max, dof) [rad, m], the solutions of each goal first, NaN behind them. count: (...,)
    solutions per goal. goal: (..., 4, 4), or (..., 3) for positions. status: (...,) strings as of
    `Solutions`. freedom: what the goals leave free, as of `Solutions`. Index with one goal's index to get its
    `Solutions`: batch[i].branch, batch[i].self_motions.
    """

    solver: Solver
    goal: Array
    q: Array
    count: npt.NDArray[np.int64]
    _verdict: npt.NDArray[np.uint8]
    _partial: PartialRows | None = None  # where the goals are partial
    freedom: tuple[str, ...] = ()
    _locked: Mapping[int, Any] = field(default_factory=dict)

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
            goals = self._partial.goal.take(np.nonzero(real)[:-1])
            out[real] = goals.residual(self.solver.fk(self.q[real]))
            return out
        out[real] = pose_errors(self.solver, self.q[real], goal[real])
        return out

    @property
    def derivative(self) -> Array:
        """dq per base twist [v; ω] of each goal, (..., k_max, dof, 6), NaN padded, as of `Solutions`."""
        if self._partial is None:
            return solve_derivative(self.solver, self.q, self.goal.shape[self.count.ndim :] == (3,))
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
                f"index {index!r} selects {np.shape(verdict)} goals, expected one: use .q for slices"
            )
        goal = np.ascontiguousarray(self.goal[index])
        rows = self.q[index][: int(self.count[index])]
        if self._partial is not None:
            return self._row_of_partial(index, int(verdict), rows)
        if self.solver.is_redundant or self.freedom or self._locked or int(verdict) == NEAREST:
            return self._row_of_redundant(index, goal, int(verdict), rows)
        is_pose = goal.shape == (4, 4)
        full = _core._ik_single(self.solver, goal) if is_pose else _core._ik_position(self.solver, goal)
        if len(full) == len(rows) and np.array_equal(full.q, rows):
            return cast(Solutions, full)
        branches = tuple(
            int(full._branch_numbers[int(np.argmin(np.abs(np.sin((full.q - row) / 2)).max(axis=1)))])
            for row in rows
        )
        note = None if len(rows) or not len(full) else "solutions exist, the filters left none"
        pose, flags = goal if is_pose else position_goal(goal), (False,) * len(rows)
        return Solutions.of(self.solver, pose, int(verdict), rows, branches, flags, note)

    def _row_of_redundant(self, index: Any, goal: Array, verdict: int, rows: Array) -> Solutions:
        """One goal's rows as a result, without the names of their branches."""
        k = len(rows)
        locked = {
            joint: np.broadcast_to(value, self.count.shape)[index] for joint, value in self._locked.items()
        }
        about = About(freedom=self.freedom, locked=locked)
        goal = goal if goal.shape == (4, 4) else position_goal(goal)
        return Solutions.of(self.solver, goal, verdict, rows, (-1,) * k, (False,) * k, None, about)

    def within(self, limits: Limits | None = None) -> SolutionsBatch:
        """The solutions inside the limits, each revolute joint first moved by a multiple of 2π to fit.

        A joint that rounding takes past a limit is set to it, so q is inside exactly.
        """
        bounds = bounds_of(self.solver, limits)
        rows = slice(3 if self.goal.shape[self.count.ndim :] == (3,) else 6)
        settled = settle_on_limits(self.solver, self.q, bounds, rows)
        moved, fits = into_limits(settled, self.solver.joint_types, bounds.lower, bounds.upper)
        return self._keep(moved, fits & self._real)

    def wrapped(self) -> SolutionsBatch:
        """The same solutions with revolute joints in (−π, π]."""
        q = wrap_joints(self.q, self.solver.joint_types)
        return self._with(q, self.count)

    def _with(
        self, q: Array, count: npt.NDArray[np.int64], verdict: npt.NDArray[np.uint8] | None = None
    ) -> SolutionsBatch:
        """The same goals with other rows."""
        verdicts = self._verdict if verdict is None else verdict
        return SolutionsBatch(
            self.solver, self.goal, q, count, verdicts, self._partial, self.freedom, self._locked
        )

    def nearest(self, q: Any, metric: str = "euclidean") -> Array:
        """Per goal the configuration nearest to q (dof,) or (..., dof), (..., dof); NaN where there is
        none.
        """
        check_choice(metric, "metric", METRICS)
        seed = self._seed(q)[..., None, :]
        limits = self.solver.limits
        moved = nearest_winding(self.q, seed, self.solver.joint_types, limits.lower, limits.upper)
        gap = np.abs(moved - seed)
        distance = gap.max(axis=-1) if metric == "max" else np.linalg.norm(gap, axis=-1)
        row = np.argmin(np.where(self._real, distance, np.inf), axis=-1)
        return np.take_along_axis(moved, row[..., None, None], axis=-2)[..., 0, :]

    def _nearest_alone(self, q: Any) -> SolutionsBatch:
        """The batch with the solution nearest to q alone, for each goal that has one."""
        rows = self.nearest(q)[..., None, :]
        return self._with(rows, np.isfinite(rows[..., 0, 0]).astype(np.int64))

    def _row_of_partial(self, index: Any, verdict: int, rows: Array) -> Solutions:
        """The rows of one goal as a result; filters may have moved them or left some out."""
        assert self._partial is not None
        if verdict == NEAREST:
            return least_squares_answer(self._partial.one(self.solver, index, UNREACHABLE))
        full = self._partial.one(self.solver, index, verdict)
        gaps = short_way(full.q[None] - rows[:, None], self.solver.joint_types)
        kept = np.abs(gaps).max(axis=2).argmin(axis=1) if len(rows) else np.zeros(0, dtype=int)
        return full._take(kept, rows, None)

    def _seed(self, q: Any) -> Array:
        """One configuration per goal, (..., dof), from as many as given or one for all."""
        dof = self.solver.dof
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
        return self._with(sorted_q, count)

    def __repr__(self) -> str:
        reached = int(np.count_nonzero(self.count))
        unreachable = int(np.count_nonzero(self._status == UNREACHABLE))
        return (
            f"SolutionsBatch({self.solver.name}: {self.count.size} goals, {reached} with solutions, "
            f"{unreachable} unreachable, {int(self.count.sum())} configurations)"
        )
