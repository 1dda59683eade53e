"""Planners that draw samples: random points of free space, joined where they are mutually visible."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from cspace import _core
from cspace.maps.outlines import longer_side
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.navigation.text import explain_division
from cspace.search import draw_seed, option
from cspace.tables import count_things
from cspace.tolerances import MOST_SAMPLES, SAMPLE_STEP


class Sampled(NamedTuple):
    """What a planner that draws samples has done; all 0 where no path can exist."""

    samples: int
    """Points drawn from free space, or the goal in their place."""
    nodes: int
    """Points kept, start among them."""
    edges: int
    """Segments tested."""


@dataclass(frozen=True, eq=False)
class SamplePlanner(PlanePlanner):
    """A planner that draws samples in a PolygonWorld.

    route.evidence is a Sampled. The status is "undetermined" where the samples were too few.
    """

    events = ("connect", "rewire")
    kind: ClassVar[int]
    """The number of the planner in the core."""

    samples: int = option(5000, "how many points are drawn.", minimum=1, maximum=MOST_SAMPLES)
    rng: int | np.random.Generator | None = option(
        None, "seed, Generator, or None for a seed drawn by chance; `route.options` keeps it."
    )

    def _fill_in(self, world: Any) -> SamplePlanner:
        return self._in_force(rng=draw_seed(self.rng))

    def _settings(self) -> tuple[Any, ...]:
        """The planner, samples, seed, neighbours (0: by radius), step [m], goal bias."""
        return self.kind, self.samples, self.rng, 0, 1.0, 0.0

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        settings = *self._settings(), Sampled
        return _core._sampling(traced, world, world._core, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        done: Sampled = route.evidence
        nodes, segments = count_things(done.nodes, "node"), count_things(done.edges, "segment")
        samples = count_things(done.samples, "sample")
        if route:
            return self._explain_path(done)
        if route.status == "unreachable":
            return f"{explain_division(route.world)}; this is known from the map, without a sample"
        return f"no path among {samples}, {nodes} and {segments} tested; a path exists; try more samples="

    def _explain_path(self, done: Sampled) -> str:
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class PRM(SamplePlanner):
    """A probabilistic roadmap: points drawn evenly from free space, each joined to the visible ones near it,
    and a shortest path on the roadmap (Kavraki, Svestka, Latombe & Overmars 1996).

    By default points are joined within γ (log n / n)^½ of each other, γ a little above (6 A / π)^½ for free
    space of the area A: then the path tends to the shortest as n grows (PRM*, Karaman & Frazzoli 2011,
    theorem 34). One seed gives one roadmap, and the one asked last is kept with the world. The trace
    contains the event "connect" for each edge of the roadmap; its value is the length [m].
    """

    name = "prm"
    summary = "shortest path on a roadmap of visible random samples"
    kind = 0

    samples: int = option(
        1000,
        "how many points are drawn from the part of free space that holds start and goal.",
        minimum=1,
        maximum=MOST_SAMPLES,
    )
    neighbours: int | None = option(
        None,
        "how many of its nearest points each is joined to; by default all within a radius that shrinks as "
        "samples grow.",
        minimum=1,
        maximum=MOST_SAMPLES,
    )

    def _settings(self) -> tuple[Any, ...]:
        return self.kind, self.samples, self.rng, self.neighbours or 0, 1.0, 0.0

    def _explain_path(self, done: Sampled) -> str:
        segments = count_things(done.edges, "segment")
        return f"a shortest way on a roadmap of {count_things(done.nodes, 'point')} and {segments} tested"


@dataclass(frozen=True, eq=False)
class RRT(SamplePlanner):
    """A rapidly exploring random tree, rooted at the start: the node nearest to a random point grows a step
    towards it, until the goal is visible from a node within a step (LaValle 1998, "Rapidly-exploring random
    trees: a new tool for path planning").

    Where a path exists, one is found with a probability that tends to one; it is not a shortest path, and
    does not tend to one. The trace contains the event "connect" for each edge of the tree; its value is the
    length [m] of the path from the start.
    """

    name = "rrt"
    summary = "tree that grows towards random samples until it reaches the goal"
    kind = 1

    samples: int = option(20_000, "how many points may be drawn.", minimum=1, maximum=MOST_SAMPLES)
    step: float | None = option(
        None,
        "the longest edge; by default a tenth of the longer side of the bounds.",
        unit="m",
        above=0,
    )
    goal_bias: float = option(
        0.05, "how often the goal is drawn in place of a random point, 0 to 1.", minimum=0, maximum=1
    )

    def _fill_in(self, world: Any) -> SamplePlanner:
        step = SAMPLE_STEP * longer_side(world.bounds) if self.step is None else self.step
        return self._in_force(rng=draw_seed(self.rng), step=step)

    def _settings(self) -> tuple[Any, ...]:
        return self.kind, self.samples, self.rng, 0, self.step, self.goal_bias

    def _explain_path(self, done: Sampled) -> str:
        samples = count_things(done.samples, "sample")
        return f"a tree of {count_things(done.nodes, 'node')} reached the goal after {samples}"


@dataclass(frozen=True, eq=False)
class RRTStar(RRT):
    """RRT*: a tree like that of RRT whose new nodes are joined where the path to them is shortest, and become
    parents of others where that shortens theirs (Karaman & Frazzoli 2011, "Sampling-based algorithms for
    optimal motion planning").

    The ball in which neighbours are sought has the radius γ (log n / n)^½ for n nodes, γ a little above
    (6 A / π)^½ for free space of the area A, or a step where that is less. Once there is a path, only points
    are drawn that a shorter one can pass: those of an ellipse around start and goal (Gammell, Srinivasa &
    Barfoot 2014, "Informed RRT*"), and A is its area where that is less. One seed gives one sequence of
    samples, so more of them never make the path longer.

    The trace also contains the event "rewire" for a node that gets another parent.
    """

    name = "rrt_star"
    summary = "tree of random samples whose paths converge to the shortest"
    kind = 2

    samples: int = option(5000, "how many points are drawn.", minimum=1, maximum=MOST_SAMPLES)
    goal_bias: float = option(
        0.05,
        "how often the goal is drawn in place of a random point while no path is known, 0 to 1.",
        minimum=0,
        maximum=1,
    )

    def _explain_path(self, done: Sampled) -> str:
        samples = count_things(done.samples, "sample")
        return f"the best way in a tree of {count_things(done.nodes, 'node')} after {samples}"
