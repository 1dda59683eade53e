"""ArmPlanner: the base of planners of arms, those of the library and those of users."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace.planning.plan_result import Plan
from cspace.planning.space import ArmSpace
from cspace.search import Planner

Seed = int | np.random.Generator | None


@dataclass(frozen=True, eq=False)
class ArmPlanner(Planner):
    """A planner of arms: `plan(space, starts, goals, rng=)` returns a Plan.

    A subclass is a dataclass(frozen=True). It declares its options as fields, by `cs.search.option`, and
    defines `plan`.
    """

    def plan(self, space: ArmSpace, starts: ArrayLike, goals: ArrayLike, *, rng: Seed = 0) -> Plan:
        """The way from one of the starts (dof,) or (s, dof) to one of the goals (dof,) or (g, dof).

        rng: seed or generator; the same seed gives the same plan on every machine.
        """
        raise NotImplementedError(f"{type(self).__name__} defines no plan(space, starts, goals, rng=)")

    def plan_each(
        self, space: ArmSpace, problems: Sequence[tuple[Any, Any]], *, rng: Seed = 0, threads: int = 0
    ) -> list[Plan]:
        """A plan per problem, a pair of starts and goals, each as if alone."""
        return [self.plan(space, starts, goals, rng=rng) for starts, goals in problems]
