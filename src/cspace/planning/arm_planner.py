"""ArmPlanner: the base of planners of arms, those of the library and those of users."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace._core import ArmProblems
from cspace.planning.plan_result import Plan
from cspace.planning.plans import Plans
from cspace.planning.space import ArmSpace
from cspace.search import Planner

Seed = int | np.random.Generator | None
Problems = Sequence[tuple[Any, Any]] | ArmProblems
"""Pairs of starts and goals."""


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

    def plan_each(self, space: ArmSpace, problems: Problems, *, rng: Seed = 0, threads: int = 0) -> Plans:
        """A plan per problem, a pair of starts and goals, each as if alone."""
        pairs = [problems[k] for k in range(len(problems))]
        return Plans(self.plan(space, starts, goals, rng=rng) for starts, goals in pairs)
