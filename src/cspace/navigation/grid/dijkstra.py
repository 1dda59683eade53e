"""Dijkstra's search: of all ways that wait the shortest goes on (Dijkstra 1959)."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from cspace.navigation.grid.search import BEST_FIRST, Settings, over_costs, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(
    world: Any,
    start: Any,
    goal: Any,
    *,
    metric: str = "octile",
    corners: str = "never",
    costs: ArrayLike | None = None,
) -> Route:
    """The shortest path over the cells of a grid, found without a guess of the remaining distance.

    start, goal: (2,) [m] in free cells. metric, corners, costs (rows, columns): as for A*.
    """
    options = {"metric": metric, "corners": corners, "costs": costs}
    return search(world, start, goal, "dijkstra", options, _settings(world, metric, corners, costs))


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion."""
    return traced(route, _settings(route.world, **route.options))


def _settings(world: Any, metric: str, corners: str, costs: ArrayLike | None) -> Settings:
    return over_costs(Settings(BEST_FIRST, h_weight=0.0), world, metric, corners, costs)
