"""Greedy best-first search: of all cells that wait the one that seems nearest to the goal goes on (Pearl
1984)."""

from __future__ import annotations

from typing import Any

from cspace.navigation.grid.search import BEST_FIRST, Settings, metric_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, metric: str = "octile", corners: str = "never") -> Route:
    """A way over the cells of a grid, soon found and as long as it happens to be.

    start, goal: (2,) [m] in free cells. metric, corners: as for A*.
    """
    options = {"metric": metric, "corners": corners}
    return search(world, start, goal, "greedy_best_first", options, _settings(metric, corners))


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion."""
    return traced(route, _settings(**route.options))


def _settings(metric: str, corners: str) -> Settings:
    return Settings(BEST_FIRST, *metric_of(metric, corners), g_weight=0.0)
