"""Theta*: A* over the cells of a grid whose ways may turn by any angle where cells see each other (Nash,
Daniel, Koenig & Felner 2007; lazy: Nash, Koenig & Tovey 2010)."""

from __future__ import annotations

from typing import Any

from cspace.errors import InputTypeError
from cspace.navigation.grid.search import (
    LAZY_THETA_STAR,
    METRICS,
    THETA_STAR,
    Settings,
    metric_of,
    reason,
    search,
    traced,
)
from cspace.navigation.route import Route
from cspace.search.trace import Trace

__all__ = ["plan", "reason", "trace"]


def plan(world: Any, start: Any, goal: Any, *, corners: str = "never", lazy: bool = False) -> Route:
    """A way from centre to centre of cells that see each other: short, though not always the shortest.

    start, goal: (2,) [m] in free cells. corners: whether a sight line, or a diagonal step, may pass a corner
    of blocked cells: "never", where "one" of the two cells beside it is free, "always". lazy: sight lines are
    looked at when a cell is settled, which are fewer, not each time it is reached.
    """
    options = {"corners": corners, "lazy": lazy}
    return search(world, start, goal, "theta_star", options, _settings(corners, lazy))


def trace(route: Route) -> Trace:
    """The cells in the order of their expansion, each from its parent."""
    return traced(route, _settings(**route.options))


def _settings(corners: str, lazy: bool) -> Settings:
    if not isinstance(lazy, bool):
        raise InputTypeError(f"lazy must be True or False, got {lazy!r}")
    rule, _ = metric_of("octile", corners)
    return Settings(LAZY_THETA_STAR if lazy else THETA_STAR, rule, METRICS["euclidean"])
