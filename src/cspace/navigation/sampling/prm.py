"""A probabilistic roadmap: points drawn evenly from free space, each joined to those near it that it sees,
and a shortest path on the roadmap (Kavraki, Svestka, Latombe & Overmars 1996).

By default points are joined within γ (log n / n)^½ of each other, γ a little above (6 A / π)^½ for free space
of the area A: then the way tends to the shortest as n grows (PRM*, Karaman & Frazzoli 2011, theorem 34).
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
    samples: int = 1000,
    neighbours: int | None = None,
    rng: int | np.random.Generator | None = None,
) -> Route:
    """A path from start to goal (2,) [m] over a roadmap of samples in a PolygonWorld.

    samples: how many points are drawn from the part of free space that holds start and goal. neighbours:
    how many of its nearest points each is joined to; by default all within a radius that shrinks as
    samples grow. rng: seed, Generator, or None for a seed drawn by chance; `route.options` keeps it.
    One seed gives one roadmap, and the one asked last is kept with the world.

    route.evidence is a Sampled. The status is "undetermined" where the roadmap does not join start and
    goal. InputError on a count below one.
    """
    options = {
        "samples": problem.count_of("samples", samples, 1),
        "neighbours": None if neighbours is None else problem.count_of("neighbours", neighbours, 1),
        "rng": problem.seed_of(rng),
    }
    return problem.ask(world, "prm", options, start, goal)


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    done: problem.Sampled = route.evidence
    segments = counted(done.edges, "segment")
    return problem.verdict_of(
        route,
        f"a shortest way on a roadmap of {counted(done.nodes, 'point')} and {segments} tested",
    )


def trace(route: Route) -> Trace:
    """The roadmap: "connect" for each edge, its value the length [m]. start, end: (k, 2) [m]."""
    return problem.trace_of(route)
