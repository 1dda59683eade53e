"""Focal search: among the ways that are surely good enough, the one that seems nearest to the goal goes on
(A*ε, Pearl & Kim 1982)."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from cspace.navigation.grid.search import FOCAL, Settings, at_least_one, over_costs, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(
    world: Any,
    start: Any,
    goal: Any,
    *,
    bound: float = 1.5,
    metric: str = "octile",
    corners: str = "never",
    costs: ArrayLike | None = None,
) -> Route:
    """A way over the cells of a grid at most `bound` times as long, or costly, as the best.

    start, goal: (2,) [m] in free cells. bound: how many times as long the way may be, 1 or more. metric,
    corners, costs (rows, columns): as for A*.

    route.evidence holds the cost of the way between their cells, and "at_least", below which no way
    costs: the factor that is proven of this very answer is their quotient. InputError for a bound below
    1.
    """
    options: dict[str, Any] = {"bound": bound, "metric": metric, "corners": corners, "costs": costs}
    return search(world, start, goal, "focal_search", options, _settings(world, **options))


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion."""
    return traced(route, _settings(route.world, **route.options))


def _settings(world: Any, bound: float, metric: str, corners: str, costs: ArrayLike | None) -> Settings:
    given = Settings(FOCAL, bound=at_least_one(bound, "bound"))
    return over_costs(given, world, metric, corners, costs)
