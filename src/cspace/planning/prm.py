"""PRM, lazy PRM and PRM*: the shortest way over a roadmap that serves many scenes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

from cspace._core import (
    ArmOptions,
    ArmPlan,
    ArmPlans,
    ArmProblems,
    RoadmapWorld,
    plan_each_on_roadmap,
    plan_on_roadmap,
)
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.planning.arm_planner import Seed
from cspace.planning.edge_planner import ENDS, EdgePlanner
from cspace.planning.plan_result import Plan
from cspace.planning.roadmap import MOST_NEIGHBOURS, NEIGHBOURS, SAMPLES, Roadmap
from cspace.planning.roadmap_files import MOST_SAMPLES
from cspace.planning.space import ArmSpace
from cspace.planning.time_limits import TimeLimit
from cspace.search import draw_seed, option
from cspace.tables import join_words, shown

KEPT_ROADMAPS: Final = 4
"""Roadmaps that a geometry keeps for planners without `roadmap=`."""


@dataclass(frozen=True, eq=False)
class RoadmapPlanner(EdgePlanner):
    """A planner on a roadmap: the one given, or one that is made on first use and kept with the robot.

    Starts and goals are joined to the nearest nodes that are free, and A* finds the shortest way. A subclass
    says in `_is_lazy` whether edges are checked only where a shortest way may use them, and in
    `_wanted_neighbours` how many each node is joined to.
    """

    samples: int = option(SAMPLES, "points drawn for the roadmap", minimum=1, maximum=MOST_SAMPLES)
    roadmap: Roadmap | str | None = option(
        None,
        "a Roadmap, or the path of a saved one; by default one is made of samples= and the seed, and kept",
    )

    _is_lazy = True
    _late = (
        "the time limit was used up before there was a roadmap; make one once with"
        " roadmap = cs.planning.Roadmap(robot), and give it as roadmap="
    )

    @property
    def _wanted_neighbours(self) -> int | None:
        """None: as PRM* needs."""
        return None

    def _roadmap_of(self, space: ArmSpace, rng: Seed) -> Roadmap:
        """The roadmap given or loaded; else the one of the geometry for these options, made if need be."""
        given: Any = self.roadmap
        if isinstance(given, Roadmap):
            return given
        if given is not None:
            return Roadmap.load(given, space.geometry)
        count, seed = self._wanted_neighbours, draw_seed(rng)
        kept: dict[Any, Roadmap] = space.geometry._kept.setdefault("roadmaps", {})
        key = self.samples, count, space.margin, seed
        found = kept.pop(key, None)
        if found is None:
            found = Roadmap(
                space.geometry, samples=self.samples, neighbours=count, margin=space.margin, rng=seed
            )
            for name in list(kept)[: max(0, len(kept) - KEPT_ROADMAPS + 1)]:
                kept.pop(name, None)
        kept[key] = found
        return found

    def _open_world(self, space: ArmSpace, rng: Seed) -> tuple[RoadmapWorld, ArmOptions]:
        """The roadmap in the scene of a space, and the options as the core takes them, with the time that is
        left. Raises TimeOver where none is."""
        limit = TimeLimit(self.time_limit)
        with limit.enforce():
            world = self._roadmap_of(space, rng)._world(space, self.search == "proved", self.resolution)
        return world, self._make_options(rng, time_limit=limit.left)

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> ArmPlan:
        """See EdgePlanner."""
        world, options = self._open_world(space, rng)
        return plan_on_roadmap(world, space.bounds, space.wraps, *rows, options, self._is_lazy)

    def _plan_each_rows(self, space: ArmSpace, problems: ArmProblems, rng: Seed, threads: int) -> ArmPlans:
        """See EdgePlanner."""
        world, options = self._open_world(space, rng)
        return plan_each_on_roadmap(
            world, space.bounds, space.wraps, problems, options, self._is_lazy, threads
        )

    def _name_plan(self, space: ArmSpace, rows: tuple[Array, Array], found: ArmPlan) -> Plan:
        """See EdgePlanner."""
        plan = super()._name_plan(space, rows, found)
        if ENDS[found.status] != "disconnected":
            return plan
        return replace(plan, reason=explain_gap(space, found))


def explain_gap(space: ArmSpace, found: ArmPlan) -> str:
    """Why a roadmap holds no path: the parts of it that start and goal are in, and what lies between."""
    stats = found.stats
    ends = stats["start_nodes"], stats["goal_nodes"]
    parts = [
        f"the roadmap joins the start with {ends[0]} of its nodes and the goal with {ends[1]} others",
        f"they come within {shown(found.approach[0])} of each other",
    ]
    contact, count = found.blocker
    if contact is not None:
        parts.append(f"{' and '.join(space.checker.name_pair(contact))} blocked {count} motions")
    return f"{join_words(parts)}; more samples (samples=) may join them"


@dataclass(frozen=True, eq=False)
class PRM(RoadmapPlanner):
    """PRM (Kavraki et al. 1996): all edges of the roadmap are checked in a scene before the first plan.

    It pays where many plans are made in one scene. Its paths are those of lazy PRM.
    """

    name = "prm"
    summary = "a roadmap whose edges are all checked before the first plan in a scene"

    neighbours: int = option(
        NEIGHBOURS, "nodes that each node is joined to", minimum=1, maximum=MOST_NEIGHBOURS
    )

    _is_lazy = False

    @property
    def _wanted_neighbours(self) -> int | None:
        return self.neighbours


@dataclass(frozen=True, eq=False)
class LazyPRM(RoadmapPlanner):
    """Lazy PRM (Bohlin & Kavraki 2000): edges are checked only where a shortest way may use them.

    A* checks an edge when it would settle a node through it (Cohen et al. 2014). What was checked is kept
    with the roadmap for the next plan in the same scene.
    """

    name = "lazy_prm"
    summary = "a roadmap whose edges are checked only where a shortest way may use them"

    neighbours: int = option(
        NEIGHBOURS, "nodes that each node is joined to", minimum=1, maximum=MOST_NEIGHBOURS
    )

    @property
    def _wanted_neighbours(self) -> int | None:
        return self.neighbours


@dataclass(frozen=True, eq=False)
class PRMStar(RoadmapPlanner):
    """PRM* (Karaman & Frazzoli 2011): as many neighbours as paths need that approach the shortest.

    Each of n nodes is joined to e (1 + 1/dof) log n others. Edges are checked as in lazy PRM.
    """

    name = "prm_star"
    summary = "a roadmap with so many edges that paths approach the shortest as samples grow"

    def _roadmap_of(self, space: ArmSpace, rng: Seed) -> Roadmap:
        """See RoadmapPlanner. Raises InputError for a roadmap with a given number of neighbours."""
        found = super()._roadmap_of(space, rng)
        if not found.is_star:
            raise InputError(
                f"roadmap joins each node to {found.neighbours} others, and PRM* chooses how many; make it"
                " with neighbours=None, or use the planner 'lazy_prm'"
            )
        return found
