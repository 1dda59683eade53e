"""The planners of the library by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

from cspace.navigation.any_angle import any_angle
from cspace.navigation.bugs import voronoi_bug, wall_followers
from cspace.navigation.cells import approximate_cells, exact_cells
from cspace.navigation.fields import (
    brushfire,
    fast_marching,
    harmonic,
    potential_a_star,
    potential_field,
    rimon_koditschek,
)
from cspace.navigation.grid import best_first, d_star_lite
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.sampling import planners
from cspace.navigation.visibility import visibility_graph
from cspace.navigation.voronoi import voronoi
from cspace.search import choose_planner, collect_planners

MODULES = (
    *(wall_followers, voronoi_bug, visibility_graph, voronoi, any_angle, approximate_cells, exact_cells),
    *(brushfire, fast_marching, harmonic, potential_a_star, potential_field, rimon_koditschek),
    *(best_first, d_star_lite, planners),
)
PLANNERS: Final[Mapping[str, PlanePlanner]] = collect_planners(MODULES, PlanePlanner)
"""Every planner of the library, with its default options, by name."""


def find_planner(planner: object, options: Mapping[str, Any] = MappingProxyType({})) -> PlanePlanner:
    """The planner of a name, or a planner itself, with options; see search.choose_planner for the errors."""
    return choose_planner(planner, options, PLANNERS, PlanePlanner)
