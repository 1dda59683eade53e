"""A*: of all ways that wait the one goes on that may still be shortest (Hart, Nilsson & Raphael 1968)."""

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
    """The shortest path over the cells of a grid; with costs the cheapest.

    start, goal: (2,) [m] in free cells. metric: "octile" (eight moves), "manhattan" (four), or "euclidean"
    (eight, with the straight line as the remaining distance). corners: whether a diagonal step may pass
    blocked cells: "never", with "one" beside it, "always". costs (rows, columns): of the cells, each more
    than 0; with None a way costs its length, else a step costs its length times the mean of its two cells.

    route.evidence["cost"] is what the way costs then.
    """
    options = {"metric": metric, "corners": corners, "costs": costs}
    return search(world, start, goal, "a_star", options, _settings(world, metric, corners, costs))


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion."""
    return traced(route, _settings(route.world, **route.options))


def _settings(world: Any, metric: str, corners: str, costs: ArrayLike | None) -> Settings:
    return over_costs(Settings(BEST_FIRST), world, metric, corners, costs)
