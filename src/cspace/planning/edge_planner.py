"""EdgePlanner: what the planners share that check motions in the core."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace._core import ArmOptions, ArmPlan, ArmPlans, ArmProblems, TimeOver
from cspace.arrays import Array
from cspace.errors import InputTypeError, name_type
from cspace.planning.arm_planner import ArmPlanner, Problems, Seed
from cspace.planning.plan_result import Plan
from cspace.planning.plans import Plans, PlanSource
from cspace.planning.space import ArmSpace
from cspace.search import draw_seed, option
from cspace.tables import join_words, shown
from cspace.tolerances import LEAST_SPACING

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

STATUS_OF_END: Final = {
    "found": "found",
    "edge budget": "undetermined",
    "time limit": "undetermined",
    "invalid start": "invalid_start",
    "invalid goals": "invalid_goal",
    "disconnected": "undetermined",
    "resting": "undetermined",
}
"""The status of a plan for each."""

STATUSES_OF_ENDS: Final = tuple(STATUS_OF_END[end] for end in ENDS)
"""The same by number."""


@dataclass(frozen=True, eq=False)
class EdgePlanner(ArmPlanner):
    """A planner that searches in the core by checks of motions.

    Its path is simplified by shortcuts, which are proved, then what is left of the motions of the search. A
    motion whose proof fails is removed, and the search goes on.
    A subclass defines `_plan_rows` and `_plan_each_rows`.
    """

    approach: ClassVar[str] = "the trees came within {} of each other"
    """What a failed search says of its closest approach."""
    _late: ClassVar[str] = "the time limit was used up before the search began"

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
                f"space is {name_type(space)}; planners take an ArmSpace, ArmSpace(robot, scene)"
            )
        rows = space.as_rows(starts, "start"), space.as_rows(goals, "goal")
        try:
            found = self._plan_rows(space, rows, rng)
        except TimeOver:
            return self._name_late(space)
        return self._name_plan(space, rows, found)

    def plan_each(self, space: ArmSpace, problems: Problems, *, rng: Seed = 0, threads: int = 0) -> Plans:
        """See ArmPlanner.plan_each. threads: 0 for all."""
        given = problems if isinstance(problems, ArmProblems) else join_problems(space, problems)
        try:
            found = self._plan_each_rows(space, given, rng, threads)
        except TimeOver:
            return Plans(self._name_late(space) for _ in range(len(given)))
        source = FoundPlans(self, space, given, found)
        return Plans._of_source(
            source, range(len(given)), self._list_statuses(found), found.cost, found.corners
        )

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> ArmPlan:
        """The core's plan from rows of starts (s, dof) to rows of goals (g, dof)."""
        raise NotImplementedError(f"{type(self).__name__} defines no _plan_rows")

    def _plan_each_rows(self, space: ArmSpace, problems: ArmProblems, rng: Seed, threads: int) -> ArmPlans:
        """The core's plans of many problems."""
        raise NotImplementedError(f"{type(self).__name__} defines no _plan_each_rows")

    def _make_options(
        self, rng: Seed, range: float = 1.0, improve: int = 0, time_limit: float | None = None
    ) -> ArmOptions:
        """The options as the core takes them. range: longest motion of a tree [rad or m]; improve: motions
        that may be checked for shorter paths; time_limit: what is left of it [s]."""
        return ArmOptions(
            self.search == "proved",
            self.certify,
            self.simplify,
            draw_seed(rng),
            self.edges,
            improve,
            self.time_limit if time_limit is None else time_limit,
            range,
            self.resolution,
        )

    def _name_plan(self, space: ArmSpace, rows: tuple[Array, Array], found: Any) -> Plan:
        """The Plan of what the core found, an ArmPlan."""
        status, reason = self._explain_end(space, rows, found)
        return Plan._of_fields(
            status=status,
            reason=reason,
            path=found.path,
            cost=found.cost,
            start=found.start,
            goal=found.goal,
            certified=found.certified,
            stats=self._list_stats(space, found),
            space=space,
            planner=self,
        )

    def _name_late(self, space: ArmSpace) -> Plan:
        """The plan where time was over before the search."""
        path = np.empty((0, space.dof))
        return Plan("undetermined", self._late, path, inf, -1, -1, False, {}, space, self)

    def _list_statuses(self, found: Any) -> tuple[str, ...]:
        """The status of each of the core's plans."""
        return tuple(map(STATUSES_OF_ENDS.__getitem__, found.status.tolist()))

    def _explain_end(self, space: ArmSpace, rows: tuple[Array, Array], found: Any) -> tuple[str, str]:
        """The status of a plan, and its reason in words."""
        return explain_end(space, rows, found, self.approach)

    def _list_stats(self, space: ArmSpace, found: Any) -> dict[str, Any]:
        """What the search did."""
        stats: dict[str, Any] = found.stats
        return stats


class FoundPlans(PlanSource):
    """The plans that the core found, named by their planner."""

    def __init__(self, planner: EdgePlanner, space: ArmSpace, problems: ArmProblems, found: ArmPlans) -> None:
        super().__init__([None] * len(problems), space.dof)
        self._planner, self._space, self._problems, self._found = planner, space, problems, found

    def path(self, k: int) -> Array:
        """See PlanSource."""
        return self._found.plan(k).path

    def _make_plan(self, k: int) -> Plan:
        return self._planner._name_plan(self._space, self._problems[k], self._found.plan(k))


def join_problems(
    space: ArmSpace, problems: Sequence[tuple[Any, Any]], time_limits: Sequence[float] | None = None
) -> ArmProblems:
    """Pairs of starts and goals as the core takes them, and what time each has.

    Raises InputError, with its number, for a problem that is not valid.
    """
    starts = [space.as_rows(rows, f"start {k}") for k, (rows, _) in enumerate(problems)]
    goals = [space.as_rows(rows, f"goal {k}") for k, (_, rows) in enumerate(problems)]
    limits = None if time_limits is None else np.array(time_limits, dtype=np.float64)
    return ArmProblems(*join_rows(starts, space.dof), *join_rows(goals, space.dof), limits)


def join_rows(parts: list[Array], dof: int) -> tuple[Array, npt.NDArray[np.int64]]:
    """The rows of all parts (m, dof), and how many each has (n,)."""
    counts = np.array([len(rows) for rows in parts], dtype=np.int64)
    return np.concatenate(parts) if parts else np.empty((0, dof)), counts


def explain_end(space: ArmSpace, rows: tuple[Array, Array], found: ArmPlan, approach: str) -> tuple[str, str]:
    """The status of a plan, and its reason in words."""
    end = ENDS[found.status]
    if end == "found":
        return end, f"found a path of length {found.cost:.6g} with {len(found.path)} corners"
    status = STATUS_OF_END[end]
    if status == "invalid_start":
        return status, explain_rows(space, rows[0], found.starts, "start")
    if status == "invalid_goal":
        return status, explain_rows(space, rows[1], found.goals, "goal")
    return status, explain_budget(space, found, end, approach)


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
