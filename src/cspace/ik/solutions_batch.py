"""What inverse kinematics answers for many goals: arrays, padded with NaN."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.ik.answers import INCOMPLETE, METRICS, NEAREST, UNREACHABLE, VERDICTS, Answers
from cspace.ik.context import About
from cspace.ik.goals.given import rows_for_goals
from cspace.ik.on_limits import keep_within
from cspace.ik.solutions import Solutions, chosen_reason, limits_reason
from cspace.ik.solver import Solver
from cspace.ik.wrapping import wrap_joints
from cspace.kinematics.batch import limits_of
from cspace.model import Limits
from cspace.tables import html_table, one_line


@dataclass(frozen=True, eq=False)
class LeftOut:
    """What a batch leaves out because of limits: goals (m,) by flat number, ascending, that have solutions
    and none within limits; q (m, k, dof): their solutions. is_chosen: whether the search for the nearest
    within limits chose them, as it found none.
    """

    goals: npt.NDArray[np.intp]
    q: Array
    limits: Limits
    is_chosen: bool

    @classmethod
    def of(cls, all_found: SolutionsBatch, kept: SolutionsBatch, limits: Limits, is_chosen: bool) -> LeftOut:
        goals = np.flatnonzero(all_found.reachable & ~kept.reachable)
        q = all_found.q.reshape(-1, *all_found.q.shape[-2:])[goals]
        return cls(goals, q, limits, is_chosen)

    def reason(self, solver: Solver, goal: int, complete: bool) -> str | None:
        """Why a goal has no solution; None for one that is not of these."""
        k = int(np.searchsorted(self.goals, goal))
        if k == len(self.goals) or self.goals[k] != goal:
            return None
        q = self.q[k][np.isfinite(self.q[k, :, 0])]
        if self.is_chosen:
            return chosen_reason(solver, q, self.limits, complete)
        return limits_reason(solver, q, self.limits)


@dataclass(eq=False, repr=False)
class SolutionsBatch(Answers):
    """Every configuration that reaches each of n goals.

    q: (..., k_max, dof) [rad, m], the solutions of each goal first, NaN behind them. count: (...,)
    solutions per goal. goal: (..., 4, 4), or (..., 3) for positions. status: (...,) strings as of
    `Solutions`. freedom: what the goals leave free, as of `Solutions`. branch: names (..., k_max). Index
    with one goal's index to get its `Solutions`: batch[i], batch[i].self_motions.
    """

    solver: Solver
    goal: Array
    q: Array
    count: npt.NDArray[np.int64]
    _verdict: npt.NDArray[np.uint8]
    _about: About | None = None
    _self_motion: Any = None  # which rows stand for a self-motion (..., k_max), where there is _about
    _left_out: LeftOut | None = None

    @classmethod
    def of(
        cls,
        solver: Solver,
        goals: Array,
        q: Any,
        count: Any,
        verdict: Any,
        about: Any = None,
        self_motion: Any = None,
    ) -> SolutionsBatch:
        """The answers to goals (..., 4, 4) or (..., 3) from arrays with one row per goal."""
        shape = goals.shape[: -1 if goals.shape[-1] == 3 else -2]

        def shaped(rows: Any) -> Any:
            return None if rows is None else rows.reshape(*shape, *rows.shape[1:])

        about = about and replace(about, q=shaped(about.q))
        return cls(solver, goals, shaped(q), shaped(count), shaped(verdict), about, shaped(self_motion))

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
    def branch(self) -> npt.NDArray[np.str_]:
        """A name for each solution, (..., k_max), as of `Solutions`; "" where a goal has fewer. Made when
        read, goal by goal."""
        out = np.full(self.q.shape[:-1], "", dtype=object)
        for index in np.ndindex(self.count.shape):
            out[index][: self.count[index]] = self[index].branch
        return out.astype(np.str_)

    @property
    def reason(self) -> npt.NDArray[np.object_]:
        """The verdict of each goal as one sentence, (...,). Made when read, goal by goal: an unreachable
        one costs a search, so for a few goals ask batch[i].reason."""
        return self._of_each("reason", np.dtype(object))

    @property
    def out_of_reach(self) -> Array:
        """How far each goal is out of reach [m], (...,), as of `Solutions`: a search for each when read."""
        return self._of_each("out_of_reach", np.dtype(float))

    def _of_each(self, name: str, kind: np.dtype[Any]) -> npt.NDArray[Any]:
        out = np.empty(self.count.shape, dtype=kind)
        for index in np.ndindex(out.shape):
            out[index] = getattr(self[index], name)
        return out

    def __getitem__(self, index: Any) -> Solutions:
        verdict = self._verdict[index]
        if np.ndim(verdict):
            raise InputError(
                f"index {index!r} selects {np.shape(verdict)} goals, expected one: use .q for slices"
            )
        k = int(self.count[index])
        goal, rows = np.ascontiguousarray(self.goal[index]), self.q[index][:k]
        numbers, flags, about, note = (-1,) * k, (False,) * k, None, None
        if self._about is not None:
            flags, about = self._self_motion[index][:k], self._about.one(index, self.count.shape, k)
        elif self._status[index] != NEAREST:
            full = (_core._ik_position if self._is_point else _core._ik_single)(self.solver, goal)
            if len(full) == k and np.array_equal(full.q, rows):
                return cast(Solutions, full)
            gaps = np.abs(np.sin((full.q - rows[:, None]) / 2)).max(axis=2)
            same = gaps.argmin(axis=1) if k else ()
            numbers = tuple(full._branch_numbers[row] for row in same)
            flags = tuple(full._is_self_motion[row] for row in same)
            note = None if k or not len(full) else "solutions exist, the filters left none"
        if not k and self._left_out is not None:
            row = index if isinstance(index, tuple) else (index,)
            number = int(np.ravel_multi_index(row, self.count.shape, mode="wrap"))
            note = self._left_out.reason(self.solver, number, bool(self.complete[index])) or note
        return Solutions.of(self.solver, goal, int(verdict), rows, numbers, flags, note, about)

    def within(self, limits: Limits | None = None) -> SolutionsBatch:
        """The solutions inside the limits, each revolute joint first moved by a multiple of 2π to fit.

        A joint that rounding takes past a limit is set to it, so q is inside exactly.
        """
        bounds = limits_of(self.solver.limits, limits, self.solver.name)
        order = None if self._about is None else np.empty(self.q.shape[:-1], dtype=np.int64)
        q, count = keep_within(self.solver, self.q, bounds, self._constrained, order)
        return self._with_rows(q, order, count)

    def wrapped(self) -> SolutionsBatch:
        """The same solutions with revolute joints in (−π, π]."""
        return replace(self, q=wrap_joints(self.q, self.solver.joint_types))

    def nearest(self, q: Any, metric: str = "euclidean") -> Array:
        """Per goal the configuration (..., dof) nearest to q (dof,) or (..., dof); NaN if there is none."""
        moved, row = self._towards(self._seed(q), metric, self.solver.limits)
        return np.take_along_axis(moved, row[..., None, None], axis=-2)[..., 0, :]

    def _nearest_within(self, q: Any, limits: Limits) -> SolutionsBatch:
        """The batch with the solution within limits nearest to q alone, for each goal that has one."""
        inside = self.within(limits)
        moved, row = inside._towards(self._seed(q), METRICS[0], limits)
        nearest = row[..., None]
        moved = np.take_along_axis(moved, nearest[..., None], axis=-2)
        found = inside._with_rows(moved, nearest, inside.reachable.astype(np.int64))
        return replace(found, _left_out=LeftOut.of(self, found, limits, False))

    def _chosen_within(self, limits: Limits) -> SolutionsBatch:
        """The same for the nearest configurations of self-motions that were searched."""
        found = self.within(limits)
        return replace(found, _left_out=LeftOut.of(self, found, limits, True))

    def _with_rows(
        self, q: Array, order: npt.NDArray[np.int64] | None, count: npt.NDArray[np.int64]
    ) -> SolutionsBatch:
        """The batch with other rows, `count` of each goal; order (..., m): which of this one's rows."""
        about, flags = self._about, self._self_motion
        if about is not None and order is not None:
            flags = np.take_along_axis(flags, order, axis=-1)
            if about.q is not None:
                whole = np.take_along_axis(about.q, order[..., None], axis=-2)
                whole[np.arange(order.shape[-1]) >= count[..., None]] = np.nan
                about = replace(about, q=whole)
        return replace(self, q=q, count=count, _about=about, _self_motion=flags)

    def _seed(self, q: Any) -> Array:
        """One configuration per goal, (..., dof), from as many as given or one for all."""
        return rows_for_goals(q, "q", self.solver.dof, self.count.shape)

    def __repr__(self) -> str:
        reached = int(np.count_nonzero(self.count))
        unreachable = int(np.count_nonzero(self._status == UNREACHABLE))
        return one_line(
            "SolutionsBatch",
            f"{self.solver.name}: {self.count.size} goals, {reached} with solutions, "
            f"{unreachable} unreachable, {int(self.count.sum())} configurations",
        )

    def _repr_html_(self) -> str:
        columns = self.status.ravel(), self.count.ravel().tolist(), self.complete.ravel()
        rows = [
            (", ".join(map(str, index)), str(status), str(count), str(bool(complete)))
            for index, status, count, complete in zip(np.ndindex(self.count.shape), *columns, strict=True)
        ]
        return html_table(repr(self)[1:-1], ("goal", "status", "solutions", "complete"), rows)
