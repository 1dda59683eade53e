"""The planners of the library by name."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from types import MappingProxyType
from typing import Any, Final

from cspace.errors import InputTypeError, suggest
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

MODULES = (
    *(wall_followers, voronoi_bug, visibility_graph, voronoi, any_angle, approximate_cells, exact_cells),
    *(brushfire, fast_marching, harmonic, potential_a_star, potential_field, rimon_koditschek),
    *(best_first, d_star_lite, planners),
)
PLANNERS: Final[Mapping[str, PlanePlanner]] = MappingProxyType(
    {
        each.name: each()
        for module in MODULES
        for each in vars(module).values()
        if isinstance(each, type) and issubclass(each, PlanePlanner) and each.summary
    }
)
"""Every planner of the library, with its default options, by name."""


@lru_cache(maxsize=64, typed=True)
def _with_options(name: str, /, **options: Any) -> PlanePlanner:
    """A planner of the library with options, kept: it is immutable, and checks take microseconds."""
    return PLANNERS[name].with_options(options)


def find_planner(planner: object, options: Mapping[str, Any] = MappingProxyType({})) -> PlanePlanner:
    """The planner of a name, or a planner itself, with options; UnknownNameError suggests the nearest name,
    InputTypeError names an option that it does not have."""
    found = PLANNERS.get(planner) if isinstance(planner, str) else planner
    if isinstance(found, PlanePlanner):
        if not options:
            return found
        if found is not planner:
            with suppress(TypeError):  # an array cannot be hashed; a wrong option is named below
                return _with_options(found.name, **options)
        return found.with_options(options)
    if isinstance(planner, type) and issubclass(planner, PlanePlanner):
        raise InputTypeError(f"planner is the class {planner.__name__}; give an object: {planner.__name__}()")
    if callable(getattr(planner, "plan", None)):
        kind = type(planner).__name__
        raise InputTypeError(f"planner is an object of type {kind}; derive its class from PlanePlanner")
    raise suggest("planner", planner, PLANNERS)
