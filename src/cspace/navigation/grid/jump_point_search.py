"""Jump point search: A* that goes straight from one place where a shortest path may have to turn to the
next (Harabor & Grastien 2011, 2014)."""

from __future__ import annotations

from typing import Any

from cspace.navigation.grid.search import JUMP_POINTS, Settings, metric_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]

USUAL = Settings(JUMP_POINTS)


def plan(world: Any, start: Any, goal: Any, *, metric: str = "octile", corners: str = "never") -> Route:
    """The shortest path over the cells of a grid, as A* finds it, with far fewer cells looked at.

    start, goal: (2,) [m] in free cells. metric, corners: as for A*.

    Cells have no costs here: jumps rest on all ways of equal length being alike.
    """
    options = {"metric": metric, "corners": corners}
    usual = metric == "octile" and corners == "never"
    settings = USUAL if usual else _settings(metric, corners)
    return search(world, start, goal, "jump_point_search", options, settings)


def trace(route: Route) -> Trace:
    """The jump points in the order of their expansion."""
    return traced(route, _settings(**route.options))


def _settings(metric: str, corners: str) -> Settings:
    return Settings(JUMP_POINTS, *metric_of(metric, corners))
