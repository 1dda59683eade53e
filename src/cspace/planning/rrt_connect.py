"""RRT-Connect: two trees grow from starts and goals towards samples and towards each other."""

from __future__ import annotations

from dataclasses import dataclass

from cspace._core import ArmOptions, ArmPlan, ArmPlans, ArmProblems, plan_arm, plan_arms
from cspace.arrays import Array
from cspace.planning.arm_planner import Seed
from cspace.planning.edge_planner import EdgePlanner
from cspace.planning.space import ArmSpace
from cspace.search import option
from cspace.tolerances import LEAST_MOTION


@dataclass(frozen=True, eq=False)
class RRTConnect(EdgePlanner):
    """RRT-Connect (Kuffner & LaValle 2000), simplified by shortcuts, every motion of the answer proved.

    The smaller tree grows towards a sample of a Halton sequence, the other one towards the new node. Nodes
    near obstacles take samples near them only (dynamic domain, Yershova et al. 2005).
    """

    name = "rrt_connect"
    summary = "two trees from start and goal; the default"

    range: float = option(1.0, "longest motion of a tree", unit="rad or m", minimum=LEAST_MOTION, maximum=1e3)

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> ArmPlan:
        """See EdgePlanner."""
        options = self._core_options(rng)
        return plan_arm(space.checker.core, space.bounds, space.wraps, *rows, options)

    def _plan_each_rows(self, space: ArmSpace, problems: ArmProblems, rng: Seed, threads: int) -> ArmPlans:
        """See EdgePlanner."""
        options = self._core_options(rng)
        return plan_arms(space.checker.core, space.bounds, space.wraps, problems, options, threads)

    def _core_options(self, rng: Seed) -> ArmOptions:
        """The options as the core takes them."""
        return self._make_options(rng, self.range)
