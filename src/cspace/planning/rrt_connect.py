"""RRT-Connect: two trees grow from starts and goals towards samples and towards each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from numpy.typing import ArrayLike

from cspace._core import ArmOptions, ArmPlan, plan_arm, plan_arms
from cspace.arrays import Array
from cspace.planning.arm_planner import ArmPlanner, Seed
from cspace.planning.plan_result import Plan
from cspace.planning.space import ArmSpace
from cspace.search import draw_seed, option
from cspace.tables import join_words, shown

ENDS = ("found", "edge budget", "time limit", "invalid start", "invalid goals")
"""How the core ends, in its order."""


@dataclass(frozen=True, eq=False)
class RRTConnect(ArmPlanner):
    """RRT-Connect (Kuffner & LaValle 2000), simplified by shortcuts, every motion of the answer proved.

    The smaller tree grows towards a sample of a Halton sequence, the other one towards the new node. Nodes
    near obstacles take samples near them only (dynamic domain, Yershova et al. 2005). The search checks
    motions at samples or proves them; the shortcuts are proved, then what is left of the trees. A motion
    whose proof fails is removed, and the search goes on.
    """

    name = "rrt_connect"
    summary = "two trees from start and goal; the default"

    search: str = option(
        "proved", "how the trees check motions", choices=("proved", "sampled"), subject="kind of check"
    )
    resolution: float = option(1.0 / 32.0, "distance of samples", unit="rad or m", above=0.0, maximum=1e3)
    range: float = option(1.0, "longest motion of a tree", unit="rad or m", above=0.0, maximum=1e3)
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
        """See ArmPlanner.plan. Raises InputError for configurations of another shape, or with NaN."""
        rows = space.as_rows(starts, "start"), space.as_rows(goals, "goal")
        found = plan_arm(space.checker.core, space.bounds, space.wraps, *rows, self.core_options(rng))
        return self.name_plan(space, rows, found)

    def plan_each(
        self, space: ArmSpace, problems: Sequence[tuple[Any, Any]], *, rng: Seed = 0, threads: int = 0
    ) -> list[Plan]:
        """See ArmPlanner.plan_each. threads: 0 for all."""
        rows = [
            (space.as_rows(starts, f"start {k}"), space.as_rows(goals, f"goal {k}"))
            for k, (starts, goals) in enumerate(problems)
        ]
        options = self.core_options(rng)
        found = plan_arms(space.checker.core, space.bounds, space.wraps, rows, options, threads)
        return [self.name_plan(space, ends, plan) for ends, plan in zip(rows, found, strict=True)]

    def core_options(self, rng: Seed) -> ArmOptions:
        """The options as the core takes them."""
        return self.make_options(rng)

    def make_options(self, rng: Seed, improve: int = 0) -> ArmOptions:
        """The options as the core takes them. improve: motions that may be checked for shorter paths."""
        proved = self.search == "proved"
        return ArmOptions(
            proved,
            self.certify,
            self.simplify,
            draw_seed(rng),
            self.edges,
            improve,
            self.time_limit,
            self.range,
            self.resolution,
        )

    def name_plan(self, space: ArmSpace, rows: tuple[Array, Array], found: ArmPlan) -> Plan:
        """The Plan of what the core found."""
        status, reason = explain_end(space, rows, found)
        path = found.path
        return Plan(
            status=status,
            reason=reason,
            path=path,
            cost=found.cost,
            start=found.start,
            goal=found.goal,
            certified=found.certified,
            stats=found.stats,
            space=space,
            planner=self,
        )


def explain_end(space: ArmSpace, rows: tuple[Array, Array], found: ArmPlan) -> tuple[str, str]:
    """The status of a plan, and its reason in words."""
    end = ENDS[found.status]
    if end == "found":
        corners = len(found.path)
        return "found", f"found a path of length {shown(found.cost)} with {corners} corners"
    if end == "invalid start":
        return "invalid_start", explain_rows(space, rows[0], found.starts, "start")
    if end == "invalid goals":
        return "invalid_goal", explain_rows(space, rows[1], found.goals, "goal")
    return "undetermined", explain_budget(space, found, end)


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


def explain_budget(space: ArmSpace, found: ArmPlan, end: str) -> str:
    """Why a search gave up: the budget, the closest approach, and what was most in the way."""
    stats = found.stats
    parts = [f"the {end} was used up after {stats['edges']} motions"]
    distance, near, _ = found.approach
    if len(near):
        parts.append(f"the trees came within {shown(distance)} of each other")
    contact, count = found.blocker
    if contact is not None:
        parts.append(f"{' and '.join(space.checker.name_pair(contact))} blocked {count} motions")
    return join_words(parts)
