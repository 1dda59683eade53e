"""RRT and RRT*: a tree grows from the starts towards samples, until it reaches a goal or paths are short."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from cspace._core import ArmOptions, ArmPlan, ArmPlans, ArmProblems, TreeOptions, plan_arm, plan_arms
from cspace.arrays import Array
from cspace.planning.arm_planner import Seed
from cspace.planning.edge_planner import EdgePlanner
from cspace.planning.space import ArmSpace
from cspace.search import option
from cspace.tolerances import LEAST_MOTION


@dataclass(frozen=True, eq=False)
class RRT(EdgePlanner):
    """RRT (LaValle 1998, "Rapidly-exploring random trees: a new tool for path planning").

    The node nearest to a sample grows a motion towards it, no longer than the range, until a goal within the
    range can be reached. The path is simplified and proved as that of every planner.
    """

    name = "rrt"
    summary = "one tree from the starts, until it reaches a goal"
    approach = "the tree came within {} of a goal"
    kind: ClassVar[tuple[bool, bool]] = False, False
    """Whether it is optimal, and informed."""

    range: float = option(
        1.0, "longest motion towards a sample", unit="rad or m", minimum=LEAST_MOTION, maximum=1e3
    )
    goal_bias: float = option(
        0.05, "how often a goal is the sample while no path is known, 0 to 1", minimum=0.0, maximum=1.0
    )

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> ArmPlan:
        """See EdgePlanner."""
        options, tree = self._core_options(rng), self._tree_options()
        return plan_arm(space.checker.core, space.bounds, space.wraps, *rows, options, tree)

    def _plan_each_rows(self, space: ArmSpace, problems: ArmProblems, rng: Seed, threads: int) -> ArmPlans:
        """See EdgePlanner."""
        options, tree = self._core_options(rng), self._tree_options()
        return plan_arms(space.checker.core, space.bounds, space.wraps, problems, options, threads, tree)

    def _core_options(self, rng: Seed) -> ArmOptions:
        """The options as the core takes them."""
        return self._make_options(rng, self.range)

    def _tree_options(self) -> TreeOptions:
        """Those of the tree."""
        return TreeOptions(*self.kind, self.goal_bias)


@dataclass(frozen=True, eq=False)
class RRTStar(RRT):
    """RRT* (Karaman & Frazzoli 2011, "Sampling-based algorithms for optimal motion planning").

    A new node is joined where the path to it is shortest, and becomes the parent of nodes near to it whose
    paths it shortens. Near are the ⌈e (1 + 1/dof) log n⌉ nearest of n nodes. Each path that is shorter than
    the last is simplified and proved; the path approaches a shortest one as the budget grows.
    """

    name = "rrt_star"
    summary = "a tree whose paths approach the shortest within a budget"
    kind = True, False

    improve: int = option(
        5000, "motions that may be checked after the first path", minimum=0, maximum=1 << 40
    )

    def _core_options(self, rng: Seed) -> ArmOptions:
        """See RRT."""
        return self._make_options(rng, self.range, self.improve)


@dataclass(frozen=True, eq=False)
class InformedRRTStar(RRTStar):
    """Informed RRT* (Gammell, Srinivasa & Barfoot 2014, "Informed RRT*").

    RRT* that draws its samples, once there is a path, from the prolate hyperspheroid through which alone a
    shorter path may lead: that of a start and a goal that are nearer to each other than the path is long.
    """

    name = "informed_rrt_star"
    summary = "RRT* whose samples can shorten the path"
    kind = True, True
