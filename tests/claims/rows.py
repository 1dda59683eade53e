"""The rows of the table of claims: each planner with the options that it is asked with, and what is claimed
of it.

What is claimed comes from the lecture where it has the planner, and else from the paper that its page names;
what is found is computed by `claims.cells`, and never written down.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from cspace.navigation import PLANNERS


@dataclass(frozen=True)
class Claim:
    """What is said of a planner, in the words of `claims.cells`; None: nothing."""

    map: str
    complete: str
    shortest: str | None = None
    clearance: str | None = None
    cost: str | None = None
    lecture: bool = False
    """Whether the lecture says so."""


@dataclass(frozen=True)
class Row:
    """A planner with options, and what is claimed of it."""

    name: str
    planner: str
    claim: Claim
    options: dict[str, Any] = field(default_factory=dict)
    few: dict[str, Any] = field(default_factory=dict)
    """Of planners that draw samples: options with fewer of them."""
    senses: float = 0.0
    """How far the robot sees [m]; 0: it feels what it touches."""
    promise: float | None = None
    """The factor within which a way is said to be the best."""
    sizes: tuple[int, ...] = ()
    """Sizes over which its growth is fitted, where the usual ones take too long."""
    some: bool = False
    """Whether it is made for some worlds alone, and refuses the others or leaves them undetermined."""

    @cached_property
    def world(self):
        return PLANNERS[self.planner].world

    @cached_property
    def draws(self):
        """Whether the planner draws samples."""
        return "rng" in PLANNERS[self.planner].options


YES, NO = "yes", "no"
CELLS, SAMPLES, SOME = "to resolution", "with samples", "in some worlds"
SHORTEST, OVER_CELLS, FOUR, TENDS = "shortest", "shortest over cells", "shortest by four moves", "tends to it"
WITHIN = "within {:g}"
WIDEST, WIDEST_CELLS, KEPT = "widest", "widest over cells", "in the middle"

LINEAR, LOG_LINEAR, SQUARE = "n", "n log n", "n² log n"


def lecture(map, complete, **more):
    return Claim(map, complete, lecture=True, **more)


def on_cells(shortest=OVER_CELLS, cost=None):
    return Claim(YES, CELLS, shortest, cost=cost)


_ALL = [
    Row("bug_1", "bug_1", lecture(NO, YES, shortest=NO)),
    Row("bug_2", "bug_2", lecture(NO, YES, shortest=NO)),
    Row("visibility_graph", "visibility_graph", lecture(YES, YES, shortest=SHORTEST, cost=SQUARE)),
    Row("voronoi", "voronoi", lecture(YES, YES, clearance=WIDEST, cost=LOG_LINEAR)),
    Row("voronoi, by length", "voronoi", Claim(YES, YES, clearance=KEPT), {"prefer": "length"}),
    Row("voronoi_bug", "voronoi_bug", lecture(NO, YES, clearance=KEPT), {"range": 2.0}, senses=2.0),
    Row("brushfire", "brushfire", lecture(YES, CELLS, clearance=WIDEST_CELLS, cost=LINEAR)),
    Row("exact_cells", "exact_cells", lecture(YES, YES, shortest=NO, cost=LOG_LINEAR)),
    Row("approximate_cells", "approximate_cells", lecture(YES, CELLS, shortest=NO)),
    Row(
        "potential_field",
        "potential_field",
        lecture(YES, NO, shortest=NO, cost=LINEAR),
        {"rho_0": 0.5},
        senses=0.5,
    ),
    Row("potential_a_star", "potential_a_star", lecture(YES, CELLS, shortest=WITHIN), promise=1.5),
    Row(
        "potential_a_star, exact",
        "potential_a_star",
        lecture(YES, CELLS, shortest=OVER_CELLS),
        {"mode": "exact"},
    ),
    Row("potential_a_star, greedy", "potential_a_star", lecture(YES, CELLS, shortest=NO), {"mode": "greedy"}),
    Row("any_angle", "any_angle", Claim(YES, YES, SHORTEST)),
    Row("tangent_bug", "tangent_bug", Claim(NO, YES, NO), {"range": 2.0}, senses=2.0),
    Row("prm", "prm", Claim(YES, SAMPLES, TENDS), {"samples": 3000}, {"samples": 60}),
    Row("rrt", "rrt", Claim(YES, SAMPLES, NO), few={"samples": 60}),
    Row("rrt_star", "rrt_star", Claim(YES, SAMPLES, TENDS), few={"samples": 60}),
    Row("dijkstra", "dijkstra", on_cells(cost=LOG_LINEAR)),
    Row("a_star", "a_star", on_cells(cost=LOG_LINEAR)),
    Row("weighted_a_star", "weighted_a_star", on_cells(WITHIN), promise=1.5),
    Row("focal_search", "focal_search", on_cells(WITHIN), promise=1.5),
    Row("greedy_best_first", "greedy_best_first", on_cells(NO)),
    Row("jump_point_search", "jump_point_search", on_cells()),
    Row("d_star_lite", "d_star_lite", on_cells()),
    Row("theta_star", "theta_star", on_cells(NO)),
    Row("wavefront", "wavefront", on_cells(FOUR, cost=LINEAR)),
    Row("fast_marching", "fast_marching", on_cells(NO, cost=LOG_LINEAR)),
    Row("harmonic", "harmonic", on_cells(NO), sizes=(3, 4, 6, 8, 12, 17)),
    Row("rimon_koditschek", "rimon_koditschek", Claim(YES, SOME, NO), sizes=(1, 2, 3, 4, 5, 6), some=True),
]

ROWS = {row.name: row for row in _ALL if row.planner in PLANNERS}
"""Every row whose planner exists, by name."""
