"""PlanePlanner: the base of planners of the plane, those of the library and those of users."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from cspace.maps.points import as_path
from cspace.navigation.checks import check_ends
from cspace.navigation.route import Route, Stats, new_route
from cspace.search import Planner, Trace

NO_EVENTS = (np.empty(0, np.int8), np.empty((0, 2)), np.empty((0, 2)), np.empty(0))


class PlanePlanner(Planner):
    """A planner of the plane: `plan(world, start, goal)` returns a Route, start and goal (2,) [m].

    A subclass is a dataclass(frozen=True). It declares its options as fields, by `cs.search.option`, and
    defines `plan`, which returns `self.make_route(…)`.
    """

    world: ClassVar[str] = "polygons"
    """The kind of world in which it plans, "polygons" or "grid"; `navigate` converts the other kind."""
    sensing: ClassVar[str] = "map"
    """What it senses: "map", or without a map "contact" or "range"."""
    takes_cells: ClassVar[bool] = False
    """Whether a planner of polygons takes the grids for which `takes_grid` is true as they are."""
    events: ClassVar[tuple[str, ...]] = ()
    """The kinds of events of its trace."""

    def plan(self, world: Any, start: ArrayLike, goal: ArrayLike) -> Route:
        """The route from start to goal (2,) [m] in a world of the planner's kind."""
        route: Route = self._fill_in(world)._search(False, world, start, goal)
        return route

    def explain_route(self, route: Route) -> str:
        """The verdict as one sentence."""
        return f"found a path of {route.length:.6g} m" if route else "no path was found"

    def trace_route(self, route: Route) -> Trace:
        """The events of the search, recorded in a second run."""
        return Trace(self.events, *self._record(route))

    def takes_grid(self, grid: Any) -> bool:
        """Whether the cells of this grid serve the planner better than polygons."""
        return self.takes_cells

    def make_route(
        self,
        world: Any,
        start: ArrayLike,
        goal: ArrayLike,
        path: ArrayLike = (),
        status: str = "",
        *,
        stats: Stats | None = None,
        evidence: Any = None,
    ) -> Route:
        """The Route of a path (m, 2) [m]. status: one of `STATUSES`; by default "found", or "undetermined" if
        the path is empty. evidence: its attribute `reason`, if any, replaces `explain_route`."""
        points = as_path(path) if np.size(path) else np.empty((0, 2))
        length = float(np.hypot(*np.diff(points, axis=0).T).sum()) if len(points) else np.inf
        status = status or ("found" if len(points) else "undetermined")
        ends = check_ends(world, start, goal)
        return new_route(world, self, ends, status, points, length, stats or Stats(0, 0, 0.0), evidence)

    def _fill_in(self, world: Any) -> PlanePlanner:
        """The planner with the defaults that depend on the world, and a seed."""
        return self

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        """Calls the compiled search, which has start and goal (2,) [m] checked by `world.check_free`: the
        Route, or if traced the arrays of the trace: kinds (k,), start, end (k, 2) [m], values (k,)."""
        if traced:
            return NO_EVENTS
        raise NotImplementedError(f"{type(self).__name__} defines no plan(world, start, goal)")

    def _record(self, route: Route) -> Any:
        """The arrays of the trace of a route."""
        return self._search(True, route.world, route.start, route.goal)
