"""The planners of the library by name."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from types import MappingProxyType
from typing import Any, Final

from cspace.errors import InputTypeError, suggest
from cspace.navigation import any_angle, bugs, cells, fields, grid, sampling, visibility, voronoi
from cspace.navigation.planner import PlanePlanner

_EXPORTS = (
    getattr(room, name)
    for room in (bugs, visibility, voronoi, any_angle, cells, fields, grid, sampling)
    for name in room.__all__
)
PLANNERS: Final[Mapping[str, PlanePlanner]] = MappingProxyType(
    {each.name: each() for each in _EXPORTS if isinstance(each, type) and issubclass(each, PlanePlanner)}
)
"""Every planner that a room exports, with its default options, by name."""


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
