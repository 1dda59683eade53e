"""RRT*: a tree like that of RRT whose new nodes are joined where the way to them is shortest, and lead others
through them where that shortens theirs (Karaman & Frazzoli 2011, "Sampling-based algorithms for optimal
motion planning").

The ball in which neighbours are asked has the radius γ (log n / n)^½ for n nodes, γ a little above
(6 A / π)^½ for free space of the area A, or a step where that is less. Once there is a path, only points are
drawn that a shorter one can pass: those of an ellipse around start and goal (Gammell, Srinivasa & Barfoot
2014, "Informed RRT*"), and A is its area where that is less. One seed gives one sequence of samples, so more
of them never make the path longer.
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
    samples: int = 5000,
    step: float | None = None,
    goal_bias: float = 0.05,
    rng: int | np.random.Generator | None = None,
) -> Route:
    """A path from start to goal (2,) [m] in a PolygonWorld that tends to the shortest as samples grow.

    samples: how many points are drawn. step [m]: the longest edge; by default a tenth of the longer side
    of the bounds. goal_bias: how often the goal is drawn in place of a random point while no path is
    known, 0 to 1. rng: seed, Generator, or None for a seed drawn by chance; `route.options` keeps it.

    route.evidence is a Sampled. The status is "undetermined" where the samples were too few. InputError
    on options out of range.
    """
    options = problem.tree_options(world, samples, step, goal_bias, rng)
    return problem.ask(world, "rrt_star", options, start, goal)


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    done: problem.Sampled = route.evidence
    return problem.verdict_of(
        route,
        f"the best way in a tree of {counted(done.nodes, 'node')} after {counted(done.samples, 'sample')}",
    )


def trace(route: Route) -> Trace:
    """The growth of the tree: "connect" for each edge, "rewire" for a node that is led through another; the
    value is the length [m] of the way from the start. start, end: (k, 2) [m]."""
    return problem.trace_of(route)
