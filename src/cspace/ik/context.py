"""What a result carries beside its rows when its goal is not a plain pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from cspace.arrays import Array

if TYPE_CHECKING:
    from cspace.ik.goals.partial import PartialGoal
    from cspace.ik.solver import Solver


@dataclass(eq=False)
class About:
    """What a result needs besides the solutions of one goal.

    goal: of a partial goal; None for a pose. extended, q: the solver of the arm with the virtual joints of a
    partial goal, and its configurations, row by row. freedom: the names of the parameters that the goal
    leaves free. locked: values of locked joints, by number. values: at how many values of the parameter
    branches are listed, 0 where the answer is one configuration of many; feasible: whether these values keep
    all limits.
    """

    goal: PartialGoal | None = None
    extended: Solver | None = None
    freedom: tuple[str, ...] = ()
    locked: Mapping[int, Any] = field(default_factory=dict)
    q: Array | None = None
    values: int = 0
    feasible: bool = False

    @property
    def own_locked(self) -> dict[int, Any]:
        """The locked joints by their numbers in the user's arm, without virtual joints."""
        if self.goal is None or self.extended is None:
            return dict(self.locked)
        first, last = len(self.goal.before), self.extended.dof - len(self.goal.behind)
        return {k - first: value for k, value in self.locked.items() if first <= k < last}

    def take(self, rows: Any, is_all: bool) -> About:
        """The same for some of the solutions, or for all of them."""
        return replace(self, q=None if self.q is None else self.q[rows], values=self.values if is_all else 0)
