"""The planners of the library by name."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from types import MappingProxyType
from typing import Any, Final

from cspace.errors import InputTypeError, suggest
from cspace.navigation.any_angle import AnyAngle
from cspace.navigation.bugs import Bug1, Bug2, TangentBug, VoronoiBug
from cspace.navigation.cells import ApproximateCellsSearch, ExactCells
from cspace.navigation.fields import (
    Brushfire,
    FastMarching,
    Harmonic,
    PotentialAStar,
    PotentialField,
    RimonKoditschek,
)
from cspace.navigation.grid import (
    AStar,
    Dijkstra,
    DStarLiteSearch,
    FocalSearch,
    GreedyBestFirst,
    JumpPointSearch,
    ThetaStar,
    Wavefront,
    WeightedAStar,
)
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.sampling import PRM, RRT, RRTStar
from cspace.navigation.visibility import VisibilityGraphSearch
from cspace.navigation.voronoi import Voronoi

__all__ = ["PLANNERS", "find_planner"]

_BUGS = (Bug1, Bug2, TangentBug, VoronoiBug)
_POLYGONS = (VisibilityGraphSearch, Voronoi, AnyAngle, ExactCells, ApproximateCellsSearch)
_FIELDS = (Brushfire, PotentialField, PotentialAStar, RimonKoditschek, Harmonic, FastMarching)
_GRID = (Dijkstra, AStar, WeightedAStar, FocalSearch, GreedyBestFirst, JumpPointSearch, ThetaStar, Wavefront)
_CLASSES: tuple[type[PlanePlanner], ...] = (
    *_BUGS,
    *_POLYGONS,
    *_FIELDS,
    *_GRID,
    DStarLiteSearch,
    PRM,
    RRT,
    RRTStar,
)

PLANNERS: Final[Mapping[str, PlanePlanner]] = MappingProxyType({each.name: each() for each in _CLASSES})
"""Every planner of the library with its default options, by name."""


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
        raise InputTypeError(
            f"planner is an object of type {type(planner).__name__}; derive the class from PlanePlanner"
        )
    raise suggest("planner", planner, PLANNERS)
