"""EdgePlanner: what the planners share that check motions in the core."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from cspace._core import ArmOptions, ArmPlan
from cspace.arrays import Array
from cspace.errors import InputTypeError
from cspace.planning.arm_planner import ArmPlanner, Seed
from cspace.planning.plan_result import Plan
from cspace.planning.space import ArmSpace
from cspace.search import draw_seed, option
from cspace.tables import join_words, shown
from cspace.tolerances import LARGEST_NUMBER, LEAST_SPACING

ENDS = (
    "found",
    "edge budget",
    "time limit",
    "invalid start",
    "invalid goals",
    "disconnected",
    "resting",
)
"""How the core ends, in its order."""


@dataclass(frozen=True, eq=False)
class EdgePlanner(ArmPlanner):
    """A planner that searches in the core by checks of motions.

    Its path is simplified by shortcuts, which are proved, then what is left of the motions of the search. A
    motion whose proof fails is removed, and the search goes on.
    A subclass defines `_plan_rows` and `_plan_each_rows`.
    """

    approach: ClassVar[str] = "the trees came within {} of each other"
    """What a failed search says of its closest approach."""

    search: str = option(
        "proved", "how the search checks motions", choices=("proved", "sampled"), subject="search"
    )
    resolution: float = option(
        1.0 / 32.0, "distance of samples", unit="rad or m", minimum=LEAST_SPACING, maximum=1e3
    )
    certify: bool = option(True, "prove every motion of the answer; False samples them as the search does")
    simplify: bool = option(True, "shorten the path")
    edges: int = option(1 << 20, "motions that the search may check", minimum=0, maximum=1 << 40)
    time_limit: float = option(
        inf,
        "time per problem; it decides only whether there is a path",
        unit="s",
        minimum=0.0,
        may_be_infinite=True,
    )

    def plan(self, space: ArmSpace, starts: ArrayLike, goals: ArrayLike, *, rng: Seed = 0) -> Plan:
        """From starts (dof,) or (s, dof) to goals (dof,) or (g, dof); see ArmPlanner.plan.

        Raises InputError for configurations of another shape, or with NaN, InputTypeError for another space.
        """
        if not isinstance(space, ArmSpace):
            raise InputTypeError(
                f"space is a {type(space).__name__}; planners take an ArmSpace, ArmSpace(robot, scene)"
            )
        rows = space.as_rows(starts, "start"), space.as_rows(goals, "goal")
        return self._name_plan(space, rows, self._plan_rows(space, rows, rng))

    def plan_each(
        self, space: ArmSpace, problems: Sequence[tuple[Any, Any]], *, rng: Seed = 0, threads: int = 0
    ) -> list[Plan]:
        """See ArmPlanner.plan_each. threads: 0 for all."""
        rows = list(problems) if are_rows(space, problems) else check_problems(space, problems)
        found = self._plan_each_rows(space, rows, rng, threads)
        return [self._name_plan(space, ends, plan) for ends, plan in zip(rows, found, strict=True)]

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> ArmPlan:
        """The core's plan from rows of starts (s, dof) to rows of goals (g, dof)."""
        raise NotImplementedError(f"{type(self).__name__} defines no _plan_rows")

    def _plan_each_rows(
        self, space: ArmSpace, rows: list[tuple[Array, Array]], rng: Seed, threads: int
    ) -> list[ArmPlan]:
        """The core's plan of each problem."""
        raise NotImplementedError(f"{type(self).__name__} defines no _plan_each_rows")

    def _make_options(self, rng: Seed, range: float = 1.0, improve: int = 0) -> ArmOptions:
        """The options as the core takes them. range: longest motion of a tree [rad or m]; improve: motions
        that may be checked for shorter paths."""
        return ArmOptions(
            self.search == "proved",
            self.certify,
            self.simplify,
            draw_seed(rng),
            self.edges,
            improve,
            self.time_limit,
            range,
            self.resolution,
        )

    def _name_plan(self, space: ArmSpace, rows: tuple[Array, Array], found: Any) -> Plan:
        """The Plan of what the core found, an ArmPlan."""
        status, reason = self._explain_end(space, rows, found)
        path = found.path
        return Plan(
            status=status,
            reason=reason,
            path=path,
            cost=found.cost,
            start=found.start,
            goal=found.goal,
            certified=found.certified,
            stats=self._list_stats(space, found),
            space=space,
            planner=self,
        )

    def _explain_end(self, space: ArmSpace, rows: tuple[Array, Array], found: Any) -> tuple[str, str]:
        """The status of a plan, and its reason in words."""
        return explain_end(space, rows, found, self.approach)

    def _list_stats(self, space: ArmSpace, found: Any) -> dict[str, Any]:
        """What the search did."""
        return dict(found.stats)


def are_rows(space: ArmSpace, problems: Sequence[tuple[Any, Any]]) -> bool:
    """Whether all starts and goals are rows (n, dof) already, as the core takes them: checked in one go."""
    ends = [rows for problem in problems for rows in problem]
    are_plain = bool(ends) and all(
        type(rows) is np.ndarray
        and rows.dtype == np.float64
        and rows.ndim == 2
        and rows.shape[1] == space.dof
        and rows.flags.carray
        and len(rows)
        for rows in ends
    )
    return are_plain and bool(np.abs(np.concatenate(ends)).max(initial=0.0) <= LARGEST_NUMBER)


def check_problems(space: ArmSpace, problems: Sequence[tuple[Any, Any]]) -> list[tuple[Array, Array]]:
    """Starts and goals as rows (n, dof); InputError, with its number, for a problem that is not valid."""
    return [
        (space.as_rows(starts, f"start {k}"), space.as_rows(goals, f"goal {k}"))
        for k, (starts, goals) in enumerate(problems)
    ]


def explain_end(space: ArmSpace, rows: tuple[Array, Array], found: ArmPlan, approach: str) -> tuple[str, str]:
    """The status of a plan, and its reason in words."""
    end = ENDS[found.status]
    if end == "found":
        corners = len(found.path)
        return "found", f"found a path of length {shown(found.cost)} with {corners} corners"
    if end == "invalid start":
        return "invalid_start", explain_rows(space, rows[0], found.starts, "start")
    if end == "invalid goals":
        return "invalid_goal", explain_rows(space, rows[1], found.goals, "goal")
    return "undetermined", explain_budget(space, found, end, approach)


def explain_rows(space: ArmSpace, rows: Array, reports: Sequence[Any], subject: str) -> str:
    """Why none of these configurations may be taken: the first, and how many."""
    causes = [
        space.describe_contact(row, contact) or space.describe_violation(row)
        for row, (_, contact) in zip(rows[:1], reports, strict=False)
    ]
    return (
        f"{subject}: {causes[0]}"
        if len(rows) == 1
        else f"none of {len(rows)} {subject}s is free; of the first, {causes[0]}"
    )


def explain_budget(space: ArmSpace, found: ArmPlan, end: str, approach: str) -> str:
    """Why a search gave up: the budget, the closest approach, and what was most in the way."""
    stats = found.stats
    parts = [f"the {end} was used up after {stats['edges']} motions"]
    distance, near, _ = found.approach
    if len(near):
        parts.append(approach.format(shown(distance)))
    return join_words(parts + name_blocker(space, found))


def name_blocker(space: ArmSpace, found: ArmPlan) -> list[str]:
    """What was most in the way, in words; empty if nothing was."""
    contact, count = found.blocker
    if contact is None:
        return []
    return [f"{' and '.join(space.checker.name_pair(contact))} blocked {count} motions"]
