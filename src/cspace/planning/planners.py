"""The planners of arms by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

from cspace.planning import aorrtc, grid_search, potential_field, prm, rrt, rrt_connect
from cspace.planning.arm_planner import ArmPlanner
from cspace.search import choose_planner, collect_planners

MODULES = (rrt_connect, aorrtc, rrt, prm, grid_search, potential_field)
PLANNERS: Final[Mapping[str, ArmPlanner]] = collect_planners(MODULES, ArmPlanner)
"""Every planner of arms, with its default options, by name."""


def find_planner(planner: object, options: Mapping[str, Any] = MappingProxyType({})) -> ArmPlanner:
    """The planner of a name, or a planner itself, with options; see search.choose_planner for the errors."""
    return choose_planner(planner, options, PLANNERS, ArmPlanner)
