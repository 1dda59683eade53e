"""Best-first searches over the cells of a grid. They differ in the order in which they expand open nodes, and
in the rules for moves and parents."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cspace.navigation.grid.search import (
    CORNERS,
    FOCAL,
    JUMP_POINTS,
    LAZY_THETA_STAR,
    METRICS,
    THETA_STAR,
    WAVES,
    CostPlanner,
    GridPlanner,
    SearchPlanner,
    Settings,
    corners_option,
)
from cspace.search import option


class AStar(CostPlanner):
    """A*: expands the open node with the smallest f = g + h. The path over the cells of a grid is the
    shortest, with costs the cheapest (Hart, Nilsson & Raphael 1968)."""

    name = "a_star"
    summary = "shortest path over cells, or with costs the cheapest"


class Dijkstra(CostPlanner):
    """Dijkstra's search: expands the open node with the smallest g (Dijkstra 1959)."""

    name = "dijkstra"
    summary = "shortest path over cells, without a heuristic"

    def _weigh_nodes(self) -> dict[str, Any]:
        return {"h_weight": 0.0}


@dataclass(frozen=True, eq=False)
class WeightedAStar(CostPlanner):
    """Weighted A*: multiplies the estimate of the remaining distance by `weight`; the path is at most
    `weight` times as long, or costly, as the best (Pohl 1970)."""

    name = "weighted_a_star"
    summary = "path within a given factor of the shortest"

    weight: float = option(1.5, "how many times as long the way may be, 1 or more; 1 is A*.", minimum=1)

    def _weigh_nodes(self) -> dict[str, Any]:
        return {"h_weight": self.weight}


@dataclass(frozen=True, eq=False)
class FocalSearch(CostPlanner):
    """Focal search: of the open nodes whose f is at most `bound` times the smallest, expands the one with the
    least estimate of the remaining distance (A*ε, Pearl & Kim 1982).

    The path is at most `bound` times as long, or costly, as the best. route.evidence holds its cost, and
    "at_least", below which no path costs: the factor that is proven of this path is their quotient.
    """

    name = "focal_search"
    summary = "path within a given factor of the shortest, with a proven bound"
    kind = FOCAL

    bound: float = option(1.5, "how many times as long the way may be, 1 or more.", minimum=1)

    def _weigh_nodes(self) -> dict[str, Any]:
        return {"bound": self.bound}


class GreedyBestFirst(GridPlanner):
    """Greedy best-first search: expands the open node with the smallest h. The path is found with few
    expansions and may have any length (Pearl 1984)."""

    name = "greedy_best_first"
    summary = "path over cells, found with few expansions"

    def _weigh_nodes(self) -> dict[str, Any]:
        return {"g_weight": 0.0}


class JumpPointSearch(GridPlanner):
    """Jump point search: A* that goes straight from one cell at which a shortest path may have to turn to the
    next, and looks at far fewer cells (Harabor & Grastien 2011, 2014).

    Cells have no costs here, because jumps need all paths of equal length to be equally good. The trace
    contains the jump points in the order of their expansion.
    """

    name = "jump_point_search"
    summary = "shortest path over cells, from turn to turn"
    kind = JUMP_POINTS


@dataclass(frozen=True, eq=False)
class Wavefront(GridPlanner):
    """Wavefront: waves from the goal number the cells, and the path descends the numbers. It has the fewest
    steps of all; by four moves that is the shortest (Barraquand, Langlois & Latombe 1992; LaValle, Planning
    Algorithms, 2006, section 8.2).

    The trace contains the cells in the order in which the waves settle them; its value is the number of the
    wave times the side of a cell [m].
    """

    name = "wavefront"
    summary = "path with the fewest steps over cells"
    kind = WAVES

    metric: str = option(
        "manhattan",
        '"manhattan" (four moves), or "octile" (eight, each counts as one step).',
        choices=METRICS,
    )


@dataclass(frozen=True, eq=False)
class ThetaStar(SearchPlanner):
    """Theta*: A* over the cells of a grid whose path may turn by any angle where cells are mutually visible;
    it is short, though not always the shortest (Nash, Daniel, Koenig & Felner 2007; lazy: Nash, Koenig &
    Tovey 2010)."""

    name = "theta_star"
    summary = "short path at any angle over mutually visible cells"

    corners: str = corners_option(
        "whether a sight line, or a diagonal step, may pass a corner of blocked cells: "
        '"never", where "one" of the two cells beside it is free, "always".'
    )
    lazy: bool = option(
        False,
        "sight lines are looked at when a cell is settled, which are fewer, not each time it is reached.",
    )

    def _make_settings(self) -> Settings:
        kind = LAZY_THETA_STAR if self.lazy else THETA_STAR
        return Settings(kind, CORNERS[self.corners], METRICS["euclidean"])
