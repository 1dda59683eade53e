"""Weighted A*: the remaining distance counts more than it should, so the search hurries to the goal (Pohl
1970)."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from cspace.navigation.grid.search import (
    BEST_FIRST,
    Settings,
    at_least_one,
    over_costs,
    reason,
    search,
    traced,
)
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(
    world: Any,
    start: Any,
    goal: Any,
    *,
    weight: float = 1.5,
    metric: str = "octile",
    corners: str = "never",
    costs: ArrayLike | None = None,
) -> Route:
    """A way over the cells of a grid at most `weight` times as long, or costly, as the best.

    start, goal: (2,) [m] in free cells. weight: how many times as long the way may be, 1 or more; 1 is
    A*. metric, corners, costs (rows, columns): as for A*.

    InputError for a weight below 1.
    """
    options: dict[str, Any] = {"weight": weight, "metric": metric, "corners": corners, "costs": costs}
    return search(world, start, goal, "weighted_a_star", options, _settings(world, **options))


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion."""
    return traced(route, _settings(route.world, **route.options))


def _settings(world: Any, weight: float, metric: str, corners: str, costs: ArrayLike | None) -> Settings:
    given = Settings(BEST_FIRST, h_weight=at_least_one(weight, "weight"))
    return over_costs(given, world, metric, corners, costs)
