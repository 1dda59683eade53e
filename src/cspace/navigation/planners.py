"""The planners by name: one row each, one file each in the room of its kind, imported when first asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, Protocol, cast

from cspace.errors import attribute_error, suggest
from cspace.search.options import Option, options_of

if TYPE_CHECKING:
    from cspace.maps import OccupancyGrid
    from cspace.search.trace import Trace

__all__ = ["PLANNERS", "Planner", "module_of", "planner_named"]


@dataclass(frozen=True)
class Planner:
    """One planner: its name, a line on what it does, the world it works in, and what it is shown of it."""

    name: str
    room: str
    """The folder of its file."""
    summary: str
    world: str
    """Its own kind of world, "polygons" or "grid": one of the other kind is converted."""
    sensing: str
    """What it is shown: "map", or where it needs none, "contact" or "range"."""
    takes_cells: bool = False
    """Whether its file says, by takes_cells(grid), of which grids the cells serve it better than polygons."""

    if not TYPE_CHECKING:  # type checkers report such names themselves

        def __getattr__(self, name: str) -> Any:
            raise attribute_error(self, name)

    @property
    def options(self) -> Mapping[str, Option]:
        """Its options by name: the type, default, unit and meaning of each."""
        return options_of(module_of(self.name).plan, module_of("a_star").plan)


_ROWS: Final[tuple[Planner, ...]] = (
    Planner(
        "bug_1",
        "bugs",
        "a robot that feels walls: around each, then on from its point nearest the goal",
        "polygons",
        "contact",
    ),
    Planner(
        "bug_2",
        "bugs",
        "a robot that feels walls: along them, back to the line from start to goal",
        "polygons",
        "contact",
    ),
    Planner(
        "tangent_bug",
        "bugs",
        "a robot that sees walls up to a distance: around what is in view",
        "polygons",
        "range",
    ),
    Planner(
        "voronoi_bug",
        "bugs",
        "a robot that sees walls up to a distance: as far from two of them",
        "polygons",
        "range",
    ),
    Planner(
        "visibility_graph",
        "visibility",
        "the shortest path over corners that see each other",
        "polygons",
        "map",
    ),
    Planner("voronoi", "voronoi", "the widest way, along points as far from two walls", "polygons", "map"),
    Planner(
        "any_angle",
        "any_angle",
        "the shortest path, through convex polygons (Polyanya)",
        "polygons",
        "map",
        takes_cells=True,
    ),
    Planner(
        "exact_cells",
        "cells",
        "a path through trapezoids between the corners, pulled taut",
        "polygons",
        "map",
    ),
    Planner(
        "approximate_cells", "cells", "a path through free squares, split where needed", "polygons", "map"
    ),
    Planner(
        "brushfire",
        "fields",
        "the widest way over cells, along the diagram of waves from walls",
        "grid",
        "map",
    ),
    Planner(
        "potential_field", "fields", "down a potential: the goal attracts, walls repel", "polygons", "map"
    ),
    Planner(
        "potential_a_star", "fields", "over cells, by a search that counts on a potential", "grid", "map"
    ),
    Planner(
        "rimon_koditschek",
        "fields",
        "down a function whose only minimum is the goal, among stars",
        "polygons",
        "map",
    ),
    Planner(
        "harmonic", "fields", "down Laplace's equation over cells, whose only rest is the goal", "grid", "map"
    ),
    Planner(
        "fast_marching", "fields", "down the times of a front from the goal, at any angle", "grid", "map"
    ),
    Planner(
        "dijkstra",
        "grid",
        "the shortest way over cells, found without a guess of what is left",
        "grid",
        "map",
    ),
    Planner("a_star", "grid", "the shortest way over cells, or with costs the cheapest", "grid", "map"),
    Planner("weighted_a_star", "grid", "a way at most so many times the shortest", "grid", "map"),
    Planner(
        "focal_search", "grid", "a way at most so many times the shortest, and a bound for it", "grid", "map"
    ),
    Planner("greedy_best_first", "grid", "a way over cells that is soon found", "grid", "map"),
    Planner("jump_point_search", "grid", "the shortest way over cells, from turn to turn", "grid", "map"),
    Planner("theta_star", "grid", "a short way of any angle over cells that see each other", "grid", "map"),
    Planner(
        "wavefront",
        "grid",
        "a way of the fewest steps over cells, down the waves from the goal",
        "grid",
        "map",
    ),
    Planner("d_star_lite", "grid", "the shortest way over cells, mended when they change", "grid", "map"),
    Planner(
        "prm",
        "sampling",
        "a roadmap of random points that see each other, and a shortest way on it",
        "polygons",
        "map",
    ),
    Planner(
        "rrt", "sampling", "a tree that grows towards random points until it sees the goal", "polygons", "map"
    ),
    Planner(
        "rrt_star", "sampling", "a tree of random points whose ways tend to the shortest", "polygons", "map"
    ),
)

PLANNERS: Final = MappingProxyType({row.name: row for row in _ROWS})
"""Every planner of `cs.navigate`, by name."""


class PlannerModule(Protocol):
    """What a planner's file offers; routes know planners by name, so planners' rows know no routes."""

    plan: Callable[..., Any]
    """plan(world, start, goal, **options) → Route: start and goal (2,) lie in free space."""

    reason: Callable[[Any], str]
    """reason(route): the verdict as one sentence."""

    trace: Callable[[Any], Trace]
    """trace(route): the events of the search, by running it again with a record kept."""

    takes_cells: Callable[[OccupancyGrid], bool]
    """Of planners whose row says so: which grids it takes as they are."""


def planner_named(name: object) -> Planner:
    """The row of a planner; UnknownNameError suggests the nearest name."""
    row = PLANNERS.get(name) if isinstance(name, str) else None
    if row is None:
        raise suggest("planner", name, PLANNERS)
    return row


@cache
def module_of(name: str) -> PlannerModule:
    """The file of a planner, imported."""
    row = PLANNERS[name]
    return cast(PlannerModule, import_module(f"cspace.navigation.{row.room}.{row.name}"))
