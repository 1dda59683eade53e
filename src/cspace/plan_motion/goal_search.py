"""GoalSearch: the plan to a goal of any kind, in the time that its planner has."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace._core import TimeOver
from cspace.arrays import Array
from cspace.plan_motion.find import explain_goals, find_goals
from cspace.plan_motion.goals import Goals
from cspace.plan_motion.separation import REASON, Separation
from cspace.planning import ArmPlanner, ArmSpace, Plan, RRTConnect
from cspace.planning.arm_planner import Seed
from cspace.planning.time_limits import TimeLimit

if TYPE_CHECKING:
    from cspace.robot import Robot

QUICK_EDGES: Final = 4096
"""Motions after which a proof for two joints is worth its time."""

PROOF_SECONDS: Final = 0.5
"""Time that must be left for such a proof: it takes half of that."""

LATE = "the time limit was used up before a configuration of the goal was found"


class GoalSearch:
    """Finds the configurations of one goal and plans to them; both share the time limit of the planner."""

    def __init__(
        self, robot: Robot, planner: ArmPlanner, space: ArmSpace, rng: Seed, seconds: float | None = None
    ) -> None:
        self.robot, self.planner, self.space, self.rng = robot, planner, space, rng
        self.limit = TimeLimit(getattr(planner, "time_limit", inf) if seconds is None else seconds)

    def find(self, starts: Array, goal: Any) -> Goals:
        """The configurations of a goal, as find_goals; none if they take too long."""
        return self._find(partial(find_goals, self.robot, self.space, starts, goal))

    def plan(self, starts: Array, goals: Goals) -> Plan:
        """A plan to the configurations of a goal; if none of them is free and others exist, to those."""
        if not len(goals.rows):
            return make_negative(self.space, self.planner, goals.status, goals.reason)
        found = self._plan_rows(starts, goals)
        if found.status == "invalid_goal" and not goals.is_given:
            return self.plan_to_more(starts, goals)
        return found

    def plan_to_more(self, starts: Array, goals: Goals) -> Plan:
        """A plan where no configuration of a goal is free: to further ones, or the reason why there is
        none."""
        if goals.find_more is not None:
            return self.plan(starts, self._find(goals.find_more))
        return make_negative(self.space, self.planner, *explain_goals(self.space, goals))

    def _find(self, find: Callable[[], Goals]) -> Goals:
        if self.limit.is_endless:
            return find()
        try:
            with self.limit.enforce():
                return find()
        except TimeOver:
            return Goals(np.empty((0, self.space.dof)), LATE, is_whole=False)

    def _plan_rows(self, starts: Array, goals: Goals) -> Plan:
        if self.space.dof != 2 or not goals.is_whole:
            return self._search(self.planner, starts, goals)
        quick = find_quick(self.planner)
        found = self._search(quick, starts, goals)
        if found.status == "undetermined" and self._are_separated(starts, goals):
            return make_negative(self.space, self.planner, "unreachable", REASON)
        is_cut = quick is not self.planner and found.stats.get("edges", 0) > QUICK_EDGES // 2
        if is_cut and self.limit.left > 0.0:
            return self._search(self.planner, starts, goals, self.limit)
        return found if quick is self.planner else replace(found, planner=self.planner)

    def _are_separated(self, starts: Array, goals: Goals) -> bool:
        """Whether a proof says that there is no way for two joints, where there is time for one."""
        left = self.limit.left
        return left > PROOF_SECONDS and Separation(self.space, left).divides(starts, goals.rows)

    def _search(
        self, planner: ArmPlanner, starts: Array, goals: Goals, limit: TimeLimit | None = None
    ) -> Plan:
        """A plan by a planner; limit: what is left of the time, unless it began with the search."""
        if self.limit.is_endless or (goals.is_given and limit is None):
            return planner.plan(self.space, starts, goals.rows, rng=self.rng)
        limited = planner.with_options({"time_limit": self.limit.left})
        found = limited.plan(self.space, starts, goals.rows, rng=self.rng)
        return replace(found, planner=planner)


def find_quick(planner: ArmPlanner) -> ArmPlanner:
    """The planner with a budget after which a proof is worth its time; itself without a larger one."""
    is_larger = isinstance(planner, RRTConnect) and planner.edges > QUICK_EDGES
    return planner.with_options({"edges": QUICK_EDGES}) if is_larger else planner


def make_negative(space: ArmSpace, planner: ArmPlanner, status: str, reason: str) -> Plan:
    """A plan without a path."""
    path = np.empty((0, space.dof))
    return Plan(status, reason, path, np.inf, -1, -1, False, {}, space, planner)
