"""AORRTC: RRT-Connect below the cost of the best path, again and again."""

from __future__ import annotations

from dataclasses import dataclass

from cspace._core import ArmOptions
from cspace.planning.arm_planner import Seed
from cspace.planning.rrt_connect import RRTConnect
from cspace.search import option


@dataclass(frozen=True, eq=False)
class AORRTC(RRTConnect):
    """AORRTC (Wilson et al. 2025): a first path by RRT-Connect, then shorter and shorter ones.

    Two trees grow in the product of configurations and costs: a sample from the set through which a shorter
    path may lead gets a bound on the cost at which it may be reached, and joins the nearest node below it.
    Each path found is simplified and proved. The path approaches a shortest one as the budget grows.
    """

    name = "aorrtc"
    summary = "RRT-Connect, then ever shorter paths within a budget"

    improve: int = option(5000, "motions that may be checked for shorter paths", minimum=0, maximum=1 << 40)

    def _core_options(self, rng: Seed) -> ArmOptions:
        """See RRTConnect."""
        return self._make_options(rng, self.range, self.improve)
