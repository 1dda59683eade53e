"""Wavefront: waves from the goal number the cells, and the way goes down from number to number (Barraquand,
Langlois & Latombe 1992; LaValle, Planning Algorithms, 2006, section 8.2)."""

from __future__ import annotations

from typing import Any

from cspace.navigation.grid.search import WAVES, Settings, metric_of, reason, search, traced
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, metric: str = "manhattan", corners: str = "never") -> Route:
    """A way over the cells of a grid of as few steps as there can be; by four moves that is the shortest.

    start, goal: (2,) [m] in free cells. metric: "manhattan" (four moves), or "octile" (eight, each counts as
    one step). corners: as for A*.
    """
    options = {"metric": metric, "corners": corners}
    return search(world, start, goal, "wavefront", options, _settings(metric, corners))


def trace(route: Route) -> Trace:
    """The cells in the order in which the waves settle them; value: the number of the wave times the side
    [m]."""
    return traced(route, _settings(**route.options))


def _settings(metric: str, corners: str) -> Settings:
    return Settings(WAVES, *metric_of(metric, corners))
