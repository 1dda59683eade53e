"""What a call asks for besides its goal, and what its result carries besides its rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.ik.goals.partial import PartialGoal
from cspace.ik.solver import Solver
from cspace.model import Limits


@dataclass(frozen=True)
class Options:
    """Which of the solutions: the keywords of `Solver.solve` of these names. limits: what near= keeps."""

    near: Any
    limits: Limits
    locked: Any
    swivel: Any
    samples: Any
    least_squares: bool
    threads: int

    @property
    def sets_freedom(self) -> bool:
        """Whether some joints are locked, or sampled at a number of values."""
        return self.locked is not None or self.samples is not None


@dataclass(eq=False)
class About:
    """What a result needs besides its solutions where its goals are not plain poses.

    goal: of partial goals; None for poses. extended, q (..., k, n): the solver of the arm with the virtual
    joints of partial goals, and its configurations, row by row. freedom: the names of the parameters that the
    goals leave free. locked: values of locked joints, by number. values: at how many values of the parameter
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

    def one(self, index: Any, shape: tuple[int, ...], count: int) -> About:
        """Of goals of a shape: what the goal at an index and its first rows need."""
        return replace(
            self,
            goal=None if self.goal is None else self.goal.take(index),
            locked={k: np.broadcast_to(value, shape)[index] for k, value in self.locked.items()},
            q=None if self.q is None else self.q[index][:count],
        )
