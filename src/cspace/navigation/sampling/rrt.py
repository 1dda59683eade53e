"""A rapidly exploring random tree: of a tree that is rooted at the start, the node nearest to a random
point grows a step towards it, until one sees the goal within a step (LaValle 1998, "Rapidly-exploring
random trees: a new tool for path planning").

Where a way exists, one is found with a probability that tends to one; it is no shortest path, and does not
tend to one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cspace.navigation.sampling import problem
from cspace.navigation.text import counted
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["plan", "reason", "trace"]


def plan(
    world: PolygonWorld,
    start: Any,
    goal: Any,
    *,
    samples: int = 20_000,
    step: float | None = None,
    goal_bias: float = 0.05,
    rng: int | np.random.Generator | None = None,
) -> Route:
    """A path from start to goal (2,) [m] by a tree that grows through a PolygonWorld.

    samples: how many points may be drawn. step [m]: the longest edge; by default a tenth of the longer
    side of the bounds. goal_bias: how often the goal is drawn in place of a random point, 0 to 1. rng:
    seed, Generator, or None for a seed drawn by chance; `route.options` keeps it.

    route.evidence is a Sampled. The status is "undetermined" where the samples were too few. InputError
    on options out of range.
    """
    options = problem.tree_options(world, samples, step, goal_bias, rng)
    return problem.ask(world, "rrt", options, start, goal)


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    done: problem.Sampled = route.evidence
    return problem.verdict_of(
        route,
        f"a tree of {counted(done.nodes, 'node')} reached the goal after {counted(done.samples, 'sample')}",
    )


def trace(route: Route) -> Trace:
    """The growth of the tree: "connect" for each edge, its value the length [m] of the way from the start.
    start, end: (k, 2) [m]."""
    return problem.trace_of(route)
